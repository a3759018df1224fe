"""What a page shows of a body on which more acts than wheels and a torque: the motion, followed in time, and why there is no separatrix and no phase plane.

A charge that only adds to the wheel has the rates of a gyrostat, and is no such body. A liquid, a medium, weight and a field take the law away from
which separatrix and phase plane come; what is left are the verdict, the equilibria, and the motion with its rates.
"""
from __future__ import annotations

from ...answers.equilibria import equilibria
from ...case.read import Case
from ...equilibrium.result import Equilibria
from ...errors import InputError, StabilabError
from ...integrate.quadratic_series import Path
from ...packages import demand
from ...physics.coefficients import content
from ...physics.effects.base import effect_words
from ...physics.scene import AnyScene, Scene

POINTS = 1200  # of a motion that is drawn
NOT_YET = {"reason": "Keep still, and the equilibria are looked for.", "rows": []}
TAKES = {"liquid_cavity": "the liquid", "resistance": "the medium"}  # energy away
TURNS = {"newtonian_field": "the field", "gravity": "the weight"}  # acts by the attitude


def needed(scene: AnyScene) -> bool:
    """Whether no scene of wheels and a torque alone has the same rates."""
    return not scene.plain and ((parts := content(scene)) is None or parts.kind != "gyrostat")


def check(case: Case) -> None:
    """Raise InputError where a page cannot show a case: its sliders count along principal axes, and so must the effects of its file."""
    if not needed(case.scene):
        return
    demand("numpy", "scipy")
    if case.frame is not None and not case.frame.as_given:
        raise InputError(f"{case.place}: explore turns wheels and torque into the principal axes, but not {_names(case.scene)}: state the case along its "
                         "principal axes (stabilab show tells them), or ask stabilab classify or report")


def why(scene: AnyScene) -> str:
    """What the page does not show, and why."""
    names = [effect.name for effect in scene.effects]
    taking = [TAKES[name] for name in names if name in TAKES]
    turning = [TURNS[name] for name in names if name in TURNS]
    if isinstance(scene, Scene) and (charge := scene.effect("charge")) is not None and charge.follows_attitude:
        turning.append("the charge")
    reasons = [f"{' and '.join(some)} {word}{'s' * (len(some) == 1)} {how}" for some, word, how in ((taking, "take", "energy away"),
                                                                                                 (turning, "act", "by the attitude")) if some]
    return f"No separatrix and no phase plane: {' and '.join(reasons)}, so no law keeps the rates on a curve that is known; what is drawn is the motion itself"


def _names(scene: AnyScene) -> str:
    return " and ".join(effect_words(effect.name) for effect in scene.effects if effect.name not in ("gyrostat", "constant_torque"))


def path(case: Case, until: float) -> Path:
    """(times, rates) of the motion up to a time, or as far as a run goes."""
    import numpy as np

    from ..plot.path import along
    from ..plot.subject import subject
    t, rates = along(subject(case), np.linspace(0.0, until, POINTS))
    return t.tolist(), [(x, y, z) for x, y, z in rates.tolist()]


def at_rest(scene: AnyScene) -> Equilibria | None:
    """The equilibria; None where they are not known."""
    try:
        return equilibria(scene)
    except StabilabError:
        return None
