"""Pages of the report from their templates.

What comes from case files is escaped, and what a template lacks is an error. Formulas are MathML
(`formulas`): no script, no font, nothing from a network."""
from __future__ import annotations

import re
from functools import lru_cache
from html import escape
from html.parser import HTMLParser
from itertools import accumulate
from pathlib import Path

from ...files import write_text
from .. import style
from ..names import around
from ..terminal import ALPHABET, but_for_commands, capital, minus, written

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


UNITS = ("deg/s", "rad/s", "deg", "rad", "days?", "min", "h", "s", "J", "τ", "N m(?: s)?")
MEASURED = re.compile(rf"(?<=\d) ({'|'.join(UNITS)})\b")
# I_omega, x_j, mu_j; e^(i r0 t), but for a power of one digit, which has a letter of its own
MARKED = re.compile(rf"(?<![\w/.])([A-Za-zΑ-Ωα-ω]|{'|'.join(ALPHABET)})_(\w+)"
                    r"|\^(?!\d(?!\d))(?:\(([^()]*)\)|([-−]?\w+))")


@around
def book(text: str):
    """Words as a book sets them: I_omega with the index ω below, the exponent of e^(i r0 t) raised."""
    from markupsafe import Markup, escape
    marked = MARKED.sub(_marked, str(escape(text))).replace("&gt;=", "≥").replace("&lt;=", "≤")
    return Markup(written(marked))  # escaped above


def _marked(result):
    letter, below, *raised = result.groups()
    if letter:
        return f"{ALPHABET.get(letter, letter)}<sub>{ALPHABET.get(below, below)}</sub>"
    return f"<sup>{(raised[0] or raised[1]).replace('-', '−')}</sup>"


@around
def signed(text: str) -> str:
    """The text with the minus of a book; commands stay as they are typed."""
    first, *others = text.split("<code>")
    parts = [part.partition("</code>") for part in others]
    built = "".join(f"<code>{command}{end}{_signed(rest)}" for command, end, rest in parts)
    return type(text)(_signed(first) + built)  # what is escaped stays so


def _signed(text: str):
    return but_for_commands(str(text), minus)


@around
def together(text: str) -> str:
    """The text with no end of a line between a number and its unit, or within one."""
    return MEASURED.sub(lambda match: match[0].replace(" ", "\u00a0"), text)


def formula(text):
    """A formula: as it is where it is typeset, else with the letters and signs of a book."""
    from markupsafe import Markup
    return text if isinstance(text, Markup) else written(text)


@around
def sentence(text: str):
    """Words for a page: with a capital at their head, and what stands between backquotes as code."""
    from markupsafe import Markup, escape
    parts = capital(text).split("`")
    rows = [escape(part) if n % 2 == 0 or n == len(parts) - 1 else typed(part) for n,
             part in enumerate(parts)]
    return Markup("").join(rows).replace("|ω|", Markup('<span class="nowrap">|ω|</span>'))


def typed(command: str):
    """A command as code; no line ends within the dashes of an option."""
    from markupsafe import Markup
    phrases = [Markup('<span class="nowrap">{}</span>').format(word) if word.startswith("--") else word
             for word in command.split(" ")]
    return Markup("<code>{}</code>").format(Markup(" ").join(phrases))


def css(fate: str) -> str:
    """The class by which a page colours a fate or a verdict."""
    return {"stable": "bounded", "asymptotically stable": "bounded", "unstable": "spin-up"}.get(fate, fate)


def picture(path: Path, narrow: Path | None = None, folder: str = "", /, **text) -> dict:
    """What a page says of a picture: its name within a folder, and its size in pixels, so that the page does
    not jump while it loads; narrow: the same one for a telephone (`show.narrow`)."""
    from PIL import Image
    with Image.open(path) as image:
        size = list(image.size)
    return {"file": folder + path.name, "size": size, **text,
            "narrow": narrow and picture(narrow, None, folder)}


def render(template: str, **values) -> str:
    """The HTML of a template. nav: rows {file, title} of the pages beside it, here: its own file, below: that
    of the page among them that it belongs to, up: how it reaches their folder."""
    return _environment().get_template(template).render(**{**ALONE, **values})


def anchored(page: str) -> str:
    """The page with a link to itself in every heading, which gets an id of its words where it has none."""
    read = _Headings(page)
    used, parts, last = {*read.ids}, [], 0
    for start, inside, end, name, text in read.headings:
        opening = page[start:inside]
        if not name:
            letters = "".join(item if item.isascii() and item.isalnum() else " " for item in text.lower())
            name = first = "-".join(letters.split()) or "part"
            while name in used:
                name = f"{first}-{len(used)}"
            used.add(name)
            opening = f'{opening[:3]} id="{name}"{opening[3:]}'
        parts += [page[last:start], opening, page[inside:end],
                  f' <a class="anchor" href="#{name}" aria-label="Link to: {escape(text)}">#</a>']
        last = end
    return "".join([*parts, page[last:]])


class _Headings(HTMLParser):
    """Of a page: ids, and of every heading of the second or third level (where it starts, where its inside
    starts and ends, its id or "", its words)."""

    def __init__(self, page: str):
        super().__init__()
        self.ids: list[str] = []
        self.headings: list[tuple[int, int, int, str, str]] = []
        self._lines = [0, *accumulate(len(line) + 1 for line in page.split("\n"))]
        self._open: tuple[int, int, str] | None = None
        self._words: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        name = dict(attrs).get("id") or ""
        self.ids += [name] if name else []
        if tag in ("h2", "h3"):
            self._open, self._words = (self._at(), self._at() + len(self.get_starttag_text()), name), []

    def handle_data(self, data):
        self._words.append(data)

    def handle_endtag(self, tag):
        if tag in ("h2", "h3") and self._open:
            start, inside, name = self._open
            text = " ".join("".join(self._words).split())
            self.headings.append((start, inside, self._at(), name, text))
            self._open = None

    def _at(self):
        line, column = self.getpos()
        return self._lines[line - 1] + column


def write(path: Path, template: str, **values) -> Path:
    """The page as a file, whole or not at all."""
    return write_text(path, anchored(render(template, **values)))
