"""The exact motion of a body with a liquid in amplitude, phase and spin, which keep their digits when the
amplitude dies out.

p = A cos phi and q = -A sin phi of a run in doubles are known to a share of the whole angular velocity: once
A has fallen below the rounding of r they are noise, and so is the angle of (p, -q). Where p' and q' vanish
with p and q, A'/A and phi' stay regular however small A is, so log A and phi are followed instead.
"""
from __future__ import annotations

import math

import numpy as np

from ...errors import InputError
from ...integrate.trajectory import FALLBACK_RTOL
from ...physics.equations import derive
from ...physics.to_numpy import to_numpy
from .averaged import omega_of, times_row
from .normal_form import check

# log A below which A'/A and phi' are those at A = 1e-100: what is left out is of the order of A, and A^3 is
# still a double
LEAST = -230.0


def polar(scene, state, times) -> dict[str, np.ndarray]:
    """{"amplitude": (n,) rad/s, "spin": (n,) rad/s, "phase": (n,) rad, unwrapped} of the exact motion from
    `state` (as of `averaged`).

    times: (n,) s, increasing from 0 or later. Relative tolerance 1e-13. Raises InputError for a scene that
    averaging does not cover, for a torque across axis 3, which keeps the amplitude from dying out, and for a
    start on that axis, which has no phase.
    """
    check(scene)
    (p, q, r), times = omega_of(state), times_row(times)
    rate = to_numpy(derive(scene)).rate
    if any(rate([0.0, 0.0, 1.0])[:2]) or not math.hypot(p, q):
        raise InputError("amplitude and phase: expected no torque across axis 3 and a start off that axis")

    def slow(_, y):
        A, c, s = math.exp(max(y[0], LEAST)), math.cos(y[1]), math.sin(y[1])
        dp, dq, dr = rate([A * c, -A * s, y[2]])
        return (dp * c - dq * s) / A, -(dp * s + dq * c) / A, dr

    from scipy.integrate import solve_ivp
    run = solve_ivp(slow, (0.0, times[-1]), (math.log(math.hypot(p, q)), math.atan2(-q, p), r), "DOP853",
                    t_eval=times, rtol=FALLBACK_RTOL,
                    atol=FALLBACK_RTOL)
    if not run.success:
        raise InputError(
            f"amplitude and phase: the run stopped at t = {run.t[-1] if len(run.t) else 0:.6g} s: "
            f"{run.message}")
    return {"amplitude": np.exp(run.y[0]), "spin": run.y[2], "phase": run.y[1]}
