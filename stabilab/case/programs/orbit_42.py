"""The orbit of a spacecraft of NASA's simulator 42, in the file Orb_*.txt that Inp_Sim.txt in its folder
names for it; and its motion relative to inertial space, where its file gives rates relative to the orbit
frame.

42 (InitSpacecraft in 42init.c, FindCLN in orbkit.c) adds C_BL w_LN to such rates; the orbit frame L has its
third axis to the centre and its second against the angular momentum of the orbit, so that on a circular
orbit w_LN = (0, -n, 0).
"""
from __future__ import annotations

import os
import re
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError
from ...numbers.exact import sqrt_fraction
from ...numbers.units import pi
from ..sections import ATTRACTION, EARTH
from ..source import source_text
from .imported import Craft
from .parts import of_quaternion

SIMULATION = "Inp_Sim.txt"
# attraction, m^3/s^2, and radius, m, from which heights count: those of 42 (LoadPlanets and LoadMoonOfEarth
# in 42init.c); of the Earth those of [circular_orbit]
WORLDS = {"EARTH": ("the Earth", ATTRACTION, EARTH),
          "LUNA": ("the Moon", Fraction("4.902801e12"), Fraction(1738000)),
          "MERCURY": ("Mercury", Fraction("2.18e13"), Fraction(2420000)),
          "VENUS": ("Venus", Fraction("3.2485e14"), Fraction(6100000)),
          "MARS": ("Mars", Fraction("4.293e13"), Fraction(3410000)),
          "JUPITER": ("Jupiter", Fraction("1.2761e17"), Fraction(71400000)),
          "SATURN": ("Saturn", Fraction("3.792e16"), Fraction(60400000))}
KINDS = {"ZERO": "none: it stays where it is", "FLIGHT": "none: it moves near the ground",
         "THREE_BODY": "about a libration point of three bodies"}
GIVEN = {"RV": "by position and velocity", "FILE": "in a file of elements or of positions"}


class Unknown(Exception):
    """Why the orbit, or the rates relative to inertial space, are not known."""


class Circular(NamedTuple):
    """A circular orbit. altitude: km, as it is written; world: in words; rate: deg/s, to 240 bits; file: that
    says so."""

    altitude: str
    world: str
    rate: Fraction
    file: str

    @property
    def key(self) -> str:
        """The line of [circular_orbit]."""
        return (f'altitude = "{self.altitude} km"' if self.world == WORLDS["EARTH"][0]
                else f'rate = "{float(self.rate):.12g} deg/s"')

    @property
    def words(self) -> str:
        """What it is, for a sentence."""
        return f"circular orbit of {self.altitude} km above {self.world}"


def orbit_beside(path: Any) -> Circular:
    """The circular orbit of a spacecraft file, which Inp_Sim.txt beside it names. Raises Unknown."""
    folder, name = os.path.split(os.fspath(path))
    try:
        simulation = source_text(os.path.join(folder, SIMULATION))
    except InputError:
        raise Unknown(f"no {SIMULATION} beside it names its orbit") from None
    listed = set(re.findall(rf"^\s*(?:TRUE|FALSE)\s+(\d+)\s+{re.escape(name)}\s", simulation, re.M))
    if len(listed) != 1:
        raise Unknown(f"{SIMULATION} beside it names {len(listed) or 'no'} orbits for it")
    number, = listed
    orbit = re.search(rf"^\s*(?:TRUE|FALSE)\s+(\S+)\s+!.*\bOrb {number}\s*$", simulation, re.M)
    if not orbit:
        raise Unknown(f"{SIMULATION} beside it names no file for orbit {number}")
    try:
        text = source_text(os.path.join(folder, orbit[1]))
    except InputError:
        raise Unknown(f"its orbit file {orbit[1]} is not beside it") from None
    return circular(text, orbit[1])


def circular(text: str, name: str) -> Circular:
    """The circular orbit in the text of an orbit file. Raises Unknown of any other orbit."""
    values = {label.strip().lower(): value.split() for value, mark, label in
              (line.partition("!") for line in text.splitlines()) if mark}

    def of(label: str) -> list[str]:
        return next((value for key, value in values.items() if key.startswith(label)), [""])

    kind, world, elements = (" ".join(of(label)) for label in ("orbit type", "orbit center", "use keplerian"))
    if kind != "CENTRAL":
        raise Unknown(f"the orbit of {name} is {KINDS.get(kind, f'of the type {kind}')}")
    if elements != "KEP":
        raise Unknown(f"the orbit of {name} is given {GIVEN.get(elements, f'as {elements}')}, not in "
                      "elements")
    if world not in WORLDS:
        raise Unknown(f"the orbit of {name} is about {world}, whose attraction is not known here")
    low_high = "PA" in of("use peri/apoapsis")
    numbers = of("periapsis & apoapsis" if low_high else "min altitude")
    try:
        first, second = map(Fraction, numbers)
    except ValueError:
        raise Unknown(f"{name} gives no altitude that is understood") from None
    words, attraction, radius = WORLDS[world]
    low = 1000 * first + radius
    if low <= 0:
        raise Unknown(f"{name} gives an altitude below the centre of {words}")
    if second != (first if low_high else 0):
        far = 1000 * second + radius
        eccentricity = (far - low) / (far + low) if low_high else second
        raise Unknown(f"the orbit of {name} is not circular (eccentricity {float(eccentricity):.3g}): its "
                      "rate changes along it")
    return Circular(numbers[0], words, sqrt_fraction(attraction / low**3) * 180 / pi(), name)


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
    orbit = orbit_beside(path)
    turning = to_body @ np.array([Fraction(0), -orbit.rate, Fraction(0)])
    supplied = [Fraction(v) for v in craft.rate or ("0", "0", "0")]
    craft.rate = [f"{float(a + b):.12g}" for a, b in zip(supplied, turning)]
    craft.orbit = orbit.key
    craft.said.append("the angular velocity relative to the orbit frame becomes that relative to inertial "
                      f"space on the {orbit.words}, of {orbit.file}")


def name_orbit(craft: Craft, path: Any) -> None:
    """Say of the orbit beside a craft whose rates do not need it what it is, or why it is not read."""
    try:
        orbit = orbit_beside(path)
    except Unknown as error:
        if SIMULATION not in str(error):  # what names no orbit for it leaves none out
            craft.omitted.append(str(error))
        return
    craft.omitted.append(f"its orbit: a {orbit.words} ({orbit.file}), {float(orbit.rate):.6g} deg/s; for "
                         f"`stabilab orbit` add [circular_orbit] {orbit.key}")
