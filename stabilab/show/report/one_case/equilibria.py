"""The equilibria of a scene as rows of a table: where, what the linear part says, the verdict and its proof."""
from __future__ import annotations

import math
import re

from ...curve_units import in_units
from .measures import DIGITS, spoken, told, vector
from .verdict import css


def table(found, measures) -> dict:
    """kind, reason and rows; places, equations of curves in rates and a parameter of theirs that is one in the unit of the page's rates."""
    unit, one = measures.rate_unit
    unit = f" {unit}" if unit else ""
    rows = [_row(vector([v * one for v in p.at[:3]]) + unit, p, measures.reason(p.because)) for p in found.points]
    for curve in found.curves:
        for segment in curve.segments:
            rows.append(_row(f"{spoken(_name(curve, measures))}, {_piece(curve, segment.t, measures)}", segment, measures.reason(segment.because)))
        for fold in curve.folds:
            row = _fold(curve, fold, f"{vector([v * one for v in fold[:3]])}{unit}", measures)
            rows += [] if row in rows else [row]  # a point where curves meet is one of each
    return {"kind": found.kind, "reason": measures.reason(found.reason), "rows": rows,
            "curves": [(spoken(_together(group, measures)), *_of(group, measures)) for group in _alike(found.curves)]}


def _fold(curve, at, where, measures):
    """A point between two pieces of a curve, with its verdict where it has one."""
    found = next((sample for sample in curve.samples if tuple(sample.at[:3]) == tuple(at[:3]) and sample.linear == "degenerate"), None)
    if found is None:
        return {"where": f"fold at {where}", "linear": "degenerate", "verdict": "", "because": "", "css": ""}
    return _row(f"{'fold' if found.because.startswith('fold') else 'meeting point'} at {where}", found, measures.reason(found.because))


def _alike(curves):
    """The curves in groups that share their equation."""
    groups: dict = {}
    for curve in curves:
        groups.setdefault(curve.equation, []).append(curve)
    return groups.values()


def _together(group, measures):
    """The names of a group: both of two, the first and the last of more."""
    names = list(dict.fromkeys(_name(curve, measures) for curve in group))
    return " and ".join(names) if len(names) < 3 else f"{names[0]} to {names[-1]}"


def _name(curve, measures):
    """The name of a curve without the range of its parameter, which its pieces tell."""
    return measures.units.axes.sentence(re.sub(r" for t in \(.*\)$", "", in_units(curve, measures.units).name))


def _of(group, measures):
    """(the equation that a group shares, with the unit of its numbers, its parametrisations, each once without the range, which its pieces tell)."""
    told = [in_units(curve, measures.units) for curve in group]
    words = [re.sub(r"^t = Omega from \S+ to \S+ rad/s; ", "", curve.parametrisation) for curve in told]
    unit = f" (ω in {told[0].unit})" if told[0].unit and re.search(r"(?<![\w.^])(?!0(?![\d.]))\d", told[0].equation) else ""
    return spoken(told[0].equation) + unit, list(dict.fromkeys(map(spoken, words)))


def _by_omega(curve):
    """Whether the parameter of a curve is the rate of its permanent rotations about the vertical."""
    return curve.parametrisation.startswith("t = Omega from ")


def _piece(curve, pair, measures):
    """Between which values of its parameter a piece of a curve lies, with the parameter's name and unit."""
    if _by_omega(curve):
        unit, one = measures.rate_unit
        return _between("Ω", [t * one for t in pair], unit)
    if re.search(r"\b(?:omega|x)\d = [^,]*\bt\b", curve.parametrisation):
        told = in_units(curve, measures.units)
        return _between("t", [t * told.one for t in pair], told.unit)
    unit, one = measures.units.angles if measures.physical and re.search(r"cos t\b|: angle", curve.parametrisation) else ("", 1.0)
    return _between("t", [t * one for t in pair], unit)


def _between(name, pair, unit):
    """Both ends of a piece with as many digits as tell them apart; an end that is none is not told."""
    low, high = next(words for digits in (DIGITS, 6, 8, 10, 17) if (words := [told(t, unit, digits) for t in pair])[0] != words[1] or digits == 17)
    if math.isinf(pair[0]):
        return f"every {name}" if math.isinf(pair[1]) else f"{name} below {high}"
    return f"{name} above {low}" if math.isinf(pair[1]) else f"{name} from {low.removesuffix(unit).rstrip()} to {high}"


def _row(where, part, because):
    return {"where": where, "linear": part.linear, "verdict": part.verdict, "because": because, "css": css(part.verdict)}
