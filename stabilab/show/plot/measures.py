"""The units of the axes of a plot: name and factor of rates, times and angles, and the names of components."""
from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError
from ..units import SYSTEMS, Units
from .subject import Subject


@dataclass(frozen=True)
class Measures:
    """rate, angle: (name, how many make one of the scene's); names: of the three components, in TeX; size: of |omega|, empty when scaled."""

    rate: tuple[str, float]
    angle: tuple[str, float]
    names: tuple[str, ...]
    size: str
    system: Units | None

    def time(self, longest: float) -> tuple[str, float]:
        """(name, factor) of the times of a plot that goes so far."""
        return (r"$\tau$", 1.0) if self.system is None else self.system.times(longest)

    def plain(self, axis: int) -> str:
        """The name of a component for text that is not typeset."""
        return ("ω" if self.size else "x") + "₁₂₃"[axis]

    def label(self, words: str, unit: str) -> str:
        """A label of an axis with its unit, where it has one."""
        return f"{words} ({unit})" if unit else words


def measures(one: Subject, units: str | None = None) -> Measures:
    """Those of a subject: units "deg" (deg/s, deg; seconds, minutes or hours) or "si" (rad/s, rad, s), None for those of the case, else "deg"; scaled
    scenes have none."""
    if units is not None and units not in SYSTEMS:
        raise InputError(f"units: expected one of {', '.join(SYSTEMS)}, got {units!r:.40}")
    if not one.physical:
        return Measures(("", 1.0), ("", 1.0), ("$x_1$", "$x_2$", "$x_3$"), "", None)
    found = SYSTEMS[units or (one.case is not None and one.case.units) or "deg"]
    return Measures(found.rates, found.angles, (r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"), r"$|\omega|$", found)
