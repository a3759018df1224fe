"""The attitude of a body at the times of the pictures of a film, and the box that stands for the body."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....answers.simulate import simulate
from ....answers.trajectory import trajectory
from ....case.attitude import attitude_of
from ....errors import InputError
from ....physics.attitude import quaternion
from ....physics.equations import rotation
from ....physics.states import start_of
from ...units import SHORT, Units
from ..subject import DEFAULT_SPAN, Subject

FRAMES = 150
STEP = np.radians(15)  # a body turns by no more from one picture to the next: the eye would see it turn backwards
ROUNDED, NEAR, TRIES = 1.02, 1.1, 20  # of a step's width; of the length of a film, to which its longest is found, in so many runs
THINNEST = 0.06  # of the longest edge
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))  # across axes 1, 1, 2, 2, 3, 3


@dataclass(frozen=True)
class Turn:
    """t: (n,) s; rotations: (n, 3, 3) from body to space; omega: (n, 3) rad/s; edges: (3,) half edges of the box, the longest 1;
    whole: whether the span that was asked for is shown to its end; asked: its length, s."""

    t: np.ndarray
    rotations: np.ndarray
    omega: np.ndarray
    edges: np.ndarray
    whole: bool
    asked: float

    def part(self, units: Units) -> str:
        """What is said of a film that ends before its span."""
        return "" if self.whole else f"The first {units.time(float(abs(self.t[-1] - self.t[0])), SHORT)} of {units.time(self.asked, SHORT)} are shown."


def turn(one: Subject, frames: int = FRAMES) -> Turn:
    """The motion in so many pictures, from the start of its span on: as far as it goes, or as the pictures reach at `STEP`."""
    if not 2 <= frames <= 5000:
        raise InputError(f"frames: expected 2 to 5000, got {frames!r:.40}")
    low, high = one.span or DEFAULT_SPAN
    (t, rotations, omega), whole = _reached(one, low, high, frames)
    scene: Any = one.scene  # physical: `which` refuses the others
    return Turn(t, rotations, omega, edges(scene.body.inertia), whole, abs(high - low))


def _reached(one, low, high, frames):
    """(the motion at the times of the pictures, whether they reach the end of the span). The greatest rate up to an end grows with it, so the ends at which
    no step is too wide are those up to one; it is enclosed between one that is short enough and one that is too long."""
    length, direction, short, long, kept = abs(high - low), float(np.sign(high - low)), 0.0, math.inf, None
    for _ in range(TRIES):
        found = _at(one, low + direction * np.linspace(0.0, length, frames))
        fastest = float(np.linalg.norm(found[2], axis=1).max(initial=0.0))
        reach = STEP * (frames - 1) / fastest if fastest else math.inf
        if length <= ROUNDED * reach:
            if math.isinf(long):
                return found, True
            short, kept = length, found
        else:
            short, long = max(short, reach), length  # a shorter way meets no greater rate
        if kept is not None and long <= NEAR * short:
            break
        length = math.sqrt(short * long)
    return kept or _at(one, low + direction * np.linspace(0.0, short, frames)), False


def _at(one, times):
    """(times, rotations, rates), as far as the run goes."""
    upright = attitude_of(one.blocks["gamma"]) if "gamma" in one.blocks else (0.0, 0.0, 0.0)
    first = tuple(one.blocks.get("attitude", upright))
    blocks = {**one.blocks, "attitude": first}
    if one.scene.plain:
        run = trajectory(one.scene, start_of(one.scene, one.state, blocks), times, laws=False)
        t, omega, attitudes = run.t, run.block("omega"), run.block("attitude")
    else:
        found = simulate(one.scene, one.state, times, blocks)
        t, omega = found.t, found.state["omega"]
        attitudes = np.array([quaternion(*row) for row in found.state["angles"]])
    if len(t) < 2:
        raise InputError("plot attitude: the motion cannot be followed: the run stopped at its start")
    return t, np.moveaxis(np.array(rotation(attitudes.T)), -1, 0), omega


def edges(inertia) -> np.ndarray:
    """(3,) half edges of the even box with these moments, the longest 1; a thin one where two moments make the third."""
    D = np.array([float(d) for d in inertia])
    found = np.sqrt(np.maximum(D.sum() - 2 * D, 0.0))  # m a_i^2 / 6 = D_j + D_k - D_i for edges a
    return np.maximum(found / found.max(), THINNEST)
