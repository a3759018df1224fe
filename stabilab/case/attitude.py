"""The attitude of a case at t = 0: its angles and its vertical must agree."""
from __future__ import annotations

import math

from ..numbers.vectors import Float3
from ..physics.scene import ordered

SLACK = 1e-6  # of a component: a direction given to six decimals is consistent


def vertical_of(psi, phi, theta=0.0) -> Float3:
    """Inertial axis 3 in the body frame at 3-1-2 angles, rad: the third row of R = Rz(theta) Rx(psi) Ry(phi).
    """
    return (-math.cos(psi) * math.sin(phi), math.sin(psi), math.cos(psi) * math.cos(phi))


def attitude_of(vertical) -> Float3:
    """The angles psi, phi, theta = 0 at which inertial axis 3 is `vertical`, a unit vector, body frame."""
    x, y, z = vertical
    return math.atan2(y, math.hypot(x, z)), math.atan2(-x, z), 0.0


def judge_attitude(table, given, scene):
    """Note a vertical and an attitude of [motion] that contradict each other. given: the blocks that the file
    gives; the zero angles that an attitude starts at where the file gives none count too."""
    needed = ordered((*getattr(scene, "blocks", ()), *given))
    if "gamma" not in given or "attitude" not in needed:
        return
    angles, vertical = given.get("attitude", (0.0, 0.0, 0.0)), given["gamma"]
    if math.dist(vertical_of(*angles), vertical) <= SLACK:
        return
    if "attitude" not in given:
        table.fault(f"attitude is missing: zero angles have the vertical [0, 0, 1], not "
                    f"{_written(vertical)}; with theta = 0 that is "
                    f"attitude = {_written(attitude_of(vertical))}", "vertical")
        return
    table.fault(f"contradicts attitude: the angles {_written(angles)} have the vertical "
                f"{_written(vertical_of(*angles))} (inertial axis 3, "
                f"body frame), got {_written(vertical)}; leave one of them as it is and make the other agree",
                "vertical")


def _written(vector) -> str:
    return f"[{', '.join(f'{v + 0.0:.10g}' for v in vector)}]"
