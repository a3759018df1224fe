"""A line that is not TOML, as its writer meant it: habits of YAML, JSON, Python, MATLAB and word processors.

Every line that is offered is one that the TOML reader takes."""
from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import NamedTuple

from .aliases import LISTS, SECTIONS, named

LONGEST = 200  # letters of a line that is repaired, and of one that is shown
TRUTHS = dict.fromkeys(("yes", "on", "true", "y", "t"), "true") | dict.fromkeys(("no", "off", "false", "n",
                                                                                 "f"),
                                                                         "false")
MAKERS = ("diag", "vector", "vec", "vec3", "vector3", "array", "list", "tuple")  # of lists, elsewhere
NOTHING = ("none", "null", "nil", "undefined", "~", "n/a", "tbd")
DECLARED = ("let", "const", "var", "double", "float", "int", "set", "auto", "local", "real")
PRINT = {"\u201c": '"', "\u201d": '"', "\u201e": '"', "\u00ab": '"', "\u00bb": '"', "\u2018": "'",
         "\u2019": "'",
         "\u2212": "-", "\u2010": "-", "\u2011": "-", "\uff0c": ",", "\uff1d": "=",
         **dict.fromkeys("\u00a0\u2007\u2009\u202f\u3000\u2002\u2003", " "),
         **dict.fromkeys("\u200b\u200c\u200d\ufeff", "")}
_DASH = re.compile(r"[\u2013\u2014](?=\s*[\d.])")
_NUMBER = r"[-+]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
_BARE = re.compile(_NUMBER)
_UNIT = r"(?:[A-Za-z°µμΩ²³·*/^.\- \d()]*[A-Za-z°²³\d)])"
_QUANTITY = re.compile(rf"{_NUMBER}\s*(?:[A-Za-z°µμ]{_UNIT[3:-1]}?|[A-Za-z°])?"
                       rf"(?:\s*(?:\+-|\+/-|±)\s*{_NUMBER}\s*(?:%|{_UNIT})?)?")
_RATIO = re.compile(r"[-+]?\d+\s*/\s*\d+")
_COMMA = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
_KEY = re.compile(r"[A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+)*")
_STATEMENT = re.compile(r"\s*(?P<key>[^=:\[\]{}]*?)\s*(?P<mark>=>|->|<-|:=|==|=|:)\s*(?P<value>.*?)\s*")
_NEXT = re.compile(r"(?P<first>.+?)\s*[,;\s]\s*(?P<rest>[A-Za-z_]\w*\s*=[^=].*)")
_HEADER = re.compile(r"\s*[\[{<(]*\s*([A-Za-z_][\w. -]*?)\s*[\]}>)]*\s*:?\s*")


class Repair(NamedTuple):
    """line: 1-based, where the fault is; key: dotted; came: the line as it is; write: what to write in its
    place, "" where only the reason is known; rule: in words."""

    line: int
    key: str
    came: str
    write: str
    rule: str


class _Hopeless(Exception):
    """What cannot be written as TOML, with the reason."""


def repair(text: str, line: int) -> Repair | None:
    """What to write in place of the line at which the TOML reader stopped; None where nothing is known. Of a
    list that is not closed the line that opens it counts."""
    lines = text.replace("\r\n", "\n").split("\n")  # as the TOML reader counts them
    number = min(line, len(lines))
    first = next((n for n in range(number, max(number - 40, 0), -1)
                  if _opens(lines[n - 1]) and not _closed(lines[n - 1:number])), number)
    before = range(max(number - 400, 1), number)  # a quote that is not closed is missed far below it
    for at in dict.fromkeys((first, number, *before)):
        if at < 1:
            continue
        full = _whole(lines, at) if at == first else lines[at - 1]
        result = _line(full) if len(full) <= LONGEST else None
        if result:
            key, write, why = result
            titled = write.startswith("[") and not key
            table = write.strip("[]") if titled else "" if write.startswith("#") else _table(lines[:at - 1])
            return Repair(at, ".".join(part for part in (table, key) if part), full.strip(), write, why)
    return None


def _whole(lines: list[str], at: int) -> str:
    """The line, with those that follow until its brackets are closed, where they are."""
    for end in range(at, min(at + 12, len(lines)) + 1):
        if _closed(lines[at - 1:end]):
            rows = [re.sub(r"\s+#.*", "", line).strip() for line in lines[at - 1:end]]
            return lines[at - 1] if end == at else " ".join(rows)
    return lines[at - 1]


