"""Torque along a principal axis and a gyrostatic component along it: the law of growth, the standard form

    u' = y2 y3 + 1,   y2' = -y3 (u - c/2),   y3' = y2 (u + c/2)

of the extreme (major or minor) axis, one number c, certificates of endless growth, and a run that looks for
one. Once true, a certificate stays true (`law`). Differences of moments and offsets are exact before
rounding.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ...integrate import to_heyoka
from ...integrate.trajectory import ATOL_SHARE, FALLBACK_RTOL, stand_in
from ...numbers.vectors import CYCLE, Float3
from ...physics.equations import derive
from ...physics.scene import ScaledGyrostat
from ...physics.to_numpy import form, to_numpy

# A certificate counts when its inequality holds by this share of the terms in it: 100 times their rounding.
CLEARANCE = 2e-14
# Units of rounding by which a step of the run (a Taylor polynomial of 20 terms) may move the motion:
# generous, for the boundary is met seldom.
STEP_ROUNDINGS = 64
# Steps of the search: several seconds where the fate hangs on it, one or two where only the time of release
# does.
STEP_BUDGET, RELEASE_BUDGET = 5_000_000, 2_000_000


@dataclass(frozen=True)
class StandardForm:
    """x[axes] = rates * (u - shift, y2, y3), t = time * tau; axes 0-based, first the torque's."""

    c: float
    axes: tuple[int, int, int]
    rates: Float3
    shift: Fraction
    time: float

    def to_standard(self, x):
        """State of the scene -> (u, y2, y3); the shift is added before rounding."""
        i, p, q = self.axes
        return (float(Fraction(float(x[i])) + self.shift) / self.rates[0], x[p] / self.rates[1],
                x[q] / self.rates[2])


def standard_form(scene) -> StandardForm | None:
    """The change to standard form, or None where there is none (torque on a middle axis, a gyrostatic
    component across it, equal moments).

    x_i' = kappa_i x_p x_q + m,  x_p' = kappa_p x_q (x_i + alpha),  x_q' = kappa_q x_p (x_i + beta): with
    kappa_i kappa_q > 0 >
    kappa_p kappa_q the rates r_i^2 = |m|/g, r_p^2 = g |m|/(kappa_i kappa_q), r_q^2 = g |m|/|kappa_i kappa_p|,
    g^2 = |kappa_p kappa_q|, and the time 1/sqrt(g |m|) bring it to standard form; r_i has the sign of m, r_q
    that of m kappa_i.
    """
    quadratic = scene.quadratic()
    i = _torque_axis(quadratic)
    if i is None or quadratic.rho[i] or quadratic.sigma[i]:
        return None
    j, k = CYCLE[i]
    if quadratic.sigma[k] or quadratic.rho[j]:
        return None
    if not quadratic.kappa[j] * quadratic.kappa[k] < 0 or not quadratic.kappa[i]:
        return None
    alpha = {j: quadratic.sigma[j] / quadratic.kappa[j], k: quadratic.rho[k] / quadratic.kappa[k]}
    p, q = (j, k) if quadratic.kappa[i] * quadratic.kappa[k] > 0 else (k, j)
    kappa, m = quadratic.kappa, abs(quadratic.m[i])
    if alpha[p] == alpha[q]:
        return None
    g = math.sqrt(abs(kappa[p] * kappa[q]))
    sign = 1 if quadratic.m[i] > 0 else -1
    r = math.sqrt(m / Fraction(g)) * sign
    rates = (r, math.sqrt(Fraction(g) * m / (kappa[i] * kappa[q])),
             math.sqrt(Fraction(g) * m / abs(kappa[i] * kappa[p])) * sign * (1 if kappa[i] > 0 else -1))
    return StandardForm(float((alpha[q] - alpha[p]) / Fraction(r)), (i, p, q), rates,
                        (alpha[p] + alpha[q]) / 2,
                        1 / math.sqrt(Fraction(g) * m))


def _torque_axis(quadratic):
    acting = [i for i in range(3) if quadratic.m[i]]
    return acting[0] if len(acting) == 1 else None


def growth_law(scene):
    """(axis 0-based, J(state), J_rate): the law of `growth` with its exact rate; None where it does not
    apply (torque not along one principal axis, or no gyrostatic component along it)."""
    if scene.variables == "scaled":
        (a, b), mu = scene.exact_ab, scene.exact_mu
        if not mu[0] or mu[1] or mu[2] or a == b:
            return None
        c = b - a
        return 0, lambda x: float(Fraction(x[1])**2 + Fraction(x[2])**2
                                  - 2 * c * Fraction(x[0])), float(-2 * c * mu[0])
    D, lam, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    i = next((n for n in range(3) if M[n]), None)
    if i is None or any(M[n] for n in range(3) if n != i) or not lam[i]:
        return None

    def J(x):
        x = [Fraction(v) for v in x]
        return float(sum((d * v + h)**2 - D[i] * d * v * v for d, v, h in zip(D, x, lam)) / 2)
    return i, J, float(lam[i] * M[i])


def spin_up_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "spin-up" at y = (u, y2, y3): it holds where margin > 0.
    """
    phi, P, J = angle_of(c, y)
    bend, depth, tail = P * P / 2, J / 2 * math.sin(phi)**2, c * c / 8 * math.sin(2 * phi)**2
    size = bend + abs(depth) + abs(J) + c * c
    return (bend - depth + tail + min(J, 0.0) / 2 - 0.625 * c * c if P > 0 else -size), size


def well_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "well" (c < 0) at y, for the best barrier angle found.
    """
    phi, P, J = angle_of(c, y)
    p = phi % math.pi

    def rise(b):  # V(b) - V(p), differences formed term by term
        return (p - b) - J / 2 * math.sin(b
                                          - p) * math.sin(b
                                                          + p) + c * c / 8 * math.sin(2 * (b - p)) * math.sin(
                                                              2 * (b + p))
    barrier = _highest(rise, max(p, math.pi - p), J, c)
    return rise(barrier) - P * P / 2, P * P / 2 + abs(J) / 2 + c * c / 8 + math.pi


