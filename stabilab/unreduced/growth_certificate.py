"""Endless growth of a free body's motion certified, and its extremes.

Torque along a principal axis and a gyrostatic component along it: the law of growth, the standard form

    u' = y2 y3 + 1,   y2' = -y3 (u - c/2),   y3' = y2 (u + c/2)

of the extreme (major or minor) axis, one number c, certificates of endless growth, and a run that looks for
one. Once true, a certificate stays true (`growth`). Differences of moments and offsets are exact before
rounding.

The extremes of a motion that grows for ever by an exact law:

Pure spin about the torque's axis: the two other components stay 0. Equal moments across it, and no gyrostatic
component: the spin grows in proportion to time, and the two others turn round their circle faster and faster.
Three equal moments: D omega' = lambda x omega + M, so with n along lambda, Omega = |lambda|/D and c = lambda
x M/|lambda|^2 (lambda x c cancels what of M stands across lambda)

    omega = n (s + g t) + c + r(t),   s = n . omega(0),   g = n . M/D,   r(t) = r0 cos(Omega t) + n x r0
    sin(Omega t).

These hold for all time; so does, of a spin-up that is certified, the growing component. The rest is over the
span of a run."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from ..integrate.events import roots_of_rates, zeros_passed
from ..numbers.balls import FIRST_BITS, Digits, Unclear, settled
from ..numbers.vectors import CYCLE, Float3, Number
from ..orbit.extremes import CERTAIN_BITS
from ..orbit.result import ALL_TIME, OVER_SPAN
from ..physics.equations import derive
from ..physics.scene import AnyScene, QuadraticForm, ScaledGyrostat
from ..physics.to_numpy import form, to_numpy
from ..reasons import Axis, Reason, Sentence, Span

if TYPE_CHECKING:
    from flint import arb

# --- The law, the standard form and its certificates
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

    def to_standard(self, x: np.ndarray | Sequence[float]):
        """State of the scene -> (u, y2, y3); the shift is added before rounding."""
        i, p, q = self.axes
        return (float(Fraction(float(x[i])) + self.shift) / self.rates[0], x[p] / self.rates[1],
                x[q] / self.rates[2])


def standard_form(scene: AnyScene) -> StandardForm | None:
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


def _torque_axis(quadratic: QuadraticForm):
    acting = [i for i in range(3) if quadratic.m[i]]
    return acting[0] if len(acting) == 1 else None


def growth_law(scene: AnyScene):
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


def spin_up_margin(c: float, y: np.ndarray | Sequence[float]) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "spin-up" at y = (u, y2, y3): it holds where margin > 0.
    """
    phi, P, J = angle_of(c, y)
    bend, depth, tail = P * P / 2, J / 2 * math.sin(phi)**2, c * c / 8 * math.sin(2 * phi)**2
    size = bend + abs(depth) + abs(J) + c * c
    return (bend - depth + tail + min(J, 0.0) / 2 - 0.625 * c * c if P > 0 else -size), size


def well_margin(c: float, y: np.ndarray | Sequence[float]) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "well" (c < 0) at y, for the best barrier angle found.
    """
    phi, P, J = angle_of(c, y)
    p = phi % math.pi

    def rise(b: float):  # V(b) - V(p), differences formed term by term
        return (p - b) - J / 2 * math.sin(b
                                          - p) * math.sin(b
                                                          + p) + c * c / 8 * math.sin(2 * (b - p)) * math.sin(
                                                              2 * (b + p))
    barrier = _highest(rise, max(p, math.pi - p), J, c)
    return rise(barrier) - P * P / 2, P * P / 2 + abs(J) / 2 + c * c / 8 + math.pi


def angle_of(c: float, y: np.ndarray | Sequence[float]):
    u, y2, y3 = y
    phi = math.atan2(y3, y2)
    return phi, u + c / 2 * math.cos(2 * phi), y2 * y2 + y3 * y3 - 2 * c * u


def _highest(rise: Callable[[float], float], low: float, J: float, c: float):
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


def release_estimate(c: float, J: float):
    """When a temporary capture (c > 0) is over. Small c: P' > 0 everywhere once J < 2 (about). Any c: P = 0
    needs J = R^2 + c^2 cos 2phi >= -c^2."""
    return max(0.0, (J - 2 if c * c < 2 else J + c * c) / (2 * c))


def certificate(c: float, y: np.ndarray | Sequence[float]) -> str | None:
    """"spin-up" or "well" where the one or the other holds at y beyond rounding, None otherwise."""
    margin, size = spin_up_margin(c, y)
    if margin > CLEARANCE * size or (c > 0 and angle_of(c, y)[2] + c * c < -CLEARANCE * size):
        return "spin-up"
    if c < 0:
        margin, size = well_margin(c, y)
        if margin > CLEARANCE * size:
            return "well"
    return None


def search_certificate(c: float, y: Sequence[float], t_max: float):
    """(certificate or "none", its time, state there, last reversal of the turn, steps): run until one holds.
    """
    if result := certificate(c, y):
        return result, 0.0, y, 0.0, 0
    if not math.isfinite(sum(v * v for v in y) * (1 + c * c)):
        return "none", None, y, 0.0, 0
    run, t, last, steps = turning_run(c), 0.0, 0.0, 0
    budget = STEP_BUDGET if c < 0 else RELEASE_BUDGET
    while t < t_max and steps < budget:
        end = min(t_max, t + max(1.0 / (1 + abs(c) + max(map(abs, y))), 0.2 * t))
        passed = run(y, end - t, budget - steps)
        last = t + float(passed.times[-1]) if len(passed.times) else last
        t = t + passed.t if passed.reason else end
        y, steps = tuple(passed.state.tolist()), steps + passed.steps
        if result := certificate(c, y):
            return result, t, y, last, steps
        if passed.reason:
            break
    return "none", None, y, last, steps


def nearest_other(c: float, y: Sequence[float], t_max: float, name: str, steps: int):
    """The relative change of the state within the run's rounding that leads to another end; None where there
    is none."""
    reach = STEP_ROUNDINGS * 2.0**-52 * (steps + 1)
    length = reach * (max(map(abs, y)) + abs(c))
    for i in range(3):
        for move in (-length, length):
            if search_certificate(c, (*y[:i], y[i] + move, *y[i + 1:]), t_max)[0] != name:
                return reach
    return None


def turning_run(c: float):
    """run(state, length, step limit): the motion, and the zeros of R^2 phi', where the turn reverses."""
    equations = derive(ScaledGyrostat(Fraction(c) / -2, Fraction(c) / 2, (1, 0, 0)))
    _, x2, x3 = equations.state
    forms = form(equations, (*equations.rhs, x2 * equations.rhs[2] - x3 * equations.rhs[1]))

    def run(y: Sequence[float], length: float, limit: int):
        return zeros_passed(forms, np.array(y), to_numpy(equations)(y), length, limit)
    return run


