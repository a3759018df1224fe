"""Extremes and period of one state in many digits: for nearly equal moments, where the centre of the orbit is so far
away that doubles lose it, and wherever the fast path finds no interval."""
from __future__ import annotations

import numpy as np

from .precise import PreciseOrbit
from .results import Fate


def extremes_and_period(reduction, state, label: int, digits: int = 50):
    """((3, 2) array, period) of one state with the given `Fate` label, in the scene's variables."""
    orbit = PreciseOrbit(reduction, state, digits)
    if label == Fate.EQUILIBRIUM:
        return np.repeat(np.asarray(state, float)[:, None], 2, axis=1), 0.0
    if label == Fate.SPIN_UP:
        return _unbounded(orbit), float("inf")
    left, right = _turning_points(orbit)
    if left is None:
        return _round_the_circle(orbit)
    inner = [y for y in _all_critical(orbit) if left < y < right]
    fastest = max([orbit.energy, *(orbit.energy - orbit.height(y) for y in inner)])
    top = orbit.mp.sqrt(2 * fastest)
    result = _box(orbit, [left, right, *(y for y in _tops(orbit) if left < y < right), orbit.mp.mpf(0)], -top, top)
    return result, _period(orbit, left, right, inner) if label == Fate.BOUNDED else float("inf")


def _all_critical(orbit):
    """Offsets of the equilibria from one turn behind to one ahead, ascending."""
    found = list(orbit.critical)
    if orbit.r.e < 0:
        found += [y - 2 * orbit.mp.pi for y in orbit.critical]
    return sorted(found)


def _turning_points(orbit):
    """Offsets of both turning points; (None, None) for a torque-free rotation over all barriers."""
    ends = []
    for side in (-1, 1):
        spots = [y for y in _all_critical(orbit) if y * side > 0]
        spots.sort(key=abs)
        inner, outer = orbit.mp.mpf(0), None
        for y in spots:
            if orbit.height(y) >= orbit.energy:
                outer = y
                break
            inner = y
        if outer is None:
            if orbit.r.e < 0:
                return None, None
            outer = inner + side
            while orbit.height(outer) < orbit.energy:
                outer = inner + 2 * (outer - inner)
        ends.append(_bisect(orbit, inner, outer))
    return ends


def _bisect(orbit, inner, outer):
    """Offset between inner (below the energy) and outer (above) where the potential equals the energy."""
    for _ in range(4 * orbit.digits):
        middle = (inner + outer) / 2
        if orbit.height(middle) < orbit.energy:
            inner = middle
        else:
            outer = middle
    return (inner + outer) / 2


def _tops(orbit):
    """Offsets where X or Z (or the components of a parabola) are stationary."""
    mp, e = orbit.mp, orbit.r.e
    if e < 0:
        angle = mp.atan2(orbit.x, orbit.z)
        return [k * mp.pi / 2 - angle for k in range(-6, 7)]
    if e > 0:
        xi, eta = orbit.x + orbit.z, orbit.x - orbit.z
        return [mp.log(abs(eta / xi)) / 2] if xi and eta else []
    a, b = orbit.ab
    p, q = orbit.number(orbit.r.p), orbit.number(orbit.r.q)
    return [-speed / bend for speed, bend in ((a, p * b), (b, q * a)) if bend]


def _to_components(orbit, y):
    """(omega_j, omega_k) at offset y."""
    first, second = orbit.place(y)
    if orbit.r.e == 0:
        return first, second
    return orbit.flip * orbit.rx * first - orbit.sj, orbit.rz * second - orbit.sk


def _box(orbit, offsets, w_low, w_high):
    r = orbit.r
    out = np.empty((3, 2))
    pairs = [_to_components(orbit, y) for y in offsets]
    for row, axis in enumerate((r.j, r.k)):
        values = [float(pair[row]) for pair in pairs]
        out[axis] = min(values), max(values)
    scale = 1 if r.e == 0 else orbit.flip / orbit.n
    ends = sorted(float(w * scale - orbit.number(r.s)) for w in (w_low, w_high))
    out[r.axis] = ends
    return out


def _round_the_circle(orbit):
    """Torque-free rotation: the whole circle, one sign of W."""
    mp = orbit.mp
    kinetic = [orbit.energy, *(orbit.energy - orbit.height(y) for y in orbit.critical)]
    sign = 1 if orbit.w > 0 else -1
    box = _box(orbit, _tops(orbit), sign * mp.sqrt(2 * min(kinetic)), sign * mp.sqrt(2 * max(kinetic)))
    period = mp.quad(lambda y: 1 / mp.sqrt(2 * (orbit.energy - orbit.height(y))), mp.linspace(0, 2 * mp.pi, 17))
    return box, float(period)


def _unbounded(orbit):
    """Extremes over the future of a spin-up; omega_i from its least value to infinity."""
    mp, r = orbit.mp, orbit.r
    if r.e == 0 or (r.e > 0 and orbit.x == 0 and orbit.z == 0):
        out = np.repeat(np.array(orbit.state)[:, None], 2, axis=1)
        out[r.axis][(0 if r.sense < 0 else 1)] = r.sense * np.inf
        return out
    ahead = [orbit.energy - orbit.height(y) for y in orbit.critical if y > 0]
    slowest = min([orbit.w, *(mp.sqrt(2 * max(v, 0)) for v in ahead)])
    if orbit.w < 0:
        best, spots = orbit.energy, sorted((y for y in _all_critical(orbit) if y < 0), reverse=True)
        for y in spots:
            if orbit.height(y) > orbit.energy:
                break
            best = max(best, orbit.energy - orbit.height(y))
        slowest = -mp.sqrt(2 * best)
    return _box(orbit, _tops(orbit), slowest, mp.inf)


def _period(orbit, left, right, inner) -> float:
    """Twice the time from one turning point to the other; nodes cluster at both ends and at every equilibrium."""
    mp = orbit.mp
    half, middle = (right - left) / 2, (right + left) / 2
    if half == 0:
        return float("inf")

    def integrand(phi):
        y = middle - half * mp.cos(phi)
        rest = orbit.energy - orbit.height(y)
        return half * mp.sin(phi) / mp.sqrt(2 * rest) if rest > 0 else mp.mpf(0)
    knots = sorted({mp.mpf(0), mp.pi, *(mp.acos((middle - y) / half) for y in inner)})
    return float(2 * mp.quad(integrand, knots, maxdegree=8))
