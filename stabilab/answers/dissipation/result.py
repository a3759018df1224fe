"""What becomes of a free body that loses energy: the result."""
from __future__ import annotations

from dataclasses import dataclass, field

from ...caveat import Caveat
from ...numbers.vectors import Float3
from ...representation import Compared, Shown

POSITIVE, NEGATIVE = "positive major axis", "negative major axis"
ACROSS, UNDECIDED = "across the minor axis", "undecided"


@dataclass(frozen=True)
class Time:
    """A time, s, known to `error`, s: what a second run from a start moved in its last places, with a coarser
    tolerance, differs by."""

    at: float
    error: float


@dataclass(frozen=True)
class Span:
    """How far one number of the start, or of the damper, may go down and up before the outcome is another;
    their sum is the width of the band of one outcome. name: "phase" (rad: the transverse angular momentum
    turned about the minor axis along the polhode), "nutation" (relative, of the sine of the nutation angle)
    or "damping" (relative, of the strength of what takes energy)."""

    name: str
    down: float
    up: float


@dataclass(frozen=True, eq=False, repr=False)
class FlatSpin(Shown, Compared):
    """What internal dissipation makes of a spin.

    outcome: "positive major axis", "negative major axis", "across the minor axis" (two greatest moments are
    equal: about some axis in their plane) or "undecided"; because: how it is known, or why it is not; level:
    "exact", "run" (a run and a second one agree) or "undecided". axis: of the greatest moment, 1 to 3, and
    minor: of the least; momentum: |H|, N m s; final_rate: |H|/(greatest moment), rad/s; rates: rad/s, along
    the principal axes, at the end, None where it is undecided or across. energy, final_energy: J, now and at
    the end.

    The nutation angle is that of the polhode: the largest angle between the angular momentum and an axis in
    the free motion of the same T and |H|. leaves: when it exceeds `within`, rad, from the minor axis;
    crosses: when the separatrix is crossed, 2 T D2 = |H|^2, D2 the intermediate moment; settles: when it is
    at most `within` from the major axis, which it then stays. Each None where it is past at the start, or not
    reached. growth, decay: s, time constants of the nutation near the minor and the major axis, by
    eigenvalues, None where there are none. spans: by how much the start may change. steps: of the first run.
    """

    outcome: str
    because: str
    level: str
    axis: int
    minor: int
    momentum: float
    final_rate: float
    rates: Float3 | None
    energy: float
    final_energy: float
    within: float
    leaves: Time | None = None
    crosses: Time | None = None
    settles: Time | None = None
    growth: float | None = None
    decay: float | None = None
    spans: tuple[Span, ...] = ()
    steps: int = 0
    caveats: tuple[Caveat, ...] = field(default=(), repr=False)

    @property
    def lost(self) -> float:
        """The energy that is lost in all, J."""
        return self.energy - self.final_energy

    @property
    def passage(self) -> float | None:
        """From leaving the minor axis to settling at the major one, s."""
        return None if self.leaves is None or self.settles is None else self.settles.at - self.leaves.at
