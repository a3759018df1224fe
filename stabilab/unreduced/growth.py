"""Endless growth: a torque along a principal axis that carries a gyrostatic component along it, too.

Law (any lambda): (|H|^2/2 - D_i T)' = H.M - D_i omega.M = lambda_i M_i, because D omega . M = D_i omega . M for M on axis
i. With lambda_i M_i != 0 a quadratic function of the state grows in proportion to time: no equilibrium, no bounded motion.
What remains to be decided is about which axis the body spins up.

Standard form (torque on the major or minor axis i, no gyrostatic component across it; `standard_form`):

    u' = y2 y3 + 1,   y2' = -y3 (u - c/2),   y3' = y2 (u + c/2),      J = y2^2 + y3^2 - 2 c u,   J' = -2c.

With phi = atan2(y3, y2), R^2 = y2^2 + y3^2:  P = phi' = u + (c/2) cos 2phi,  (R^2)' = c R^2 sin 2phi, and, R^2 put in by J,

    P' = -dV/dphi,   V(phi, J) = -phi - (J/2) sin^2 phi + (c^2/8) sin^2 2phi,   E = P^2/2 + V,   E' = c sin^2 phi.

y2 = y3 = 0 stays so: u = u0 + tau, spin-up. c > 0: 2cu = R^2 - J >= -J0 + 2c tau, so u -> +infinity: every motion spins up
about axis i; only its release from a temporary capture is left to observe.

Certificate "spin-up" (any c). K = E + phi = P^2/2 - (J/2) sin^2 phi + (c^2/8) sin^2 2phi has K' = P + c sin^2 phi, and
P^2/2 >= L := K + min(J, 0)/2 - c^2/8. If P > 0 and L > c^2/2, then P > |c|, so K' > 0, and (K + J/2)' = P - c cos^2 phi > 0:
L grows, P stays above |c|, for ever. L' >= sqrt(2L) - |c| > 0 gives sqrt(2L) ~ tau, P ~ tau; R then converges (integrate
(ln R^2)' = c sin 2phi by parts in phi), and u = (R^2 - J)/(2c) ~ tau.
For c > 0 also J < -c^2 suffices: P = 0 needs J = R^2 + c^2 cos 2phi >= -c^2, and J falls.

Certificate "well" (c < 0). Fix phi_b in [pi/2, pi]; p = phi mod pi inside (pi - phi_b, phi_b), E < V(phi_b, J) at p's branch.
While p stays inside, (V(phi_b, J) - E)' = |c| (sin^2 phi - sin^2 phi_b) >= 0, so phi_b is never reached; nor is pi - phi_b, where
V is higher by 2 phi_b - pi. So p stays inside for ever, y3 keeps its sign, J -> infinity, R^2 = J + 2cP - c^2 cos 2phi ~ J. With
e = (P^2/2 + (J/2) cos^2 phi - phi + (c^2/8) sin^2 2phi)/J: e' <= |c| (2 pi - P^2)/J^2, so P^2/J^2 is integrable although J ~ tau:
the oscillation about phi = pi/2 dies out in angle, y3 ~ +-sqrt(2|c| tau). (phi_b = pi is the weaker certificate with pi - p.)

Both certificates are monotone: once one holds it holds for ever, so it may be looked for at any later time. For c < 0 the end of the
run that led there decides, and its rounding could carry a motion over the boundary between the two; so six neighbours, as
far away as that rounding could at most have moved it, must end alike, else the answer is "undecided".
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from ..errors import InputError
from .growth_form import growth_law, standard_form
from ..orbit.result import Fate

# A certificate counts when its inequality holds by this share of the terms in it: 100 times their rounding.
CLEARANCE = 2e-14
# Units of rounding by which a step of the run (a Taylor polynomial of 20 terms) may move the motion: generous, for the boundary is met seldom.
STEP_ROUNDINGS = 64
# Steps of the search: several seconds where the fate hangs on it, one or two where only the time of release does.
STEP_BUDGET, RELEASE_BUDGET = 5_000_000, 2_000_000
# Steps after which the finite end of a spin-up is given over the span run, unproved beyond it.
EXTREMES_BUDGET = 300_000
# How long to look where the caller names no time, in the motion's own unit 1/sqrt(g |m|).
PATIENCE = 1e6


@dataclass(frozen=True)
class CapturedFate:
    """What becomes of a motion that no bound holds.

    axis, sense: 1, 2, 3 and +-1 of the spin-up (0 where unclear). J0, J_rate: the law J = J0 + J_rate t at the state, in
    the scene's variables (|H|^2/2 - D_i T; x2^2 + x3^2 - 2(b-a) x1 when scaled). release_time: last reversal of the
    turn about axis i, after which it spins up for ever (0: there is none; None: captured for ever, or not run to it);
    release_estimate: about when the barrier will have vanished at the latest (None where no capture was
    seen or it lasts for ever). certificate: "bound", "spin-up",
    "well", "axis", "law", "evidence" or "none"; t_certificate: time at which it was found to hold; times in the scene's unit.
    """

    fate: Fate
    axis: int
    sense: int
    because: str
    release_time: float | None
    release_estimate: float | None
    J0: float
    J_rate: float
    certificate: str
    t_certificate: float | None
    steps: int


def spin_up_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "spin-up" at y = (u, y2, y3): it holds where margin > 0."""
    phi, P, J = _angle(c, y)
    bend, depth, tail = P * P / 2, J / 2 * math.sin(phi)**2, c * c / 8 * math.sin(2 * phi)**2
    size = bend + abs(depth) + abs(J) + c * c
    return (bend - depth + tail + min(J, 0.0) / 2 - 0.625 * c * c if P > 0 else -size), size