# --- Extremes
# Steps after which the finite end of a spin-up is given over the span run, unproved beyond it.
EXTREMES_BUDGET = 300_000
GROWS_FOR_EVER = Sentence("grows-for-ever-others-over", "{axis} for all time, the others over {span}")
FINITE_OVER = Sentence("finite-entries-over", "finite entries over {span}")


@dataclass(frozen=True)
class GrowthExtremes:
    """box: (3, 2) least and greatest of each component, +-inf where it grows; over: what they are
    known over; span: length of the run that the finite entries come from, None where no run was needed;
    whole: whether it came to its end."""

    box: np.ndarray
    over: Reason
    span: float | None
    whole: bool = True


def captured_extremes(scene, state, answer, span: float | None = None, exact=None) -> GrowthExtremes:
    """The extremes over t >= 0 of a motion whose `CapturedFate` is known.

    span: how long to look for the finite ends (the scene's time; None: as long as the certificate took, and
    twenty units of the motion). A spin-up is run on to where its growing component can fall no lower than it
    has: P >= sqrt(2L), and for c > 0 2cu >= -J. exact: the state as it was given (Fractions).
    """
    resolved = law_extremes(scene, exact or state, answer.certificate)
    if resolved is not None:
        return GrowthExtremes(np.array([[float(v) for v in pair] for pair in resolved]), ALL_TIME, None)
    change = standard_form(scene)
    unit = change.time if change else 1 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = max(1.5 * (answer.t_certificate or 0.0), 20 * unit) if span is None else span
    roots, certain = _run_to_floor(scene, state, change, answer, span)
    box = roots.extremes()
    reach, full = Span(0.0, roots.t_reached, scene.time_unit), not roots.reason
    over = OVER_SPAN(span=reach)
    if span < 0:  # nothing is known of what was before
        return GrowthExtremes(box, over, roots.t_reached, full)
    if answer.certificate in ("spin-up", "bound", "well"):
        box[answer.axis - 1, 1 if answer.sense > 0 else 0] = answer.sense * np.inf
        over = (GROWS_FOR_EVER(axis=Axis(answer.axis), span=reach) if certain
                else FINITE_OVER(span=reach))
    return GrowthExtremes(box, over, roots.t_reached, full)


def _run_to_floor(scene, state, change, answer, span):
    """(roots of the rates over the span, or further where that makes the growing component's finite end
    certain; whether it is)."""
    roots = longer = roots_of_rates(scene, state, span)
    while answer.certificate in ("spin-up", "bound") and span > 0:
        if _floor_holds(change, longer):
            return longer, True
        spent = max(longer.steps, answer.steps) >= EXTREMES_BUDGET
        if answer.certificate == "bound" or longer.reason or spent:
            break
        span = max(1.5 * span, answer.t_certificate)
        longer = roots_of_rates(scene, state, span)
    return roots, False


def _floor_holds(change, roots):
    """Whether u can fall no lower after the run than it did in it: u >= sqrt(2L) - |c|/2, L growing
    (`growth`), or u >= -J/2c, J falling."""
    c, i = change.c, change.axes[0]
    smallest = min(change.to_standard(x.tolist())[0]
                for x in (roots.start, roots.end, *roots.states[roots.component == i]))
    end = change.to_standard(roots.end.tolist())
    margin, _ = spin_up_margin(c, end)
    if margin > 0 and math.sqrt(2 * (margin + c * c / 2)) - abs(c) / 2 >= smallest:
        return True
    return c > 0 and -angle_of(c, end)[2] / (2 * c) >= smallest


