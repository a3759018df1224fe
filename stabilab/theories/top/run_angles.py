"""Classical Euler angles psi, theta, phi of a run, followed through whole turns however far apart its times
are."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...errors import InputError
from ..follow import follow
from .euler_angles import EulerAngles, euler_angles

TO_A_TURN = 60  # points to a turn of the fastest rate: psi is then known to some 1e-7
MOST = 400_000


def with_euler_angles(case, run, model: str = "exact", order: int | None = None):
    """The run with a part "euler", (n, 3), rad: precession psi (0 at t = 0), nutation theta, rotation phi of
    the weight's direction gamma (Amer et al. 2023, fast top: eq. (42), corrected); its reason says where they
    are singular.

    The motion is followed again at times close enough for psi. Raises InputError where the state has no
    gamma.
    """
    if "gamma" not in run.state:
        raise InputError("angles: psi, theta, phi of the vertical need gamma in the state: an effect that "
                         "asks for it (gravity, "
                         "newtonian_field, a charge with angle = \"attitude\"), or vertical in [motion]")
    if not len(run.t):
        return replace(run, state=run.state | {"euler": np.empty((0, 3))})
    found = angles_along(case, run.t, model, order)
    at, start = np.searchsorted(found.t, run.t), int(np.argmin(np.abs(found.t)))
    angles = np.stack([found.psi - found.psi[start], found.theta, found.phi], axis=-1)[at]
    words = f"Euler angles: {found.reason}, psi known to about {found.error:.1g} rad"
    reason = words if run.reason in ("", "all times reached") else f"{run.reason}; {words}"
    return replace(run, state=run.state | {"euler": angles}, reason=reason)


def angles_along(case, times, model: str = "exact", order: int | None = None) -> EulerAngles:
    """The angles from 0 to the farthest of the times (n,), s, on both sides of 0 where they lie so; at those
    times, at 0, and close enough for psi."""
    times = np.asarray(times, float)
    reach, row = float(np.abs(times).max()), np.asarray(follow(case, times, model,
                                                               order=order).state["omega"])
    fastest = float(np.linalg.norm(np.vstack([row, case.state]), axis=1).max())
    count = int(min(MOST, 2 + np.ceil(reach * fastest * TO_A_TURN / (2 * np.pi))))
    sides = [sign * np.linspace(0.0, reach, count) for sign in (1, -1) if (sign * times > 0).any()]
    whole = follow(case, np.unique(np.concatenate([[0.0], times, *sides])), model, order=order)
    return euler_angles(whole.t, whole.state["omega"], whole.state["gamma"])