def well_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "well" (c < 0) at y, for the best barrier angle found."""
    phi, P, J = _angle(c, y)
    p = phi % math.pi

    def rise(b):  # V(b) - V(p), differences formed term by term
        return (p - b) - J / 2 * math.sin(b - p) * math.sin(b + p) + c * c / 8 * math.sin(2 * (b - p)) * math.sin(2 * (b + p))
    barrier = _highest(rise, max(p, math.pi - p), J, c)
    return rise(barrier) - P * P / 2, P * P / 2 + abs(J) / 2 + c * c / 8 + math.pi


def _angle(c, y):
    u, y2, y3 = y
    phi = math.atan2(y3, y2)
    return phi, u + c / 2 * math.cos(2 * phi), y2 * y2 + y3 * y3 - 2 * c * u


def _highest(rise, low, J, c):
    """An angle in [low, pi] where V is about highest (any angle makes a valid certificate)."""
    places = [low + (math.pi - low) * n / 48 for n in range(49)] + [math.pi - (math.pi - low) * 4.0**-n for n in range(1, 24)]
    b = max(places, key=rise)
    for _ in range(6):  # Newton on V' = -1 - (J/2) sin 2b + (c^2/4) sin 4b, kept only where it climbs
        slope, bend = -1 - J / 2 * math.sin(2 * b) + c * c / 4 * math.sin(4 * b), -J * math.cos(2 * b) + c * c * math.cos(4 * b)
        if bend >= 0:
            break
        step = min(max(b - slope / bend, low), math.pi)
        if rise(step) <= rise(b):
            break
        b = step
    return b


def captured_fate(scene, state, t_max: float | None = None) -> CapturedFate:
    """Which axis the motion from `state` (three numbers, the scene's variables) spins up about, and when it is released.

    t_max: how long to look for a certificate, in the scene's time (None: a million of the motion's own units). Raises InputError for a scene whose torque is not along
    one principal axis with a gyrostatic component along it.
    """
    from ..integrate.trajectory import _state
    state = tuple(_state(state).tolist())
    try:
        law = growth_law(scene)
        start = None if law is None else law[1](state)
    except OverflowError:
        raise InputError("state: the squares of rates this large, or of moments, are beyond the largest double: choose other units") from None
    if law is None:
        raise InputError("capture needs a torque along one principal axis and a gyrostatic component along that axis; "
                         "this scene is for the reduction or for the torque off the axes")
    axis, _, rate = law
    change = standard_form(scene)
    answer = _by_certificate(change, change.to_standard(state), t_max) if change else _without_form(scene, state, axis, t_max)
    return CapturedFate(J0=start, J_rate=rate, **answer)


def _by_certificate(change, y, t_max):
    """Fields of CapturedFate from the standard form."""
    c, (i, _, q), unit = change.c, change.axes, change.time
    spin = dict(fate=Fate.SPIN_UP, axis=i + 1, sense=1 if change.rates[0] > 0 else -1)
    if y[1] == y[2] == 0:
        return spin | dict(because=f"pure spin about axis {i + 1}, which the torque speeds up for ever", release_time=0.0,
                           release_estimate=None, certificate="axis", t_certificate=0.0, steps=0)
    vanishing = _release_estimate(c, _angle(c, y)[2]) * unit if c > 0 else None
    t_max = PATIENCE * unit if t_max is None else t_max
    name, t, end, last, steps = _search(c, y, t_max / unit)
    if c < 0 and steps and name != "none" and (reach := _nearest_other(c, y, t_max / unit, name, steps)):
        return dict(fate=Fate.UNDECIDED, axis=0, sense=0, release_time=None, release_estimate=None, certificate="none", t_certificate=None,
                    steps=steps, because=f"unbounded, but between spin-up about axis {i + 1} and capture about axis {q + 1}: a change of the "
                                         f"state by {reach:.0e} of its size, as rounding of the run may make, turns the one into the other")
    estimate = None if name == "spin-up" and not last else vanishing
    when = None if t is None else t * unit
    known = dict(release_estimate=estimate, certificate=name, t_certificate=when, steps=steps)
    if name == "well":
        sense = (1 if change.rates[2] > 0 else -1) * (1 if end[2] > 0 else -1)
        return known | dict(fate=Fate.SPIN_UP, axis=q + 1, sense=sense, release_time=None, because=(
            f"captured about axis {q + 1} for ever: the barrier ahead grows faster than the energy, and the spin about axis "
            f"{q + 1} grows like the square root of time"))
    if name == "spin-up":
        return spin | known | dict(release_time=last * unit, because=(
            f"spin-up about axis {i + 1}: the turn about it can reverse no more (proved from t = {when:.6g} on)"))
    if c > 0:
        return spin | known | dict(certificate="bound", t_certificate=0.0, release_time=None, because=(
            f"spin-up about axis {i + 1}: its rate is bounded below by a growing line; still captured when the search ended, "
            f"release expected at about t = {estimate:.6g}"))
    return known | dict(fate=Fate.UNDECIDED, axis=0, sense=0, release_time=None, because=(
        f"unbounded, but neither spin-up about axis {i + 1} nor capture about axis {q + 1} was certain after {steps} steps "
        f"(the search ends at t = {t_max:g})"))


def _release_estimate(c, J):
    """When a temporary capture (c > 0) is over. Small c: P' > 0 everywhere once J < 2 (about). Any c: P = 0 needs
    J = R^2 + c^2 cos 2phi >= -c^2."""
    return max(0.0, (J - 2 if c * c < 2 else J + c * c) / (2 * c))


def certificate(c, y) -> str | None:
    """"spin-up" or "well" where the one or the other holds at y beyond rounding, None otherwise."""
    margin, size = spin_up_margin(c, y)
    if margin > CLEARANCE * size or (c > 0 and _angle(c, y)[2] + c * c < -CLEARANCE * size):
        return "spin-up"
    if c < 0:
        margin, size = well_margin(c, y)
        if margin > CLEARANCE * size:
            return "well"
    return None


def _search(c, y, t_max):
    """(certificate or "none", its time, state there, last reversal of the turn, steps): run until one holds."""
    if found := certificate(c, y):
        return found, 0.0, y, 0.0, 0
    if not math.isfinite(sum(v * v for v in y) * (1 + c * c)):
        return "none", None, y, 0.0, 0
    run, t, last, steps = _runner(c, y), 0.0, 0.0, 0
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


def _nearest_other(c, y, t_max, name, steps):
    """The relative change of the state within the run's rounding that leads to another end; None where there is none."""
    reach = STEP_ROUNDINGS * 2.0**-52 * (steps + 1)
    length = reach * (max(map(abs, y)) + abs(c))
    for i in range(3):
        for move in (-length, length):
            if _search(c, (*y[:i], y[i] + move, *y[i + 1:]), t_max)[0] != name:
                return reach
    return None


