"""A case as TOML text again, from its data: numbers as they were written."""
from __future__ import annotations

import json
import re
import tomllib
from decimal import Decimal, localcontext
from fractions import Fraction
from typing import Any

DECIMALS = 20  # an exact decimal of so many digits is written as one, any other number as a ratio
RATIO, DIGITS = 120, 36  # a ratio with more letters is one of 240 bits, of axes that are irrational: it is rounded to so many digits


class Written(str):
    """A number as it stands in a file."""


def data_of(text: str) -> dict[str, Any]:
    """The data of a case file."""
    return tomllib.loads(text, parse_float=Written)


def exact_text(value: Fraction) -> Written | str:
    """A rational as a case takes it: a decimal, or a ratio in quotes; numbers that were enclosed, not given, are rounded."""
    places, rest = 0, value.denominator
    for prime in (2, 5):
        power = 0
        while rest % prime == 0:
            rest, power = rest // prime, power + 1
        places = max(places, power)
    digits = f"{abs(value.numerator) * 10**places // value.denominator:0{places + 1}d}" if rest == 1 else ""
    if not digits or len(digits) > DECIMALS:
        ratio = f"{value.numerator}/{value.denominator}"
        return ratio if len(ratio) <= RATIO else Written(f"{_rounded(value):e}")
    whole, fraction = (digits[:-places], digits[-places:]) if places else (digits, "0")
    return Written(f"{'-' if value < 0 else ''}{whole}.{fraction}")


def _rounded(value: Fraction) -> Decimal:
    with localcontext() as context:
        context.prec = DIGITS
        return Decimal(value.numerator) / Decimal(value.denominator)


def text_of(data: dict[str, Any], head: str = "") -> str:
    """TOML text; head: a comment above it."""
    lines = [f"# {line}" for line in head.splitlines()]
    _table(lines, (), data)
    return "\n".join(lines).strip("\n") + "\n"


def _table(lines: list[str], path: tuple[str, ...], table: dict[str, Any], brackets: str = "[%s]") -> None:
    plain = {k: v for k, v in table.items() if not _is_table(v)}
    if path and (plain or not table or brackets != "[%s]"):
        lines += ["", brackets % ".".join(map(_key, path))]
    lines += [f"{_key(k)} = {_value(v)}" for k, v in plain.items()]
    for key, value in table.items():
        if isinstance(value, dict):
            _table(lines, (*path, key), value)
        elif _is_table(value):
            for row in value:
                _table(lines, (*path, key), row, "[[%s]]")


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _quoted(key)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Written) or not isinstance(value, (str, list, dict)):
        return str(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return f"{{{', '.join(f'{_key(k)} = {_value(v)}' for k, v in value.items())}}}"
