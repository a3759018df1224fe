"""Equilibria as curves and points to draw, and how each verdict looks."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ....equilibrium.result import Equilibria, EquilibriumCurve
from ... import style
from ...sampling import spread

CURVES: dict[str, dict[str, Any]] = {
    "stable": {"color": style.BLUE, "linestyle": "-", "linewidth": 2.0}, "unstable": {"color": style.VERMILION, "linestyle": "--", "linewidth": 1.8},
    "undecided": {"color": style.GREY, "linestyle": ":", "linewidth": 2.0}}
POINTS: dict[str, dict[str, Any]] = {
    "stable": {"marker": "o", "color": style.BLUE, "markersize": 7, "linestyle": "none"},
    "unstable": {"marker": "o", "markerfacecolor": "white", "markeredgecolor": style.VERMILION, "markeredgewidth": 1.8, "markersize": 7.5,
                 "linestyle": "none"},
    "undecided": {"marker": "D", "markerfacecolor": "white", "markeredgecolor": style.GREY, "markeredgewidth": 1.8, "markersize": 6.5,
                  "linestyle": "none"}}
FOLD: dict[str, Any] = {"marker": "D", "color": style.GREEN, "markersize": 6, "linestyle": "none"}
ROUND = np.linspace(0, 2 * np.pi, 73)


class Rest(NamedTuple):
    """curves: (verdict, points (n, 3)); planes: (verdict, two unit vectors that span it (2, 3)) through the origin; points: (verdict, place
    (3,)); folds: (n, 3), where curves change their verdict. Rates in the scene's variables."""

    curves: list[tuple[str, np.ndarray]]
    planes: list[tuple[str, np.ndarray]]
    points: list[tuple[str, np.ndarray]]
    folds: np.ndarray


def rest_states(found: Equilibria, number: int = 600) -> Rest:
    """All equilibria of a scene, so many on every piece of their curves."""
    curves, planes, folds = [], [], []
    for curve in found.curves:
        if curve.name.startswith("plane"):
            verdicts = [segment.verdict for segment in curve.segments]
            planes.append((simple(max(verdicts, key=verdicts.count)), plane_of(curve)))
            continue
        folds += [fold[:3] for fold in curve.folds]
        for segment in curve.segments:
            points = np.array([curve.point(float(t))[:3] for t in spread(*segment.t, number)], float)
            curves.append((simple(segment.verdict), points[np.isfinite(points).all(axis=1)]))
    return Rest(curves, planes, [(simple(p.verdict), np.array(p.at[:3], float)) for p in found.points], np.array(folds, float).reshape(-1, 3))


def simple(verdict: str) -> str:
    """"stable", "unstable" or "undecided" of the verdicts in words."""
    return "undecided" if verdict == "undecided" else "unstable" if "unstable" in verdict else "stable"


def plane_of(curve: EquilibriumCurve) -> np.ndarray:
    """Two unit vectors that span a plane of equilibria."""
    return np.linalg.svd(np.array([sample.at[:3] for sample in curve.samples], float), full_matrices=False)[2][:2]


def disc(spanning: np.ndarray, radius: float) -> np.ndarray:
    """The rim (n, 3) of a disc about the origin in the plane of two vectors."""
    return radius * (np.cos(ROUND)[:, None] * spanning[0] + np.sin(ROUND)[:, None] * spanning[1])


def meanings(rest: Rest, words: str = "equilibria") -> list[tuple[str, dict[str, Any]]]:
    """Rows of a legend for what there is."""
    rows = [(f"{kind} {words}", CURVES[kind]) for kind in CURVES if any(kind == one for one, *_ in rest.curves)]
    rows += [(f"plane of {kind} {words}", {"facecolor": CURVES[kind]["color"], "alpha": 0.35}) for kind in CURVES if any(kind == p for p, _ in rest.planes)]
    rows += [(f"{kind} equilibrium", POINTS[kind]) for kind in POINTS if any(kind == p for p, _ in rest.points)]
    return rows + ([("change of stability", FOLD)] if len(rest.folds) else [])
