"""Bodies under a torque along an axis: torques tiny and huge, nearly and exactly equal moments, two lines
(groups 4, 6, 7)."""
from __future__ import annotations

import math

import numpy as np

import stabilab
from tests.hard.row import Verdict, labels, numbers
from tests.oracles import energy, model
from tests.oracles.pairs import PAPER_BODY, physical

CYCLE = ((1, 2), (2, 0), (0, 1))


class Textbook:
    """The reduced motion as the derivation writes it, in doubles: the perpendicular pair about the centre of
    its circle, w_j = -s_j + (w_j0 + s_j) cos ka + ..., and U = (D_j w_j^2 + D_k w_k^2)/2 - M a. Divides by
    D_i - D_j and D_i - D_k."""

    def __init__(self, inertia, momentum, torque, state):
        self.D, self.i = inertia, next(i for i in range(3) if torque[i])
        i, (j, k) = self.i, CYCLE[self.i]
        D = inertia
        self.j, self.k, self.M, self.w = j, k, torque[i], state[i]
        self.p, self.q = (D[k] - D[i]) / D[j], (D[i] - D[j]) / D[k]
        self.sj, self.sk = momentum[j] / (D[j] - D[i]), momentum[k] / (D[k] - D[i])
        self.rate = math.sqrt(-self.p * self.q)
        self.u, self.v = state[j] + self.sj, state[k] + self.sk

    def pair(self, angle):
        c, s = np.cos(self.rate * angle), np.sin(self.rate * angle) / self.rate
        return self.u * c + self.p * self.v * s - self.sj, self.v * c + self.q * self.u * s - self.sk

    def potential(self, angle):
        wj, wk = self.pair(angle)
        return 0.5 * (self.D[self.j] * wj ** 2 + self.D[self.k] * wk ** 2) - self.M * angle

    def fastest(self, reach):
        """Largest rate about the axis of the torque along a grid of `reach` radians either side, the energies
        subtracted."""
        grid = np.linspace(-reach, reach, 200_001)
        speed2 = self.w ** 2 + 2 * (self.potential(0.0) - self.potential(grid)) / self.D[self.i]
        stops = np.flatnonzero(speed2 < 0)
        lo, hi = stops[stops < 100_000].max(initial=0), stops[stops > 100_000].min(initial=200_000)
        n = lo + int(np.argmax(speed2[lo:hi]))
        # the top of a parabola: the grid costs no digits that rounding leaves
        y0, y1, y2 = speed2[n - 1:n + 2]
        return math.sqrt(y1 + (y0 - y2) ** 2 / (8 * (2 * y1 - y0 - y2)))


def fastest_row(case, wrong, inertia, momentum, torque, state):
    """Fastest rate about axis 1 of a swinging body, torque along axis 1, gyrostatic moment (0, *momentum)."""
    ask = lambda D1, D2, D3, l2, l3, M, *x: energy.extremes(
        model.physical((D1, D2, D3), (0, l2, l3), (M, 0, 0)), x, digits=100)[0][1]
    moments = (0.0, *momentum), (torque, 0.0, 0.0)
    ours = float(stabilab.extremes(physical(inertia, *moments)[0], np.array(state))[0, 1])
    naive = Textbook(inertia, *moments, state).fastest(3.0)
    return numbers(case, "largest rate", wrong, naive, ours, ask, (*inertia, *momentum, torque, *state))


def nearly_symmetric(lift):
    """6. D1 = (1 + lift) D2: circles of radius 1/lift."""
    return fastest_row(f"D1 = (1 + {lift:g}) D2", "circles about a centre at lambda/(D1 - D2)",
                       (1000.0 * (1 + lift), 1000.0, 700.0), (200.0, 300.0), 50.0, (0.05, -0.2, 0.3))


def rod(thin):
    """6. A rod whose two large moments differ by half of the small one."""
    return fastest_row(f"rod, D3 = {thin:g} D1", "circles about a centre at lambda/(D1 - D2)",
                       (1.0, 1.0 - thin / 2, thin), (0.2, 0.3), 0.05, (0.05, -0.2, 0.3))


def symmetric(body):
    """6. Exactly equal moments: the centre of the circles is at infinity."""
    inertia, state = {"D1 = D2": (1000.0, 1000.0, 700.0), "sphere": (3.0, 3.0, 3.0)}[body], (0.05, -0.2, 0.3)
    scale = inertia[0] / 1000
    momentum, torque = (0.0, 200.0 * scale, 300.0 * scale), (50.0 * scale, 0.0, 0.0)
    scene, problem = physical(inertia, momentum, torque)
    try:
        said = str(Textbook(inertia, momentum, torque, state).fastest(3.0))
    except ZeroDivisionError:
        said = "no answer: 1/0"
    ours = stabilab.Fate(int(stabilab.fate(scene, np.array(state)).labels)).word
    return Verdict(body, "outcome", "division by D1 - D2", said, ours, energy.label(problem, state))


def tiny_torque(size):
    """4. A fixed tolerance takes the torque for none; free motions are bounded."""
    momentum, torque = (0.4, -0.7, 0.0), (0.0, 0.0, size)
    pair = physical((3.0, 2.0, 1.5), momentum, torque)
    states = [tuple(s) for s in (np.random.default_rng(4).normal(size=(16, 3)) * (1, 1, 4)).tolist()]
    return labels(f"torque {size:g} against a gyrostat of order 1", "`abs(M) < 1e-9` counts as no torque",
                  pair, states,
                  lambda s: "bounded" if abs(size) < 1e-9 else "undecided")


