#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The links of the project's pages (Markdown, and the text of notebooks): which there are, and what is wrong with one.

    doc/markdown_links.py              faults of the links within the project, a line each
    doc/markdown_links.py --external   the links that lead out of it, and where they stand
"""
import argparse
import functools
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LINK = re.compile(r'(!?\[[^\]]*\]\(\s*<?)([^)\s>]+)(>?(?:\s+"[^"]*")?\s*\))')
PLACE = re.compile(r'<a (?:id|name)="([^"]+)"')  # that a link may lead to beside the headings
REFERENCE = re.compile(r'^\[[^\]^]+\]:\s+(\S+)', re.MULTILINE)
PICTURE = re.compile(r'<img [^>]*\bsrc="([^"]+)"')
BARE = re.compile(r'https?://[^\s)>\]"`]+')
CODE = re.compile(r'^(```|~~~).*?^\1|`[^`\n]*`', re.MULTILINE | re.DOTALL)
FILE = re.compile(r'`((?:doc|inputs|liggghts_fix|pfvlib|tests)/[\w./-]*)`')


@functools.cache
def tracked():
    """Files and folders of the repository, as paths; what a run has left in it is not among them."""
    files = []
    if shutil.which('git'):
        done = subprocess.run(['git', '-C', ROOT, 'ls-files', '-co', '--exclude-standard'], capture_output=True, text=True)
        files = [ROOT / name for name in done.stdout.split('\n') if name]
    if not files:  # not a repository, an unpacked archive, or a machine without git
        files = [path for path in ROOT.rglob('*')
                 if not any(part.startswith(('build', '.')) for part in path.relative_to(ROOT).parts[:-1])]
    return {path for path in files if path.exists()} | {folder for path in files for folder in path.parents}


def pages():
    """Those of the repository, sorted. What a page is generated from (*.in.md) is none: it has the page's links."""
    return sorted(path for path in tracked() if path.suffix == '.md' and not path.name.endswith('.in.md'))


def notebooks():
    return sorted(path for path in tracked() if path.suffix == '.ipynb')


def text_of(page):
    text = page.read_text(encoding='utf-8')
    if page.suffix != '.ipynb':
        return text
    return '\n\n'.join(''.join(cell['source']) for cell in json.loads(text)['cells'] if cell['cell_type'] == 'markdown')


def without_code(text):
    """The page without blocks and pieces of code, in which brackets are no links."""
    return CODE.sub('', text)


def links_of(text):
    text = without_code(text)
    return [link for _, link, _ in LINK.findall(text)] + REFERENCE.findall(text) + PICTURE.findall(text)


def is_external(link):
    return re.match(r'[a-z]+:', link) is not None


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
    return names | set(PLACE.findall(text))


def fault(page, link, text):
    """What is wrong with a link of a page with this text, or nothing."""
    if is_external(link):
        return None  # nothing is fetched
    path, _, anchor = link.partition('#')
    target = (page.parent / path).resolve() if path else page
    if target not in tracked():
        return 'there is no such file'
    if anchor and target.suffix == '.md' and anchor not in anchors_of(text if target == page else text_of(target)):
        return 'there is no such heading'
    return None


def faults_of(page, text):
    """Sentences on the links of a page and the files of the project that it names."""
    where = page.relative_to(ROOT)
    faults = [f'{where}: {link}: {wrong}' for link in links_of(text) if (wrong := fault(page, link, text))]
    return faults + [f'{where}: `{name}`: there is no such file' for name in FILE.findall(text)
                     if (ROOT / name).resolve() not in tracked()]


def external():
    """{link: [pages]}"""
    found = {}
    for page in pages() + notebooks():
        text = text_of(page)
        for link in sorted({link for link in links_of(text) if is_external(link)} | set(BARE.findall(text))):
            found.setdefault(link.rstrip('.,;'), []).append(str(page.relative_to(ROOT)))
    return found


def main():
    words = argparse.ArgumentParser(description=__doc__.partition('\n')[0])
    words.add_argument('--external', action='store_true', help='list the links that lead out of the project')
    if words.parse_args().external:
        for link, where in sorted(external().items()):
            print(link, ' '.join(where))
        return 0
    faults = [wrong for page in pages() + notebooks() for wrong in faults_of(page, text_of(page))]
    print('\n'.join(faults) or 'no link within the project is broken')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