def _runner(c, y):
    """run(t, step limit) -> (time reached, state, last reversal of the turn on the way or None, steps)."""
    from ..physics.to_numpy import form, heyoka_available
    from ..physics.equations import derive
    from ..physics.scene import ScaledGyrostat
    equations = derive(ScaledGyrostat(Fraction(c) / -2, Fraction(c) / 2, (1, 0, 0)))
    _, x2, x3 = equations.state
    turn = x2 * equations.rhs[2] - x3 * equations.rhs[1]  # R^2 phi'
    maker = _taylor_runner if heyoka_available() else _scipy_runner
    return maker(equations, form(equations, (*equations.rhs, turn)), y)


def _taylor_runner(equations, forms, y):
    from ..physics.to_numpy import taylor_events
    at = [0.0, y]

    def run(t, limit):
        with taylor_events(forms) as (integrator, found):
            integrator.time = at[0]
            integrator.state[:] = at[1]
            steps = integrator.propagate_until(t, max_steps=limit)[3]
            at[:] = integrator.time, tuple(integrator.state.tolist())
            reversals = [time for time, *_ in found]
        return at[0], at[1], max(reversals, default=None), steps
    return run


def _scipy_runner(equations, forms, y):
    import numpy as np
    from scipy.integrate import DOP853
    from scipy.optimize import brentq
    from ..physics.to_numpy import to_numpy
    from ..integrate.trajectory import ATOL_SHARE, FALLBACK_RTOL
    system, at = to_numpy(equations), [0.0, np.array(y)]

    def turn(x):
        rate = system.rate(list(x))
        return x[1] * rate[2] - x[2] * rate[1]

    def run(t, limit):
        solver = DOP853(lambda _, x: np.array(system.rate(x.tolist())), at[0], at[1], t, rtol=FALLBACK_RTOL,
                        atol=FALLBACK_RTOL * ATOL_SHARE)
        steps, last = 0, None
        while solver.status == "running" and steps < limit:
            solver.step()
            steps += 1
            dense, times = solver.dense_output(), np.linspace(solver.t_old, solver.t, 9)
            values = np.array([turn(x) for x in dense(times).T])
            for n in np.nonzero(values[:-1] * values[1:] < 0)[0]:
                last = brentq(lambda s: turn(dense(s)), times[n], times[n + 1])
        at[:] = solver.t, solver.y
        return solver.t, tuple(solver.y.tolist()), last, steps
    return run