def _table(lines: list[str]) -> str:
    """The table that is open after these lines."""
    headers = [result for line in lines if (result := re.match(r"\s*\[\[?\s*([\w.-]+)\s*\]", line))]
    return headers[-1][1] if headers else ""


def _opens(line: str) -> bool:
    bare = re.sub(r'"[^"]*"|\'[^\']*\'|#.*', "", line)
    return "=" in bare and any(bare.count(a) > bare.count(b) for a, b in ("[]", "{}", "()"))


def _closed(lines: list[str]) -> bool:
    bare = re.sub(r'"[^"\n]*"|\'[^\'\n]*\'|#.*', "", "\n".join(lines))
    return all(bare.count(a) <= bare.count(b) for a, b in ("[]", "{}", "()"))


def _line(line: str) -> tuple[str, str, str] | None:
    """(key, what to write, why) of one line, None where nothing is known or nothing is wrong."""
    reasons: list[str] = []
    plain = _keyboard(line, reasons)
    if re.match(r"\s*(//|;|%|!|--|/\*|\* |rem )", plain, re.I):
        text = re.sub(r"^\s*(//+|;+|%+|!+|--+|/\*+|\*+|rem)\s*", "", plain, flags=re.I)
        return "", f"# {text.removesuffix('*/').strip()}".strip(), "a comment begins with #"
    try:
        result = _header(plain, reasons) or _statement(plain, reasons) or _row(plain, reasons)
    except RecursionError:
        return None
    except _Hopeless as hopeless:
        key = _STATEMENT.fullmatch(plain)
        return (named(key["key"]) if key else "", "", str(hopeless))
    if not result or result[1] == line.strip() or not reasons or not _is_toml(result):
        return None
    return *result, "; ".join(dict.fromkeys(reasons))


def _is_toml(result: tuple[str, str]) -> bool:
    """Whether the reader takes what is offered: a row of a list by itself, or lines of their own."""
    key, write = result
    lines = write.replace("; on a line of its own ", "\n")
    try:
        tomllib.loads(lines if key or write.startswith("[") and not write.endswith(",") and "," not in write
                      else f"k = [{lines}]")
    except ValueError:
        return False
    return True


def _keyboard(line: str, reasons: list[str]) -> str:
    """The line with the letters of a keyboard in place of those of print."""
    result = "".join(PRINT.get(c, c) for c in _DASH.sub("-", line))
    if result != line:
        strange = next(c for c in line if c in PRINT or c in "\u2013\u2014")
        reasons.append(f"U+{ord(strange):04X} is a character of print; here stands that of the keyboard")
    return result


def _header(line: str, reasons: list[str]) -> tuple[str, str] | None:
    """The title of a table."""
    result = _HEADER.fullmatch(re.sub(r"\s+#.*", "", line))
    if not result or not (line.lstrip()[0] in "[{<(" or line.rstrip()[-1] in ":]}>)"):
        return None
    name = result[1].strip().replace(" ", "_")
    name = SECTIONS.get(name.lower(), name if name.startswith("effects.") or name.lower() not in LISTS
                        else name.lower())
    many = name in LISTS
    reasons.append("several of one kind stand under a title in double brackets" if many
                   else "the title of a table stands in square brackets")
    return "", f"[[{name}]]" if many else f"[{name}]"


def _statement(line: str, reasons: list[str]) -> tuple[str, str] | None:
    """A key and its value."""
    result = _STATEMENT.fullmatch(line)
    if result is None or not result["key"].strip(" \"'"):
        return _without_mark(line, reasons)
    key, value = _key(result["key"], reasons), result["value"]
    if result["mark"] != "=":
        reasons.append("a key and its value are joined by =")
    value, comment = _comment(value, reasons)
    if not value:
        raise _Hopeless(f"the value of {key} is missing")
    if key == "stuck" and not _taken(value) and value.lower() not in TRUTHS:
        reasons.append("it is true or false")
        return key, f"{key} = true{comment}"
    two = _NEXT.fullmatch(value)
    if two and not re.search(r"[\[{(\"']", two["first"]):
        reasons.append("one key a line")
        rest = _statement(two["rest"], reasons)
        return key, f"{key} = {_value(two['first'], reasons)}; on a line of its own {rest and rest[1]}"
    return key, f"{key} = {_value(value, reasons)}{comment}"


