# SPDX-License-Identifier: GPL-3.0-or-later
"""Equations that a page has as plain text, so that it can be read anywhere, turned into TeX for the site.

    Φ = 1/2 Σ_ij (Q_ij - U_ij)² / c_ij     ->     \\Phi = \\tfrac{1}{2} \\sum_{ij} (Q_{ij} - U_{ij})^{2} / c_{ij}

An index or exponent is what follows `_` or `^` (letters, digits, a minus); a point between symbols is a scalar product;
words of two letters and more are words. What stands below one another in two lines becomes a column.
"""
import re

from markdown_links import CODE

SIGNS = {"Σ": r"\sum ", "×": r"\times ", "≥": r"\ge ", "≤": r"\le ", "½": r"\tfrac{1}{2}", "->": r"\to ",
         "·": r"\cdot ", "∇": r"\nabla ", "∮": r"\oint "}
GREEK = dict(zip("ΔΦΩαβγδεθλμνπρσφχω", (
    "Delta Phi Omega alpha beta gamma delta varepsilon theta lambda mu nu pi rho sigma varphi chi omega").split()))
RAISED = dict(zip("⁻¹²³ᵀ", "-123T"))
DIFFERENTIALS = {"dL", "dQ", "dp", "dv", "dV", "dt", "dx"}
TOKEN = re.compile(r"(?P<source>(?:eqs?\.|thesis) [\d.,\- ]*\d)|(?P<word>[A-Za-z']{2,}(?![\w^]))|(?P<half>\b1/2\b)"
                   r"|(?P<number>\d+(?:\.\d+)?)|(?P<index>_[A-Za-z]+)|(?P<power>\^-?\w+|[⁻¹²³ᵀ]+)|(?P<arrow>->)"
                   r"|(?P<product>(?<=\S)\.(?=[^\s,]))|(?P<blank> +)|(?P<other>.)")
RAISING = r"(?:\^(?:-1|[A-Za-z])|⁻¹|ᵀ)"
INDEXED = rf"(?:Δ?[A-Za-zΑ-Ωα-ω])(?:_[a-z]{{1,3}}{RAISING}?|{RAISING})(?!\w)"
SYMBOL = rf"(?:{INDEXED}|Δ?[B-HJ-Zb-zΑ-Ωα-ω](?![\w_^'’]))"
BETWEEN = r"(?: [=+×-] |[ /.])"
INLINE = re.compile(rf"(?<![\w^./_`\[-])(?:{SYMBOL}{BETWEEN})*{INDEXED}(?:{BETWEEN}{SYMBOL})*(?![\w`^_/(])")
KEPT = re.compile(rf"{CODE.pattern}|\]\([^)]*\)|https?://\S+", CODE.flags)  # code, and where links lead
BLOCK = re.compile(r"(?<=\n\n)((?: {4}.*\n)+(?:\n(?: {4}.*\n)+)*)(?=\n|\Z)")


def one_sign(sign):
    if sign in GREEK:
        return f"\\{GREEK[sign]} "
    return SIGNS.get(sign, f"\\{sign}" if sign in "{}%&#$" else sign)


def upright(index):
    """What is a word stands upright, numbers of pores and grains do not."""
    return f"\\mathrm{{{index}}}" if len(index) > 2 or index in ("av", "in") else index


def tex(text):
    """Of one piece of a line."""
    made = []
    for found in TOKEN.finditer(text.strip()):
        kind, token = found.lastgroup, found[0]
        if kind == "source" or kind == "word" and token not in DIFFERENTIALS:
            made.append(f"\\text{{{token}}}")
        elif kind == "index":
            made.append(f"_{{{upright(token[1:])}}}")
        elif kind == "power":
            made.append("^{" + "".join(RAISED.get(sign, sign) for sign in token.lstrip("^")) + "}")
        else:
            made.append({"half": r"\tfrac{1}{2}", "arrow": r"\to ", "product": r"\cdot "}.get(kind) or one_sign(token))
    for at, piece in enumerate(made):  # blanks count beside words
        if piece.isspace() and any("\\text" in beside for beside in made[max(at - 1, 0):at + 2]):
            made[at] = r"\ "
        elif piece == " " and made[at - 1] in (",", ";"):
            made[at] = r"\ "
    return "".join(made)


def with_matrix(lines):
    """Brackets below one another, as in `K = [ a  b ]` over `[ c  d ]`, become one matrix of the first line."""
    for first, second in zip(lines, lines[1:]):
        place = second.find("[ ")
        if place > 0 and not second[:place].strip() and first[place:place + 2] == "[ ":
            rows = [[tex(cell) for cell in re.split(r" {2,}", line[place + 1:].rstrip().rstrip("]").strip())]
                    for line in (first, second)]
            matrix = r" \\ ".join(" & ".join(row) for row in rows)
            return [first[:place] + "\0", *lines[2:]], rf"\begin{{bmatrix}} {matrix} \end{{bmatrix}}"
    return lines, ""


def display(block):
    """TeX of a block of lines."""
    lines, matrix = with_matrix([line[4:] for line in block.rstrip("\n").split("\n")])
    pieces = [[(piece.start(), piece[0]) for piece in re.finditer(r"\S(?:\S| (?! ))*", line)] for line in lines]
    starts = [place for line in pieces for place, _ in line]
    columns = sorted({place for place in starts if starts.count(place) > 1} | {0})
    rows = []
    for line in pieces:
        row = [""] * len(columns)
        for place, piece in line:
            column = max(number for number, start in enumerate(columns) if start <= place)
            gap = r" \quad " if row[column] or place not in columns else ""
            row[column] += gap + tex(piece)
        rows.append(r" & \quad ".join(row))
    joined = " \\\\[0.4em]\n".join(rows).replace("\0", matrix)
    return f"\\begin{{array}}{{{'l' * len(columns)}}}\n{joined}\n\\end{{array}}"


def is_equation(block):
    return "->" not in block and re.search(r"[=Φ]", block) and re.search(r"[Σ^_Δλμ⁻]", block)


def typeset(text):
    """The page with its equations as TeX: indented blocks, and symbols with an index or exponent in the text."""
    def block_of(found):
        block = found[1]
        return f"```{{math}}\n{display(block)}\n```\n" if is_equation(block) else block

    def symbols(part):
        lines = [line if line.startswith(("    ", "#")) else INLINE.sub(
            lambda found: f"{{math}}`{tex(found[0])}`", line)
            for line in part.split("\n")]
        return "\n".join(lines)

    text = BLOCK.sub(block_of, text)
    parts, at = [], 0
    for kept in KEPT.finditer(text):
        parts += [symbols(text[at:kept.start()]), kept[0]]
        at = kept.end()
    return "".join(parts) + symbols(text[at:])
