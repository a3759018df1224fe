"""Extremes of a motion that grows for ever by an exact law.

Pure spin about the torque's axis: the two other components stay 0. Equal moments across it, and no gyrostatic
component: the spin grows in proportion to time, and the two others turn round their circle faster and faster.
Three equal moments: D omega' = lambda x omega + M, so with n along lambda, Omega = |lambda|/D and c = lambda
x M/|lambda|^2 (lambda x c cancels what of M stands across lambda)

    omega = n (s + g t) + c + r(t),   s = n . omega(0),   g = n . M/D,   r(t) = r0 cos(Omega t) + n x r0
    sin(Omega t).

These hold for all time; so does, of a spin-up that is certified, the growing component. The rest is over the
span of a run.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ...integrate.events import roots_of_rates
from ...numbers.balls import FIRST_BITS, Unclear, settled
from ...numbers.vectors import CYCLE
from ...orbit.extremes.balls import CERTAIN_BITS
from .certificate import angle_of, spin_up_margin, standard_form

# Steps after which the finite end of a spin-up is given over the span run, unproved beyond it.
EXTREMES_BUDGET = 300_000
FOREVER = "all time"


@dataclass(frozen=True)
class GrowthExtremes:
    """box: (3, 2) least and greatest of each component, +-inf where it grows; over: in words, what they are
    known over; span: length of the run that the finite entries come from, None where no run was needed;
    whole: whether it came to its end."""

    box: np.ndarray
    over: str
    span: float | None
    whole: bool = True


def captured_extremes(scene, state, answer, span: float | None = None, exact=None) -> GrowthExtremes:
    """The extremes over t >= 0 of a motion whose `CapturedFate` is known.

    span: how long to look for the finite ends (the scene's time; None: as long as the certificate took, and
    twenty units of the motion). A spin-up is run on to where its growing component can fall no lower than it
    has: P >= sqrt(2L), and for c > 0 2cu >= -J. exact: the state as it was given (Fractions).
    """
    known = law_extremes(scene, exact or state, answer.certificate)
    if known is not None:
        return GrowthExtremes(np.array([[float(v) for v in pair] for pair in known]), FOREVER, None)
    change = standard_form(scene)
    unit = change.time if change else 1 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = max(1.5 * (answer.t_certificate or 0.0), 20 * unit) if span is None else span
    roots, certain = _run_to_floor(scene, state, change, answer, span)
    box = roots.extremes()
    over, whole = f"{scene.time_unit} in [0, {roots.t_reached:g}]", not roots.reason
    if span < 0:  # nothing is known of what was before
        return GrowthExtremes(box, over, roots.t_reached, whole)
    if answer.certificate in ("spin-up", "bound", "well"):
        box[answer.axis - 1, 1 if answer.sense > 0 else 0] = answer.sense * np.inf
        over = (f"axis {answer.axis} for all time, the others over {over}" if certain
                else f"finite entries over {over}")
    return GrowthExtremes(box, over, roots.t_reached, whole)


def _run_to_floor(scene, state, change, answer, span):
    """(roots of the rates over the span, or further where that makes the growing component's finite end
    certain; whether it is)."""
    roots = longer = roots_of_rates(scene, state, span)
    while answer.certificate in ("spin-up", "bound") and span > 0:
        if _floor_holds(change, longer):
            return longer, True
        if answer.certificate == "bound" or longer.reason or max(longer.steps,
                                                                 answer.steps) >= EXTREMES_BUDGET:
            break
        span = max(1.5 * span, answer.t_certificate)
        longer = roots_of_rates(scene, state, span)
    return roots, False


def _floor_holds(change, roots):
    """Whether u can fall no lower after the run than it did in it: u >= sqrt(2L) - |c|/2, L growing
    (`growth`), or u >= -J/2c, J falling."""
    c, i = change.c, change.axes[0]
    least = min(change.to_standard(x.tolist())[0]
                for x in (roots.start, roots.end, *roots.states[roots.component == i]))
    end = change.to_standard(roots.end.tolist())
    margin, _ = spin_up_margin(c, end)
    if margin > 0 and math.sqrt(2 * (margin + c * c / 2)) - abs(c) / 2 >= least:
        return True
    return c > 0 and -angle_of(c, end)[2] / (2 * c) >= least


# -- what is known for all time


def law_extremes(scene, state, certificate, bits: int | None = None):
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

    def question(numbers):
        pairs = ([_drifting(scene, x, a, numbers) for a in range(3)] if across
                 else _about_axis(form, x, i, numbers))
        certain = bits or CERTAIN_BITS
        if not all(_narrow(pair, certain) for pair in pairs):
            raise Unclear
        return tuple(pairs)
    return settled(question, FIRST_BITS if bits is None else 2 * bits)


def _narrow(pair, certain) -> bool:
    finite = [v for v in pair if not isinstance(v, float)]
    return max(float(v.rad()) for v in finite) <= 2.0**-certain * max(float(abs(v).mid()) for v in finite)


def _about_axis(form, x, i, numbers):
    """Of a spin about the torque's axis in proportion to time, while the two others turn round a circle."""
    j, k = CYCLE[i]
    radius, still = numbers.ball(x[j] * x[j] + x[k] * x[k]).sqrt(), not (x[j] or x[k])
    pairs = [(radius, radius) if still else (-radius, radius)] * 3
    pairs[i] = _growing(numbers.ball(x[i]), form.m[i])
    return pairs


def _growing(least, way):
    """The pair of a component that grows without bound in one direction, `least` being how far it goes in the
    other."""
    return (least, math.inf) if way > 0 else (-math.inf, least)


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


def _least(here, v, r0, turned, pace, swing, square, D, numbers):
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


def _cross(a, b):
    return [a[j] * b[k] - a[k] * b[j] for j, k in CYCLE]