def _without_mark(line: str, reasons: list[str]) -> tuple[str, str] | None:
    result = re.fullmatch(r"\s*([A-Za-z_]\w*)\s+([\[\"'\d.+-].*)", line)
    if not result:
        alone = re.fullmatch(r"\s*([A-Za-z_]\w*)\s*", line)
        if alone and alone[1] != "stuck":
            raise _Hopeless(f"the value of {alone[1]} is missing, or the brackets of a title")
        reasons.append("a key has a value")
        return ("stuck", "stuck = true") if alone else None
    reasons.append("a key and its value are joined by =")
    value, comment = _comment(result[2], reasons)
    return result[1], f"{named(result[1])} = {_value(value, reasons)}{comment}"


def _row(line: str, reasons: list[str]) -> tuple[str, str] | None:
    """A line inside a list."""
    value, comment = _comment(line.strip(), reasons)
    if not re.match(r"[\[(\-+.\d\"']", value):
        return None
    bare = value.rstrip(", ")
    return "", f"{_value(bare, reasons)}{',' if bare != value else ''}{comment}"


def _key(key: str, reasons: list[str]) -> str:
    """A key without quotes, blanks and declarations."""
    bare = key.strip(" \"'-")
    first, _, rest = bare.partition(" ")
    if rest and first.lower() in DECLARED:
        bare = rest
        reasons.append(f"no word {first} stands before a key")
    resolved = named(bare)
    if resolved != bare:
        reasons.append(f"the key is called {resolved}")
    elif not _KEY.fullmatch(bare):
        resolved = re.sub(r"\W+", "_", bare.encode("ascii", "ignore").decode()).strip("_")
        if not resolved:
            raise _Hopeless(f"a key is made of the letters A to Z, digits and underscores, got {bare[:40]}")
        reasons.append("a key has neither blanks nor other signs")
    return resolved


def _unquoted_signs(text: str) -> Iterator[tuple[int, str, int]]:
    """(where, the sign, how many brackets are open) of all that stands outside quotes and is no bracket."""
    depth, quote = 0, ""
    for at, c in enumerate(text):
        if quote:
            quote = "" if c == quote else quote
        elif c in "\"'":
            quote = c
        elif c in "[({":
            depth += 1
        elif c in "])}":
            depth -= 1
        else:
            yield at, c, depth


def _comment(value: str, reasons: list[str]) -> tuple[str, str]:
    """(the value, its comment with a #): what stands outside quotes and brackets behind a sign of comment."""
    for at, c, depth in _unquoted_signs(value):
        if c == "#":
            return value[:at].rstrip(), f"  {value[at:]}"
        elif not depth and (c in ";!" or value.startswith(("//", "/*"), at)
                            or c == "%" and re.match(r"%\s*[A-Za-z]", value[at:])):
            text = value[at:].strip(";!/*% ")
            reasons.append("a comment begins with #" if text else f"nothing stands behind a value, no {c} "
                                                                   "either")
            return value[:at].rstrip(" ,"), f"  # {text}" if text else ""
    return value, ""


def _value(value: str, reasons: list[str]) -> str:
    """A value as TOML has it. Raises _Hopeless with the reason where there is no such."""
    value = value.strip()
    if value.endswith(",") and value[:-1].strip() and _balance(value) <= 0:
        reasons.append("no comma stands at the end")
        value = value[:-1].rstrip()
    called = re.fullmatch(r"(?:[A-Za-z_]\w*\.)*([A-Za-z_]\w*)\(\s*(.*?)\s*\)", value)
    if called and (called[2][:1] in ("[", "(") or called[1].lower() in MAKERS):
        reasons.append("a list stands in square brackets alone")
        value = called[2] if called[2][:1] in ("[", "(") else f"[{called[2]}]"
    elif called and called[1] == "dict":
        reasons.append("a table stands in braces, or below its title in square brackets")
        value = f"{{{called[2]}}}"
    numbers = re.split(r"\s*[,;]\s*", value)
    if len(numbers) > 1 and all(_QUANTITY.fullmatch(x) for x in numbers) and not _COMMA.fullmatch(value):
        reasons.append("a list stands in square brackets")
        value = f"[{', '.join(numbers)}]"
    value, behind = _behind(value)
    if behind:
        return _each(value, behind, reasons)
    if value[:1] == "{" and re.search(r"[=:]", value):
        return _inline(value, reasons)
    if value[:1] in ("[", "(", "{", "<") or value[-1:] in ("]", ")"):
        return _list(value, reasons)
    return _scalar(value, reasons)


