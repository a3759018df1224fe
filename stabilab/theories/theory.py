"""What the theory behind the analytic models of a case says of its motion beyond the motion itself, in words and numbers."""
from __future__ import annotations

from typing import Any

import numpy as np

from ..asked import checked_case
from ..errors import InputError
from .cavity.attractors import attractors
from .charged.mean_pointing import pointing, spin_drift
from .charged.model import body_of
from .charged.modes import modes, resonances
from .charged.printed import MISPRINTS
from .charged.validity import SMALL_ANGLE, horizon, largest_tilt
from .follow import family
from .top.euler_angles import mean_precession, periodic_angles
from .top.lindstedt import lindstedt
from .top.model import ORDER, state_of

REVOLUTION = np.linspace(0.0, 1.0, 721)  # shares of a period at which the nutation is looked at


def theory(case: Any, order: int | None = None, model: str | None = None) -> list[dict]:
    """What the analytic theories know of a case: a list of {"about", "words", "values"}.

    case: as `stabilab.load` gives it. values by name, with the unit in the words; none where no theory applies or the case gives no motion. order: of
    the top's expansion; model: "printed" adds the misprints of the charged body's paper. Where the theory refuses the case's numbers the one
    row says why: the InputError is told and not raised.
    """
    module = family(checked_case(case).scene)
    if module is None or case.state is None:
        return []
    told = {"charged": _axisymmetric, "cavity": _averaged, "top": _top}
    try:
        rows = told[module.__name__.split(".")[-2]](case, order)
        return rows + (_misprints() if model == "printed" and module.MODELS[0] == "linear" else [])
    except InputError as error:
        return [_row("theory", f"no answer: {error}")]


def lines(rows) -> list[str]:
    """A line of text per row."""
    return [f"{row['about']}: {row['words']}" for row in rows]


def _row(about, words, **values):
    return {"about": about, "words": words, "values": values}


def _misprints():
    return [_row(f"misprint, {where}", f"{what}: {wrong}; the model corrected takes {right}") for where, (what, wrong, right) in MISPRINTS.items() if wrong]


def _pair(z):
    return [complex(z).real, complex(z).imag]


def _axisymmetric(case, order):
    body = body_of(case)
    m, until, tilt = modes(body), float(horizon(body)), float(largest_tilt(body))
    root = float(m.root.value())
    rows = [_row("resonance", words) for words in resonances(body)] or [_row("resonance", "none: no frequency of the data vanishes or meets another")]
    rows.append(_row("instability", f"p and q grow by e in {1 / abs(root):.6g} s", growth_rate=abs(root)) if bool(m.unstable) and root else
                _row("frequencies", f"p and q turn at {root:.10g} rad/s, the tilt also at {float(body.spin):.10g} rad/s", omega=root,
                     spin=float(body.spin)))
    bound = "for all time" if until == float("inf") else f"up to t = {until:.6g} s at least (estimate)"
    rows.append(_row("small angles", f"the tilt stays below {SMALL_ANGLE:g} rad {bound}" + (
        f"; its largest value in the linear model is {tilt:.6g} rad" if tilt < float("inf") else "; in the linear model it grows without bound"),
        horizon=until, largest_tilt=tilt))
    return rows + _means(body)


def _means(body):
    rows, aim, drift = [], pointing(body), spin_drift(body)
    if aim.status != "mean exists":
        rows.append(_row("mean pointing", f"{aim.status}: {aim.reason}"))
    else:
        rows.append(_row("mean pointing", f"the angular momentum points {float(aim.momentum_error):.6g} rad off inertial axis 3 on average and circles "
                         f"with radius {float(aim.momentum_radius):.6g} kg m^2/s", momentum=_pair(aim.momentum),
                         angle=float(aim.momentum_error), radius=float(aim.momentum_radius)))
        if body.mass is not None and body.force.any():
            ratio = complex(aim.velocity_ratio)
            rows.append(_row("velocity", f"as time grows its direction tends to v1/v3 = {ratio.real:.6g}, v2/v3 = {ratio.imag:.6g}",
                             velocity_ratio=_pair(ratio)))
    if drift.status != "mean exists":
        return rows + [_row("spin drift", f"{drift.status}: {drift.reason}")]
    return rows + [_row("spin drift", f"theta leaves theta0 + r0 t at {float(drift.rate):.6g} rad/s and {float(drift.acceleration):.6g} rad/s^2 "
                        "(second order of the tilt, on average)", rate=float(drift.rate), acceleration=float(drift.acceleration))]


def _averaged(case, order):
    found = attractors(case.scene)
    rows = []
    for p in found.points:
        speeds = ", ".join(f"{v.real:.6g}" + (f" {v.imag:+.6g}i" if v.imag else "") for v in p.rates)
        rows.append(_row(f"steady state, {p.kind}", f"amplitude {p.amplitude:.10g} rad/s, spin {p.spin:.10g} rad/s; neighbours change at the rates "
                         f"{speeds} 1/s (negative: they come back); {p.because}", kind=p.kind, amplitude=p.amplitude, spin=p.spin,
                         rates=[_pair(v) for v in p.rates]))
    rows += [_row("steady states, a family", words) for words in found.families]
    return rows + [_row("steady states", found.reason)]


def _top(case, order):
    motion = lindstedt(case.scene, state_of(case), [0.0], ORDER if order is None else order)
    rows = [_row("resonance", f"{r.condition}, at a distance of {r.distance:.6g}", harmonic=r.harmonic, distance=r.distance)
            for r in motion.resonances]
    if motion.order < 0 or motion.status == "diverging":
        return rows + [_row("periodic motion", f"{motion.status}: {motion.reason}")]
    rows.append(_row("periodic motion", f"by the expansion of order {motion.order}: period {motion.period:.12g} s; "
                     f"the free wobble turns at Omega^2 = {motion.Omega2:.6g} of the squared spin",
                     period=motion.period, Omega2=motion.Omega2))
    theta = periodic_angles(motion, motion.period * REVOLUTION).theta
    rows.append(_row("nutation", f"theta between {theta.min():.10g} and {theta.max():.10g} rad", least=float(theta.min()), greatest=float(theta.max())))
    try:
        mean = mean_precession(motion)
        return rows + [_row("mean precession", f"psi turns at {mean:.10g} rad/s on average", rate=mean)]
    except InputError as error:
        return rows + [_row("mean precession", f"no answer: {error}")]

