"""The words about a curve of equilibria with their numbers in the unit in which rates are told."""
from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from .units import Units

DIGITS = 6
RATE = r"(?:omega|x)\d"
NUMBER = r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?"
# what is left of a clause once names, numbers, the parameter and signs are taken out; an oblique plane or a
# field has other symbols
KNOWN = re.compile(
    rf"{RATE}|{NUMBER}|\bt\b|\b(?:arbitrary|and|on a straight "
    rf"line|plane|line|along|equilibrium|hyperbola|the gyrostatic moment)\b|[-+=/(), ]")
TURNS = re.compile(r" and its turns about axis \d$")
TERM = re.compile(rf"({NUMBER})(/t| t\b)?")


class Told(NamedTuple):
    """A curve in words. one: how many of the unit make one in the variables of the curve; `unit` is empty
    where these are scaled."""

    name: str
    equation: str
    parametrisation: str
    unit: str
    one: float


def in_units(curve, units: Units) -> Told:
    """The name, the equation and the parametrisation of a curve whose numbers are all rates, or products of
    two, in the unit of rates; those of any other as they are, in rad/s."""
    words = (curve.name, curve.equation, TURNS.sub("", curve.parametrisation))
    name, one = units.rates
    if units.scaled or one == 1.0 or any(KNOWN.sub("", part) for part in words):
        return Told(curve.name, curve.equation, curve.parametrisation, "" if units.scaled else "rad/s", 1.0)
    title, equation, run = (", ".join(_clause(clause, one) for clause in part.split(", ")) for part in words)
    return Told(title, equation, run + curve.parametrisation[len(words[2]):], name, one)


def _clause(clause, one):
    """"omega1 = 0.4 + t", "(omega1 + 0.4) omega2 = 2" or "omega1 = 0.4 + 2/t" with its numbers in another
    unit of rates."""
    left, equals, right = clause.partition(" = ")
    product = len(re.findall(RATE, left)) == 2 and bool(equals)
    return _scaled(left, one, one) + equals + _scaled(right, one * one if product else one, one)


def _scaled(words, one, rate):
    """A number that stands alone times `one`; one over t, a product of two rates, times the square of that of
    a rate; one times t as it is."""
    factors = {"": one, "/t": rate * rate, " t": 1.0}
    return TERM.sub(lambda found: f"{float(found[1]) * factors[found[2] or '']:.{DIGITS}g}{found[2] or ''}",
                    words)