def _behind(value: str) -> tuple[str, str]:
    """(a list, what stands behind its last bracket)."""
    depth = 0
    for at, c in enumerate(value if value[:1] in ("[", "(") else ""):
        depth += (c in "[(") - (c in "])")
        if not depth:
            return value[:at + 1], value[at + 1:].strip()
    return value, ""


def _each(value: str, behind: str, reasons: list[str]) -> str:
    """A list with the unit behind it at each of its numbers."""
    if set(behind) <= set("])}"):
        return _list(value + behind, reasons)
    items = _split(value[1:-1], reasons)
    if not re.fullmatch(r"[A-Za-z°][^\"'\[\]]*", behind) or not all(_BARE.fullmatch(item) for item in items):
        raise _Hopeless(f"{behind[:40]} stands behind the list: take it away, or begin a comment with #")
    reasons.append("each number has its unit, in quotes")
    united = [f'"{item} {behind}"' for item in items]
    return f"[{', '.join(united)}]"


def _inline(value: str, reasons: list[str]) -> str:
    if value[-1:] != "}":
        raise _Hopeless("a table in braces stands in one line; write its title in square brackets, such as "
                        "[body], and a key a line below it")
    pairs = [_statement(item, reasons) for item in _items(value[1:-1])]
    if re.search(r",\s*}", value):
        reasons.append("no comma stands at the end")
    if None in pairs:
        raise _Hopeless("expected keys with their values between the braces")
    return f"{{{', '.join(pair[1] for pair in pairs if pair)}}}"


def _list(value: str, reasons: list[str]) -> str:
    """A list, its brackets put right."""
    inner = value
    if value[0] in "[({<" and (value[-1] in "])}>" or value.count("[") > value.count("]")):
        inner = value[1:]
        if value[-1] in "])}>" and _balance(value) <= 0:
            inner = inner[:-1]
        else:
            reasons.append("the bracket at its end is missing")
        if value[0] != "[":
            reasons.append("a list stands in square brackets")
    elif value[-1] in "])":
        reasons.append("the bracket at its beginning is missing")
        inner = value[:-1]
    if re.search(r",\s*,", inner):
        reasons.append("one comma parts two numbers")
    if inner == value:
        return _scalar(value, reasons)
    while _balance(inner) < 0 and inner.rstrip()[-1:] in ("]", ")"):
        reasons.append("there is one bracket too many at its end")
        inner = inner.rstrip()[:-1]
    return f"[{', '.join(_value(item, reasons) for item in _split(inner, reasons))}]"


def _balance(text: str) -> int:
    bare = re.sub(r'"[^"]*"|\'[^\']*\'', "", text)
    return sum(bare.count(c) for c in "[({<") - sum(bare.count(c) for c in "])}>")


def _split(inner: str, reasons: list[str]) -> list[str]:
    """The items of a list: parted by commas, semicolons or blanks, with commas for decimals or without."""
    if not re.search(r"[\[({\"']", inner):
        for mark in (r"\s*;\s*", r",\s+", r"\s+"):
            items = [item for item in re.split(mark, inner.strip(" ,;")) if item]
            if len(items) > 1 and all(_COMMA.fullmatch(item) for item in items):
                reasons.append("decimals stand behind a point")
                return [item.replace(",", ".") for item in items]
        digits = [item.strip() for item in inner.split(",")]
        if (len(digits) in (4, 6) and all(re.fullmatch(r"[-+]?\d+", digit) for digit in digits)
                and any(re.fullmatch(r"0\d+", digit) for digit in digits[1::2])):
            reasons.append("decimals stand behind a point")
            return [f"{a}.{b}" for a, b in zip(digits[::2], digits[1::2])]
        if ";" in inner and re.search(r"[\d.][,\s]\s*[-+\d.]", inner):
            reasons.append("every row has brackets of its own")
            return [f"[{row}]" for row in re.split(r"\s*;\s*", inner.strip(" ;")) if row]
        if ";" in inner:
            reasons.append("commas part the numbers of a list")
            return [item for item in re.split(r"\s*;\s*", inner.strip(" ;")) if item]
        text = inner.split()
        if len(text) > 1 and "," not in inner and all(_BARE.fullmatch(word) for word in text):
            reasons.append("commas part the numbers of a list")
            return text
    return _items(inner)