def _without_form(scene, state, axis, t_max):
    """Fields of CapturedFate where the standard form does not exist: exact spin of a symmetric body, else evidence."""
    form = scene.quadratic()
    sense = 1 if form.m[axis] > 0 else -1
    if not (form.kappa[axis] or form.rho[axis] or form.sigma[axis]):
        return dict(fate=Fate.SPIN_UP, axis=axis + 1, sense=sense, release_time=0.0, release_estimate=None, certificate="law",
                    t_certificate=0.0, steps=0, because=f"the moments across axis {axis + 1} are equal: its spin grows exactly "
                                                        "in proportion to time")
    if not any(form.kappa):
        return dict(fate=Fate.SPIN_UP, axis=0, sense=0, release_time=0.0, release_estimate=None, certificate="law", t_certificate=0.0,
                    steps=0, because="three equal moments: the spin along lambda, which is on no axis, grows exactly in "
                                     "proportion to time, the rest of the motion is bounded")
    from .off_axis import growth
    t_max = PATIENCE / math.sqrt(abs(form.m[axis])) if t_max is None else t_max
    seen = growth(scene, state, t_max)
    clear = seen.axis > 0
    words = (f"spin-up about axis {seen.axis} by the evidence of a run to t = {seen.span:.6g} ({seen.words})" if clear else
             f"no axis of spin-up was clear in a run to t = {seen.span:.6g}")
    return dict(fate=Fate.SPIN_UP if clear else Fate.UNDECIDED, axis=seen.axis, sense=seen.sense, release_time=None,
                release_estimate=None, certificate="evidence" if clear else "none", t_certificate=None, steps=seen.steps,
                because=f"unbounded, because |H|^2/2 - D{axis + 1} T grows in proportion to time; {words}")


def captured_extremes(scene, state, answer: CapturedFate | None = None):
    """((3, 2) array of extremes over t >= 0, words saying over what they are known).

    Growing components have +-inf at their growing end; in a capture "well" the two other components swing ever wider, like
    t^(1/4) (their action is an adiabatic invariant), and have both. The finite end of a certified spin-up holds for all
    time, P >= sqrt(2L) keeping it from falling lower; every other finite entry is over the span named.
    """
    import numpy as np
    from ..integrate.extrema import roots_of_rates
    answer = answer or captured_fate(scene, state)
    change = standard_form(scene)
    unit = change.time if change else 1 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = max(1.5 * (answer.t_certificate or 0.0), 20 * unit)
    roots = roots_of_rates(scene, state, span)
    certain = answer.certificate in ("spin-up", "axis")
    while answer.certificate == "spin-up" and certain and not _floor_holds(change, roots):
        span *= 1.5
        certain = not roots.reason and roots.steps < EXTREMES_BUDGET
        roots = roots_of_rates(scene, state, span) if certain else roots
    extremes = roots.extremes()
    if answer.certificate == "well":
        others = [i for i in range(3) if i != answer.axis - 1]
        extremes[others] = -np.inf, np.inf
    if answer.axis:
        extremes[answer.axis - 1, 1 if answer.sense > 0 else 0] = answer.sense * np.inf
    where = f"{scene.time_unit} in [0, {roots.t_reached:g}]"
    if answer.certificate == "axis":
        return extremes, "all time"
    return extremes, f"axis {answer.axis} for all time, the others over {where}" if certain else f"finite entries over {where}"


def _floor_holds(change, roots):
    """Whether u can fall no lower after the run than it did in it: u >= sqrt(2L) - |c|/2, L growing (module docstring)."""
    c, i = change.c, change.axes[0]
    margin, _ = spin_up_margin(c, change.to_standard(roots.end.tolist()))
    u = [change.to_standard(x.tolist())[0] for x in (roots.start, roots.end, *roots.states[roots.component == i])]
    return margin > 0 and math.sqrt(2 * (margin + c * c / 2)) - abs(c) / 2 >= min(u)
