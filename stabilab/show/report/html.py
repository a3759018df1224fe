"""Pages of the report from their templates, and formulas as MathML.

What comes from case files is escaped, and what a template lacks is an error. MathML is set by the browser
itself: no script, no font, nothing from a network."""
from __future__ import annotations

import re
from functools import lru_cache
from html import escape, unescape
from pathlib import Path

from ...files import write_text
from ...physics.equations import Equations
from .. import style
from ..names import around
from ..terminal import ALPHABET, written
from ..text.scene import PRODUCTS, right_side

TEMPLATES = Path(__file__).parents[1] / "templates"
ALONE = {"nav": (), "here": "", "below": "", "up": "", "title": ""}  # of a page that is no part of a folder


@lru_cache(maxsize=1)
def _environment():
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    environment = Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined)
    environment.globals["style"] = style
    environment.filters |= {"written": written, "sentence": sentence, "typed": typed, "formula": formula,
                            "book": book, "signed": signed, "together": together}
    return environment


# -5, 1e-5, (-h, = -a
MINUS = re.compile(r"(?<![\w)])-(?=\d)|(?<=\de)-(?=\d)|(?<=[(\[])-(?=\s?\w)|(?<=[(,=] )-(?=\w)"
                   # (b-a), b - a, r0 - W
                   r"|(?<=\b[a-z])-(?=[a-z]\))|(?:(?<=\b\w )|(?<=\b\w\d ))-(?= \w\d?\b)")
EXPONENT = re.compile(r"(?<=\de)([-−])0+(?=\d)")  # 1e-08, as Python prints it
MEASURED = re.compile(r"(?<=\d) (?=(?:deg/s|rad/s|deg|rad|days?|min|h|s|J|τ|N m)\b)")
COMPOUND = re.compile(r"(?<=\d\u00a0)N m(?: s)?\b")
INDEXED = re.compile(r"(?<![\w/.])([A-Za-zΑ-Ωα-ω]|" + "|".join(ALPHABET) + r")_(\w+)")  # I_omega, x_j, mu_j
# b - a, (-M2, x = -y
SUBTRACTED = re.compile(r"(?<=[\w)²³*;]) - (?=[\w(])|(?:(?<=[(=,\[] )|(?<=[(\[=])|^)-(?=[\w(])")
HEADING = re.compile(r'<h([23])(?: id="([^"]*)")?>(.*?)</h\1>', re.S)
RAISED = re.compile(r"\^(?:\(([^()]*)\)|([-−]?\w+))")


@around
def book(text: str):
    """Words as a book sets them: I_omega with the index ω below, the exponent of e^(i r0 t) raised."""
    from markupsafe import Markup, escape
    below = INDEXED.sub(
        lambda found: f"{ALPHABET.get(found[1], found[1])}<sub>{ALPHABET.get(found[2], found[2])}</sub>",
        str(escape(text)))
    below = SUBTRACTED.sub(lambda found: found[0].replace("-", "−"),
                           below.replace("&gt;=", "≥").replace("&lt;=", "≤"))
    # escaped above
    return Markup(RAISED.sub(lambda found: f"<sup>{(found[1] or found[2]).replace('-', '−')}</sup>",
                             written(below)))


@around
def signed(text: str) -> str:
    """The text with the minus of a book: before numbers and in their exponents, which begin with no zero,
    before a name and between two. Commands stay as they are typed."""
    parts = re.split(r"(<code>.*?</code>)", text)
    # what is escaped stays so
    return type(text)("".join(part if part.startswith("<code>") else MINUS.sub("−", EXPONENT.sub(r"\1", part))
                              for part in parts))


@around
def together(text: str) -> str:
    """The text with no end of a line between a number and its unit, or within one."""
    return COMPOUND.sub(lambda unit: unit[0].replace(" ", "\u00a0"), MEASURED.sub("\u00a0", text))


def formula(text):
    """A formula: as it is where it is typeset, else with the letters and signs of a book."""
    from markupsafe import Markup
    return text if isinstance(text, Markup) else written(text)


