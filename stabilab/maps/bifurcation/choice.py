"""Which equilibria a diagram counts: isolated ones, those on the motion's own curve, or where stability changes along a curve of them."""
from __future__ import annotations

from .family import Family
from .result import CURVES
from .system import BORDERS, ISOLATED, LEAF, Conics, OnLine, across, fixed_axis, on_line

WHAT = {ISOLATED: "isolated equilibria (torque off the principal axes)",
        LEAF: "equilibria on the curve that the motion keeps to, all branches of it",
        BORDERS: "points where stability changes along the curve of equilibria"}

MORE = "stabilab classify tells their stability at one value"


def chosen(family: Family, borders: bool) -> tuple[str, str, OnLine | Conics | None, tuple[str, ...]]:
    """(kind, in words, the equations or None where all is curves, notes)."""
    n = family.numbers
    axis = fixed_axis(family)
    if all(c.is_zero() for c in n["M"]):
        return CURVES, f"without a torque equilibria form curves for every value; {MORE}", None, ()
    if axis is None:
        line = on_line(family)
        if line.special.is_zero():
            return CURVES, f"the torque lies along equal moments of inertia, where equilibria form curves; {MORE}", None, ()
        return ISOLATED, WHAT[ISOLATED], line, ()
    if not n["lam"][axis].is_zero():
        one, zero = family.ring.constant(1), family.ring.constant(0)
        load = n["lam"][axis] * n["M"][axis]
        note = f"the torque lies on principal axis {axis + 1} and a wheel carries momentum along it: no equilibrium wherever neither is zero"
        return ISOLATED, WHAT[ISOLATED], OnLine((one, zero, zero), (zero,) * 3, (zero,) * 3, one, load, load), (note,)
    D = n["D"]
    if borders or "y" not in n:
        return _solvable(BORDERS, WHAT[BORDERS], across(family, axis, BORDERS))
    others = [i for i in range(3) if i != axis]
    if all((D[i] - D[axis]).is_zero() and n["lam"][i].is_zero() for i in others):
        return CURVES, f"three equal moments of inertia and no wheel: nothing balances a torque; {MORE}", None, ()
    return _solvable(LEAF, f"{WHAT[LEAF]} (torque on principal axis {axis + 1})", across(family, axis, LEAF))


def _solvable(kind: str, what: str, conics: Conics) -> tuple[str, str, Conics | None, tuple[str, ...]]:
    """The same, or words where the two conics share a curve."""
    common = conics.f.gcd(conics.g) if not (conics.f.is_zero() or conics.g.is_zero()) else None
    if common is None or max(common.degrees()[:2]) > 0:
        return CURVES, f"whole curves of equilibria solve what a diagram would count, {what}; {MORE}", None, ()
    return kind, what, conics, ()
