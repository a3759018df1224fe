"""One vocabulary: names such as omega1 and lambda3 as people write them, and back where an encoding has no such letters."""
from __future__ import annotations

import re

GREEK = {"omega": "ω", "lambda": "λ", "Lambda": "Λ", "mu": "μ", "gamma": "γ", "alpha": "α", "sigma": "σ", "zeta": "ζ", "tau": "τ"}
PLAIN = {letter: name for name, letter in GREEK.items()} | {
    "²": "^2", "³": "^3", "⁴": "^4", "±": "+-", "−": "-", "–": "-", "≤": "<=", "≥": ">=", "≠": "!=", "√": "sqrt", "×": "x",
    "·": ".", "µ": "u", "°": " deg", "…": "..."}
# A name with its number, between bars, or the time of a scaled case; not part of a path, a key or an option.
NAMES = re.compile(r"(?<![\w./\\])(?<![\w-]-)(omega|lambda|Lambda|mu|gamma|alpha|sigma|zeta)(?=(?:[123]|_[ijk])\b(?!\\|/[A-Za-z]|\.\w))"
                   r"|(?<=\|)(?:omega|gamma)(?= ?[xyz]?\|)|\bgamma(?= = \()|(?<=[\d )=] )tau\b")


def greek(text: str) -> str:
    """The text with the names of angular velocities, momenta and torques as letters: omega1 becomes ω1."""
    return NAMES.sub(lambda found: GREEK[found[0]], text)


def plain(text: str) -> str:
    """The text in ASCII as far as its letters have names: ω1 becomes omega1."""
    return "".join(PLAIN.get(letter, letter) for letter in text)


def for_people(text: str, encoding: str | None) -> str:
    """The text in letters that the encoding can write; None: of a stream of letters, which writes all."""
    found = greek(text)
    if encoding is None:
        return found
    try:
        found.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return plain(found)
    return found