def angle_of(c, y):
    u, y2, y3 = y
    phi = math.atan2(y3, y2)
    return phi, u + c / 2 * math.cos(2 * phi), y2 * y2 + y3 * y3 - 2 * c * u


def _highest(rise, low, J, c):
    """An angle in [low, pi] where V is about highest (any angle makes a valid certificate)."""
    places = ([low + (math.pi - low) * n / 48 for n in range(49)]
              + [math.pi - (math.pi - low) * 4.0**-n for n in range(1, 24)])
    b = max(places, key=rise)
    for _ in range(6):  # Newton on V' = -1 - (J/2) sin 2b + (c^2/4) sin 4b, kept only where it climbs
        slope, bend = -1 - J / 2 * math.sin(2
                                            * b) + c * c / 4 * math.sin(4 * b), -J * math.cos(
                                                2 * b) + c * c * math.cos(4 * b)
        if bend >= 0:
            break
        step = min(max(b - slope / bend, low), math.pi)
        if rise(step) <= rise(b):
            break
        b = step
    return b


def release_estimate(c, J):
    """When a temporary capture (c > 0) is over. Small c: P' > 0 everywhere once J < 2 (about). Any c: P = 0
    needs J = R^2 + c^2 cos 2phi >= -c^2."""
    return max(0.0, (J - 2 if c * c < 2 else J + c * c) / (2 * c))


def certificate(c, y) -> str | None:
    """"spin-up" or "well" where the one or the other holds at y beyond rounding, None otherwise."""
    margin, size = spin_up_margin(c, y)
    if margin > CLEARANCE * size or (c > 0 and angle_of(c, y)[2] + c * c < -CLEARANCE * size):
        return "spin-up"
    if c < 0:
        margin, size = well_margin(c, y)
        if margin > CLEARANCE * size:
            return "well"
    return None


def search_certificate(c, y, t_max):
    """(certificate or "none", its time, state there, last reversal of the turn, steps): run until one holds.
    """
    if found := certificate(c, y):
        return found, 0.0, y, 0.0, 0
    if not math.isfinite(sum(v * v for v in y) * (1 + c * c)):
        return "none", None, y, 0.0, 0
    run, t, last, steps = runner(c, y), 0.0, 0.0, 0
    budget = STEP_BUDGET if c < 0 else RELEASE_BUDGET
    while t < t_max and steps < budget:
        t = min(t_max, t + max(1.0 / (1 + abs(c) + max(map(abs, y))), 0.2 * t))
        t, y, reversal, taken = run(t, budget - steps)
        last, steps = reversal if reversal is not None else last, steps + taken
        if not all(map(math.isfinite, y)):
            break
        if found := certificate(c, y):
            return found, t, y, last, steps
    return "none", None, y, last, steps


def nearest_other(c, y, t_max, name, steps):
    """The relative change of the state within the run's rounding that leads to another end; None where there
    is none."""
    reach = STEP_ROUNDINGS * 2.0**-52 * (steps + 1)
    length = reach * (max(map(abs, y)) + abs(c))
    for i in range(3):
        for move in (-length, length):
            if search_certificate(c, (*y[:i], y[i] + move, *y[i + 1:]), t_max)[0] != name:
                return reach
    return None


def runner(c, y):
    """run(t, step limit) -> (time reached, state, last reversal of the turn on the way or None, steps)."""
    equations = derive(ScaledGyrostat(Fraction(c) / -2, Fraction(c) / 2, (1, 0, 0)))
    _, x2, x3 = equations.state
    turn = x2 * equations.rhs[2] - x3 * equations.rhs[1]  # R^2 phi'
    maker = _taylor_runner if to_heyoka.heyoka_available() else _scipy_runner
    return maker(equations, form(equations, (*equations.rhs, turn)), y)


def _taylor_runner(equations, forms, y):
    at = [0.0, y]

    def run(t, limit):
        with to_heyoka.taylor_events(forms) as (integrator, found):
            integrator.time = at[0]
            integrator.state[:] = at[1]
            steps = integrator.propagate_until(t, max_steps=limit)[3]
            at[:] = integrator.time, tuple(integrator.state.tolist())
            reversals = [time for time, *_ in found]
        return at[0], at[1], max(reversals, default=None), steps
    return run


def _scipy_runner(equations, forms, y):
    from scipy.optimize import brentq
    system, at = to_numpy(equations), [0.0, np.array(y)]

    def turn(x):
        rate = system.rate(list(x))
        return x[1] * rate[2] - x[2] * rate[1]

    def run(t, limit):
        solver = stand_in(system.rate, at[1], t, at[0], atol=FALLBACK_RTOL * ATOL_SHARE)
        steps, last = 0, None
        while solver.status == "running" and steps < limit:
            solver.step()
            steps += 1
            dense, times = solver.dense_output(), np.linspace(solver.t_old, solver.t, 9)
            values = np.array([turn(x) for x in dense(times).T])
            for n in np.nonzero(values[:-1] * values[1:] < 0)[0]:
                last = brentq(lambda s, dense=dense: turn(dense(s)), times[n], times[n + 1])
        at[:] = solver.t, solver.y
        return solver.t, tuple(solver.y.tolist()), last, steps
    return run
