"""What a run over a span shows of a motion whose bounds alone are proved: extremes as roots of the rates, and
how the energy went."""
from __future__ import annotations

import numpy as np

from ..integrate.events import roots_of_rates
from ..physics.coefficients import limits_of
from ..physics.scene import Scene
from ..physics.states import equations_and_start
from ..physics.to_numpy import to_numpy
from ..validation import reach_of

STIFF = 1e5  # fastest decay times span beyond which a search for extremes would take minutes


def seen_over(scene, start, span) -> dict:
    """Extremes as roots of the rates from the start to the end of the span, and how the energy went; empty
    where the decay is too fast. start: its blocks by name."""
    turning = Scene(scene.body, *(e for e in scene.effects if e.name != "body_force"))
    equations, state = equations_and_start(turning, start)
    system, length = to_numpy(equations), reach_of(span)
    J = system.jacobian(state)
    if not np.isfinite(J).all() or abs(np.linalg.eigvals(J).real).max() * length > STIFF:
        return {"extremes_over": "none: the decay is too fast for a search over the span"}
    found = roots_of_rates(turning, start, length)
    over = f"s in [0, {found.t_reached:g}]"
    ends = system.invariants(np.vstack([found.start, found.end]))["energy"]
    return {"extremes": tuple((float(a), float(b)) for a, b in found.extremes()),
            "extremes_over": over,
            **_validity(turning, found, over),
            "evidence": {"span": found.t_reached, "energy_change": float(ends[1] - ends[0]),
                         "rate_end": [float(v) for v in found.end[:3]], "steps": found.steps}}


def _validity(scene, found, over) -> dict:
    """Of approximate laws, at every state that the search met: where a rate vanishes, and at both ends."""
    limits = limits_of(scene)
    if limits is None:
        return {}
    return {"validity": limits.along(scene, np.vstack([found.start, found.states, found.end]),
                                     f"over {over}")}