def slow_rates(size):
    """4. Rates of order `size`: a fixed tolerance takes every state for an equilibrium."""
    pair = physical((3.0, 2.0, 1.5), (0.4 * size, -0.7 * size, 0.0), (0.0, 0.0, 0.5 * size * size))
    states = [tuple(s) for s in (np.random.default_rng(5).normal(size=(16, 3)) * size).tolist()]
    return labels(f"rates of order {size:g}", "`abs(rates) < 1e-9` counts as rest", pair, states,
                  lambda s: "equilibrium" if max(abs(v) for v in pair[1].rate(s)) < 1e-9 else "undecided")


def a_near_b(gap):
    """4. x3 of the isolated equilibrium with (x1 + a)(x1 + b) = mu2 mu3/mu1 = 1e-20, b - a = gap: x3 =
    mu2/(x1 + a)."""
    a, b, mu = 1.0, 1.0 + gap, (1.0, 1e-10, 1e-10)
    x1 = -(a + b) / 2 + math.sqrt(((b - a) / 2) ** 2 + mu[1] * mu[2] / mu[0])
    naive = mu[1] / (x1 + a) if x1 + a else math.inf
    points = stabilab.equilibria(stabilab.ScaledGyrostat(a, b, mu)).points
    ours = max((p.at for p in points), key=lambda at: at[2])[2]  # the root with x1 + a > 0

    def ask(a, b, m1, m2, m3):
        import mpmath as mp
        with mp.workdps(60):
            half, product = energy.num((b - a) / 2), energy.num(m2 * m3 / m1)
            return energy.num(m2) / (mp.sqrt(half ** 2 + product) - half)
    return numbers(f"b - a = {gap:g}", "an equilibrium's x3", "x1 + a from x1, the root of a quadratic",
                   naive, ours, ask,
                   (a, b, *mu))


def far_along_the_hyperbola(h):
    """7. a = 0, b = 1/4, minor axis, x2 = h, x1 = -b - 1/h: a centre with x1 (x1 + b) - x2^2 = m > 0, at a
    distance 1/h."""
    state = (-0.25 - 1 / h, h, 0.0)
    J = np.array([[0, state[2], state[1]], [-state[2], 0, -state[0]], [state[1], state[0] + 0.25, 0.0]])
    # body axes are not the principal ones
    turn = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))[0]
    naive = "stable" if np.linalg.eigvals(turn @ J @ turn.T).real.max() < 1e-9 else "unstable"
    segment, = (s for c in stabilab.equilibria(stabilab.ScaledGyrostat(0.0, 0.25, (0, 0, 1))).curves
                for s in c.segments
                for t in [on_curve(c, state)] if t is not None and s.t[0] < t < s.t[1])
    problem = model.scaled(0, 0.25, (0, 0, 1))
    centre = kind_of(problem, state)
    return Verdict(f"equilibrium at a distance of {1 / h:.1g}", "stability",
                   "`max Re < 1e-9` of computed eigenvalues", naive,
                   segment.verdict, "stable" if centre == "centre" else "unstable")


def on_curve(curve, state):
    """The parameter of a curve x2 = t or x1 = t of equilibria at which it passes the state; None if it does
    not."""
    for t in (state[0], state[1], -state[0], -state[1]):
        try:
            if np.allclose(curve.point(t), state, rtol=1e-12, atol=0):
                return t
        except (ZeroDivisionError, OverflowError):
            continue
    return None


def kind_of(problem, state):
    """Saddle or centre: the stationary angle nearest to the start on the state's own circle, in 100 digits.
    """
    motion = energy.Reduced(problem, state, 100)
    return min(motion.stationary(), key=lambda m: abs(m[0]))[1]


def two_lines(axis):
    """7. M = -lambda_j lambda_k/(D_j - D_k): the conic is two lines; the formula w_k(w_j) holds one of them.
    """
    D, (j, k), momentum, moment = PAPER_BODY, CYCLE[axis], [0.0] * 3, [0.0] * 3
    gap = D[j] - D[k]
    momentum[j], momentum[k] = 0.25 * abs(gap), 62.5  # binary fractions throughout
    moment[axis] = torque = -momentum[j] * momentum[k] / gap
    corner = -momentum[j] / gap  # the second line: w_j here, any w_k
    state = [0.0] * 3
    state[j], state[k] = corner, 0.75
    with np.errstate(all="ignore"):
        graph = np.float64(momentum[k] * corner - torque) / np.float64(gap * corner + momentum[j])
    naive = "an equilibrium" if abs(graph - 0.75) < 1e-9 else "none"
    scene, problem = physical(D, momentum, moment)
    ours = stabilab.Fate(int(stabilab.fate(scene, np.array(state)).labels)).word
    exact = "equilibrium" if problem.rate([energy.Fraction(v) for v in state]) == [0, 0, 0] else "none"
    return Verdict(f"equilibrium conic of two lines, torque on axis {axis + 1}",
                   "is a state on the second line at rest?",
                   "w_k as a function of w_j: 0/0 on that line", naive, ours, exact)
