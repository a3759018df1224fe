"""What a hard case shows: the errors of the naive formula and of the program against the condition, or both
their words."""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

import stabilab
from tests.oracles import energy
from tests.oracles.pairs import WORDS

UNIT = 2.0 ** -53  # half a unit in the last place of the answer itself


@dataclass(frozen=True)
class Row:
    """Numbers: errors of the naive formula (inf: no answer) and of the program, the condition; relative to
    the exact value."""

    case: str
    asked: str
    goes_wrong: str
    naive: float
    ours: float
    condition: float


@dataclass(frozen=True)
class Verdict:
    """Words: what the naive test says, what the program says, and what is so."""

    case: str
    asked: str
    goes_wrong: str
    naive: str
    ours: str
    exact: str


def half_units(ask, inputs, base=None):
    """Sum over the inputs of the change of ask(inputs) by half a unit in the last place of each, numbers
    exact."""
    base = ask(*map(Fraction, inputs)) if base is None else base
    halves = [Fraction(math.ulp(v)) / 2 for v in inputs]
    nudged = ([Fraction(v) + (halves[n] if i == n else 0) for n, v in enumerate(inputs)]
              for i in range(len(inputs)))
    return sum(distance(ask(*row), base) for row in nudged)


def distance(values, exact):
    """Largest difference of two answers, each a number or a row of numbers."""
    pairs = zip(values, exact, strict=True) if hasattr(exact, "__len__") else [(values, exact)]
    return max(abs(v - e) for v, e in pairs)


def numbers(case, asked, goes_wrong, naive, ours, ask, inputs) -> Row:
    """The row of an answer (number or row of numbers) whose exact value is ask(inputs)."""
    exact = ask(*map(Fraction, inputs))
    size = distance(exact, [0] * len(exact) if hasattr(exact, "__len__") else 0)
    relative = lambda v: float(distance(v, exact)
                               / size) if np.isfinite(np.asarray(v, float)).all() else math.inf
    return Row(case, asked, goes_wrong, relative(naive), relative(ours),
               float(half_units(ask, inputs, exact) / size) + UNIT)


def labels(case, goes_wrong, pair, states, naive, digits=120) -> Verdict:
    """How many of the states (scene, problem in `pair`) get a wrong label; naive(state) -> word."""
    scene, problem = pair
    exact = [energy.label(problem, s, digits=digits) for s in states]
    ours = stabilab.fate(scene, np.array(states)).labels.tolist()
    tell = lambda wrong: f"{sum(wrong)} of {len(states)} wrong"
    return Verdict(case, f"outcome of {len(states)} states", goes_wrong,
                   tell(naive(s) != e for s, e in zip(states, exact)),
                   tell(o != WORDS[e] for o, e in zip(ours, exact)), tell([False]))
