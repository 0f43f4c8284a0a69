# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of the pages: each file, figure and heading that a page of the project points at is there, and each figure of
doc/figures is shown by one."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r'!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+"[^"]*")?\s*\)')
REFERENCE = re.compile(r'^\[[^\]^]+\]:\s+(\S+)', re.MULTILINE)
CODE = re.compile(r'^(```|~~~).*?^\1|`[^`\n]*`', re.MULTILINE | re.DOTALL)


def without_code(text):
    """The page without blocks and pieces of code, in which brackets are no links."""
    return CODE.sub('', text)


def links_of(text):
    text = without_code(text)
    return LINK.findall(text) + REFERENCE.findall(text)


def anchors_of(text):
    """The names that a forge gives to the headings of a page: lower case, blanks as hyphens, no punctuation."""
    text = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    seen, names = {}, set()
    for title in re.findall(r'^#{1,6}\s+(.*?)\s*#*$', text, re.MULTILINE):
        title = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', title)
        name = re.sub(r'[^\w\- ]', '', title.lower()).replace(' ', '-')
        count = seen.get(name, 0)
        seen[name] = count + 1
        names.add(f'{name}-{count}' if count else name)
    return names | set(re.findall(r'<a (?:id|name)="([^"]+)"', text))


def pages():
    names = subprocess.run(['git', '-C', ROOT, 'ls-files', '*.md'], capture_output=True, text=True).stdout.split()
    if not names:  # not a repository: an unpacked archive
        names = [str(path.relative_to(ROOT)) for path in ROOT.rglob('*.md')
                 if not any(part.startswith(('build', '.')) for part in path.relative_to(ROOT).parts[:-1])]
    # what a page is generated from shows the links of the page
    return sorted(ROOT / name for name in names if not name.endswith('.in.md'))


def fault(page, link, texts):
    """What is wrong with a link of a page, or nothing."""
    if re.match(r'[a-z]+:', link):
        return None  # outside the project: nothing is fetched in a test
    path, _, anchor = link.partition('#')
    target = (page.parent / path).resolve() if path else page
    if not target.exists():
        return 'there is no such file'
    if anchor and target.suffix == '.md':
        if target not in texts:
            texts[target] = target.read_text(encoding='utf-8')
        if anchor not in anchors_of(texts[target]):
            return 'there is no such heading'
    return None


class Links(unittest.TestCase):
    def test_each_link_within_the_project_leads_somewhere(self):
        texts = {page: page.read_text(encoding='utf-8') for page in pages()}
        count, faults = 0, []
        for page, text in list(texts.items()):
            for link in links_of(text):
                count += 1
                wrong = fault(page, link, texts)
                if wrong:
                    faults.append(f'{page.relative_to(ROOT)}: {link}: {wrong}')
        self.assertGreater(count, 100)
        self.assertEqual(faults, [])

    def test_each_figure_is_shown_by_a_page(self):
        shown = set()
        for page in pages():
            for link in links_of(page.read_text(encoding='utf-8')):
                shown.add((page.parent / link.partition('#')[0]).resolve())
        figures = list((ROOT / 'doc/figures').glob('*.png'))
        self.assertTrue(figures)
        self.assertEqual([path.name for path in figures if path.resolve() not in shown], [])

    def test_wrong_links_are_found(self):
        page = ROOT / 'README.md'
        text = '# A title\n![figure](doc/figures/none.png) [here](#a-title) [there](#another) `[code](none.md)`\n'
        faults = [fault(page, link, {page: text}) for link in links_of(text)]
        self.assertEqual(faults, ['there is no such file', None, 'there is no such heading'])


if __name__ == '__main__':
    unittest.main()