def _items(inner: str) -> list[str]:
    """What commas part, brackets and quotes counted; items that stand side by side in brackets too."""
    items, start = [], 0
    inner = re.sub(r"([\])])\s*;?\s*(?=[\[(])", r"\1, ", inner)
    for at, c, depth in _unquoted_signs(inner):
        if c == "," and depth == 0:
            items.append(inner[start:at])
            start = at + 1
    return [item.strip() for item in (*items, inner[start:]) if item.strip()]


def _scalar(value: str, reasons: list[str]) -> str:
    if _taken(value):
        return value
    bare = value.strip("\"'").strip()
    if bare != value:
        reasons.append("a text begins and ends with the same quote")
        return f'"{_unquoted(bare)}"'
    if re.fullmatch(r"[-+]?[xyzXYZ]", value):
        reasons.append("a direction is three numbers")
        return str([(-1 if value[0] == "-" else 1) * (c == value[-1].lower()) for c in "xyz"])
    if value[:1] in tuple("{[(<\\") or value[-1:] in tuple("]})"):
        raise _Hopeless("brackets that do not fit each other")
    lower = value.lower()
    if lower in TRUTHS:
        reasons.append("truth values are true and false, in small letters")
        return TRUTHS[lower]
    if lower in NOTHING:
        raise _Hopeless(f"there is no value {value}: leave the key out")
    if _COMMA.fullmatch(value):
        full, _, digits = value.partition(",")
        reasons.append("decimals stand behind a point" + (f"; of thousands write {full}{digits}"
                                                          if len(digits) == 3 and full.strip("+-0") else ""))
        return f"{full}.{digits}"
    if _BARE.fullmatch(value):
        return _number(value, reasons)
    if _RATIO.fullmatch(value):
        reasons.append("a ratio stands in quotes")
        return f'"{value}"'
    thousands = re.fullmatch(r"[-+]?\d{1,3}(?:[ ']\d{3})+", value)
    if thousands:
        reasons.append("digits stand side by side")
        return re.sub(r"[ ']", "", value)
    ends = re.fullmatch(rf"({_NUMBER})\s*(?::|\.\.\.?)\s*({_NUMBER})", value)
    if ends:
        reasons.append("a list stands in square brackets")
        return f"[{ends[1]}, {ends[2]}]"
    percent = re.fullmatch(rf"({_NUMBER})\s*%", value)
    if _QUANTITY.fullmatch(value) or percent:
        reasons.append("a number with its unit stands in quotes" if not re.search(r"±|\+/?-", value)
                       else "a number with its uncertainty stands in quotes")
        return f'"{value}"'
    if re.search(rf"^{_NUMBER}.*[*/+^(]|\bpi\b|\w\(", value):
        raise _Hopeless(f"{value[:40]} is not worked out here: write the number itself")
    reasons.append("a text stands in quotes")
    return f'"{_unquoted(value)}"'


def _unquoted(text: str) -> str:
    return text.replace('"', "").replace("\\", "/")


def _number(value: str, reasons: list[str]) -> str:
    """Digits as TOML has them."""
    sign = value[0] if value[0] in "+-" else ""
    mantissa, mark, power = re.fullmatch(r"([^eEdD]*)([eEdD]?)(.*)", value[len(sign):]).groups()
    full, point, digits = mantissa.partition(".")
    if point and not (full and digits):
        reasons.append("digits stand on both sides of the point")
    if len(full) > 1 and full.startswith("0"):
        reasons.append("no zeros stand in front")
    if mark in ("d", "D"):
        reasons.append("a power of ten is written with e")
    full = full.lstrip("0") or "0"
    return f"{sign}{full}{f'.{digits or 0}' if point else ''}{'e' if mark else ''}{power}"


def _taken(value: str) -> bool:
    """Whether the reader takes it as it is."""
    try:
        tomllib.loads(f"k = {value}")
    except ValueError:
        return False
    return "\n" not in value
