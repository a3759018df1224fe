"""What a separatrix parts, or why there is none, in words."""
from __future__ import annotations

NO_REDUCTION = "no reduction to one degree of freedom: the separatrix of this scene is not known in closed form"
PARABOLIC = ("parabolic reduction (two equal moments): all motions are bounded by walls on both sides, except pure spin about the torque; no sheet bounds a "
             "spin-up")


def what_it_parts(potential, sense: int) -> str:
    """Of a scene with sheets."""
    if potential.walled:
        return "both sides of each sheet are bounded: it parts oscillations about one centre from those around two"
    if sense == 0:
        return ("both sides of each sheet are bounded: inside motions oscillate about a centre, outside about more of "
                "them or right round the axis")
    return "each sheet bounds the motions that oscillate about the centres inside it"


def why_none(conic) -> str:
    """Of a scene without."""
    if conic.pieces or conic.lines:
        return ("no equilibrium is a saddle of the reduced potential: each orbit has a single well, and there is no "
                "separatrix surface")
    return "there is no equilibrium, so there is no saddle and no separatrix surface"
