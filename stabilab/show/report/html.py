"""Pages of the report from their templates.

What comes from case files is escaped, and what a template lacks is an error. Formulas are MathML
(`formulas`): no script, no font, nothing from a network."""
from __future__ import annotations

import re
from functools import lru_cache
from html import escape, unescape
from pathlib import Path

from ...files import write_text
from .. import style
from ..names import around
from ..terminal import ALPHABET, written

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
