"""Claims of the charged body's figures: by the printed (8) and (11), by (35), and by the linear model that
the paper solves, with the paper's data."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ....theories.charged.closed_form import solution
from ....theories.charged.model import circle
from ....theories.charged.modes import ChargedBody
from .trend import side, trend

FIELD = 100.0 * 1.02**2 * math.cos(0.37)  # H l^2 cos(sigma)
STEPS = {"wheel": (1.3, 1.6, 1.9), "charge": (0.001, 0.003, 0.005), "torque": (4.0, 4.5, 5.0)}
OTHERS = {"wheel": 1.3, "charge": 0.003, "torque": 4.0}
END = 50.0  # s, of the paper's figures
ROUNDING = 1e-12  # a smaller relative change is none


def _body(**changed) -> ChargedBody:
    data = OTHERS | changed
    return ChargedBody((8.7, 8.6, 11.1), 2.7 * 2 * math.pi / 60, data["wheel"], data["charge"] * FIELD,
                       (data["torque"], 0.0), force=(0, 0, 3), mass=10.0)


def _wave(**changed):
    """(amplitude of p, wavelength) by (11), from rest: p1 + i q1 = (i A/W)(1 - e^(i W t))."""
    body = _body(**changed)
    D1, D2, D3 = body.inertia
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    W = math.sqrt(zeta1 * zeta2) * (body.spin + (body.gyrostat - body.charge_moment) / (zeta1 * D1))
    return body.torque[0] / D1 / abs(W), 2 * math.pi / abs(W)


def _steps(name, good):
    """How many of the paper's steps of a parameter are not as `good`(change of amplitude, change of
    wavelength) says."""
    waves = [_wave(**{name: value}) for value in STEPS[name]]
    return sum(not good(b[0] - a[0], b[1] - a[1]) for a, b in zip(waves, waves[1:]))


def _proportion():
    (first, _), (last, _) = _wave(torque=4.0), _wave(torque=5.0)
    return last / first - 1.25


def _circle():
    """Change of the largest |G1 + i G2| of (35) between M1 = 4 and 5; its departure from proportionality."""
    period = 2 * math.pi / _body().spin
    widths = [float(np.hypot(*circle(_body(torque=M1), np.array(period / 2)))) for M1 in (4.0, 5.0)]
    return widths[1] / widths[0] - 1, widths[1] / widths[0] - 1.25


def _axial(names, good):
    """Of the linear model at the end: how many steps of the parameters do not change axial velocity and way
    as `good` says; the largest relative change."""
    missed, largest = 0, 0.0
    for name in names:
        runs = [solution(_body(**{name: value}), END) for value in STEPS[name]]
        ends = [(float(run.velocity[..., 2]), float(run.position[..., 2])) for run in runs]
        for before, after in zip(ends, ends[1:]):
            changes = [b / a - 1 for a, b in zip(before, after)]
            missed += not all(map(good, changes))
            largest = max(largest, *map(abs, changes))
    return missed, largest


@lru_cache
def _run(parameter, value):
    return solution(_body(**{parameter: value}), np.linspace(0, END, 10001))


def _of(part, axis, measure, parameter, value) -> float:
    """A measure of one component of the linear motion over the 50 s of the figures."""
    run = _run(parameter, value)
    x = getattr(run, part)[:, axis - 1]
    rest = x - np.polyval(np.polyfit(run.t, x, 1), run.t)
    return float({"amplitude": np.ptp(x) / 2, "end": x[-1], "growth": np.polyfit(run.t, x, 1)[0],
                  "amplitude about its growth": np.ptp(rest) / 2, "least": x.min(),
                  "turns": (np.diff(np.sign(np.diff(x))) != 0).sum()}[measure])


def _trend(part, axis, measure, parameter, goes, truth=""):
    """How a measure goes along the paper's values of a parameter, in the paper's linear model."""
    pairs = [trend([_of(part, one, measure, parameter, value) for value in STEPS[parameter]], goes, truth)
             for one in ([axis] if isinstance(axis, int) else axis)]
    return tuple(map(sum, zip(*pairs)))


def _circle_trend(parameter):
    """How the radius of (35) goes: it holds neither wheel nor charge."""
    period = 2 * math.pi / _body().spin
    return trend([float(np.hypot(*circle(_body(**{parameter: value}), np.array(period / 2))))
                  for value in STEPS[parameter]], "stays")


def _pointing():
    """Mean direction of the linear model's velocity at 1e5 s less M1/(D3 r0^2), as printed, and less M1/(r0
    (D3 r0 + lambda3 - charge's moment)), relative."""
    body = _body()
    velocity = solution(body, np.linspace(0.9e5, 1e5, 2001)).velocity
    seen = float((velocity[:, 1] / velocity[:, 2]).mean())
    M1, D3, r0 = body.torque[0], body.inertia[2], body.spin
    held = D3 * r0 + body.gyrostat - body.charge_moment
    return seen / (M1 / (D3 * r0**2)) - 1, seen / (M1 / (r0 * held)) - 1


TESTS = {
    "trend": _trend,
    "circle trend": _circle_trend,
    "pointing": _pointing,
    "side": lambda part, axis, parameter, lies: side(
        min(_of(part, axis, "least", parameter, value) for value in STEPS[parameter]), lies),
    "wheel lowers": lambda: (_steps("wheel", lambda amplitude, wavelength: amplitude < 0 and wavelength < 0),
                             0),
    "charge wavelength": lambda: (_steps("charge", lambda amplitude, wavelength: wavelength < 0),
                                  _steps("charge", lambda a, w: a > 0 and w > 0)),
    "torque amplitude": lambda: (_steps("torque", lambda amplitude, wavelength: amplitude < 0),
                                 _proportion()),
    "circle": _circle,
    "axial by wheel": lambda: _axial(("wheel",), lambda change: change < -ROUNDING),
    "axial by charge and torque": lambda: _axial(("charge", "torque"), lambda change: change > ROUNDING),
}
