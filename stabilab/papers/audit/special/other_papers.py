"""Claims of the other papers' figures and texts that no formula says: of the charged body by the printed (8)
and (11), by (35), and by the linear model that the paper solves; of the liquid by the program's own normal
form and averaged equations; of the fast top by its exact motion; with the papers' data."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ....answers.simulate import simulate
from ....case.read import load_all
from ....physics.effects.charge import Charge
from ....physics.effects.constant_torque import ConstantTorque
from ....physics.effects.gyrostat import Gyrostat
from ....physics.effects.liquid_cavity import LiquidCavity
from ....physics.effects.resistance import Resistance
from ....physics.scene import Body, Scene
from ....theories.cavity.averaged import averaged
from ....theories.cavity.normal_form import constants
from ....theories.charged.closed_form import solution
from ....theories.charged.model import circle
from ....theories.charged.modes import ChargedBody
from ...table import cases_folder
from .constant_torque import side, trend

# -- the charged body
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


# -- the liquid in a cavity

MOMENTS, EPS, DENSITY, P0 = (9.51, 9.3, 9.0), 0.1, 1250.0, 1.9
START, LIQUID_END = (1.0, 0.0, 1.0), 20.0  # rad/s, s
WHEELS = ((0.1, 0.15, 0.2), (15.0, 20.0, 25.0))
RESISTANCES = (1.5, 2.0, 2.5)


def _liquid(wheel=0.1, charge=0.01, zeta=2.0, torque=-6.0) -> Scene:
    """The paper's body, its unvaried data completed as in the cases."""
    return Scene(Body(MOMENTS), Gyrostat((0, 0, wheel)), Charge(charge, 100, 0.01, 0.3),
                 LiquidCavity(DENSITY, 1000, P0),
                 Resistance(EPS**2 * zeta), ConstantTorque((0, 0, torque * EPS**2)))


def _frequency(one: Scene) -> float:
    """omega of (11) at the start, rad/s; an imaginary one by its size."""
    n = {name: float(value) for name, value in constants(one).items()}
    first, second = ((n["d"] + sign * n["h"]) * START[2] - n["Gamma"] for sign in (1, -1))
    return math.sqrt(abs(first * second)) / n["J0"]


def _wheel():
    """Share of the paper's steps of lambda3 at which the frequency does not grow; at which it does other than
    whether Gamma is above d r says."""
    missed = parted = steps = 0
    for values in WHEELS:
        for a, b in zip(values, values[1:]):
            first, second = _liquid(wheel=a), _liquid(wheel=b)
            n = {name: float(value) for name, value in constants(first).items()}
            grows = _frequency(second) > _frequency(first)
            above = n["Gamma"] > (n["d"] + abs(n["h"])) * START[2]
            missed, parted, steps = missed + (not grows), parted + (grows != above), steps + 1
    return missed / steps, parted / steps


def _liquid_mass():
    """Moment of inertia of the frozen liquid as a sphere over the body's, less 1; how many of the statements
    "radius 1.69 m" and "25 t" are not so."""
    radius = (P0 * 525 / (8 * math.pi)) ** (1 / 7)
    mass = DENSITY * 4 / 3 * math.pi * radius**3
    return 2 / 5 * mass * radius**2 / MOMENTS[2] - 1, (abs(radius - 1.69) > 0.005) + (abs(mass - 25e3) > 500)


def _resistance():
    """Of the averaged motion: steps of zeta downwards after which the amplitude at the end is not smaller;
    upwards."""
    ends = [float(averaged(_liquid(zeta=zeta), START, (0.0, LIQUID_END)).amplitude[-1])
            for zeta in RESISTANCES]
    steps = list(zip(ends, ends[1:]))  # (at the smaller zeta, at the larger)
    return sum(not small < large for small, large in steps), sum(not large < small for small, large in steps)


