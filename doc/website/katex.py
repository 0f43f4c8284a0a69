# SPDX-License-Identifier: GPL-3.0-or-later
"""Equations as HTML, set by KaTeX (Debian's libjs-katex, nodejs) when the site is built: pages take its fonts alone."""
import functools
import json
import subprocess

from docutils.nodes import SkipNode

FOLDER = "/usr/share/javascript/katex"
PROGRAM = f"""
const katex = require("{FOLDER}/katex.min.js");
require("readline").createInterface({{input: process.stdin}}).on("line", line => {{
  const [tex, displayMode] = JSON.parse(line);
  let answer;
  try {{ answer = [katex.renderToString(tex, {{displayMode}}), ""]; }}
  catch (error) {{ answer = ["", error.message]; }}
  console.log(JSON.stringify(answer));
}});"""


@functools.cache
def process():
    return subprocess.Popen(["node", "-e", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@functools.cache
def rendered(tex, display):
    process().stdin.write(json.dumps([tex, display]) + "\n")
    process().stdin.flush()
    made, fault = json.loads(process().stdout.readline())
    if fault:
        raise ValueError(f"KaTeX does not know what to do with {tex}: {fault}")
    return made


def inline(writer, node):
    writer.body.append(rendered(node.astext(), False))
    raise SkipNode


def display(writer, node):
    writer.body.append(f'<div class="equation">{rendered(node.astext(), True)}</div>')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("katex", (inline, None), (display, None))
    app.config.html_math_renderer = "katex"
    return {}
