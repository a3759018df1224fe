"""The table of hard cases: error of the naive formula, of the program, and what half a unit in the last place of every input does.

python -m tests.hard_table writes docs/hard-cases.md. Exact values: the potential in 60 and more digits (`oracles.energy`), and
for divided differences the exponential of a matrix in ball arithmetic.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

import numpy as np

import stabilab
from stabilab.analysis.divided_differences import divided_difference

from .oracles import energy, model
from .oracles.pairs import brink, scaled

PAGE = Path(__file__).parent.parent / "docs" / "hard-cases.md"
ALLOWED = 32  # times the condition: some thirty operations, each as good as rounding its operands


@dataclass(frozen=True)
class Row:
    """One hard case: errors of the naive formula and of the program, and the condition bound, all relative to the exact value."""

    case: str
    asked: str
    goes_wrong: str
    naive: float
    ours: float
    condition: float


def half_units(ask, inputs):
    """Sum over the inputs of the change of ask(inputs) by half a unit in the last place of each, numbers exact."""
    base = ask(*map(Fraction, inputs))
    nudged = ([Fraction(v) + (Fraction(math.ulp(v)) / 2 if i == n else 0) for n, v in enumerate(inputs)] for i in range(len(inputs)))
    return sum(abs(ask(*row) - base) for row in nudged)


def _row(case, asked, wrong, naive, ours, ask, inputs):
    exact = ask(*map(Fraction, inputs))
    size = abs(exact)
    relative = lambda v: float(abs(v - exact) / size) if math.isfinite(v) else math.inf  # noqa: E731
    return Row(case, asked, wrong, relative(naive), relative(ours), float(half_units(ask, inputs) / size) + 2.0**-53)


def naive_margin(a, b, state):
    """Highest saddle within a turn ahead minus the energy, scaled minor axis: a quartic by companion matrix, and the difference
    of two energies."""
    X, z, v, c = state[0] + a, state[1], state[2], b - a
    h = np.roots([1, 0, c * c - X * X - z * z, 2 * c, 1])
    h = h[abs(h.imag) < 1e-9 * abs(h)].real
    h = h[h ** 4 - c * h - 1 > 0]
    here = math.atan2(X, z)
    height = lambda X, angle: -angle - X * (X + 2 * c) / 2  # noqa: E731
    ahead = [(s, math.atan2(-(c + 1 / s), s)) for s in h.tolist()]
    tops = [height(-(c + 1 / s), t + (2 * math.pi if t <= here else 0)) for s, t in ahead]
    return max(tops) - (v * v / 2 + height(X, here)) if tops else -math.inf


def margin_row(case, wrong, a, b, state, digits=100):
    ask = lambda a, b, *x: energy.margin(model.scaled(a, b, (0, 0, 1)), x, digits=digits)  # noqa: E731
    ours = float(stabilab.fate(scaled(a, b, (0, 0, 1))[0], np.array(state)).margins)
    return _row(case, "margin", wrong, naive_margin(a, b, state), ours, ask, (a, b, *state))


def near_separatrix(distance):
    state = brink(scaled(0.2, 0.4, (0, 0, 1))[1], (-3.0, 1.0), distance)
    return margin_row(f"1e{round(math.log10(distance))} inside the separatrix", "two energies are subtracted", 0.2, 0.4, state)


def large_circle(radius):
    start = (radius * math.sin(1.9) - 0.25, radius * math.cos(1.9))
    state = brink(scaled(0.25, 0.75, (0, 0, 1))[1], start, -radius ** -2)
    return margin_row(f"circle of radius A = {radius:g}", "U of order A^2 hides a tilt of order 1", 0.25, 0.75, state)


def fold(share):
    h = (1 + share) * -1.0  # a = b = 0: fold at h = 1 and h = -1
    return margin_row(f"well {share:g} before its fold", "a quartic with a double root", 0.0, 0.0, (-1 / h, h, 0.01 * share ** 1.5))


def near_plane(tiny):
    """Largest x2 from x1 + b = 1 + tiny, x3 = -1, x2 = 0 on the middle axis (a = 0, b = tiny); the state's numbers are exact."""
    digits = int(60 - 2 * math.log10(tiny))
    ask = lambda b: energy.extremes(model.scaled(0, b, (0, 1, 0)), (1, 0, -1), digits=digits)[1][1]  # noqa: E731
    ours = float(stabilab.extremes(scaled(0.0, tiny, (0, 1, 0))[0], np.array([1.0, 0.0, -1.0]))[1, 1])
    C = (1.0 + tiny) ** 2 - 1.0  # zero in doubles: on the plane, where the motion spins up
    return _row(f"{tiny:g} off the plane C = 0, middle axis", "largest x2", "x1 + b rounds: on the plane, spin-up for ever",
                math.inf if C == 0 else math.nan, ours, ask, (tiny,))


