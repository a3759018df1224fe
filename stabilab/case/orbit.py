"""[circular_orbit] of a case file: the circular orbit of a satellite, by its rate, its period, or its height
or radius about the Earth."""
from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from ..numbers.units import pi
from ..physics.effects.base import Effect
from .table import Table

KEYS = ("rate", "period", "altitude", "radius")
ATTRACTION = Fraction(398600441800000)  # of the Earth, m^3/s^2 (IERS Conventions 2010, in round numbers)
EARTH = Fraction(6378137)  # its equatorial radius, m (WGS 84)
ONLY = ("a satellite on a circular orbit, and this question takes a body without gravity gradient: ask "
        "`stabilab orbit` (stabilab.circular_orbit), or take away [circular_orbit]")
NONE = ('expected a table [circular_orbit] with rate, period, altitude or radius, such as '
        'altitude = "700 km"')
WHEELS = ("on a circular orbit only wheels are known beside the gravity gradient: take it away, or "
          "take away [circular_orbit]")


def judge_orbit(top: Table, effects: Iterable[Effect], orbiting: bool):
    """Note an orbit where the question knows none; where it asks for one, what acts beside it, or, of a file
    without another fault, that there is none."""
    if not orbiting:
        if "circular_orbit" in top:
            top.fault(ONLY, "circular_orbit")
        return
    if "circular_orbit" not in top:
        if not top.faults.problems:
            top.fault(NONE)
    elif (table := top.table("circular_orbit")) is not None:
        rate_squared(table)
    for key in ("scaled", "sweep"):
        if key in top:
            top.fault(f"a circular orbit takes one body in SI units: take away [{key}]", key)
    for effect in effects:
        if effect.name != "gyrostat":
            given = effect.name in top.data.get("effects", {})
            top.fault(WHEELS, *(("effects", effect.name) if given else ("thrusters",)))


def rate_squared(table: Table) -> Fraction | None:
    """n^2, 1/s^2, of a circular orbit; None where it is at fault."""
    table.known(KEYS)
    key = table.one_of(*KEYS)
    if key is None:
        if not any(one in table for one in KEYS):
            table.fault(NONE.replace("a table [circular_orbit] with", "one of"))
        return None
    value = table.number(key)
    if value is None:
        return None
    least = EARTH if key == "radius" else Fraction(0)
    if value <= least:
        cures = {"rate": 'the angular velocity of the orbit is positive, such as rate = "0.06 deg/s"',
                 "period": 'a revolution takes a positive time, such as period = "98 min"',
                 "altitude": 'the height above the equatorial radius of the Earth is positive, such as '
                             'altitude = "700 km"',
                 "radius": 'the distance from the centre of the Earth exceeds its equatorial radius, '
                           '6378.137 km; about another body give the rate or the period'}
        table.fault(f"got {float(value):.10g}: {cures[key]}", key)
        return None
    if key == "rate":
        return value**2
    return ((2 * pi() / value)**2 if key == "period"
            else ATTRACTION / (value + (EARTH if key == "altitude" else 0))**3)
