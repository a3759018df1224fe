"""Minor axis: next to separatrices, on large circles, by folds, far from the origin, about centres (groups 1,
2, 3, 4, 11)."""
from __future__ import annotations

import math

import numpy as np

import stabilab
from tests.hard.row import Verdict, labels, numbers
from tests.oracles import energy, model
from tests.oracles.pairs import brink, scaled


def saddles(radius2, c):
    """(X, h) of the saddles on the circle X^2 + x2^2 = radius2: a quartic by companion matrix."""
    h = np.roots([1, 0, c * c - radius2, 2 * c, 1])
    h = h[abs(h.imag) < 1e-9 * abs(h)].real
    return [(-(c + 1 / s), s) for s in h[h ** 4 - c * h - 1 > 0].tolist()]


def barrier_minus_energy(a, b, state):
    """Highest saddle within a turn ahead minus the energy, the two subtracted."""
    X, z, v, c = state[0] + a, state[1], state[2], b - a
    here = math.atan2(X, z)
    height = lambda X, angle: -angle - X * (X + 2 * c) / 2
    ahead = [(x, math.atan2(x, s)) for x, s in saddles(X * X + z * z, c)]
    tops = [height(x, t + (2 * math.pi if t <= here else 0)) for x, t in ahead]
    return max(tops) - (v * v / 2 + height(X, here)) if tops else -math.inf


def expanded(a, b, state):
    """The same from the sums of squares multiplied out, as the papers' first integrals are: x1^2 + 2 a x1 +
    a^2 + x2^2 and x3^2/2 - x1^2/2 - b x1 - t."""
    x1, x2, v = state
    radius2, here = x1 * x1 + 2 * a * x1 + a * a + x2 * x2, math.atan2(x1 + a, x2)
    height = lambda x1, angle: -angle - x1 * x1 / 2 - b * x1
    ahead = [(x - a, math.atan2(x, s)) for x, s in saddles(radius2, b - a)]
    tops = [height(x, t + (2 * math.pi if t <= here else 0)) for x, t in ahead]
    return max(tops) - (v * v / 2 + height(x1, here)) if tops else -math.inf


def word(margin):
    return "bounded" if margin > 0 else "spin-up" if margin < 0 else "separatrix"


def margin_row(case, wrong, a, b, state, digits=100, naive=barrier_minus_energy):
    ask = lambda a, b, *x: energy.margin(model.scaled(a, b, (0, 0, 1)), x, digits=digits)
    ours = float(stabilab.fate(scaled(a, b, (0, 0, 1))[0], np.array(state)).margins)
    return numbers(case, "margin", wrong, naive(a, b, state), ours, ask, (a, b, *state))


def next_to_a_separatrix(distance):
    """1. States a relative distance off the separatrix, above many places, on both sides."""
    pair = scaled(0.2, 0.4, (0, 0, 1))
    places = np.random.default_rng(1).uniform((-4, -4), (4, 4), (14, 2)).tolist()
    states = [brink(pair[1], p, s * distance) for p in places for s in (1, -1)]
    case = f"{distance:g} from the separatrix" if distance else "the doubles nearest to the separatrix"
    return labels(case, "two energies are subtracted", pair, [s for s in states if s][:16],
                  lambda s: word(barrier_minus_energy(0.2, 0.4, s)))


def period_by_a_separatrix(distance):
    """1. The period, by the textbook's quadrature: the energies subtracted at every node."""
    a, b = 0.2, 0.4
    state = brink(scaled(a, b, (0, 0, 1))[1], (2.75, 1.125), -distance)
    ask = lambda a, b, *x: energy.period(model.scaled(a, b, (0, 0, 1)), x, digits=50)
    ours = float(stabilab.period(scaled(a, b, (0, 0, 1))[0], np.array(state)))
    return numbers(f"{distance:g} inside the separatrix", "period", "two energies are subtracted",
                   textbook_period(a, b, state), ours, ask, (a, b, *state))


def textbook_period(a, b, state):
    X, z, c = state[0] + a, state[1], b - a
    A, start = math.hypot(X, z), math.atan2(X, z)
    height = lambda t: -t - 0.5 * (A * np.sin(t)) ** 2 - c * A * np.sin(t)
    level = 0.5 * state[2] ** 2 + height(start)

    def turn(inside, outside):
        for _ in range(100):
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if height(middle) < level else (inside, middle)
        return inside
    grid = start + np.linspace(-6.25, 6.25, 800_001)
    walls = grid[height(grid) >= level]
    left, right = (turn(start, w) for w in (walls[walls < start].max(), walls[walls > start].min()))
    phi = (np.arange(4000) + 0.5) * np.pi / 4000  # the midpoint rule: periodic in phi
    theta = 0.5 * (left + right) - 0.5 * (right - left) * np.cos(phi)
    with np.errstate(invalid="ignore"):
        return (2 * np.nansum(np.pi / 4000 * 0.5 * (right - left) * np.sin(phi)
                              / np.sqrt(2 * (level - height(theta)))))


