"""The equilibria of a scene as rows of a table: where, what the linear part says, the verdict and its proof."""
from __future__ import annotations

from .measures import spoken, told, vector
from .verdict import css


def table(found, measures) -> dict:
    """kind, reason and rows; places in the unit of the page's rates, equations of curves and their parameter t in rad/s, or scaled."""
    unit, one = measures.rate_unit
    unit = f" {unit}" if unit else ""
    rows = [_row(vector([v * one for v in p.at[:3]]) + unit, p, measures.reason(p.because)) for p in found.points]
    for curve in found.curves:
        for segment in curve.segments:
            rows.append(_row(f"{spoken(curve.name)}, t from {_ends(segment.t)}", segment, spoken(segment.because)))
        rows += [{"where": f"fold at {vector([v * one for v in fold[:3]])}{unit}", "linear": "degenerate", "verdict": "", "because": "", "css": ""}
                 for fold in curve.folds]
    return {"kind": found.kind, "reason": measures.reason(found.reason), "rows": rows, "curve_unit": " (rad/s)" if unit else "",
            "curves": [(spoken(_together(group)), *_of(group)) for group in _alike(found.curves)]}


def _alike(curves):
    """The curves in groups that share their equation."""
    groups: dict = {}
    for curve in curves:
        groups.setdefault(curve.equation, []).append(curve)
    return groups.values()


def _together(group):
    """The name of a group: that of its curve, or of the first and the last."""
    return group[0].name if len(group) == 1 else f"{group[0].name} to {group[-1].name}"


def _of(group):
    """(the equation that a group shares, its parametrisations, each once)."""
    return spoken(group[0].equation), list(dict.fromkeys(spoken(curve.parametrisation) for curve in group))


def _ends(pair):
    """Both ends of a piece with as many digits as tell them apart."""
    found = next(words for digits in (4, 6, 8, 10, 17) if (words := [told(t, digits=digits) for t in pair])[0] != words[1] or digits == 17)
    return " to ".join(found)


def _row(where, part, because):
    return {"where": where, "linear": part.linear, "verdict": part.verdict, "because": because, "css": css(part.verdict)}
