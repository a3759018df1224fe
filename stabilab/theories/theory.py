"""What the theory behind the analytic models of a case says of its motion beyond the motion itself, in words
and numbers."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError
from ..integrate.events import roots_of_rates
from ..validation import checked_case
from .cavity.normal_form import attractors
from .charged.model import MISPRINTS, body_of
from .charged.modes import SMALL_ANGLE, horizon, largest_tilt, modes, pointing, resonances, spin_drift
from .follow import family
from .top.euler_angles import COARSE, angles_along, mean_precession
from .top.lindstedt import lindstedt
from .top.model import ORDER, state_of

GAMMA = (3, 4, 5)  # of the state of a top


def theory(case: Any, order: int | None = None, model: str | None = None,
           end: float | None = None) -> list[dict]:
    """What the analytic theories know of a case: a list of {"about", "words", "values"}. The words say of
    which motion a number is: of a model's equations, or of the exact motion.

    case: as `stabilab.load` gives it. values by name, with the unit in the words; none where no theory
    applies or the case gives no motion. order: of the top's expansion; model: "printed" adds the misprints of
    the charged body's paper; end: time in s up to which the exact motion of a top is looked at (None: the end
    of the case's span). Where the theory refuses the case's numbers the one row says why: the InputError is
    told and not raised.
    """
    module = family(checked_case(case).scene)
    if module is None or case.state is None:
        return []
    told = {"charged": _axisymmetric, "cavity": _averaged, "top": _top}
    end = case.span[1] if end is None and case.span else end
    try:
        rows = told[module.__name__.split(".")[-2]](case, order, end)
        return rows + (_misprints() if model == "printed" and module.MODELS[0] == "linear" else [])
    except InputError as error:
        return [_row("theory", f"no answer: {error}")]


def lines(rows) -> list[str]:
    """A line of text per row."""
    return [f"{row['about']}: {row['words']}" for row in rows]


def _row(about, words, **values):
    return {"about": about, "words": words, "values": values}


def _misprints():
    return [_row(f"misprint, {where}", f"{what}: {wrong}; the model corrected takes {right}")
            for where, (what, wrong, right) in MISPRINTS.items() if wrong]


def _pair(z):
    return [complex(z).real, complex(z).imag]


def _axisymmetric(case, order, end):
    body = body_of(case)
    m, until, tilt = modes(body), horizon(body), largest_tilt(body)
    root = float(m.root)
    rows = ([_row("resonance", words) for words in resonances(body)]
            or [_row("resonance", "none: no frequency of the data vanishes or meets another")])
    rows.append(_row("instability", f"{LINEAR} p and q grow by e in {1 / abs(root):.6g} s",
                     growth_rate=abs(root)) if m.unstable else
                _row("frequencies",
                     f"{LINEAR} p and q turn at {root:.10g} rad/s, the tilt also at "
                     f"{float(body.spin):.10g} rad/s", omega=root,
                     spin=float(body.spin)))
    bound = "for all time" if until == float("inf") else f"up to t = {until:.6g} s at least (estimate)"
    rows.append(_row("small angles", f"{LINEAR} the tilt stays below {SMALL_ANGLE:g} rad {bound}" + (
        f"; its largest value there is {tilt:.6g} rad" if tilt < float("inf")
        else "; it grows without bound"), horizon=until, largest_tilt=tilt))
    return rows + _means(body, "" if tilt <= SMALL_ANGLE else OUTGROWN)


LINEAR, OUTGROWN = "in the linear model", "; that is not of the exact motion, whose tilt is not small"


def _means(body, outgrown):
    """What the linear model says on average. outgrown: what is added where its angles are not small."""
    rows, aim, drift = [], pointing(body), spin_drift(body)
    if aim.status != "mean exists":
        rows.append(_row("mean pointing", f"{LINEAR}: {aim.status}: {aim.reason}"))
    else:
        rows.append(_row("mean pointing",
                         f"{LINEAR} the angular momentum points {float(aim.momentum_error):.6g} rad off "
                         f"inertial axis 3 on average and "
                         f"circles with radius {float(aim.momentum_radius):.6g} kg m^2/s{outgrown}",
                         momentum=_pair(aim.momentum),
                         angle=float(aim.momentum_error), radius=float(aim.momentum_radius)))
        if body.mass is not None and body.force.any():
            ratio = complex(aim.velocity_ratio)
            rows.append(_row("velocity",
                             f"{LINEAR} its direction tends to v1/v3 = {ratio.real:.6g}, v2/v3 = "
                             f"{ratio.imag:.6g} as time grows{outgrown}",
                             velocity_ratio=_pair(ratio)))
    if drift.status != "mean exists":
        return rows + [_row("spin drift", f"{LINEAR}: {drift.status}: {drift.reason}")]
    return rows + [_row("spin drift",
                        f"{LINEAR} theta leaves theta0 + r0 t at {float(drift.rate):.6g} rad/s and "
                        f"{float(drift.acceleration):.6g} rad/s^2 "
                        f"(second order of the tilt, on average){outgrown}", rate=float(drift.rate),
                        acceleration=float(drift.acceleration))]


def _averaged(case, order, end):
    found = attractors(case.scene)
    rows = []
    for p in found.points:
        speeds = ", ".join(f"{v.real:.6g}" + (f" {v.imag:+.6g}i" if v.imag else "") for v in p.rates)
        rows.append(_row(f"steady state, {p.kind}",
                         f"of the averaged equations: amplitude {p.amplitude:.10g} rad/s, spin {p.spin:.10g} "
                         f"rad/s; neighbours "
                         f"change at the rates {speeds} 1/s (negative: they come back); {p.because}",
                         kind=p.kind, amplitude=p.amplitude, spin=p.spin,
                         rates=[_pair(v) for v in p.rates]))
    rows += [_row("steady states, a family", f"of the averaged equations: {words}")
             for words in found.families]
    return rows + [_row("steady states", found.reason)]


def _top(case, order, end):
    motion = lindstedt(case.scene, state_of(case), [0.0], ORDER if order is None else order)
    rows = [_row("resonance", f"{r.condition}, at a distance of {r.distance:.6g}", harmonic=r.harmonic,
                 distance=r.distance)
            for r in motion.resonances]
    if motion.order < 0 or motion.status == "diverging":
        rows.append(_row("periodic motion", f"{motion.status}: {motion.reason}"))
    else:
        rows.append(_periodic(motion))
    return rows + (_exact_angles(case, float(end)) if end else [])


def _periodic(motion):
    """Of the expansion's own motion, which has the start's r and gamma and p, q of its own."""
    values, words = {"period": motion.period, "Omega2": motion.Omega2,
                     "departure": motion.departure.tolist()}, ""
    try:
        values["precession"] = mean_precession(motion)
        words = f", psi turns at {values['precession']:.10g} rad/s on average"
    except InputError as error:
        words = f", no mean precession: {error}"
    return _row("periodic motion",
                f"through r and gamma of the start, by the expansion of order {motion.order}: period "
                f"{motion.period:.12g} s{words}; p, q of the start are ({motion.departure[0]:.6g}, "
                f"{motion.departure[1]:.6g}) rad/s off it; a small free wobble about it turns at Omega^2 = "
                f"{motion.Omega2:.6g} of the squared spin", **values)


def _exact_angles(case, end):
    """Nutation and precession of the exact motion from the start to `end`, s: turning points as roots of
    gamma''s rate, psi along the run."""
    over = f"of the exact motion over s in [{min(end, 0.0):g}, {max(end, 0.0):g}]"
    found = roots_of_rates(case.scene, state_of(case), end)
    if found.reason:
        return [_row("nutation", f"no answer: the run {found.reason} at t = {found.t_reached:.6g} s")]
    gamma = np.vstack([found.start, found.end, found.states[found.component == GAMMA[2]]])[:, GAMMA]
    theta = np.arctan2(np.hypot(gamma[:, 0], gamma[:, 1]), gamma[:, 2])
    least, greatest = float(theta.min()), float(theta.max())
    rows = [_row("nutation", f"theta {over} between {least:.10g} and {greatest:.10g} rad", least=least,
                 greatest=greatest)]
    angles = angles_along(case, [end])
    if angles.status == "singular" or angles.error > COARSE:
        return [*rows, _row("mean precession", f"no answer: {angles.reason}")]
    rate = float(angles.psi[-1] - angles.psi[0]) / abs(end) * (1 if end > 0 else -1)
    return [*rows, _row("mean precession", f"psi {over} turns at {rate:.10g} rad/s on average", rate=rate)]
