# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of the pages: each file, figure and heading that a page of the project points at is there, each file that it
names by its path, and each figure of doc/figures is shown by one. `doc/markdown_links.py --external` lists others."""
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'doc'))
from markdown_links import ROOT, fault, faults_of, is_external, links_of, notebooks, pages, text_of  # noqa: E402


class Links(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.texts = {page: text_of(page) for page in pages() + notebooks()}

    def test_each_link_within_the_project_leads_somewhere(self):
        self.assertGreater(sum(not is_external(link) for text in self.texts.values() for link in links_of(text)), 200)
        self.assertEqual([wrong for page, text in self.texts.items() for wrong in faults_of(page, text)], [])

    def test_each_figure_is_shown_by_a_page(self):
        shown = {(page.parent / link.partition('#')[0]).resolve() for page, text in self.texts.items()
                 for link in links_of(text)}
        figures = list((ROOT / 'doc/figures').glob('*.png'))
        self.assertTrue(figures)
        self.assertEqual([path.name for path in figures if path.resolve() not in shown], [])

    def test_a_machine_without_git_can_look_too(self):
        done = subprocess.run([sys.executable, ROOT / 'doc/markdown_links.py'], env={'PATH': ''}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_wrong_links_are_found(self):
        page = ROOT / 'README.md'
        text = ('# A title\n![figure](doc/figures/none.png) [here](#a-title) [there](#another) `[code](none.md)`\n'
                '[in another](doc/method.md#none) [of a run](build/site/index.html) `tests/none.py`\n')
        self.assertEqual([fault(page, link, text) for link in links_of(text)],
                         ['there is no such file', None, 'there is no such heading', 'there is no such heading',
                          'there is no such file'])
        self.assertIn('README.md: `tests/none.py`: there is no such file', faults_of(page, text))


if __name__ == '__main__':
    unittest.main()
