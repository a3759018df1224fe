"""Claims about the liquid's figures that no formula says, by the program's own normal form and averaged
equations, with the paper's data."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ....physics.effects.charge import Charge
from ....physics.effects.constant_torque import ConstantTorque
from ....physics.effects.gyrostat import Gyrostat
from ....physics.effects.liquid_cavity import LiquidCavity
from ....physics.effects.resistance import Resistance
from ....physics.scene import Body, Scene
from ....theories.cavity.averaged import averaged
from ....theories.cavity.normal_form import constants
from .trend import trend

MOMENTS, EPS, DENSITY, P0 = (9.51, 9.3, 9.0), 0.1, 1250.0, 1.9
START, END = (1.0, 0.0, 1.0), 20.0  # rad/s, s
WHEELS = ((0.1, 0.15, 0.2), (15.0, 20.0, 25.0))
RESISTANCES = (1.5, 2.0, 2.5)


def scene(wheel=0.1, charge=0.01, zeta=2.0, torque=-6.0) -> Scene:
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
            first, second = scene(wheel=a), scene(wheel=b)
            n = {name: float(value) for name, value in constants(first).items()}
            grows, above = _frequency(second) > _frequency(first), n["Gamma"] > (
                n["d"] + abs(n["h"])) * START[2]
            missed, parted, steps = missed + (not grows), parted + (grows != above), steps + 1
    return missed / steps, parted / steps


def _mass():
    """Moment of inertia of the frozen liquid as a sphere over the body's, less 1; how many of the statements
    "radius 1.69 m" and "25 t" are not so."""
    radius = (P0 * 525 / (8 * math.pi)) ** (1 / 7)
    mass = DENSITY * 4 / 3 * math.pi * radius**3
    return 2 / 5 * mass * radius**2 / MOMENTS[2] - 1, (abs(radius - 1.69) > 0.005) + (abs(mass - 25e3) > 500)


def _resistance():
    """Of the averaged motion: steps of zeta downwards after which the amplitude at the end is not smaller;
    upwards."""
    ends = [float(averaged(scene(zeta=zeta), START, (0.0, END)).amplitude[-1]) for zeta in RESISTANCES]
    steps = list(zip(ends, ends[1:]))  # (at the smaller zeta, at the larger)
    return sum(not small < large for small, large in steps), sum(not large < small for small, large in steps)


def _charge():
    """Relative change of the frequency from e = 0.01 to 10,000 C; of that with the charge's moment taken off
    the wheel instead."""
    plain, charged = scene(), scene(charge=1e4)
    instead = scene(wheel=float(constants(charged)["Gamma"]), charge=0)
    return abs(_frequency(charged) / _frequency(plain)
               - 1), abs(_frequency(charged) / _frequency(instead) - 1)


STEPS = {"zeta": RESISTANCES, "torque": (-3.0, -6.0, -9.0), "wheel": WHEELS[1]}


@lru_cache
def _run(parameter, value):
    return averaged(scene(**{parameter: value}), START, np.linspace(0, END, 401))


def _trend(quantity, parameter, goes, truth=""):
    """How amplitude or spin at 20 s, or the angle by which (p, q) has turned, goes along the paper's values.
    """
    return trend([abs(float(getattr(_run(parameter, value), quantity)[-1])) for value in STEPS[parameter]],
                 goes, truth)


def _turns_back(parameter):
    """How many of the three motions have their largest phase at the end; how many have not."""
    grown = sum(int(_run(parameter, value).phase.argmax()) == 400 for value in STEPS[parameter])
    return grown, len(STEPS[parameter]) - grown


TESTS = {"trend": _trend, "turns back": _turns_back,
         "mass": _mass, "wheel frequency": _wheel,
         "resistance": _resistance, "charge": _charge}
