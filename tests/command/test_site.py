# SPDX-License-Identifier: GPL-3.0-or-later
"""What the site makes of the pages, without building it: equations as TeX, links to the site's own pages."""
import pathlib
import sys
import tempfile
import unittest

DOC = pathlib.Path(__file__).resolve().parents[2] / "doc"
sys.path[:0] = [str(DOC), str(DOC / "website")]
import equations  # noqa: E402
import site_pages  # noqa: E402
from markdown_links import ROOT, pages  # noqa: E402
from site_links import faults_of  # noqa: E402


class Site(unittest.TestCase):
    def test_blocks_of_equations_become_tex(self):
        made = equations.typeset("so\n\n    F = S p              S is one of S^T\n"
                                 "    Φ = 1/2 Σ_ij Q_ij²   eq. 6\n\nand\n")
        self.assertIn(r"F = S p & \quad S\ \text{is}\ \text{one}\ \text{of}\ S^{T} \\", made)
        self.assertIn(r"\Phi  = \tfrac{1}{2} \sum _{ij} Q_{ij}^{2} & \quad \text{eq. 6}", made)
        self.assertIn("{math}`\\theta  \\Delta t S^{T} M^{-1} S`", equations.typeset("of θ Δt S^T M^-1 S alone"))
        self.assertIn(r"{math}`d_{\mathrm{max}}/d_{\mathrm{min}}`", equations.typeset("ratio d_max/d_min here"))

    def test_code_headings_and_links_stay(self):
        for text in ("`A_ij^k` and `pfv_x`\n", "## Why E must be S^T\n", "[x_ij](a_b.md#c_d)\n",
                     "file_name.cpp, a_name\n", "https://a_b.org/c_d\n",
                     "x\n\n    pfv solve --packing a.csv\n\ny\n", "```\nF_ij = S^T\n```\n"):
            self.assertEqual(equations.typeset(text), text)

    def test_links_lead_to_pages_of_the_site(self):
        with tempfile.TemporaryDirectory() as folder:
            links = site_pages.Links(pathlib.Path(folder))
            same = " `[d](x)` [e](CITATION.cff) [f](doc/method.md#moments) [g](#scenes)"
            turned = links.of_page(ROOT / "README.md",
                                   "[a](inputs/oedometer) [b](doc/start.md) [c](doc/notebooks)" + same)
            self.assertEqual(
                turned, "[a](inputs/oedometer/README.md) [b](index.md) [c](doc/notebooks/index.md)" + same)
            self.assertTrue(pathlib.Path(folder, "CITATION.cff").is_file())
            self.assertEqual(links.of_page(site_pages.FRONT, "[a](user_guide.md)"), "[a](doc/user_guide.md)")

    def test_each_page_has_a_place(self):
        with tempfile.TemporaryDirectory() as folder:
            for page in pages():
                site_pages.write(pathlib.Path(folder) / site_pages.place_of(page), "")
            named = site_pages.tree(pathlib.Path(folder)).split()
        for page in pages():
            if page != site_pages.FRONT:
                self.assertEqual(named.count(str(page.relative_to(ROOT).with_suffix(""))), 1, page)

    def test_wrong_links_of_the_site_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, 'a.html').write_text(
                '<h1 id="top"></h1><a href="b.html#here">b</a><a href="#top">top</a><a href="b.html#none">c</a>'
                '<img src="d.png"><script src="//e/f.js">')
            pathlib.Path(folder, 'b.html').write_text('<p id="here"></p>')
            pathlib.Path(folder, 'g.css').write_text('@font-face {src: url("https://h/i")}')
            self.assertEqual(faults_of(pathlib.Path(folder)), [
                'a.html: //e/f.js: is fetched from the net', 'a.html: b.html#none: there is no such place',
                'a.html: d.png: there is no such file', 'g.css: https://h/i: is fetched from the net',
                'only 2 pages were made'])


if __name__ == "__main__":
    unittest.main()