def minute(amplitude):
    """Largest x3 and the depth of an orbit about the centre (-2, 1/2), a = b = 0, started beside it."""
    state = (-2.0, 0.5 + 2.0 ** -52, amplitude)
    ask = lambda *x: energy.extremes(model.scaled(0, 0, (0, 0, 1)), x, digits=200)[2][1]  # noqa: E731
    ours = float(stabilab.extremes(scaled(0.0, 0.0, (0, 0, 1))[0], np.array(state))[2, 1])
    height = lambda X, z: -math.atan2(X, z) - X * X / 2  # noqa: E731
    deep = amplitude ** 2 / 2 + height(state[0], state[1]) - height(-2.0, 0.5)
    naive = math.sqrt(2 * deep) if deep >= 0 else math.nan
    return _row(f"orbit of amplitude {amplitude:g} about a centre", "largest x3", "E - U(centre) is below the rounding of either", naive, ours, ask, state)


def small_divisor(r0):
    """exp's divided difference over the nodes 0, -0.3i, i r0, -i r0 at t = 2, against the sum of residues."""
    from .test_divided_differences import error_in_half_units
    nodes, t = [0j, -0.3j, 1j * r0, -1j * r0], 2.0
    residues = complex(sum(np.exp(z * t) / np.prod([z - w for w in nodes if w != z]) for z in nodes))
    naive, ours = (error_in_half_units(v, nodes, t) for v in (residues, complex(divided_difference(nodes, t))))
    unit = 2.0 ** -53  # the answer is of order one, and so is its condition
    return Row(f"small divisor {r0:g}, charged body", "tilt", "partial fractions: 1/r0^2 stands against an answer near 1", naive * unit, ours * unit, unit)


MAKERS = [(near_separatrix, 1e-14), (large_circle, 1e8), (fold, 1e-4), (near_plane, 1e-30), (near_plane, 1e-100),
          (minute, 1e-8), (minute, 1e-17), (small_divisor, 1e-3), (small_divisor, 1e-6)]


def rows() -> list[Row]:
    return [row_of(n) for n in range(len(MAKERS))]


@lru_cache
def row_of(n) -> Row:
    make, number = MAKERS[n]
    return make(number)


def page(found) -> str:
    """The table in Markdown; one digit of each number, and what is rounding is called so: the same on every machine."""
    show = lambda v: "no answer" if not math.isfinite(v) else "< 1e-15" if v < 1e-15 else f"{v:.0e}"  # noqa: E731
    lines = ["# Hard cases", "", "Relative errors against 60 digits and more. *Condition*: what half a unit in the last place of every input, and of the answer,",
             f"does to the answer; the program stays within {ALLOWED} times that. Written by `python -m tests.hard_table`; each case is tested.", "",
             "| hard case | asked for | what goes wrong in naive code | naive error | our error | condition |", "|---|---|---|---|---|---|"]
    return "\n".join([*lines, *(f"| {r.case} | {r.asked} | {r.goes_wrong} | {show(r.naive)} | {show(r.ours)} | {show(r.condition)} |" for r in found), ""])


if __name__ == "__main__":
    PAGE.write_text(page(rows()), encoding="utf-8")
    print(PAGE.read_text(encoding="utf-8"))