def margin_by_a_separatrix(distance):
    """1. The margin itself."""
    state = brink(scaled(0.2, 0.4, (0, 0, 1))[1], (-3.0, 1.0), distance)
    return margin_row(f"{distance:g} inside the separatrix", "two energies are subtracted", 0.2, 0.4, state)


def on_a_large_circle(radius):
    """2. The doubles nearest to the separatrix: their margin is less than the rounding of the energies, A^2.
    """
    pair = scaled(0.25, 0.75, (0, 0, 1))
    angles = np.random.default_rng(2).uniform(0, 2 * math.pi, 22).tolist()
    states = [brink(pair[1], (radius * math.sin(t) - 0.25, radius * math.cos(t)), 0.0) for t in angles]
    return labels(f"circle of radius A = {radius:g}", "U of order A^2 hides a tilt of order 1", pair,
                  [s for s in states if s][:16], lambda s: word(barrier_minus_energy(0.25, 0.75, s)))


def margin_on_a_large_circle(radius):
    """2. The margin of a state a tilt's worth below the barrier."""
    start = (radius * math.sin(1.9) - 0.25, radius * math.cos(1.9))
    state = brink(scaled(0.25, 0.75, (0, 0, 1))[1], start, -radius ** -2)
    return margin_row(f"circle of radius A = {radius:g}", "U of order A^2 hides a tilt of order 1", 0.25,
                      0.75, state)


def well_before_its_fold(share):
    """3. a = b = 0: the centre h = 1 - share on a circle just larger than the fold's; its well is share^3
    deep."""
    h = 1 - share
    state = (-1 / h, h, share ** 1.5)
    return margin_row(f"well {share:g} before its fold",
                      "a quartic with a nearly double root; two energies subtracted",
                      0.0, 0.0, state)


def huge_gyrostat(size):
    """4. a = -size, b = -2 size: the energies are of order size^2."""
    a, b = -size, -2 * size
    return margin_row(f"gyrostat {size:g} times what the torque holds",
                      "U of order c A hides a tilt of order 1", a, b,
                      (size + 0.5, 2.0, 0.25))


def far_from_the_origin(base):
    """11. a, b of order 1e8 with c = 3/4."""
    state = (-base - 1.5, 2.0, 0.25)
    return margin_row(f"a, b = {base:g}, b - a = 0.75", "squares of a multiplied out", base, base + 0.75,
                      state, naive=expanded)


def circle_of_no_radius(radius):
    """11. The angle on the circle is asin(X/A)."""
    state, (scene, problem) = (0.0, radius, 0.5), scaled(0.0, 0.5, (0, 0, 1))
    A = math.sqrt(state[0] ** 2 + state[1] ** 2)
    try:
        said = "spin-up" if math.isfinite(math.asin(state[0] / A)) else "no answer"
    except ZeroDivisionError:
        said = "no answer: 0/0"
    ours = stabilab.fate(scene, np.array(state))
    return Verdict(f"circle of radius A = {radius:g}", "outcome", "A^2 is 0 and the angle undefined", said,
                   stabilab.Fate(int(ours.labels)).word, energy.label(problem, state, digits=800))


def minute_orbit(amplitude):
    """11. Largest x3 of an orbit about the centre (-2, 1/2), a = b = 0, started one unit in the last place
    beside it."""
    state = (-2.0, 0.5 + 2.0 ** -52, amplitude)
    ask = lambda *x: energy.extremes(model.scaled(0, 0, (0, 0, 1)), x, digits=120)[2][1]
    ours = float(stabilab.extremes(scaled(0.0, 0.0, (0, 0, 1))[0], np.array(state))[2, 1])
    height = lambda X, z: -math.atan2(X, z) - X * X / 2
    deep = amplitude ** 2 / 2 + height(state[0], state[1]) - height(-2.0, 0.5)
    naive = math.sqrt(2 * deep) if deep >= 0 else math.nan
    return numbers(f"orbit of amplitude {amplitude:g} about a centre", "largest x3",
                   "E - U(centre) is below the rounding of either", naive, ours, ask, state)
