"""The motion of a spacecraft of NASA's simulator 42 relative to inertial space, where its file gives rates
relative to the orbit frame: with the orbit file that Inp_Sim.txt in its folder names for it.

42 (InitSpacecraft in 42init.c, FindCLN in orbkit.c) adds C_BL w_LN to such rates; the orbit frame L has its
third axis to the centre and its second against the angular momentum of the orbit, so that on a circular
orbit w_LN = (0, -n, 0).
"""
from __future__ import annotations

import os
import re
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ...errors import InputError
from ...numbers.exact import sqrt_fraction
from ...numbers.units import pi
from ..sections import ATTRACTION, EARTH
from ..source import source_text
from .imported import Craft
from .parts import of_quaternion


class Unknown(Exception):
    """Why the rates relative to inertial space are not known."""


def altitude_beside(path: Any) -> str:
    """The height in km, as it is written, of the circular orbit about the Earth of a spacecraft file. Raises
    Unknown."""
    folder, name = os.path.split(os.fspath(path))
    try:
        simulation = source_text(os.path.join(folder, "Inp_Sim.txt"))
    except InputError:
        raise Unknown("no Inp_Sim.txt beside it names its orbit") from None
    listed = set(re.findall(rf"^\s*(?:TRUE|FALSE)\s+(\d+)\s+{re.escape(name)}\s", simulation, re.M))
    if len(listed) != 1:
        raise Unknown(f"Inp_Sim.txt beside it names {len(listed) or 'no'} orbits for it")
    number, = listed
    orbit = re.search(rf"^\s*(?:TRUE|FALSE)\s+(\S+)\s+!.*\bOrb {number}\s*$", simulation, re.M)
    if not orbit:
        raise Unknown(f"Inp_Sim.txt beside it names no file for orbit {number}")
    try:
        text = source_text(os.path.join(folder, orbit[1]))
    except InputError:
        raise Unknown(f"its orbit file {orbit[1]} is not beside it") from None
    return _altitude(text, orbit[1])


def _altitude(text: str, name: str) -> str:
    values = {label.strip().lower(): value.split() for value, mark, label in
              (line.partition("!") for line in text.splitlines()) if mark}

    def of(label: str) -> list[str]:
        return next((value for key, value in values.items() if key.startswith(label)), [""])

    if of("orbit type") != ["CENTRAL"] or of("orbit center") != ["EARTH"] or of("use keplerian") != ["KEP"]:
        raise Unknown(f"{name} is no orbit about the Earth in Keplerian elements")
    low_high = "PA" in of("use peri/apoapsis")
    numbers = of("periapsis & apoapsis" if low_high else "min altitude")
    try:
        first, second = map(Fraction, numbers)
    except ValueError:
        raise Unknown(f"{name} gives no altitude that is understood") from None
    if second != (first if low_high else 0):
        raise Unknown(f"the orbit of {name} is not circular: its rate changes along it")
    return numbers[0]


def rate_of_orbit(altitude: str) -> Fraction:
    """n of a circular orbit about the Earth at this height in km, deg/s, to 240 bits."""
    return sqrt_fraction(ATTRACTION / (1000 * Fraction(altitude) + EARTH)**3) * 180 / pi()


def from_quaternion(q: Sequence[str]) -> np.ndarray:
    """What turns components of the frame to those of the body, of 42's quaternion (the scalar last), as its
    Q2C has it; exact, of any length but zero."""
    x, y, z, w = map(Fraction, q)
    if not any((x, y, z, w)):
        raise Unknown("its quaternion is zero")
    return of_quaternion(w, (x, y, z))


def add_orbit(craft: Craft, path: Any, to_body: np.ndarray) -> None:
    """The rates of the craft, deg/s, relative to inertial space, and its orbit. to_body: what turns
    components of the orbit frame to those of the body. Raises Unknown."""
    altitude = altitude_beside(path)
    turning = to_body @ np.array([Fraction(0), -rate_of_orbit(altitude), Fraction(0)])
    supplied = [Fraction(v) for v in craft.rate or ("0", "0", "0")]
    craft.rate = [f"{float(a + b):.12g}" for a, b in zip(supplied, turning)]
    craft.altitude = altitude
    craft.said.append("the angular velocity relative to the orbit frame becomes that relative to inertial "
                      f"space on the circular orbit of {altitude} km beside it")
