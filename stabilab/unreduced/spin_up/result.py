"""What is known of spin-up from one state."""
from __future__ import annotations

from dataclasses import dataclass

from ...orbit.result import Fate
from ...shown import Shown
from .clock import SteadyTrap, Trap


@dataclass(frozen=True, repr=False)
class SpinUp(Shown):
    """The fate of one motion as far as spin-up decides it.

    fate: SPIN_UP, BOUNDED (exact cases alone) or UNDECIDED. axis: 1, 2, 3 of the body, 0 where it is none; sense: +1 or -1 about it, 0
    where undecided; direction: unit vector in principal axes along which the rate grows, None where undecided. level: "exact" (by a closed
    solution), "certified" (the theorem's inequality holds for the state at time t of a run in machine precision and for a ball about it
    that holds the run's rounding), "proved" (the way to the inequality is enclosed, `enclosure.proof`; t is exact, state the middle of what
    holds it) or "undecided". trap: bounds and clocks. t: when it fired, or how long the motion was followed; state there; steps. cause:
    words. condition: growth of a small change of the start, across the motion, on the way to t. passed: steps that the way to t takes one by one; steps are
    those computed, fewer where a slow drift is run over many revolutions at once (`way.drift`).
    """

    fate: Fate
    axis: int
    sense: int
    direction: tuple | None
    level: str
    trap: Trap | SteadyTrap | None
    t: float
    state: tuple
    steps: int
    cause: str
    condition: float
    passed: float = 0.0
