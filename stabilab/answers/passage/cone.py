"""The torques that a misalignment allows: of the thrusters that state one, else of the whole torque tilted by an angle."""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, cast

import numpy as np

from ...physics.scene import Scene

UP = 1 + 1e-12  # more than the rounding of these few doubles


@dataclass(frozen=True)
class Cone:
    """torque: on its axis, N m, principal axes; parts: what each tilted force or torque adds: (whole (3,), first (3,), second (3,), half-angle): at
    azimuth phi the change is (cos - 1) whole + sin (cos phi first + sin phi second). words: what is tilted; angle: the largest half-angle."""

    torque: np.ndarray
    parts: tuple[Any, ...]
    words: str
    angle: float

    def at(self, azimuth: float) -> np.ndarray:
        """The torque (3,) at the edge of the cone."""
        return self.torque + sum((math.cos(a) - 1) * whole + math.sin(a) * (math.cos(azimuth) * first + math.sin(azimuth) * second)
                                 for whole, first, second, a in self.parts)

    def reach(self) -> tuple[float, tuple[float, float]]:
        """(most of the part across the axis, (least, most) of the component along it) of every torque in the cone."""
        axis = int(np.argmax(np.abs(self.torque)))
        across = [n for n in range(3) if n != axis]
        side = sum((1 - math.cos(a)) * math.hypot(*whole[across]) + math.sin(a) * np.linalg.norm(np.stack([first, second])[:, across], 2)
                   for whole, first, second, a in self.parts)
        along = sum((1 - math.cos(a)) * abs(whole[axis]) + math.sin(a) * math.hypot(first[axis], second[axis]) for whole, first, second, a in self.parts)
        blur = (UP - 1) * (float(np.abs(self.torque).max()) + side + along)
        return float(side) + blur, (float(self.torque[axis] - along) - blur, float(self.torque[axis] + along) + blur)


def cone_of(scene: Scene, case: Any = None, angle: float | None = None) -> Cone:
    """The cone of a scene's torque: tilted as a whole by `angle`, or, without it, as the stuck thrusters of the case state.

    Azimuth 0 of a torque along an axis lies towards the axis that follows it, cyclically; of another across the axis that is farthest from it; of a
    thruster, across the structural axis that is farthest from its force.
    """
    torque = np.array([float(v) for v in scene.vector("constant_torque")])
    axis = int(np.argmax(np.abs(torque)))
    loose = [] if angle is not None or case is None else [t for t in case.thrusters if t.stuck and t.misalignment]
    if loose:
        parts = tuple(_of_force(case, thruster) for thruster in loose)
        return Cone(torque, parts, "the force of " + " and ".join(t.name for t in loose), max(part[-1] for part in parts))
    first, second = (abs(torque[axis]) * np.eye(3)[(axis + n) % 3] for n in (1, 2))
    if np.count_nonzero(torque) > 1:
        first = np.cross(np.eye(3)[int(np.argmin(np.abs(torque)))], torque)
        first *= np.linalg.norm(torque) / np.linalg.norm(first)
        second = np.cross(torque, first) / np.linalg.norm(torque)
    return Cone(torque, ((torque, first, second, angle),), "the torque", cast(float, angle))


def _of_force(case: Any, thruster: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """(whole, first, second, half-angle) of the torque of a thruster whose force points anywhere in its cone, along principal axes."""
    force = np.array([float(v) for v in thruster.direction])
    arm = np.array([float(v) for v in thruster.arm])
    aside = np.eye(3)[int(np.argmin(np.abs(force)))]
    first = np.cross(aside, force)
    first /= np.linalg.norm(first)
    frame = np.array([[float(v) for v in axis] for axis in case.frame.axes])
    turned = [frame @ np.cross(arm, float(thruster.force) * v) for v in (force, first, np.cross(force, first))]
    return turned[0], turned[1], turned[2], float(thruster.misalignment)


def tilted(scene: Scene, torque: np.ndarray) -> Scene:
    """The scene under another torque (3,), its doubles taken at their word."""
    others = [effect for effect in scene.effects if effect.name != "constant_torque"]
    kind = type(scene.effect("constant_torque"))
    return Scene(scene.body, *others, kind(tuple(Fraction(float(v)) for v in torque)))
