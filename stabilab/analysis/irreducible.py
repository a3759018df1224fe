"""Scenes without a reduction: what can still be said of the fate, extremes and period of their motions.

Three kinds: no torque and a gyrostatic moment with no zero component (closed orbits on the momentum sphere); a torque
along a principal axis with a gyrostatic component along it (unbounded by an exact law); a torque in the plane of two
equal moments (turned onto an axis); and a torque off the axes, where nothing is known and a run gives evidence.
"""
from __future__ import annotations

from fractions import Fraction

import numpy as np

from ..errors import InputError
from .fate import Reason, _write, at_rest, fate
from .results import Fate


def kind_of(scene) -> str:
    """"free", "law", "turned" or "off-axis" for a scene that has no reduction."""
    form = scene.quadratic()
    acting = [i for i in range(3) if form.m[i]]
    if not acting:
        return "free"
    if len(acting) == 1:
        return "law"
    from .alignment import aligned
    return "turned" if aligned(scene) is not None else "off-axis"


def labeller(scene):
    """The chunk labeller of `fate` for such a scene."""
    kind = kind_of(scene)
    if kind == "turned":
        from .alignment import aligned
        twin, rotation = aligned(scene)

        def turned(states, out):
            result = fate(twin, states @ rotation.T)
            for name in ("labels", "margins", "reasons", "sense"):
                out[name][:] = getattr(result, name)
            out["axis"][:] = 0  # the spin-up is about the torque's direction, not about a body axis
            at_rest(scene, states, out)
            return result.precise
        return turned
    one = {"free": _free, "law": _law, "off-axis": _off_axis}[kind]

    def label(states, out):
        for index, state in enumerate(states):
            one(scene, state, out, index)
        at_rest(scene, states, out)
        return 0
    return label


def _law(scene, state, out, index):
    from .captured import captured_fate
    found = captured_fate(scene, state)
    out["labels"][index], out["reasons"][index], out["margins"][index] = found.fate, Reason.UNBOUNDED_LAW, -np.inf
    out["axis"][index], out["sense"][index] = found.axis, found.sense


def _off_axis(scene, state, out, index):
    _write(out, index, Fate.UNDECIDED, Reason.OFF_AXIS, np.inf)


def _free(scene, state, out, index):
    margin, tie = free_margin(scene, state)
    label = Fate.SEPARATRIX if tie else Fate.BOUNDED
    _write(out, index, label, Reason.TIE if tie else Reason.TORQUE_FREE, margin)


def free_margin(scene, state, digits=60):
    """(margin, tie) without torque: energy of the saddle nearest in energy on the same momentum sphere, minus energy.

    Saddles are the permanent rotations H = s omega on |H| = h at which D^-1 - 1/s is indefinite across H: the roots
    s of sum s^2 lambda_i^2/(D_i - s)^2 = h^2, a sextic, in many digits. Physical scenes; inf where there is no saddle.
    """
    if scene.variables != "physical":
        return float("inf"), False
    import mpmath
    mp = mpmath.mp.clone()
    mp.dps = digits
    number = lambda v: mp.mpf(Fraction(v).numerator) / Fraction(v).denominator
    D, lam = [number(d) for d in scene.body.exact], [number(v) for v in scene.vector("gyrostat")]
    w = [number(float(v)) for v in state]
    h2 = sum((d * v + l) ** 2 for d, v, l in zip(D, w, lam))
    energy = sum(d * v * v for d, v in zip(D, w)) / 2
    heights = [height for height in _saddle_energies(mp, D, lam, h2)]
    if not heights:
        return float("inf"), False
    margin = min((height - energy for height in heights), key=abs)
    tie = abs(margin) <= mp.mpf(10) ** (8 - digits) * (energy + h2 / min(D))
    return (0.0 if tie else float(margin)), bool(tie)


def _saddle_energies(mp, D, lam, h2):
    squares = [_times(mp, [1, -d], [1, -d]) for d in D]
    everything = [mp.mpf(1)]
    for square in squares:
        everything = _times(mp, everything, square)
    poly = [-h2 * a for a in everything]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        term = _times(mp, _times(mp, squares[j], squares[k]), [lam[i] ** 2, 0, 0])
        poly = [a + b for a, b in zip(poly, [mp.mpf(0)] * (len(poly) - len(term)) + term)]
    while poly and poly[0] == 0:
        poly.pop(0)
    for root in mp.polyroots(poly, maxsteps=500, extraprec=600) if len(poly) > 1 else []:
        s = mp.re(root)
        if abs(mp.im(root)) > mp.mpf(10) ** (-mp.dps // 4) * (1 + abs(root)) or s == 0 or any(s == d for d in D):
            continue
        omega = [-l / (d - s) for d, l in zip(D, lam)]
        H = [d * v + l for d, v, l in zip(D, omega, lam)]
        if _indefinite_across(H, [1 / d - 1 / s for d in D]):
            yield sum(d * v * v for d, v in zip(D, omega)) / 2


def _times(mp, a, b):
    out = [mp.mpf(0)] * (len(a) + len(b) - 1)
    for i, u in enumerate(a):
        for j, v in enumerate(b):
            out[i + j] += u * v
    return out


def _indefinite_across(H, diagonal) -> bool:
    """Whether diag(diagonal) restricted to the plane normal to H is indefinite: the bordered determinant's sign."""
    a, b, c = diagonal
    return H[0] ** 2 * b * c + H[1] ** 2 * a * c + H[2] ** 2 * a * b < 0


def extremes_one_by_one(scene, states, span):
    """(n, 3, 2) extremes for scenes without a reduction; see `extremes.extremes`."""
    kind = kind_of(scene)
    if kind == "turned":
        return np.array([_turned_extremes(scene, state, span) for state in states]).reshape(-1, 3, 2)
    from .offaxis import evidence, extremes_over_period
    if kind == "free":
        return np.array([extremes_over_period(scene, s).extremes for s in states]).reshape(-1, 3, 2)
    rest = fate(scene, states).labels == Fate.EQUILIBRIUM if kind == "off-axis" else np.zeros(len(states), bool)
    if span is None and not rest.all():
        raise InputError("this scene has no reduction, so its extremes are searched over a time span: give span=T "
                         f"({scene.time_unit}), or a span in the case's [motion]")
    return np.array([np.stack([s, s], axis=1) if at_rest_ else evidence(scene, s, span).extremes
                     for s, at_rest_ in zip(states, rest)]).reshape(-1, 3, 2)


def _turned_extremes(scene, state, span):
    """Extremes in a plane of equal moments: roots of the body components' own rates over one period, or over the span."""
    from .offaxis import evidence
    label, time = fate(scene, state).labels, float(periods_one_by_one(scene, state[None])[0])
    if label == Fate.EQUILIBRIUM:
        return np.stack([state, state], axis=1)
    if label == Fate.BOUNDED and np.isfinite(time):
        return evidence(scene, state, 1.02 * time).extremes
    if span is None:
        raise InputError("this motion spins up about a direction between the axes: give span=T for its extremes")
    return evidence(scene, state, span).extremes


def periods_one_by_one(scene, states):
    """(n,) periods for scenes without a reduction: from one return of a free motion; inf for unbounded ones."""
    kind = kind_of(scene)
    if kind == "turned":
        from .alignment import aligned
        from .quadrature import periods
        twin, rotation = aligned(scene)
        return periods(twin, states @ rotation.T)
    if kind == "free":
        from .offaxis import extremes_over_period
        return np.array([extremes_over_period(scene, s).period for s in states])
    return np.where(fate(scene, states).labels == Fate.EQUILIBRIUM, 0.0, np.inf)
