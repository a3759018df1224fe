"""Limits that are never reached: a motion that rests, extremes or a bound over all time below the limit, or one whole period below it."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...numbers.vectors import Exact3, Float3
from ...orbit.result import Fate
from ...physics.quadratic import rests
from ...physics.scene import AnyScene
from ..extremes import extremes, period
from ..fate import fate
from ..kinds import kind_of
from ..motion import motion
from .limit import Limit
from .result import Found

SLACK = 1e-9  # relative: extremes and periods are known to 1e-11
REDUCED = ("orbit", "aligned", "free")


def never(scene: AnyScene, state: Float3, exact: Exact3, limit: Limit) -> tuple[Found | None, float | None]:
    """(the answer where extremes over all time stay below the limit, a time by which it is reached if ever or None). exact: three rationals."""
    if limit.kind == "tilt":
        return None, None
    if rests(scene.quadratic(), exact):
        return Found(math.inf, math.inf, "exact", f"{limit.words}: never, the state is an equilibrium"), None
    kind = kind_of(scene)
    if kind not in REDUCED:
        return None, None
    row = np.array(state, float)
    if kind == "aligned" and not _repeats(scene, row):
        return None, None  # its extremes over all time are not known
    if limit.beyond(extremes(scene, row).tolist(), SLACK):
        return Found(math.inf, math.inf, "exact", f"{limit.words}: never, the extremes over all time stay below it"), None
    if fate(scene, row).labels != Fate.BOUNDED:
        return None, None
    repeats = float(period(scene, row)) if kind == "orbit" else math.inf
    return None, repeats * (1 + SLACK) if 0 < repeats < math.inf else None


def _repeats(scene: AnyScene, row: np.ndarray) -> bool:
    return bool(fate(scene, row).labels == Fate.BOUNDED) and math.isfinite(float(period(scene, row)))


def after_a_period(limit: Limit) -> Found:
    """The answer where a whole period, enclosed, stays below the limit."""
    return Found(math.inf, math.inf, "proved", f"{limit.words}: never, the motion repeats and a whole period stays below it")


def never_bounded(scene: AnyScene, state: Any, limit: Limit) -> Found | None:
    """The answer for a scene of other effects, where energy or momentum bound the rate below the limit; None where they do not."""
    if limit.kind == "tilt":
        return None
    found = motion(scene, state, brief=True)
    bound = found.invariants.get("rate_bound", math.inf)
    if found.fate == Fate.EQUILIBRIUM or (found.fate == Fate.BOUNDED and limit.beyond_rate(bound * (1 + SLACK))):
        why = "the state is an equilibrium" if found.fate == Fate.EQUILIBRIUM else f"|omega| <= {bound:.6g} rad/s always"
        return Found(math.inf, math.inf, "exact", f"{limit.words}: never, {why}")
    return None
