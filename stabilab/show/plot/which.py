"""Which kinds of plot a scene has, and why it has not the others."""
from __future__ import annotations

import math

from ...answers.equilibria import equilibria
from ...errors import InputError, printable
from ...orbit.far_states import far_exponent
from ...orbit.reduction import reduce
from ...orbit.result import Fate
from ...physics.effects.base import effect_words
from ...unreduced.section import LEAST, crossed
from .subject import Subject

# kind -> what it shows
KINDS = {
    "time": "the rates over time, with limits, extremes and period",
    "phase": "the plane of the reduced motion: turn about the torque's axis and its rate",
    "sphere": "the surface on which the motion stays, with the other motions on it",
    "space": "the motion in the space of rates, beside the separatrix",
    "section": "the Poincaré section: passages of a plane, with neighbours and the periodic motion in the middle of an island",
    "equilibria": "all equilibria, stable and unstable",
    "budget": "what accuracy costs in time",
    "state": "every part of the state over time, the analytic models beside the exact motion",
    "attitude": "the body as it turns, as an animation",
}
FAR = "rates, torque or wheel are so large or so small that their squares leave the range of doubles: choose other units"


def why_not(kind: str, one: Subject) -> str:
    """Why a subject has no plot of a kind; empty where it has one."""
    if kind not in KINDS:
        return f"there is no such kind; expected one of {', '.join(KINDS)}"
    if kind == "equilibria":
        return _equilibria(one)
    if one.state is None:
        return "it needs a motion: add [motion] with angular_velocity or x" if one.case is not None else "it needs a state: three rates at t = 0"
    return _REASONS.get(kind, lambda one: "")(one)


def check(kind: str, one: Subject) -> None:
    """Raise InputError where a subject has no plot of a kind; it names those that there are."""
    why = why_not(kind, one)
    if not why:
        return
    if kind not in KINDS:
        raise InputError(f"kind {printable(kind)!r:.60}: {why}")
    raise InputError(f"plot {kind}: {why}; this one has {', '.join(offered(one))}")


def offered(one: Subject) -> tuple[str, ...]:
    """The kinds of plot that a subject has."""
    return tuple(kind for kind in KINDS if not why_not(kind, one))


def default(one: Subject) -> str:
    """The kind that says most of a subject: its plane where it reduces, all parts of a longer state, else the rates over time."""
    return next(kind for kind in ("phase", "state", "time", "equilibria") if not why_not(kind, one))


def _equilibria(one: Subject) -> str:
    found = equilibria(one.scene) if one.twin.plain else None  # there always are some with other effects, and they take longer
    return f"there is none: {found.reason}" if found is not None and not found.points and not found.curves else ""


def _far(one: Subject) -> str:
    return FAR if one.twin.plain and far_exponent(one.twin, one.state) is not None else ""


def _phase(one: Subject) -> str:
    if not one.twin.plain:
        return f"with {_beyond(one)} the motion does not reduce to one degree of freedom"
    if reduce(one.twin) is None:
        return "the motion does not reduce to one degree of freedom (torque off the principal axes, or a wheel along it)"
    return _far(one)


def _sphere(one: Subject) -> str:
    if not one.twin.plain:
        return f"with {_beyond(one)} no surface is known on which the motion stays"
    if free(one) and one.physical:
        return _far(one)
    return "no surface is known on which the motion stays (torque off the principal axes, or a wheel along it)" if reduce(one.twin) is None else _far(one)


def certain_from(one: Subject) -> float:
    """The time (scene's time) from which on spin-up is certain; inf of a motion that is not known to spin up."""
    found = one.motion
    return float(found.evidence.get("t_certificate") or 0.0) if found.fate == Fate.SPIN_UP else math.inf


def _section(one: Subject) -> str:
    if not one.twin.plain:
        return f"it is drawn of a body with a wheel and a torque alone, not with {_beyond(one)}"
    if why := _far(one):
        return why
    if one.motion.fate == Fate.EQUILIBRIUM:
        return "the motion is an equilibrium: it passes no plane"
    until = certain_from(one)
    if crossed(one.twin, one.state, until) is not None:
        return ""
    if math.isinf(until):
        return f"the motion does not come back: it passes no plane {LEAST} times"
    when = "from its start on" if not until else f"from {until:.4g} {one.scene.time_unit} on"
    return f"spin-up about {one.axes.short(one.motion.axis)} is certain {when}, before the motion has passed any plane {LEAST} times"


def _state(one: Subject) -> str:
    return "no approximate theory comes with a wheel and a constant torque: the rates over time are the exact motion" if one.scene.plain else ""


def _budget(one: Subject) -> str:
    return "it needs a span: the time up to which the motion is followed" if one.span is None else ""


def _attitude(one: Subject) -> str:
    return "" if one.physical else "scaled variables have no body to turn: give the case in physical units"


def free(one: Subject) -> bool:
    """Whether no torque acts on the body of a scene of wheel and torque."""
    return not any(one.twin.quadratic().m)


def _beyond(one: Subject) -> str:
    *others, last = (effect_words(effect.name) for effect in one.scene.effects
                     if effect.name not in ("gyrostat", "constant_torque"))
    return f"{', '.join(others)} and {last}" if others else last


_REASONS = {"phase": _phase, "sphere": _sphere, "state": _state, "attitude": _attitude, "budget": _budget, "time": _far, "space": _far, "section": _section}