@around
def sentence(text: str):
    """Words for a page: with a capital at their head, and what stands between backquotes as code."""
    from markupsafe import Markup, escape
    # no formula, no name of a file
    text = text[:1].upper() + text[1:] if re.match("[a-z]+( |$)", text) else text
    parts = text.split("`")
    found = [escape(part) if n % 2 == 0 or n == len(parts) - 1 else typed(part) for n,
             part in enumerate(parts)]
    return Markup("").join(found).replace("|ω|", Markup('<span class="nowrap">|ω|</span>'))


def typed(command: str):
    """A command as code; no line ends within the dashes of an option."""
    from markupsafe import Markup
    words = [Markup('<span class="nowrap">{}</span>').format(word) if word.startswith("--") else word
             for word in command.split(" ")]
    return Markup("<code>{}</code>").format(Markup(" ").join(words))


def css(fate: str) -> str:
    """The class by which a page colours a fate or a verdict."""
    return {"stable": "bounded", "asymptotically stable": "bounded", "unstable": "spin-up"}.get(fate, fate)


def picture(path: Path, folder: str = "", narrow: Path | None = None, /, **words) -> dict:
    """What a page says of a picture: its name within a folder, and its size in pixels, so that the page does
    not jump while it loads; narrow: the same one for a telephone."""
    from PIL import Image
    with Image.open(path) as image:
        size = list(image.size)
    return {"file": folder + path.name, "size": size, "narrow": narrow and picture(narrow, folder), **words}


def render(template: str, **values) -> str:
    """The HTML of a template. nav: rows {file, title} of the pages beside it, here: its own file, below: that
    of the page among them that it belongs to, up: how it reaches their folder."""
    return _environment().get_template(template).render(**{**ALONE, **values})


def anchored(page: str) -> str:
    """The page with a link to itself in every heading, which gets an id of its words where it has none."""
    used = set(re.findall(r' id="([^"]*)"', page))

    def linked(found):
        level, name, inside = found[1], found[2], found[3]
        words = " ".join(unescape(re.sub("<[^>]*>", "", inside)).split())
        if not name:
            name = first = re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-") or "part"
            while name in used:
                name = f"{first}-{len(used)}"
            used.add(name)
        return (f'<h{level} id="{name}">{inside} <a class="anchor" href="#{name}" '
                f'aria-label="Link to: {escape(words)}">#</a></h{level}>')
    return HEADING.sub(linked, page)


def write(path, template: str, **values) -> Path:
    """The page as a file, whole or not at all."""
    return write_text(path, anchored(render(template, **values)))


# --- Formulas
# symbols and digits or so of a sum that fit beside each other on a page; a longer one goes on in the next
# line
LINE = 46
LONG = 40  # operations: a law of more is stated in words alone


def equations_of_motion(equations: Equations) -> list:
    """An equation a component of the state: its factor and its rate with a dot, and the sum."""
    rows = []
    for number, (moment, part) in enumerate(zip(equations.inertia, equations.state)):
        factor = "" if moment == 1 else inner(moment)
        # the dot above the letter, not above the middle of letter and index
        dotted = re.sub(r"<mi>[^<]*</mi>", r"<mover>\g<0><mo>&#x2D9;</mo></mover>", inner(part), count=1)
        rows.append(display(f"{factor}{dotted}<mo>=</mo>{in_lines(right_side(equations, number))}"))
    return rows


def display(content: str):
    """A line of its own."""
    from markupsafe import Markup
    return Markup(f'<math display="block"><mrow>{content}</mrow></math>')


def inline(expression):
    """An expression within a sentence."""
    from markupsafe import Markup
    return Markup(f"<math><mrow>{inner(expression)}</mrow></math>")


def symbol(name: str):
    """A symbol by its name: lambda1 with its Greek letter and its index."""
    from sympy import Symbol
    return inline(Symbol(name))


