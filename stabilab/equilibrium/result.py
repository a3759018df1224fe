"""Equilibria as data."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import TYPE_CHECKING

from ..numbers.vectors import Float3
from ..record import record
from ..shown import Shown

if TYPE_CHECKING:
    from ..physics.law_limits import Validity


@record
class EquilibriumPoint:
    """One equilibrium with its verdicts.

    at: three components in the scene's variables. eigenvalues: of the Jacobian there (1/s, or 1/tau when scaled).
    linear: "stable" (centre), "unstable", "degenerate". verdict: "stable", "unstable", "undecided" (Lyapunov sense,
    for the full nonlinear motion), because: its proof in words.
    """

    at: Float3
    eigenvalues: tuple[complex, ...]
    linear: str
    verdict: str
    because: str


@record
class CurveSegment:
    """A piece of an equilibrium curve with one verdict; `t` is the open parameter interval (ends may be infinite)."""

    t: tuple[float, float]
    linear: str
    verdict: str
    because: str


@record
class EquilibriumCurve:
    """A curve of equilibria: point(t) -> (x1, x2, x3) for t inside the segments' intervals.

    equation and parametrisation in symbols; folds are the points between segments where the linear verdict is
    degenerate; samples are equilibria spread over every segment.
    """

    name: str
    equation: str
    parametrisation: str
    point: Callable[[float], Float3] = field(repr=False, compare=False)
    segments: tuple[CurveSegment, ...] = ()
    folds: tuple[Float3, ...] = ()
    samples: tuple[EquilibriumPoint, ...] = ()


@record
class Equilibria(Shown):
    """All equilibria of a scene. kind: "none", "points", "curves" (curves, possibly with points) or "all" (every
    state is one); reason: why these and no others. validity: of an approximate law (`stabilab.physics.law_limits`), at the points; None where
    all laws are exact."""

    kind: str
    reason: str
    points: tuple[EquilibriumPoint, ...] = ()
    curves: tuple[EquilibriumCurve, ...] = ()
    validity: Validity | None = None
