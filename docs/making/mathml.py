"""Formulas as MathML, which browsers draw themselves: MathJax would fetch a megabyte from the network at
every page, and LaTeX pictures need LaTeX."""
from __future__ import annotations

import re
from xml.etree import ElementTree

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

SPACE = "http://www.w3.org/1998/Math/MathML"
ROWS = {"math", "mrow", "mtd", "msqrt", "mstyle"}  # what takes any number of children
FUNCTIONS = {"cos", "sin", "ln", "exp", "arcosh", "atan", "det", "min", "max", "sup", "inf", "sgn"}
TIGHT = {"|", "/"}  # LaTeX sets no space about them; a browser does, and more behind a bar than before it
RELATIONS = {"~", "∼"}  # of which a browser knows no space
LENGTH = re.compile(r"(?<=\d)(?=(?:bp|cc|cm|dd|em|ex|in|mm|mu|pc|pt|sp))")
PRIMED = re.compile(r"('+)(?:\^(?:\{([^{}]*)\}|(\w)))?")
LONG = 45  # letters of LaTeX: a telephone may be too narrow for more (site.css)
BREAKS = {"2em", "1em"}  # \qquad and \quad, which part the equations of a line


def setup(app) -> None:
    """Make it the renderer of formulas, by the name "mathml"."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))


def formula(latex: str) -> str:
    """A formula within a line."""
    return _written(_set(latex, "inline"))


def equations(latex: str) -> list[str]:
    """The equations of a displayed line, each for itself, so that a narrow page sets them below each other.
    """
    whole = _set(latex, "block")
    row = whole[0] if len(whole) == 1 and _kind(whole[0]) == "mrow" else whole
    parts: list[list] = [[]]
    for child in list(row):
        if _kind(child) == "mspace" and child.get("width") in BREAKS:
            parts.append([])
        else:
            parts[-1].append(child)
    made = []
    for part in filter(None, parts):
        one = ElementTree.Element("math", {"xmlns": SPACE, "display": "block"})
        ElementTree.SubElement(one, "mrow").extend(part)
        made.append(_written(one))
    return made


def _set(latex, display):
    # the converter would take "2cm" for a length of two centimetres
    whole = ElementTree.fromstring(convert(PRIMED.sub(_primes, LENGTH.sub("{}", latex)), display=display))
    for row in list(whole.iter()):
        if _kind(row) in ROWS:
            _spaced(row)
    return whole


def _spaced(row):
    """The children of a row with the spaces of LaTeX: none about bars and strokes, a thin one about the name
    of a function, unless a bracket stands there."""
    children = list(row)
    for one, child in enumerate(children):
        after = children[one + 1] if one + 1 < len(children) else None
        if child.text in TIGHT:
            child.set("lspace", "0")
            child.set("rspace", "0")
        elif child.text in RELATIONS:
            child.tag = child.tag.replace("mi", "mo")
            child.set("lspace", "0.278em")
            child.set("rspace", "0.278em")
        elif child.text == "∞":  # a number as it stands in a formula, no sign between two
            child.tag = child.tag.replace("mo", "mi")
        elif child.text == ":" and after is not None and after.text == "=":
            row.remove(child)
            after.text = "≔"
        name = child[0] if len(child) and _kind(child) in ("msup", "msub", "msubsup") else child
        if (name.text or "").strip() in FUNCTIONS:
            if _kind(name) == "mo":
                name.set("lspace", "0")
                name.set("rspace", "0")
            before = children[one - 1] if one else None
            if before is not None and (_kind(before) not in ("mo", "mspace") or before.text == ")"):
                row.insert(list(row).index(child), _thin())
            if after is not None and after.text not in ("(", "[", ")", ","):
                row.insert(list(row).index(child) + 1, _thin())


def _primes(found):
    """Primes and a power behind them as one superscript, of which the converter makes several."""
    return "^{" + r"\prime" * len(found[1]) + f" {found[2] or found[3] or ''}}}"


def _thin():
    return ElementTree.Element(f"{{{SPACE}}}mspace", {"width": "0.167em"})


def _kind(element):
    return element.tag.rpartition("}")[2]


def _written(element) -> str:
    ElementTree.register_namespace("", SPACE)
    for one in element.iter():
        one.tag = _kind(one)
    element.set("xmlns", SPACE)
    return ElementTree.tostring(element, encoding="unicode")


def _inline(page, node) -> None:
    long = " long" * (len(node.astext()) > LONG)
    page.body.append(f'<span class="math{long}">{formula(node.astext())}</span>')
    raise SkipNode


def _block(page, node) -> None:
    parts = [f'<div tabindex="0">{one}</div>' for one in equations(node.astext())]
    page.body.append(f'<div class="math">{"".join(parts)}</div>')
    raise SkipNode
