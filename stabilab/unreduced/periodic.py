"""Periodic motions and Poincare sections of the flow under a torque of any direction with a wheel, and
whether such a motion is elliptic.

A periodic motion is found by Newton's method on the return map of a section.

A section is a plane on which one rate has a value and grows (or falls). The map from one passage to the next
is evaluated by Taylor series, its derivative by the variational equations V' = J(x) V beside it: a change dx
of the start moves the next passage, at the time t and the state y, by V dx - f(y) (V dx)_k/f_k(y). The flow
keeps volume, so the product of the map's two multipliers at a fixed point is 1: two real ones (hyperbolic),
or exp(+- i angle): elliptic, and then, where the angle is in no low resonance and the map twists, tori
surround it (KAM): the island in which neighbours stay. That is not proved here.

The section of a motion is the plane that it crosses most; its passages through it are roots of the Taylor
series, and a fan of neighbours crosses it beside them.

It maps the plane to itself: a periodic motion
is a fixed point (or comes back after a few passages), a motion on a torus fills a closed curve, one that
leaves scatters."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..numbers.double_double import EPS
from ..numbers.polynomial import bernstein, bernstein_halves, held_newton
from ..numbers.vectors import CYCLE

# --- Periodic motions
ORDER, TOLERANCE = 20, 1e-17
STEPS = 800      # from one passage to the next, at most
PASSES = 15      # of Newton's method
SEARCH_SIZE = 2          # times the size of a state: no periodic motion is looked for so far from it
CLOSED = 1e-11   # relative distance of a passage from the next at a periodic motion
RETURNS = 48, 160  # passages whose mean is where the search for a centre begins
NARROW = 2.0**-24  # of a step: two zeros nearer than that are a touch


@dataclass(frozen=True)
class Section:
    """Where the rate number `axis` (0, 1, 2) passes `level` in the direction `sense`."""

    axis: int
    level: float
    sense: int

    @property
    def across(self) -> list[int]:
        """The two other rates, by which a place on the section is told."""
        return [n for n in range(3) if n != self.axis]


@dataclass(frozen=True)
class Periodic:
    """A periodic motion: its state on the section, its period (scene's time) and the two multipliers of the
    return map there."""

    state: tuple
    period: float
    multipliers: tuple
    section: Section

    @property
    def elliptic(self) -> bool:
        """Whether the multipliers are a pair on the unit circle, not real."""
        item = self.multipliers[0]
        return abs(item.imag) > 1e-9 and abs(abs(item) - 1) < 1e-6

    @property
    def angle(self) -> float:
        """By which neighbours turn about it from passage to passage, rad; nan where it is not elliptic."""
        return (abs(math.atan2(self.multipliers[0].imag, self.multipliers[0].real)) if self.elliptic
                else math.nan)


def passage(scene: Any, state: Any, section: Section,
            linear: bool = True) -> tuple[float, np.ndarray, np.ndarray] | None:
    """(time, state, derivative of the state with respect to the start at that time) of the next passage; None
    where there is none in STEPS steps. linear: the derivative too, else it stays the identity."""
    rows = np.array(scene.quadratic().coefficients, float)
    x, V, t, k = np.array(state, float), np.eye(3), 0.0, section.axis
    for _ in range(STEPS):
        a, A = _series(rows, x, V, linear)
        h = _length(a)
        row = section.sense * (a[:, k] - section.level * (np.arange(len(a)) == 0))
        # the start itself is no passage: what is left of the polynomial without that root
        on_it = not t and abs(row[0]) <= 1e-13 * abs(x).max()
        between = _rising(_over(row[1:] if on_it else row, h))
        if between is not None:
            root = _root(row, between[0] * h, between[1] * h)
            return t + root, _at(a, root), _at(A, root) if linear else V
        x, V, t = _at(a, h), _at(A, h) if linear else V, t + h
        if not np.isfinite(x).all():
            return None
    return None


def periodic(scene: Any, state: Any, section: Section) -> Periodic | None:
    """The periodic motion near a state, which is moved onto the section; None where Newton's method finds
    none."""
    x = np.array(state, float)
    x[section.axis], across = section.level, section.across
    for _ in range(PASSES):
        result = passage(scene, x, section)
        if result is None:
            return None
        t, y, V = result
        f = np.array(scene.quadratic().rate(y.tolist()))
        slope = (V - np.outer(f, V[section.axis]) / f[section.axis])[np.ix_(across, across)]
        gap = (y - x)[across]
        if np.abs(gap).max() < CLOSED * np.abs(x).max():
            return Periodic(tuple(x.tolist()), t, tuple(complex(v) for v in np.linalg.eigvals(slope)),
                            section)
        try:
            x[across] += np.linalg.solve(np.eye(2) - slope, gap)
        except np.linalg.LinAlgError:
            return None
        if not math.dist(x, state) < SEARCH_SIZE * math.hypot(*state):
            return None
    return None


def in_the_middle(scene: Any, state: Any) -> Periodic | None:
    """The elliptic periodic motion in the middle of the passages of a motion that recurs; None where the mean
    of these leads to none."""
    states = sampled(scene, state)
    if states is None:
        return None
    for section in sections(states):
        places: list[np.ndarray] = []
        for count in RETURNS:
            places += [*returns(scene, places[-1] if places else states[-1], section,
                                count - len(places))[1]]
            orbit = periodic(scene, np.mean(places, axis=0), section) if len(places) == count else None
            if orbit is not None and orbit.elliptic:
                return orbit
    return None


def sections(states: np.ndarray) -> list[Section]:
    """The three planes through the mean of states (n, 3) along a motion, the one that it crosses most and
    farthest first."""
    middle = states.mean(axis=0)
    swings = [np.count_nonzero(np.diff(np.signbit(states[:, n] - middle[n]))) * states[:, n].std()
              for n in range(3)]
    return [Section(axis, float(middle[axis]), 1) for axis in np.argsort(swings)[::-1].tolist()]


def sampled(scene: Any, state: Any, steps: int = 400, until: float = math.inf) -> np.ndarray | None:
    """(n, 3) states at the ends of some Taylor steps, before a time (scene's time) where one is given; None
    where the numbers overflow."""
    rows, out = np.array(scene.quadratic().coefficients, float), []
    x, t = np.array(state, float), 0.0
    for _ in range(steps):
        a, _ = _series(rows, x, np.eye(3), False)
        h = _length(a)
        x, t = _at(a, h), t + h
        if not np.isfinite(x).all():
            return None
        if t > until:
            break
        out.append(x)
    return np.array(out).reshape(-1, 3)


def _series(rows, x, V, linear):
    """Taylor coefficients of the state, (ORDER + 1, 3), and of its derivative, (ORDER + 1, 3, 3)."""
    a, A = np.zeros((ORDER + 1, 3)), np.zeros((ORDER + 1, 3, 3))
    a[0], A[0] = x, V
    kappa, rho, sigma, m = rows
    for n in range(ORDER):
        back = a[n::-1]
        for i, (j, k) in enumerate(CYCLE):
            a[n + 1, i] = (kappa[i] * (a[:n + 1, j] @ back[:, k]) + rho[i] * a[n, k] + sigma[i] * a[n, j]
                           + (m[i] if n == 0 else 0.0)) / (n + 1)
            if linear:
                A[n + 1, i] = (kappa[i] * (back[:, j] @ A[:n + 1, k] + back[:, k] @ A[:n + 1, j])
                               + rho[i] * A[n, k] + sigma[i] * A[n, j]) / (n + 1)
    return a, A


def _length(a) -> float:
    size = max(np.abs(a[0]).max(), 1e-300)
    return float(min((TOLERANCE * size / max(np.abs(a[n]).max(), 1e-300)) ** (1 / n)
                     for n in (ORDER - 1, ORDER)))


def _at(a, h):
    """The polynomial at h."""
    return np.tensordot(h ** np.arange(len(a)), a, 1)


def _over(row, h: float) -> np.ndarray:
    """Bernstein coefficients of a polynomial on [0, h]."""
    return bernstein(len(row) - 1) @ (row * h ** np.arange(len(row)))


def _rising(values: np.ndarray, low: float = 0.0, high: float = 1.0) -> tuple[float, float] | None:
    """The part of [low, high] in which a polynomial, by its coefficients there, first comes from below zero
    to zero or above; None where it never does. Halved until it has one zero at most: a step of the series may
    pass the plane and come back."""
    signs = values >= 0
    changes = np.count_nonzero(signs[1:] != signs[:-1])
    if changes == 0 or high - low < NARROW:
        return None
    if changes == 1:
        return None if signs[0] else (low, high)
    (left, right), middle = bernstein_halves(values), (low + high) / 2
    return _rising(left, low, middle) or _rising(right, middle, high)


def _root(row, low: float, high: float) -> float:
    """The zero in [low, high] of a polynomial that rises through zero there."""
    slope = row[1:] * np.arange(1, len(row))

    def look(t: float) -> tuple[float, float, bool | None]:
        value, rate = (float(np.polynomial.polynomial.polyval(t, c)) for c in (row, slope))
        return value, rate, value > 0 if value else None
    return held_newton(look, low, high, 0.5, EPS)


# --- The section of a motion
LEAST = 5         # passages, for a plane to show anything
ONE_PLACE = 1e-9  # relative size of a set of passages that is one place
ASIDE = 0.05      # of the size of a state: how far the farthest neighbour of a single place is


def crossed(scene: Any, state: Any, until: float = math.inf) -> Section | None:
    """The plane through the middle of a motion that it crosses most, of those that it crosses LEAST times
    before `until` (scene's time); None where there is no such plane."""
    states = sampled(scene, state, until=until)
    if states is None or len(states) < LEAST:
        return None
    return next((section for section in sections(states)
                 if len(returns(scene, state, section, LEAST, until)[0]) == LEAST), None)


def returns(scene: Any, state: Any, section: Section, count: int, until: float = math.inf,
            reach: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,), places (n, 3)) of the next passages of a section: `count` of them, fewer where the motion
    passes no more before `until` (scene's time), or where a place is farther than `reach` from the origin."""
    times: list[float] = []
    places: list[np.ndarray] = []
    now, x = 0.0, np.array(state, float)
    while len(times) < count and (result := passage(scene, x, section, linear=False)) is not None:
        now, x = now + result[0], result[1]
        if not now <= until or math.hypot(*x) > reach:
            break
        times.append(now)
        places.append(x)
    return np.array(times), np.array(places).reshape(-1, 3)


def neighbours_of(middle: np.ndarray, location: np.ndarray, section: Section, number: int) -> np.ndarray:
    """(number, 3) states on the section along the line from a middle through a place: half of them between
    the two, half up to as far beyond. Where the two are one place, all of them beside it along the first of
    the other rates."""
    route, size = location - middle, float(np.abs(middle).max())
    route[section.axis] = 0.0
    inside, reach = number // 2, 1.0
    if math.hypot(*route) <= ONE_PLACE * size:
        inside, reach = 0, 0.0
        route = ASIDE * size * np.eye(3)[section.across[0]]
    outside = number - inside
    shares = [*(n / (inside + 1) for n in range(1, inside + 1)),
              *(reach + n / outside for n in range(1, outside + 1))]
    return middle + np.array(shares).reshape(-1, 1) * route


def one_place(places: np.ndarray) -> bool:
    """Whether all passages (n, 3) are at the same place: the motion is periodic."""
    return float(np.ptp(places, axis=0).max()) <= ONE_PLACE * float(np.abs(places).max())
