# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages as Sphinx gets them: the repository's, each in its place, with the links that a forge understands turned
into those of a site; the notebooks run; one page for each public header."""
import os
import pathlib
import re
import shutil

from equations import typeset
from markdown_links import CODE, LINK, PLACE, ROOT, is_external, pages

FRONT = ROOT / "doc/start.md"
NOTEBOOKS = ROOT / "doc/notebooks"
GROUPS = {  # what is not named comes last
    "Use": "README doc/user_guide doc/fix_pfv doc/python doc/settings doc/file_variants doc/container doc/periodic "
           "doc/conventions doc/from_couple_cfd doc/from_flow_engine doc/what_changed",
    "Method": "doc/method doc/accuracy doc/pore_scale doc/open_water doc/darcy_grid doc/solvers doc/stability doc/couple_every",
    "Results": "doc/experiments doc/oedometer doc/waves doc/error_vs_time doc/scaling doc/benchmarks doc/extremes",
    "Notebooks": "doc/notebooks/index",
    "Scenes": "inputs/*",
    "Reference": "reference/python reference/cpp",
    "Others": "*"}


def place_of(page):
    """Of a page within the site."""
    return pathlib.Path("index.md") if page == FRONT else page.relative_to(ROOT)


WITH_EQUATIONS = {ROOT / f"doc/{name}.md" for name in (
    "method", "open_water", "stability", "oedometer", "waves", "experiments", "accuracy", "pore_scale", "conventions", "darcy_grid")}


class Links:
    """Turns the links of a page; what they lead to and is no page is copied beside the pages."""

    def __init__(self, folder):
        self.folder, self.known = folder, set(pages())
        self.made = set()  # figures that stand beside their page

    def target(self, path):
        """The page or file that the site has for a path of the repository."""
        if path == NOTEBOOKS:
            return NOTEBOOKS / "index.md"
        if path.is_dir() and path / "README.md" in self.known:
            return path / "README.md"
        return path.with_suffix(".md") if path.suffix == ".ipynb" else path

    def turned(self, page, link):
        path, mark, anchor = link.partition("#")
        if is_external(link) or not path or path in self.made:
            return link
        source = (page.parent / path).resolve()
        target = self.target(source)
        if target.suffix != ".md":
            if target.is_dir():
                raise SystemExit(f"website: {page.relative_to(ROOT)} leads to the folder {path}, which has no page")
            copy = self.folder / target.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(target, copy)
        return os.path.relpath(place_of(target), place_of(page).parent) + mark + anchor

    def of_page(self, page, text):
        """The text with its links turned, but for those within code."""
        places = PLACE.findall(text)
        parts, at = [], 0
        for code in CODE.finditer(text):
            parts += [self.of_text(page, text[at:code.start()], places), code[0]]
            at = code.end()
        return "".join(parts) + self.of_text(page, text[at:], places)

    def of_text(self, page, text, places):
        for name in places:  # no heading: a link that Sphinx does not look up
            text = re.sub(rf"\[([^\]]*)\]\(#{name}\)", rf'<a href="#{name}">\1</a>', text)
        return LINK.sub(lambda link: link[1] + self.turned(page, link[2]) + link[3], text)


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def run_notebook(path):
    """(its page, {name: bytes} of its figures)"""
    import nbformat
    from nbclient import NotebookClient
    from nbconvert import MarkdownExporter
    from traitlets.config import Config
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=None, resources={"metadata": {"path": str(NOTEBOOKS)}}).execute()
    naming = Config({"ExtractOutputPreprocessor": {"output_filename_template": path.stem + "_{cell_index}{extension}"}})
    text, resources = MarkdownExporter(config=naming).from_notebook_node(notebook)
    return text, resources["outputs"]


def stage_notebooks(links, folder):
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        text, figures = run_notebook(path)
        page = path.with_suffix(".md")
        for name, content in figures.items():
            place = folder / place_of(page).with_name(name)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        links.made |= set(figures)
        write(folder / place_of(page), links.of_page(page, text))
    names = "\n".join(path.stem for path in sorted(NOTEBOOKS.glob("*.ipynb")))
    write(folder / "doc/notebooks/index.md", f"# Notebooks\n\n```{{toctree}}\n{names}\n```\n")


def stage_reference(folder):
    source = pathlib.Path(__file__).parent
    write(folder / "reference/python.md", (source / "python_reference.in.md").read_text())
    headers = sorted((ROOT / "pfvlib/include/pfv").glob("*.hpp"))
    listed = "\n".join(header.stem for header in headers)
    write(folder / "reference/cpp.md", (source / "cpp_reference.in.md").read_text().replace("HEADERS", listed))
    for header in headers:
        write(folder / f"reference/{header.stem}.md",
              f"# pfv/{header.name}\n\n```{{eval-rst}}\n.. doxygenfile:: {header.name}\n```\n")


def tree(folder):
    """What the front page's column of contents shows."""
    left = {str(path.relative_to(folder).with_suffix("")) for path in folder.rglob("*.md")}
    left -= {"index"} | {name for name in left if name.startswith("doc/notebooks/") and name != "doc/notebooks/index"}
    left -= {name for name in left if name.startswith("reference/")}
    left |= {"reference/python", "reference/cpp"}
    lines = []
    for caption, names in GROUPS.items():
        here = []
        for name in names.split():
            stem = name[:-1]
            here += [name] if name in left else []
            here += sorted(one for one in left if name.endswith("*") and one.startswith(stem))
        left -= set(here)
        if here:
            lines += ["```{toctree}", ":hidden:", f":caption: {caption}", *here, "```", ""]
    return "\n".join(lines)


def stage(folder):
    links = Links(folder)
    for page in pages():
        text = page.read_text(encoding="utf-8")
        write(folder / place_of(page), links.of_page(page, typeset(text) if page in WITH_EQUATIONS else text))
    stage_notebooks(links, folder)
    stage_reference(folder)
    front = folder / "index.md"
    front.write_text(front.read_text() + "\n" + tree(folder))
