"""Symbolic values as JSON and back: texts that hold numbers, names and sums, and nothing that could be run.
"""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

SUM, PRODUCT, POWER, RATIO, SYMBOL, FRACTION, ROW, TABLE, RECORD = ("+", "*", "^", "q", "x", "/", "()", "{}",
                                                                    "record")


def written(thing: Any) -> Any:
    """SymPy's sums, products, powers, rationals and symbols, fractions, and dataclasses, tuples and dicts of
    them, as lists for JSON.

    Raises TypeError for anything else.
    """
    if thing is None or isinstance(thing, (str, int, float)):
        return thing
    if isinstance(thing, Fraction):
        return [FRACTION, thing.numerator, thing.denominator]
    if isinstance(thing, tuple):
        return [ROW, *map(written, thing)]
    if isinstance(thing, dict):
        return [TABLE, *([written(key), written(value)] for key, value in thing.items())]
    if is_dataclass(thing):
        return [RECORD, type(thing).__name__,
                {one.name: written(getattr(thing, one.name)) for one in fields(thing) if one.init}]
    return _symbolic(thing)


def _symbolic(thing: Any) -> list[Any]:
    from sympy import Add, Mul, Pow, Rational, Symbol
    if isinstance(thing, Rational):
        return [RATIO, int(thing.p), int(thing.q)]
    if type(thing) is Symbol:
        return [SYMBOL, thing.name,
                {word: value for word, value in thing.assumptions0.items() if word != "commutative"}]
    for sign, kind in ((SUM, Add), (PRODUCT, Mul), (POWER, Pow)):
        if type(thing) is kind:
            return [sign, *map(written, thing.args)]
    raise TypeError(f"{type(thing).__name__} is not written down")


def read(data: Any, records: Mapping[str, type]) -> Any:
    """What `written` wrote. records: the dataclasses that may stand in it, by their names. Raises ValueError,
    KeyError or TypeError for what it did not write."""
    if data is None or isinstance(data, (str, int, float)):
        return data
    sign, *rest = data
    if sign == ROW:
        return tuple(read(one, records) for one in rest)
    if sign == TABLE:
        return {read(key, records): read(value, records) for key, value in rest}
    if sign == RECORD:
        name, parts = rest
        return records[name](**{key: read(part, records) for key, part in parts.items()})
    if sign == FRACTION:
        return Fraction(*map(_whole, rest))
    return _read_symbolic(sign, rest, records)


def _read_symbolic(sign: Any, rest: list[Any], records: Mapping[str, type]) -> Any:
    """Sums and products keep the order in which they stand: nothing is worked out again."""
    from sympy import Add, Expr, Mul, Pow, Rational, Symbol
    if sign == RATIO:
        return Rational(*map(_whole, rest))
    if sign == SYMBOL:
        name, assumptions = rest
        if not isinstance(name, str):
            raise TypeError("a symbol's name is a text")
        return Symbol(name, **assumptions)
    parts = [read(one, records) for one in rest]
    if not all(isinstance(part, Expr) for part in parts):
        raise TypeError("sums, products and powers are of expressions")
    return {SUM: Add, PRODUCT: Mul, POWER: Pow}[sign](*parts, evaluate=False)


def _whole(number: Any) -> int:
    if type(number) is not int:
        raise TypeError("expected a whole number")
    return number