def _liquid_charge():
    """Relative change of the frequency from e = 0.01 to 10,000 C; of that with the charge's moment taken off
    the wheel instead."""
    plain, charged = _liquid(), _liquid(charge=1e4)
    instead = _liquid(wheel=float(constants(charged)["Gamma"]), charge=0)
    return tuple(abs(_frequency(charged) / _frequency(other) - 1) for other in (plain, instead))


LIQUID_STEPS = {"zeta": RESISTANCES, "torque": (-3.0, -6.0, -9.0), "wheel": WHEELS[1]}


@lru_cache
def _averaged(parameter, value):
    return averaged(_liquid(**{parameter: value}), START, np.linspace(0, LIQUID_END, 401))


def _liquid_trend(quantity, parameter, goes, truth=""):
    """How amplitude or spin at 20 s, or the angle by which (p, q) has turned, goes along the paper's values.
    """
    return trend([abs(float(getattr(_averaged(parameter, value), quantity)[-1]))
                  for value in LIQUID_STEPS[parameter]], goes, truth)


def _turns_back(parameter):
    """How many of the three motions have their largest phase at the end; how many have not."""
    grown = sum(int(_averaged(parameter, value).phase.argmax()) == 400 for value in LIQUID_STEPS[parameter])
    return grown, len(LIQUID_STEPS[parameter]) - grown


# -- the fast top

FAMILIES = {"lx": ("lx30-lz30", "lx60-lz30", "lx90-lz30"), "lz": ("lx30-lz30", "lx30-lz60", "lx30-lz90")}
TOP_END = 1.3  # s, of the paper's figures
TOP = {"z": 0.1, "k": 0.2, "wheel": 0.0}  # z0', k and l_z/r0 of a top without l_z


def _lambda1(C: float, A=1.0, B=1.1) -> tuple[float, float]:
    """(lambda1 of (10), Omega^2) of a body with these moments."""
    A1, B1 = (C - B) / A, (A - C) / B
    square = -A1 * B1
    return (TOP["z"] * (A1 / (B / C) - C / A) + TOP["k"] * (A1 - square)) / (1 - square), square


def _poles():
    """Size of lambda1 where C is 1e-9 short of A + B over that at C = 1.4, less one; the residue of the pole
    seen 1e-6 short of it against 1e-9, relative."""
    (near, at), (closer, there), (far, _) = _lambda1(2.1 - 1e-6), _lambda1(2.1 - 1e-9), _lambda1(1.4)
    return abs(closer / far) - 1, closer * (1 - there) / (near * (1 - at)) - 1


@lru_cache
def _top(name):
    """The exact motion of a case of Table 1."""
    case, = load_all(cases_folder() / f"top-{name}.toml")
    return simulate(case, times=np.linspace(0, TOP_END, 1301))


def _top_trend(part, axis, measure, family, goes, truth=""):
    """How the amplitude of a component of the exact motion, or how often it turns, goes along a family."""
    parts = [np.asarray(_top(name).state[part])[:, axis - 1] for name in FAMILIES[family]]
    measured = {"amplitude": lambda x: np.ptp(x) / 2,
                "turns": lambda x: (np.diff(np.sign(np.diff(x))) != 0).sum()}
    return trend([float(measured[measure](x)) for x in parts], goes, truth)


def _closed():
    """Least distance of the exact (p, q, r, gamma) from its start after 0.1 s, over its distance at most: a
    closed curve comes back; the share of the three cases of a family in which it does."""
    shares = []
    for name in FAMILIES["lx"]:
        state = _top(name).state
        away = np.linalg.norm(np.hstack([state["omega"], state["gamma"]])
                              - np.hstack([state["omega"][0], state["gamma"][0]]), axis=1)
        shares.append(float(away[100:].min() / away.max()))
    return min(shares), sum(share < 1e-2 for share in shares)


TESTS = {
    "liquid trend": _liquid_trend, "turns back": _turns_back, "mass": _liquid_mass, "wheel frequency": _wheel,
    "resistance": _resistance, "charge": _liquid_charge,
    "poles": _poles, "top trend": _top_trend, "closed": _closed,
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
