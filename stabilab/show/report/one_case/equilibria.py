"""The equilibria of a scene as rows of a table: where, what the linear part says, the verdict and its proof."""
from __future__ import annotations

import math
import re

from .measures import DIGITS, spoken, told, vector
from .verdict import css


def table(found, measures) -> dict:
    """kind, reason and rows; places, and Omega where it is a curve's parameter, in the unit of the page's rates; equations of curves and a
    parameter t of theirs that is a rate in rad/s; or scaled."""
    unit, one = measures.rate_unit
    unit = f" {unit}" if unit else ""
    rows = [_row(vector([v * one for v in p.at[:3]]) + unit, p, measures.reason(p.because)) for p in found.points]
    for curve in found.curves:
        for segment in curve.segments:
            rows.append(_row(f"{spoken(curve.name)}, {_piece(curve, segment.t, measures)}", segment, spoken(segment.because)))
        rows += [{"where": f"fold at {vector([v * one for v in fold[:3]])}{unit}", "linear": "degenerate", "verdict": "", "because": "", "css": ""}
                 for fold in curve.folds]
    return {"kind": found.kind, "reason": measures.reason(found.reason), "rows": rows, "curve_unit": " (rad/s)" if unit else "",
            "curves": [(spoken(_together(group)), *_of(group, measures)) for group in _alike(found.curves)]}


def _alike(curves):
    """The curves in groups that share their equation."""
    groups: dict = {}
    for curve in curves:
        groups.setdefault(curve.equation, []).append(curve)
    return groups.values()


def _together(group):
    """The name of a group: that of its curve, or of the first and the last."""
    return group[0].name if len(group) == 1 else f"{group[0].name} to {group[-1].name}"


def _of(group, measures):
    """(the equation that a group shares, its parametrisations, each once)."""
    unit, one = measures.rate_unit

    def in_unit(span):
        return "from {} to {} {}".format(*(f"{float(end) * one:.6g}" for end in span.groups()), unit)
    words = [re.sub(r"(?<=^t = Omega )from (\S+) to (\S+) rad/s", in_unit, curve.parametrisation) for curve in group]
    return spoken(group[0].equation), list(dict.fromkeys(map(spoken, words)))


def _by_omega(curve):
    """Whether the parameter of a curve is the rate of its permanent rotations about the vertical."""
    return curve.parametrisation.startswith("t = Omega from ")


def _piece(curve, pair, measures):
    """Between which values of its parameter a piece of a curve lies, with the parameter's name and unit."""
    if _by_omega(curve):
        unit, one = measures.rate_unit
        return _between("Ω", [t * one for t in pair], unit)
    a_rate = re.search(r"\b(?:omega|x)\d = [^,]*\bt\b", curve.parametrisation)
    return _between("t", pair, ("rad/s" if a_rate else "rad" if re.search(r"cos t\b|: angle", curve.parametrisation) else "") if measures.physical else "")


def _between(name, pair, unit):
    """Both ends of a piece with as many digits as tell them apart; an end that is none is not told."""
    low, high = next(words for digits in (DIGITS, 6, 8, 10, 17) if (words := [told(t, unit, digits) for t in pair])[0] != words[1] or digits == 17)
    if math.isinf(pair[0]):
        return f"every {name}" if math.isinf(pair[1]) else f"{name} below {high}"
    return f"{name} above {low}" if math.isinf(pair[1]) else f"{name} from {low.removesuffix(unit).rstrip()} to {high}"


def _row(where, part, because):
    return {"where": where, "linear": part.linear, "verdict": part.verdict, "because": because, "css": css(part.verdict)}
