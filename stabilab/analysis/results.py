"""What the analyses answer: frozen results that say how well they are known."""
from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Callable


class Fate(IntEnum):
    """What becomes of a state as time goes on."""

    BOUNDED = 0
    SPIN_UP = 1
    SEPARATRIX = 2
    EQUILIBRIUM = 3
    UNDECIDED = 4

    @property
    def word(self) -> str:
        """The word used in reports and JSON."""
        return ("bounded", "spin-up", "separatrix", "equilibrium", "undecided")[self]


@dataclass(frozen=True)
class EquilibriumPoint:
    """One equilibrium with its verdicts.

    at: three components in the scene's variables. eigenvalues: of the Jacobian there (1/s, or 1/tau when scaled).
    linear: "stable" (centre), "unstable", "degenerate". verdict: "stable", "unstable", "undecided" (Lyapunov sense,
    for the full nonlinear motion), because: its proof in words.
    """

    at: tuple[float, float, float]
    eigenvalues: tuple[complex, complex, complex]
    linear: str
    verdict: str
    because: str


@dataclass(frozen=True)
class CurveSegment:
    """A piece of an equilibrium curve with one verdict; `t` is the open parameter interval (ends may be infinite)."""

    t: tuple[float, float]
    linear: str
    verdict: str
    because: str


@dataclass(frozen=True)
class EquilibriumCurve:
    """A curve of equilibria: point(t) -> (x1, x2, x3) for t inside the segments' intervals.

    equation and parametrisation in symbols; folds are the points between segments where the linear verdict is
    degenerate; samples are equilibria spread over every segment.
    """

    name: str
    equation: str
    parametrisation: str
    point: Callable[[float], tuple[float, float, float]] = field(repr=False, compare=False)
    segments: tuple[CurveSegment, ...] = ()
    folds: tuple[tuple[float, float, float], ...] = ()
    samples: tuple[EquilibriumPoint, ...] = ()


@dataclass(frozen=True)
class Equilibria:
    """All equilibria of a scene. kind: "none", "points", "curves" (curves, possibly with points) or "all" (every
    state is one); reason: why these and no others."""

    kind: str
    reason: str
    points: tuple[EquilibriumPoint, ...] = ()
    curves: tuple[EquilibriumCurve, ...] = ()


@dataclass(frozen=True)
class Motion:
    """Everything known about the motion from one state.

    axis: 1, 2, 3 of the spin-up, 0 otherwise; sense: +1 or -1 of the spin-up, 0 otherwise.
    margin_energy: height of the barrier ahead minus energy (negative above it; None where no barrier stands ahead at
    this value of the invariant). margin_velocity: smallest change of the state that reaches the separatrix, at
    whatever value of the invariant (None where the scene has none). period: None where the motion does not repeat. extremes: ((min, max),) * 3 over t >= 0, entries +-inf where
    unbounded, None where unknown; extremes_over: "all time" or the span they were searched over.
    """

    at: tuple[float, float, float]
    fate: Fate
    because: str
    axis: int = 0
    sense: int = 0
    margin_energy: float | None = None
    margin_velocity: float | None = None
    period: float | None = None
    extremes: tuple | None = None
    extremes_over: str = "all time"
    invariants: dict[str, float] = field(default_factory=dict)
    evidence: dict = field(default_factory=dict)
    tolerance: float | None = None


@dataclass(frozen=True)
class Sheet:
    """One sheet of the separatrix as a parametric grid.

    points: (n, m, 3) array; row r is the homoclinic curve at one value of the invariant, rows run from the fold
    outward, columns run once around the loop from the saddle (column 0) back to the saddle (column -1).
    residual: (n, m) distance from the surface in energy, relative to the scale of the energy terms.
    saddle: (n, 3) the saddle equilibria at the rows; centre: (n, 3) the enclosed centres. error: estimate, from the
    grid's second differences, of the largest distance of flat facets from the surface, in the unit of the points; cut: +1
    where facets of the first half of the columns are cut from (r, c) to (r + 1, c + 1), -1 the other way; the second half
    mirrors it.
    """

    name: str
    points: object
    residual: object
    saddle: object
    centre: object
    invariant: object
    error: float | None = None
    cut: int = 1


@dataclass(frozen=True)
class Separatrix:
    """Every sheet of the separatrix inside the asked-for range; reason says why there is none or what bounds it."""

    sheets: tuple[Sheet, ...]
    reason: str


@dataclass(frozen=True)
class Trajectory:
    """States at the asked-for times.

    t: (n,) times; states: (n, N), blocks: where each block of the state stands in the N columns; invariant_drift: law name -> largest relative departure from it over the run;
    counters: integrator's own counts (steps, rate evaluations); status: "reached", "stopped" (reason says why).
    """

    t: object
    states: object
    method: str
    rtol: float
    invariant_drift: dict[str, float]
    counters: dict[str, int]
    status: str
    reason: str
    blocks: dict = field(default_factory=lambda: {"omega": slice(0, 3)})

    def block(self, name: str):
        """(n, m) states of one block."""
        return self.states[:, self.blocks[name]]
