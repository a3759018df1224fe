"""What is seen of a motion that no certificate decides, in words."""
from __future__ import annotations

import math

from .form import forms_of

SMALL = 0.05  # a component of the torque below this share of it is called small
PARKED = 0.3  # relative distance from the saddle-focus, in spin and in cone, that is called parked
WIDE = 2.0    # transverse motion over spin beyond which the motion is not about the axis at all


def seen(scene, state, recurrence: str = "") -> str:
    """The cause why spin-up about neither axis is certified at a state on its way, strongest first. recurrence: what is
    said of a motion that recurs (`island`), where it does."""
    forms = forms_of(scene)
    if not forms:
        return _no_form(scene)
    causes = [words for rank, words in sorted(_look(form, state, scene.time_unit) for form in forms) if words]
    island = _between(scene, state, recurrence)
    small = _small(scene, forms)
    return "; ".join(filter(None, [causes[0] if causes else "slow: the torque has not yet gathered the spin about an axis", small, island]))


def _no_form(scene):
    if scene.variables != "scaled" and len(set(scene.body.exact)) == 2:
        return "the torque has no component about the axis of symmetry and no spin-up in the equator has a certificate: nothing to test"
    return ("the torque has no component about the major or the minor axis (it lies along the middle axis, if anywhere): no certificate of "
            "spin-up exists about that axis, and nothing was followed")


def _look(form, state, unit):
    """(rank, words) of one form."""
    X, zeta = form.place(state)
    axis, cone = form.axis + 1, abs(zeta) / (abs(X) or 1e-300) / math.sqrt(form.D1 * abs(form.scale[0] * form.scale[1]))
    if X < 0:
        rest = form.drag / form.M1
        if form.drag > 0 and abs(X + rest) < PARKED * rest and cone < 3 * PARKED:
            return 0, (f"parked near a saddle-focus, a spin of {-form.sense * rest:.4g} against the torque about axis {axis}, which it leaves on the "
                       f"time scale of {form.D1 * form.drag / form.M1**2:.3g} {unit}")
        if cone < 1:
            return 1, (f"spin against the torque about axis {axis}, still slowing down: it ends after some {form.D1 * -X / form.M1:.3g} {unit} "
                       "and the fate is open until then")
        return 4, ""
    if cone > WIDE:
        return 4, ""
    return (2, f"wide cone about axis {axis}: the transverse motion is {cone:.2g} times the spin, which gains only in the mean") if cone > 0.3 else (
        3, f"spin along the torque about axis {axis}, whose rate swings by much more than the torque gives it")


def _small(scene, forms):
    torque = [float(v) for v in (scene.exact_mu if scene.variables == "scaled" else scene.vector("constant_torque"))]
    size = math.hypot(*torque)
    words = [f"small torque component about axis {form.axis + 1} ({form.M1 / size:.2g} of the torque)" for form in forms if form.M1 < SMALL * size]
    return ", ".join(words)


def _between(scene, state, recurrence):
    """A pointer to bounded islands: with a wheel and two equilibria, the state no faster than thrice the farther of them."""
    ends = _equilibria(scene)
    if not ends:
        return ""
    size = math.hypot(*state)
    if size > 3 * max(math.hypot(*end) for end in ends):
        return ""
    return recurrence or "between two equilibria, saddle-foci as a rule, where a bounded island may exist"


def _equilibria(scene):
    """The two equilibria of a scene with a wheel, or none: M.w = 0 and M.Dw = -M.l leave a line, and one quadratic on it."""
    if scene.variables == "scaled" or not any(scene.vector("gyrostat")):
        return ()
    D, l, M = ([float(v) for v in vector] for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))
    DM = [d * m for d, m in zip(D, M)]
    along = _cross(M, DM)
    square = _dot(along, along)
    if not square:
        return ()
    base = [-_dot(M, l) * v / square for v in _cross(along, M)]  # M.base = 0, DM.base = -M.l
    # along M: (w x (Dw + l)).M = M.M with w = base + s along
    H = lambda w: [d * v + e for d, v, e in zip(D, w, l)]
    c = _dot(_cross(base, H(base)), M) - _dot(M, M)
    a = _dot(_cross(along, [d * v for d, v in zip(D, along)]), M)
    b = _dot(_cross(along, H(base)), M) + _dot(_cross(base, [d * v for d, v in zip(D, along)]), M)
    disc = b * b - 4 * a * c
    if not a or disc <= 0:
        return ()
    return tuple([v + s * u for v, u in zip(base, along)] for s in ((-b - math.sqrt(disc)) / (2 * a), (-b + math.sqrt(disc)) / (2 * a)))


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
