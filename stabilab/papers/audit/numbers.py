"""Numbers in what the audit says beside a claim: a row names each in its table `numbers`, as a formula or as
one of QUANTITIES with its arguments, and "{name}" in its texts stands for what is computed from the motion
when the row is tried. So no digit of a correction is typed."""
from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...answers.simulate import trajectory
from ...errors import InputError
from ...physics.body import Body
from ...physics.coefficients import scaling
from ...theories.printed.claims import Row, parse
from ...theories.printed.evaluate import Evaluator, precise
from .. import table as paper
from ..families import sweep
from ..figures import cavity, charged
from . import measured, trends

DIGITS = 4  # of a number in a text
NAMED = re.compile(r"\{([A-Za-z]\w*)\}")
LATE = 100.0  # tau up to which a motion is followed to where it leaves


def filled(row: Row) -> Row:
    """The row with its numbers computed and put in. InputError for one that is missing, unknown or unused."""
    texts = (*row.corrected, *(row.options.get(key, "") for key in ("note", "because")))
    named = {name for text in texts for name in NAMED.findall(text)}
    given = row.options.get("numbers", {})
    if named != given.keys():
        raise InputError(f"{row.place}: numbers: expected one for each of "
                         f"{', '.join(sorted(named)) or 'no name'}, got {', '.join(given) or 'none'}")
    if not given:
        return row
    values = {name: _written(_value(row, name, item)) for name, item in given.items()}
    put: Callable[[str], str] = lambda text: NAMED.sub(lambda match: values[match[1]], text)
    options = row.options | {key: put(row.options[key]) for key in ("note", "because") if key in row.options}
    return replace(row, corrected=tuple(map(put, row.corrected)), options=options)


def _value(row: Row, name: str, item: Any) -> float | str | Sequence[Any]:
    if isinstance(item, str):
        return float(Evaluator(precise(30), {}, {}, None)(parse(item, {})).real)
    kind, *arguments = item
    if kind not in QUANTITIES:
        raise InputError(f"{row.place}: numbers.{name}: no quantity {kind!r}; known are "
                         f"{', '.join(QUANTITIES)}")
    return QUANTITIES[kind](*arguments)


def _written(value: float | str | Sequence[Any]) -> str:
    """With DIGITS digits; several with commas, pairs as intervals."""
    if isinstance(value, str):
        return value
    if isinstance(value, (tuple, list)):
        parts = [f"[{_written(item[0])}, {_written(item[1])}]" if isinstance(item, tuple) else _written(item)
                 for item in value]
        return ", ".join(parts)
    return f"{value:.{DIGITS}g}"


# --- What can be named
def _places(lambda1: float) -> str:
    """Both saddles and both centres of the circle of Fig. 4, alpha."""
    return f"({', '.join(f'{alpha:.4g}' for pair in measured.places(lambda1) for alpha in pair)})"


def _leaves(lambda1: float) -> float:
    """tau at which the motion of Fig. 12 leaves the third axis: where x3 passes 0."""
    times = np.linspace(0, LATE, 100_001)
    run = trajectory(paper.printed_scene("major", lambda1), paper.START_CAPTURED, times)
    t, x = np.asarray(run.t), np.asarray(run.states)
    after = int(np.argmax(x[:, 2] < 0))
    low, high = x[after - 1, 2], x[after, 2]
    return float(t[after - 1] + (t[after] - t[after - 1]) * low / (low - high))


def _liquid() -> tuple[float, float]:
    """(radius of the cavity, m; mass of its liquid, t)."""
    liquid = sweep("liquid-base")[""].scene.effect("liquid_cavity")
    return cavity.radius(liquid), cavity.liquid_mass(liquid) / 1000


def _widens(axis: int) -> float:
    """By how much the range of Fig. 8 is wider with the largest wheel than with the smallest, per cent."""
    (low, high), *_, (least, most) = measured.ranges(axis)
    return 100 * ((most - least) / (high - low) - 1)


QUANTITIES: dict[str, Callable[..., Any]] = {
    "measured": trends.measured,  # family, part, measure, axis, values of the family, model
    "fold radius": lambda lambda1, which: paper.fold_radii(lambda1 / 500)[which],
    "places": _places,
    "loop area": lambda lambda1, side: measured.loop_area(lambda1, ("left", "right").index(side)),
    "ranges": measured.ranges,
    "widens": _widens, "leaves": _leaves,
    "seconds of tau": lambda: float(scaling(Body(paper.INERTIA), Fraction(1)).time),
    "radius of the cavity": lambda: _liquid()[0],
    "mass of the liquid": lambda: _liquid()[1],
    "pointing error": lambda: measured.TESTS["pointing error"]()[0],
    "exact pointing error": charged.exact_mean_pointing,
}
