# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of the pages: each file, figure and heading that a page of the project points at is there, each file that it
names by its path, and each figure of doc/figures is shown by one. `doc/markdown_links.py --external` lists others."""
import pathlib
import sys
import tempfile
import unittest

DOC = pathlib.Path(__file__).resolve().parents[2] / 'doc'
sys.path[:0] = [str(DOC), str(DOC / 'website')]
from markdown_links import ROOT, fault, faults_of, is_external, links_of, notebooks, pages, text_of  # noqa: E402
from site_links import faults_of as faults_of_site  # noqa: E402


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

    def test_wrong_links_are_found(self):
        page = ROOT / 'README.md'
        text = ('# A title\n![figure](doc/figures/none.png) [here](#a-title) [there](#another) `[code](none.md)`\n'
                '[in another](doc/method.md#none) [of a run](build/site/index.html) `tests/none.py`\n')
        self.assertEqual([fault(page, link, text) for link in links_of(text)],
                         ['there is no such file', None, 'there is no such heading', 'there is no such heading',
                          'there is no such file'])
        self.assertIn('README.md: `tests/none.py`: there is no such file', faults_of(page, text))

    def test_wrong_links_of_the_site_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, 'a.html').write_text(
                '<h1 id="top"></h1><a href="b.html#here">b</a><a href="#top">top</a><a href="b.html#none">c</a>'
                '<img src="d.png"><script src="//e/f.js">')
            pathlib.Path(folder, 'b.html').write_text('<p id="here"></p>')
            pathlib.Path(folder, 'g.css').write_text('@font-face {src: url("https://h/i")}')
            self.assertEqual(faults_of_site(pathlib.Path(folder)), [
                'a.html: //e/f.js: is fetched from the net', 'a.html: b.html#none: there is no such place',
                'a.html: d.png: there is no such file', 'g.css: https://h/i: is fetched from the net',
                'only 2 pages were made'])


if __name__ == '__main__':
    unittest.main()
