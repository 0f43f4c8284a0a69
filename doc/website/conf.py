# SPDX-License-Identifier: GPL-3.0-or-later
"""Sphinx's configuration for doc/website.py, which says where the pages and the module are."""
import logging
import os
import pathlib
import sys

sys.path[:0] = [os.environ["PFV_SITE_MODULE"], str(pathlib.Path(__file__).parent)]

project = "pfv"
release = os.environ["PFV_SITE_VERSION"]
copyright = "the pfv developers, GPL-3.0-or-later"
extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe", "docstrings", "katex"]
myst_heading_anchors = 5
suppress_warnings = ["myst.header"]  # README files may begin below the first level

html_theme = "furo"
html_title = f"pfv {release}"
html_static_path = [str(pathlib.Path(__file__).parent / "static"), os.environ["PFV_SITE_STATIC"]]
html_css_files = ["katex/katex.min.css", "site.css"]
html_copy_source = False
html_show_sphinx = False
pygments_style = "friendly"

autodoc_member_order = "groupwise"
breathe_projects = {"pfv": os.environ["PFV_SITE_DOXYGEN"]}
breathe_default_project = "pfv"
breathe_show_include = False
primary_domain = None
highlight_language = "none"
nitpicky = False


def declared_once(record):
    """The namespace stands on the page of each header; Sphinx asks for one."""
    return not str(record.args or record.msg).count(".. cpp:type:: pfv'")


logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(declared_once)
