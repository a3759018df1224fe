"""What a separatrix parts, or why there is none, in words."""
from __future__ import annotations

NO_REDUCTION = "without a reduction to one degree of freedom the separatrix of this scene is not known in closed form"


def what_it_parts(potential, sense: int) -> str:
    """Of a scene with sheets."""
    if potential.walled:
        return "both sides of each sheet are bounded: it parts oscillations about one centre from those around two"
    if sense == 0:
        return ("both sides of each sheet are bounded: inside motions oscillate about a centre, outside about more of "
                "them or right round the axis")
    return "each sheet bounds the motions that oscillate about the centres inside it"


def why_none(conic, sense: int) -> str:
    """Of a scene on circles or hyperbolas without sheets."""
    if conic.pieces or conic.lines:
        return ("no equilibrium is a saddle of the reduced potential, each orbit has a single well, and there is no "
                "separatrix surface")
    if sense == 0:
        return "no force acts along any orbit: the rate about the axis of symmetry is constant, and there is no saddle and no separatrix surface"
    return "there is no equilibrium, so there is no saddle and no separatrix surface"


def why_parabolic(reduction) -> str:
    """Of a scene on parabolas: no sheets are drawn of it."""
    bent = reduction.kappa or reduction.rho or reduction.sigma
    if reduction.sense == 0:
        told = "no torque acts, and every motion is bounded"
    elif bent:
        told = "all motions are bounded by walls on both sides, except pure spin about the torque"
    else:
        told = "nothing turns the body out of the torque's way, and every motion spins up"
    return f"parabolic reduction ({reduction.geometry.where}): {told}; no sheet bounds a spin-up"
