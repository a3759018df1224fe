"""The motion as a page draws it: in plain floats where these are sure of it, else in as many digits as it
takes once the hand rests, for on an unstable plane, and on the separatrix itself, whatever a step in floats
leaves grows until the line is another motion's; and why a body on which more acts than wheels and a torque
has no separatrix and no phase plane.

A liquid, a medium, weight and a field take the law away from which both come; a charge that only adds to the
wheel has the rates of a gyrostat, and is no such body.
"""
from __future__ import annotations

import math
from typing import Any

from ...answers.equilibria import equilibria
from ...case.read import Case
from ...equilibrium.result import Equilibria
from ...errors import InputError, StabilabError
from ...integrate.quadratic_series import Path, followed, parting
from ...packages import demand, present
from ...physics.coefficients import content
from ...physics.effects.base import effect_words
from ...physics.scene import AnyScene, QuadraticForm, Scene
from ..units import Units
from .pictures import Bag

POINTS, MOST = 1200, 6000  # of a motion that is drawn: at least, at most
FRAMES = 400  # of the body that turns
CLOSE = 0.25  # rad of turn from one to the next, where so many are enough
NOT_YET = {"reason": "Keep still, and the equilibria are looked for.", "rows": []}
TAKES = {"liquid_cavity": "the liquid", "resistance": "the medium",
         "viscous_damper": "the damper", "rate_damper": "the damper",
         "eddy_currents": "the eddy currents"}  # energy away
TURNS = {"newtonian_field": "the field", "gravity": "the weight"}  # acts by the attitude


def needed(scene: AnyScene) -> bool:
    """Whether no scene of wheels and a torque alone has the same rates."""
    return not scene.plain and ((parts := content(scene)) is None or parts.kind != "gyrostat")


def check(case: Case) -> None:
    """Raise InputError where a page cannot show a case: its sliders count along principal axes, and so must
    the effects of its file, unless they are alike along all axes."""
    if not needed(case.scene):
        return
    demand("numpy", "scipy")
    scene, turned = case.scene, case.frame
    if turned is None or turned.as_given:
        return
    # the same along all axes, as an isotropic damper is
    alike = scene.blocks == ("omega",) and all(effect.turned(turned) is effect for effect in scene.beyond)
    if not alike:
        names = " and ".join(effect_words(effect.name) for effect in scene.beyond)
        raise InputError(f"{case.place}: explore turns wheels and torque into the principal axes, but not "
                         f"{names}: state the case along its principal axes (stabilab show tells them), or "
                         f"ask stabilab classify or report")


def why(scene: AnyScene) -> str:
    """What the page does not show, and why."""
    names = [effect.name for effect in scene.effects]
    taking = [TAKES[name] for name in names if name in TAKES]
    turning = [TURNS[name] for name in names if name in TURNS]
    if isinstance(scene,
                  Scene) and (charge := scene.effect("charge")) is not None and charge.follows_attitude:
        turning.append("the charge")
    motors = ["the motor"] * ("wheel_motor" in names)
    parts = ((taking, "take", "energy away"), (turning, "act", "by the attitude"),
             (motors, "change", "the momentum of its wheel"))
    reasons = [f"{' and '.join(some)} {word}{'s' * (len(some) == 1)} {how}"
               for some, word, how in parts if some]
    return (
        f"No separatrix and no phase plane: {' and '.join(reasons)}, so no law keeps the rates on a curve "
        f"that is known; what is drawn is the motion itself")


def path(case: Case, until: float) -> Path:
    """(times, rates) of the motion up to a time, or as far as a run goes."""
    import numpy as np

    from ..plot.path import along, subject
    turn = until * math.hypot(*case.state)
    number = min(MOST, max(POINTS, math.ceil(turn / CLOSE)))
    t, rates = along(subject(case), np.linspace(0.0, until, number))
    return t.tolist(), [(x, y, z) for x, y, z in rates.tolist()]


def film(case: Case, until: float, bag: Bag, units: Units) -> dict[str, Any]:
    """The body as it turns in that time, as `templates/turning.js` draws it."""
    from ..plot import turning
    one = turning.subject(case, span=until)
    found = turning.turn(one, FRAMES)
    drawn = turning.drawn(one, found, units.times(until), units.rates,
                          lambda rows: bag.add("float32", rows.ravel().tolist()))
    return drawn | {"names": [units.axes.label(n) for n in (1, 2, 3)],
                    "words": f"Arrows: {found.words}. {found.part(units)}"}


def at_rest(scene: AnyScene) -> Equilibria | None:
    """The equilibria; None where they are not known."""
    try:
        return equilibria(scene)
    except StabilabError:
        return None


def line(case: Case, form: QuadraticForm | None, until: float, moving: bool) -> Path:
    """(times, rates) of the motion from t = 0 on. form: its rates, where they are quadratic. moving: a hand
    that does not wait is shown the part of which floats are sure; so is a page without NumPy."""
    if form is None:
        return path(case, until)
    times, states = followed(form, case.state, until)
    known = parting(form, (times, states))
    if (known < len(times) or times[-1] < until) and not moving and present("numpy"):
        return path(case, until)
    return times[:known], states[:known]
