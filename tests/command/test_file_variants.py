# SPDX-License-Identifier: GPL-3.0-or-later
"""Each file of file_variants.py is read, with the permeability of the plain table, or refused for the right reason.

    test_file_variants.py --page     writes the table of them, doc/file_variants.md
"""
import pathlib
import sys
import unittest

from command import CommandTest, DENSE
from file_variants import FILES, SOLVE

PAGE = pathlib.Path(__file__).resolve().parents[2] / "doc/file_variants.md"


class FileVariants(CommandTest):
    def permeability(self, packing, options):
        """(that of the report, or of the last axis of its tensor; what else is said)"""
        report = self.folder / "report.json"
        report.unlink(missing_ok=True)
        result = self.run_pfv("solve", "--packing", packing, *options, "--report", report)
        if result.returncode:
            self.assertFalse(report.exists())
            return None, result
        numbers = self.json("report.json")
        return numbers["permeability"] or (numbers["permeability_tensor"] or [[None] * 3] * 3)[2][2], result

    def check(self, variant, plain):
        found, result = self.permeability("file", variant.options)
        if variant.refused:
            self.assert_refused(result, "file", *variant.refused)
            return
        self.assertEqual(result.returncode, 0, result.stderr)
        for part in variant.said:
            self.assertIn(part, result.stderr)
        if not variant.said:
            self.assertEqual(result.stderr, "")
        if variant.factor is None:
            self.assertIsNone(found)
        else:
            self.assertAlmostEqual(found / plain / variant.factor, 1, delta=variant.tolerance)

    def test_each_is_read_or_refused(self):
        plain = {}  # of the options
        for _, variants in FILES:
            for variant in variants:
                options = tuple(variant.plain or SOLVE)
                if options not in plain:
                    plain[options], _ = self.permeability(DENSE, options)
                    self.assertGreater(plain[options], 0)
                (self.folder / "file").write_bytes(variant.content)
                with self.subTest(variant.name):
                    self.check(variant, plain[options])

    def test_the_page_lists_them(self):
        self.assertEqual(PAGE.read_text(), page(), "tests/command/test_file_variants.py --page writes it anew")


def page():
    """The table as a page."""
    count = sum(len(variants) for _, variants in FILES)
    text = [f"""# Files that are read, and what is said of the others

The same 100 spheres in {count} files as people and programs write them: each is either read, with the permeability of
the plain table, or refused, with the cause in the message (exit status 2, no file written).
`ctest -R command.file_variants` solves them all; the files stand in `tests/command/file_variants.py`, and
`tests/command/test_file_variants.py --page` writes this page of them. What may
be given is in the [user guide](user_guide.md#files-of-spheres).
"""]
    for title, variants in FILES:
        text.append(f"## {title}\n\n| file | read? | said |\n|---|---|---|")
        for variant in variants:
            option = f", `{' '.join(variant.extra)}`" if variant.extra else ""
            said = " ... ".join(variant.refused or variant.said)
            text.append(f"| {variant.name}{option} | {'no' if variant.refused else 'yes'} | {said} |")
        text.append("")
    return "\n".join(text)


if __name__ == "__main__":
    PAGE.write_text(page()) if sys.argv[1:] == ["--page"] else unittest.main()