def law(balance) -> str:
    """The quantity of a law, and its rate where that is not zero; empty where too long to be read."""
    from sympy import Integer, count_ops
    quantity, rate = rounded(balance.quantity), rounded(Integer(0) + balance.rate)
    if count_ops(quantity) + count_ops(rate) > LONG:
        return ""
    changes = ("<mtext>&#x2009;constant</mtext>" if rate == 0
               else f"<mo>)</mo><mo>&#x2D9;</mo><mo>=</mo>{inner(rate)}")
    return display(f"{'' if rate == 0 else '<mo>(</mo>'}{in_lines(quantity)}{changes}")


def rounded(expression):
    """The expression with numbers of many digits rounded to six."""
    from sympy import Float, Integer, Rational
    expression = Integer(0) + expression
    return expression.xreplace({number: Float(number, 6) for number in expression.atoms(Rational)
                                if len(str(number)) > 8})


def in_lines(expression) -> str:
    """A sum in as many lines as it takes, one below the other; everything else as `inner`."""
    from sympy import Add, Integer
    expression = Integer(0) + expression
    if not isinstance(expression, Add) or sum(map(_width, expression.args)) <= LINE:
        return inner(expression)
    lines: list[list] = [[]]
    for term in expression.as_ordered_terms():
        if lines[-1] and sum(map(_width, lines[-1])) + _width(term) > LINE:
            lines.append([])
        lines[-1].append(term)
    rows = ""
    for number, terms in enumerate(lines):  # the later ones begin with their sign
        sign = "<mo>+</mo>" if number and not terms[0].could_extract_minus_sign() else ""
        rows += f'<mtr><mtd style="text-align: left"><mrow>{sign}{inner(Add(*terms))}</mrow></mtd></mtr>'
    return f'<mtable displaystyle="true">{rows}</mtable>'


def _width(term) -> float:
    """How many symbols and digits stand beside each other in a term: a fraction counts by its wider part."""
    from sympy import fraction
    return max(sum(len(word) if word[0].isdigit() else 1.3
                   for word in re.findall(r"[A-Za-z]\w*|[\d.]+|[-+(]", str(part))) for part in fraction(term))


def inner(expression) -> str:
    """The expression as presentation MathML, without the element around it."""
    from sympy import Integer
    from sympy.printing.mathml import mathml
    text = numbered(mathml(Integer(0) + expression, printer="presentation"))
    # eHl2: SymPy sees an index
    text = re.sub(r"<msub><mi>(\w+)</mi><mi>(\d)</mi></msub>",
                  lambda found: _product(found[1] + found[2]) or found[0], text)
    text = re.sub(r"<mi>(\w+)</mi>", lambda found: _product(found[1]) or found[0], text)
    for product in map(_product, PRODUCTS):  # a power is that of all its letters
        text = text.replace(f"<msup>{product}", f"<msup><mrow><mo>(</mo>{product}<mo>)</mo></mrow>")
    return text


def numbered(mathml: str) -> str:
    """MathML of SymPy with the minus, the i and the e of a book, which SymPy has struck twice, with bars that
    browsers draw over conjugates, and whole numbers of six digits without a zero behind their point."""
    mathml = mathml.replace("&ImaginaryI;", "i").replace("&ExponentialE;", "e")
    mathml = mathml.replace("<mo>-</mo>", "<mo>&#x2212;</mo>").replace("<mn>-", "<mn>&#x2212;")
    mathml = re.sub(r'<menclose notation="top">(.*?)</menclose>',
                    r'<mover accent="true"><mrow>\1</mrow><mo>&#xAF;</mo></mover>', mathml)
    return re.sub(r"<mn>([^<>]*\d)\.0</mn>", r"<mn>\1</mn>", mathml)


def _product(name) -> str:
    """What a name stands for as a product of letters with indices and powers; empty where for itself."""
    made = (re.split("([_^])", word) for word in PRODUCTS.get(name, "").split())
    kind = {"_": "msub", "^": "msup"}
    letters = "".join(f"<{kind[part[1]]}><mi>{part[0]}</mi><mi>{part[2]}</mi></{kind[part[1]]}>"
                      if len(part) > 1 else f"<mi>{part[0]}</mi>" for part in made)
    return letters and f"<mrow>{letters}</mrow>"
