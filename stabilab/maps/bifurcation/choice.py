"""Which equilibria a diagram counts: isolated ones, those on the motion's own curve, or where stability changes along a curve of them."""
from __future__ import annotations

from ...errors import InputError
from .family import Family
from .system import BORDERS, ISOLATED, LEAF, Conics, OnLine, across, fixed_axis, on_line

WHAT = {ISOLATED: "isolated equilibria (torque off the principal axes)",
        LEAF: "equilibria on the curve that the motion keeps to, all branches of it",
        BORDERS: "points where stability changes along the curve of equilibria"}


def chosen(family: Family, borders: bool) -> tuple[str, str, OnLine | Conics | None, tuple[str, ...]]:
    """(kind, in words, the equations or None where there is nothing to solve, notes). Raises InputError for what is not covered."""
    n, case = family.numbers, family.case
    axis = fixed_axis(family)
    if all(c.is_zero() for c in n["M"]):
        raise InputError(f"{case.place}: without a torque equilibria form curves for every value: stabilab classify tells them and their stability; "
                         "a diagram needs a torque")
    if axis is None:
        line = on_line(family)
        if line.special.is_zero():
            raise InputError(f"{case.place}: all over the range the torque lies along equal moments of inertia, where equilibria form curves that no diagram "
                             "covers: stabilab classify tells them for one value")
        return ISOLATED, WHAT[ISOLATED], line, ()
    if not n["lam"][axis].is_zero():
        one, zero = family.ring.constant(1), family.ring.constant(0)
        load = n["lam"][axis] * n["M"][axis]
        note = f"the torque lies on principal axis {axis + 1} and a wheel carries momentum along it: no equilibrium wherever neither is zero"
        return ISOLATED, WHAT[ISOLATED], OnLine((one, zero, zero), (zero,) * 3, (zero,) * 3, one, load, load), (note,)
    D = n["D"]
    if borders or "y" not in n:
        return BORDERS, WHAT[BORDERS], _solvable(family, across(family, axis, BORDERS)), ()
    others = [i for i in range(3) if i != axis]
    if not family.scaled and (D[others[0]] - D[axis]).is_zero() and (D[others[1]] - D[axis]).is_zero():
        raise InputError(f"{case.place}: three equal moments of inertia: no diagram covers a sphere; stabilab classify tells its equilibria")
    return LEAF, f"{WHAT[LEAF]} (torque on principal axis {axis + 1})", _solvable(family, across(family, axis, LEAF)), ()


def _solvable(family: Family, conics: Conics) -> Conics:
    if conics.f.is_zero() or conics.g.is_zero() or conics.f.gcd(conics.g).degrees()[0] > 0 or conics.f.gcd(conics.g).degrees()[1] > 0:
        raise InputError(f"{family.case.place}: all over the range whole curves of equilibria solve what a diagram would count: "
                         "stabilab classify tells them for one value")
    return conics