# -- what is known for all time


def law_extremes(scene: AnyScene, state: Sequence[float | Fraction], certificate: str | None,
                 bits: int | None = None):
    """((least, greatest),) * 3 over t >= 0 as balls, floats where infinite, of a motion known by the
    certificate "axis" or "law"; None for others.

    state: three floats or Fractions, taken exactly. bits: how narrow the balls are against each component's
    size; None: as doubles need.
    """
    if certificate not in ("axis", "law"):
        return None
    form, x = scene.quadratic(), [Fraction(v) for v in state]
    i = next(n for n in range(3) if form.m[n])
    across = form.rho[i] or form.sigma[i]  # a gyrostatic component across the torque: three equal moments

    def question(numbers: Digits):
        pairs = ([_drifting(scene, x, a, numbers) for a in range(3)] if across
                 else _about_axis(form, x, i, numbers))
        certain = bits or CERTAIN_BITS
        if not all(_narrow(pair, certain) for pair in pairs):
            raise Unclear
        return tuple(pairs)
    return settled(question, FIRST_BITS if bits is None else 2 * bits)


def _narrow(pair: tuple[arb, Number], certain: int) -> bool:
    finite = [v for v in pair if not isinstance(v, float)]
    return max(float(v.rad()) for v in finite) <= 2.0**-certain * max(float(abs(v).mid()) for v in finite)


def _about_axis(form, x, i, numbers):
    """Of a spin about the torque's axis in proportion to time, while the two others turn round a circle."""
    j, k = CYCLE[i]
    radius, still = numbers.ball(x[j] * x[j] + x[k] * x[k]).sqrt(), not (x[j] or x[k])
    pairs = [(radius, radius) if still else (-radius, radius)] * 3
    pairs[i] = _growing(numbers.ball(x[i]), form.m[i])
    return pairs


def _growing(smallest, route):
    """The pair of a component that grows without bound in one direction, `smallest` being how far it goes in
    the other."""
    return (smallest, math.inf) if route > 0 else (-math.inf, smallest)


def _drifting(scene, x, a, numbers):
    """Component a of a turn about lambda with a drift along it: x + v t + r0 (cos - 1) + q sin, of Omega t
    (see the module text)."""
    D, lam, M = scene.body.exact[0], scene.vector("gyrostat"), scene.vector("constant_torque")
    square = sum(v * v for v in lam)
    along, torque = (sum(p * q for p, q in zip(lam, v)) for v in (x, M))
    rest = [w - v * along / square - c / square for w, v, c in zip(x, lam, _cross(lam, M))]  # r0
    v, r0, turned = lam[a] * torque / (square * D), rest[a], _cross(lam, rest)[a]  # q = turned/|lambda|
    swing = r0 * r0 + turned * turned / square
    here, reach = numbers.ball(x[a]), numbers.ball(swing).sqrt() if swing else numbers.ball(0)
    if not v:
        return here - numbers.ball(r0) - reach, here - numbers.ball(r0) + reach
    pace = v + turned / D  # of the component at the start: Omega q = turned/D
    if v < 0:  # its mirror image grows upwards
        low = _least(-here, -v, -r0, -turned, -pace, swing, square, D, numbers)
        return -math.inf, -low
    return _least(here, v, r0, turned, pace, swing, square, D, numbers), math.inf


def _least(here: arb, v: Fraction, r0: Fraction, turned: Fraction, pace: Fraction, swing: Fraction,
           square: Fraction | int, D: Fraction, numbers: Digits):
    """The least of here + v t + r0 (cos - 1) + q sin of Omega t over t >= 0, v > 0: at the start, or at the
    first of its minima after it.

    r0 cos + q sin = A sin(Omega t + phi); the slope v + Omega A cos vanishes on its way up where sin =
    -sqrt(1 - (v/Omega A)^2).
    """
    falls = square * swing - (v * D) ** 2  # (Omega A)^2 - v^2, times D^2
    if falls <= 0 or (not pace and r0 <= 0):
        return here
    ball = numbers.ball
    omega, size = ball(square).sqrt() / ball(D), ball(swing).sqrt()
    depth = ball(falls / (square * swing)).sqrt()
    bottom = numbers.angle(-depth, -ball(v) / (omega * size))
    start = numbers.angle(ball(r0), ball(turned) / ball(square).sqrt())
    turn = bottom - start
    while not turn > 0:
        if 0 in turn:
            raise Unclear
        turn = turn + 2 * numbers.pi()
    while (less := turn - 2 * numbers.pi()) > 0:
        turn = less
    return here.min(here - ball(r0) + ball(v) * turn / omega - size * depth)


def _cross(a: Sequence[Fraction], b: Sequence[Fraction]):
    return [a[j] * b[k] - a[k] * b[j] for j, k in CYCLE]
