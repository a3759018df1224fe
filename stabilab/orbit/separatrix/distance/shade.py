"""Which points of a sheet part bounded motions from spin-up: those whose saddle no higher barrier stands beside.

On a circle under a torque the fate is that of the highest barrier within one turn ahead. A loop counts as far as no place
between it and its saddle, and none ahead of the saddle, is higher than the saddle: there the sheet ends on the loop on which
two barriers are as high, and the other barrier's sheet goes on. Where two sheets meet so, they form a notch that points into
the bounded motions, and the nearest point may lie in it: a bound that uses both heights at once closes there.
"""
from __future__ import annotations

import math
from fractions import Fraction

from ..circle import moved, others, slope


class Shade:
    """The barriers beside a saddle; constants: (G, c, d, mu) of the force."""

    def __init__(self, constants):
        self.g = constants

    def _places(self, chart, t):
        """Offsets of the other barriers within a turn on either side."""
        x, z = chart.curve.at(t)[:2]
        for side in (1, -1):
            for q in others(self.g, x, z, side):
                if q < math.inf and slope(self.g, *moved(x, z, side * q)) > 0:
                    yield side * q

    def __call__(self, chart, t, y) -> bool:
        """Whether the point counts."""
        return not any((at > 0 or at > y) and _barrier(chart, t, at).phi < 0 for at in self._places(chart, t))

    def bound(self, search, form, best, chart, t, dt, y, dy):
        """A better lower bound over a box by what may shade it: inf where it is shaded for certain."""
        for at in self._places(chart, t):
            if at < 0 and not at > y + dy:
                continue
            p, bends = _barrier(chart, t, at), chart.bends(t, dt, at, 0.0)[3]
            if p.phi + abs(p.phi_t) * dt + 0.5 * (abs(bends[0]) + bends[1]) * dt * dt + p.off[1] < 0:
                return math.inf
            share = form.t / p.phi_t if p.phi_t else 0.0
            if share > 0:  # points that count have p.phi >= 0, so this much may be taken off
                (tt, rtt), *rest = form.bends
                new = form._replace(value=form.value - share * p.phi, t=0.0, off=form.off + share * p.off[1],
                                    bends=[(tt - share * bends[0], rtt + share * bends[1]), *rest])
                best = max(best, new.least(dt, dy))
            if best < search.goal and p.phi * p.phi < (p.phi_t * dt) ** 2 and dt < 0.1:
                self._notch(search, chart, t, y, at)
        return best

    def _notch(self, search, chart, t, y, at):
        """Try the loop on which the two barriers are as high."""
        for _ in range(6):
            p = _barrier(chart, t, at)
            step = -p.phi / p.phi_t if p.phi_t else 0.0
            t = min(max(t + step, chart.t[0]), chart.t[1])
            near = [place for place in self._places(chart, t) if (place > 0) == (at > 0)]
            if not near:
                return
            at = min(near, key=lambda place: abs(place - at))
            if abs(step) < 1e-15 * (1 + abs(t)):
                break
        p = _barrier(chart, t, at)
        t += math.copysign(4e-16 * (1 + abs(t)) + (p.off[1] / abs(p.phi_t) if p.phi_t else 0.0), p.phi_t)
        search.better(*chart.at_one(t, y))


def _barrier(chart, t, at):
    """The point of a sheet at another barrier: phi is below zero where that is higher than the saddle. Two barriers of a wide circle may be as
    high but for the last digits of what they rise above the centre, which doubles lose, with those of the barrier's place: then a step of
    Newton's method in balls leads to it."""
    p, (bend, _) = chart.point(t, at), chart.bends(t, 0.0, at, 0.0)[5]
    if not bend > 0 or abs(p.phi) > 4 * (p.off[1] + (abs(p.phi_y) + p.rough[3]) ** 2 / bend):
        return p
    p = chart.exact_point(t, at)
    return chart.exact_point(t, Fraction(at) - Fraction(p.phi_y / bend))
