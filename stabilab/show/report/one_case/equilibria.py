"""The equilibria of a scene as rows of a table: where, what the linear part says, the verdict and its proof."""
from __future__ import annotations

from .measures import spoken, told, vector
from .verdict import css


def table(found, measures) -> dict:
    """kind, reason and rows; places in the unit of the page's rates, equations of curves and their parameter t in rad/s, or scaled."""
    unit, one = measures.rate_unit
    unit = f" {unit}" if unit else ""
    rows = [_row(vector([v * one for v in p.at[:3]]) + unit, p) for p in found.points]
    for curve in found.curves:
        for segment in curve.segments:
            low, high = (told(t, digits=4) for t in segment.t)
            rows.append(_row(f"{spoken(curve.name)}, t from {low} to {high}", segment))
        rows += [{"where": f"fold at {vector([v * one for v in fold])}{unit}", "linear": "degenerate", "verdict": "", "because": "", "css": ""}
                 for fold in curve.folds]
    return {"kind": found.kind, "reason": spoken(found.reason), "rows": rows, "curve_unit": " (rad/s)" if unit else "",
            "curves": [(curve.name, spoken(curve.equation), spoken(curve.parametrisation)) for curve in found.curves]}


def _row(where, part):
    return {"where": where, "linear": part.linear, "verdict": part.verdict, "because": spoken(part.because), "css": css(part.verdict)}
