"""What the theory behind a case's models says of its motion, and each model beside the exact motion.

It is said in words and numbers; of a model, how far off it is, and from when on."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..answers.caveats import answered
from ..case.given import Given, Span, Start, as_case, time_in, with_start
from ..errors import InputError, refusal_of
from ..integrate.events import roots_of_rates
from ..physics.states import checked_times
from ..reasons import Angle, Filling, PerSecond, Quantity, Rate, Reason, Sentence, Time, as_reason
from ..reasons import Span as Reach
from ..representation import Answer, Compared
from .cavity_normal_form import attractors
from .charged import MISPRINTS, body_of
from .charged_modes import (
    SMALL_ANGLE,
    horizon,
    largest_tilt,
    modes,
    pointing,
    resonances,
    spin_drift,
)
from .euler_angles import COARSE, angles_along, mean_precession
from .follow import family, follow, models_of
from .top import OF_EXPANSION, ORDER, state_of
from .top_lindstedt import lindstedt

if TYPE_CHECKING:
    from ..answers.simulate import Simulation


NO_ANSWER = Sentence("theory-no-answer", "no answer: {why}")
RUN_ENDED = Sentence("theory-run-ended", "no answer: the run {why} at t = {time}")
MISPRINT = Sentence("misprint", "{what}: {wrong}; the model corrected takes {right}")
NO_RESONANCE = Sentence("no-resonance", "none: no frequency of the data vanishes or meets another")()
GROW = Sentence("linear-model-grows", "in the linear model p and q grow by e in {time}")
TURN = Sentence("linear-model-turns", "in the linear model p and q turn at {rate}, the tilt also at {spin}")
STAYS = Sentence("linear-tilt-stays", "in the linear model the tilt stays below {angle} {long}")
ALWAYS = Sentence("linear-tilt-always", "for all time")()
UP_TO = Sentence("linear-tilt-up-to", "up to t = {time} at least (estimate)")
LARGEST = Sentence("linear-tilt-largest", "its largest value there is {tilt}")
WITHOUT_BOUND = Sentence("linear-tilt-grows", "it grows without bound")()
OF_LINEAR = Sentence("linear-mean-status", "in the linear model: {status}: {why}")
POINTS = Sentence(
    "linear-mean-pointing", "in the linear model the angular momentum points {angle} off inertial axis 3 on "
    "average and circles with radius {radius}")
TENDS = Sentence(
    "linear-velocity-tends", "in the linear model its direction tends to v1/v3 = {first}, v2/v3 = {second} "
    "as time grows")
DRIFTS = Sentence(
    "linear-spin-drifts", "in the linear model θ leaves θ0 + r0 t at {rate} and {acceleration} (second order "
    "of the tilt, on average)")
OUTGROWN = Sentence("linear-model-outgrown", "that is not of the exact motion, whose tilt is not small")()
STEADY = Sentence(
    "averaged-steady-state", "of the averaged equations: amplitude {amplitude}, spin {spin}; neighbours "
    "change at the rates {rates} (negative: they come back); {why}")
STEADY_TURNING = Sentence(
    "averaged-steady-turning", "of the averaged equations: amplitude {amplitude}, spin {spin}; neighbours "
    "change at the rate {rate} (negative: they come back), turning at {turning}; {why}")
FAMILY = Sentence("averaged-family", "of the averaged equations: {states}")
AT_DISTANCE = Sentence("top-resonance-at", "{resonance}, at a distance of {distance}")
PERIODIC = Sentence(
    "top-periodic-motion", "through r and γ of the start, by the expansion of order {order}: period "
    "{period}, {precession}; p, q of the start are {departure} off it; a small free wobble about it turns at "
    "Ω² = {square} of the squared spin")
PRECESSES = Sentence("top-precesses", "ψ turns at {rate} on average")
NO_PRECESSION = Sentence("top-no-precession", "no mean precession: {why}")
NUTATES = Sentence("top-nutates-over", "θ of the exact motion over {span} between {least} and {greatest}")
PRECESSES_EXACTLY = Sentence(
    "top-precesses-over", "ψ of the exact motion over {span} turns at {rate} on average")

# --- What the theory says beyond the motion
GAMMA = (3, 4, 5)  # of the state of a top


def theory(case: Given, order: int | None = None, model: str | None = None,
           end: float | None = None, *, state: Start | None = None, span: Span | None = None) -> list[dict]:
    """What the analytic theories know of a case: a list of {"about", "words", "reason", "values"}. The words
    say of which motion a number is: of a model's equations, or of the exact motion; reason: the same as a
    `stabilab.reasons.Reason`.

    case: in any form, or a scene with `state`. values by name, with the unit in the words; none where no
    theory applies or the case gives no motion. order: of the top's expansion; model: "printed" adds the
    misprints of the charged body's paper; end: time in s up to which the exact motion of a top is looked at
    (None: the end of the case's span). Where the theory refuses the case's numbers the one row says why: the
    InputError is reported and not raised.
    """
    case = as_case(case, state, span)
    module = family(case.scene)
    if module is None or case.state is None:
        return []
    printed = {"charged": _axisymmetric, "cavity": _averaged, "top": _top}
    end = case.span[1] if end is None and case.span else end
    try:
        rows = printed[module.__name__.split(".")[-1]](case, order, end)
        return rows + (_misprints() if model == "printed" and module.MODELS[0] == "linear" else [])
    except InputError as error:
        return [_row("theory", NO_ANSWER(why=refusal_of(error)))]


def _row(about: str, reason: Reason, **values: object) -> dict:
    return {"about": about, "words": reason.text(), "reason": reason, "values": values}


def _misprints():
    return [_row(f"misprint, {where}", MISPRINT(what=what, wrong=as_reason(wrong), right=as_reason(right)))
            for where, (what, wrong, right) in MISPRINTS.items() if wrong]


def _pair(z: complex):
    return [complex(z).real, complex(z).imag]


def _axisymmetric(case, order, end):
    body = body_of(case)
    m, until, tilt = modes(body), horizon(body), largest_tilt(body)
    root = float(m.root)
    rows = [_row("resonance", resonance) for resonance in resonances(body) or (NO_RESONANCE,)]
    rows.append(_row("instability", GROW(time=Time(1 / abs(root))), growth_rate=abs(root)) if m.unstable else
                _row("frequencies", TURN(rate=Rate(root), spin=Rate(float(body.spin))), omega=root,
                     spin=float(body.spin)))
    long = ALWAYS if until == float("inf") else UP_TO(time=Time(until).lower)
    rows.append(_row("small angles", STAYS(angle=Angle(SMALL_ANGLE), long=long).then(
        LARGEST(tilt=Angle(tilt)) if tilt < float("inf") else WITHOUT_BOUND),
        horizon=until, largest_tilt=tilt))
    return rows + _means(body, None if tilt <= SMALL_ANGLE else OUTGROWN)


def _means(body, outgrown: Reason | None):
    """What the linear model says on average. outgrown: what is added where its angles are not small."""
    rows, aim, drift = [], pointing(body), spin_drift(body)
    if aim.status != "mean exists":
        rows.append(_row("mean pointing", OF_LINEAR(status=aim.status, why=aim.reason)))
    else:
        points = POINTS(angle=Angle(float(aim.momentum_error)),
                        radius=Quantity(float(aim.momentum_radius), "kg m^2/s"))
        rows.append(_row("mean pointing", points.then(outgrown), momentum=_pair(aim.momentum),
                         angle=float(aim.momentum_error), radius=float(aim.momentum_radius)))
        if body.mass is not None and body.force.any():
            ratio = complex(aim.velocity_ratio)
            tends = TENDS(first=Quantity(ratio.real), second=Quantity(ratio.imag))
            rows.append(_row("velocity", tends.then(outgrown), velocity_ratio=_pair(ratio)))
    if drift.status != "mean exists":
        return rows + [_row("spin drift", OF_LINEAR(status=drift.status, why=drift.reason))]
    rate, acceleration = float(drift.rate), float(drift.acceleration)
    drifts = DRIFTS(rate=Rate(rate), acceleration=Quantity(acceleration, "rad/s^2"))
    return rows + [_row("spin drift", drifts.then(outgrown), rate=rate, acceleration=acceleration)]


def _averaged(case, order, end):
    result = attractors(case.scene)
    rows = []
    for p in result.points:
        location: dict[str, Filling] = {"amplitude": Rate(p.amplitude), "spin": Rate(p.spin), "why": p.reason}
        if any(v.imag for v in p.rates):  # a conjugate pair, as the averaged equations are real
            turning = PerSecond(abs(p.rates[0].imag))
            reason = STEADY_TURNING(**location, rate=PerSecond(p.rates[0].real), turning=turning)
        else:
            reason = STEADY(**location, rates=PerSecond(tuple(v.real for v in p.rates)))
        rows.append(_row(f"steady state, {p.kind}", reason, kind=p.kind, amplitude=p.amplitude, spin=p.spin,
                         rates=[_pair(v) for v in p.rates]))
    rows += [_row("steady states, a family", FAMILY(states=item)) for item in result.families]
    return rows + [_row("steady states", result.reason)]


def _top(case, order, end):
    motion = lindstedt(case.scene, state_of(case), [0.0], ORDER if order is None else order)
    rows = [_row("resonance", AT_DISTANCE(resonance=r.condition, distance=Quantity(r.distance)),
                 harmonic=r.harmonic, distance=r.distance)
            for r in motion.resonances]
    if motion.order < 0 or motion.status == "diverging":
        rows.append(_row("periodic motion", OF_EXPANSION(status=motion.status, why=motion.reason)))
    else:
        rows.append(_periodic(motion))
    return rows + (_exact_angles(case, float(end)) if end else [])


def _periodic(motion):
    """Of the expansion's own motion, which has the start's r and gamma and p, q of its own."""
    values = {"period": motion.period, "Omega2": motion.Omega2, "departure": motion.departure.tolist()}
    try:
        values["precession"] = mean_precession(motion)
        precession = PRECESSES(rate=Rate(values["precession"]))
    except InputError as error:
        precession = NO_PRECESSION(why=refusal_of(error))
    reason = PERIODIC(order=motion.order, period=Time(motion.period), precession=precession,
                      departure=Rate(tuple(values["departure"])), square=Quantity(motion.Omega2))
    return _row("periodic motion", reason, **values)


def _exact_angles(case, end):
    """Nutation and precession of the exact motion from the start to `end`, s: turning points as roots of
    gamma''s rate, psi along the run."""
    span = Reach(min(end, 0.0), max(end, 0.0))
    result = roots_of_rates(case.scene, state_of(case), end)
    if result.reason:
        return [_row("nutation", RUN_ENDED(why=result.reason, time=Time(result.t_reached)))]
    gamma = np.vstack([result.start, result.end, result.states[result.component == GAMMA[2]]])[:, GAMMA]
    theta = np.arctan2(np.hypot(gamma[:, 0], gamma[:, 1]), gamma[:, 2])
    lower, greatest = float(theta.min()), float(theta.max())
    rows = [_row("nutation", NUTATES(span=span, least=Angle(lower), greatest=Angle(greatest)), least=lower,
                 greatest=greatest)]
    angles = angles_along(case, [end])
    if angles.status == "singular" or angles.error > COARSE:
        return [*rows, _row("mean precession", NO_ANSWER(why=angles.reason))]
    rate = float(angles.psi[-1] - angles.psi[0]) / abs(end) * (1 if end > 0 else -1)
    return [*rows, _row("mean precession", PRECESSES_EXACTLY(span=span, rate=Rate(rate)), rate=rate)]


# --- Each model beside the exact motion
GRID = 801  # times over the span on which the error is looked at
ZOOM = 65  # times between two of them, and again between two of those, to place a first error
LEVELS = (0.01, 0.1)
SHARED = ("omega", "gamma", "angles", "momentum", "velocity", "position")


@dataclass(frozen=True, eq=False)
class Departure(Compared):
    """Error of one part of the state under one model.

    error: (n,) largest component's distance from the exact motion, inf where the model has stopped; scale:
    the largest exact component over the span, against which `first` is measured: {0.01: time of the first 1 %
    error or None, 0.1: ...}, a stop being an error of any size; largest: while the model runs.
    """

    model: str
    part: str
    error: np.ndarray
    scale: float
    largest: float
    first: dict


@dataclass(frozen=True, repr=False, eq=False)
class Comparison(Answer, Compared):
    """t: (n,) times; runs: model -> Simulation, the exact one first; departures: one per model and part of
    the state; refusals: model -> the reason why it has no answer for this motion, refused: the same in words;
    theory: what else the theory says (`theory.theory`)."""

    t: np.ndarray
    runs: dict
    departures: tuple[Departure, ...]
    refusals: dict
    theory: tuple = ()

    @property
    def refused(self) -> dict[str, str]:
        """Model -> why it has no answer, in words and SI units."""
        return {model: reason.text() for model, reason in self.refusals.items()}

    @property
    def validity(self):
        """Of the scene's laws along the exact motion; None where all are exact."""
        return self.runs["exact"].validity


def compare(case: Given, times: ArrayLike | None = None, order: int | None = None, *,
            state: Start | None = None, span: Span | None = None) -> Comparison:
    """All models of a case over its span (or at `times` (n,), s, increasing from 0) against the exact motion.

    case: in any form, with a motion, or a scene with `state`; order: of the fast top's expansion.

    The first times of 1 % and 10 % error are bracketed on the grid and refined by evaluating both models in
    between. Raises InputError as `follow` does.
    """
    case = with_start(as_case(case, state, span), "compare")
    if order is not None and "lindstedt" not in models_of(case.scene):
        raise InputError(
            f"order: belongs to the model \"lindstedt\"; this scene has {', '.join(models_of(case.scene))}")
    times = None if times is None else time_in(case.scene, times, "times")
    if case.span is None and times is None:
        raise InputError("compare: the case states no span: give it times")
    times = np.linspace(case.span[0], case.span[1], GRID) if times is None else checked_times(times)
    runs, refused = side_by_side(case, times, order)
    exact, result = runs["exact"], []
    for name, run in list(runs.items())[1:]:
        for part in (p for p in SHARED if p in run.state and p in exact.state):
            result.append(_departure(case, name, part, run, exact, order))
    return answered(Comparison(times, runs, tuple(result), refused,
                               tuple(theory(case, order, end=float(times[-1])))), case, exact.validity)


def side_by_side(case, times, order: int | None = None) -> tuple[dict, dict]:
    """(model -> Simulation at the times, the exact one first; model -> why it refuses this motion)."""
    runs, refused = {}, {}
    for name in models_of(case.scene):
        try:
            runs[name] = follow(case, times, name, order=order if name == "lindstedt" else None)
        except InputError as error:
            if name == "exact":
                raise
            refused[name] = refusal_of(error)
    return runs, refused


def _gap(run: Simulation, exact: Simulation, part: str):
    shown = min(len(run.t), len(exact.t))
    gap = np.full(len(exact.t), np.inf)
    gap[:shown] = np.abs(np.asarray(run.state[part])[:shown]
                         - np.asarray(exact.state[part])[:shown]).max(axis=1)
    return gap


def _departure(case, name, part, run, exact, order):
    error = _gap(run, exact, part)
    scale = float(np.abs(exact.state[part]).max())
    first = {level: _first(case, name, part, exact.t, error, level * scale, order) for level in LEVELS}
    return Departure(name, part, error, scale, float(error[np.isfinite(error)].max(initial=0.0)), first)


def _first(case, name, part, times, error, level, order):
    """The first time at which the error exceeds `level`, or None."""
    over = np.nonzero(~(error <= level))[0]
    if not len(over):
        return None
    for _ in range(2):
        if over[0] == 0:
            break
        times = np.linspace(times[over[0] - 1], times[over[0]], ZOOM)
        run = follow(case, times, name, order=order if name == "lindstedt" else None)
        error = _gap(run, follow(case, times, "exact"), part)
        over = np.nonzero(~(error <= level))[0]
        over = over if len(over) else [ZOOM - 1]  # the model's own rounding at the end of the bracket
    return float(times[over[0]])
