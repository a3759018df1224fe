"""[body], [effects], thrusters and wheels of a case file, or [scaled], to a scene along principal axes."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from ..errors import InputError
from ..numbers.principal import PrincipalAxes
from ..physics.body import Body
from ..physics.coefficients import to_scaled, torque_from_mu
from ..physics.effects import REGISTRY, effect_class
from ..physics.effects.base import Effect
from ..physics.scene import ScaledGyrostat, Scene
from ..reasons import Reason, Sentence
from .aliases import cure_of_key
from .body import added, body_of, centre_of_mass, fitted, turned_effects
from .hardware import Limits, Thruster, Wheel, limits_of, thrusters_of, wheels_of
from .motion import StatedMotion
from .table import Faults, Table, did_you_mean

NO_CENTRE = Sentence("no-centre-of-mass",
                     "the file gives no centre_of_mass: thrusters are placed from it")()
STAND_IN = Body((3, 2, 1))  # lets the faults of the effects show where the body itself is at fault


class Craft(NamedTuple):
    """What the file says a spacecraft carries."""

    thrusters: tuple[Thruster, ...] = ()
    wheels: tuple[Wheel, ...] = ()
    limits: Limits | None = None
    assumed: tuple[Reason, ...] = ()


def craft_of(top: Table) -> Craft:
    if "scaled" in top:
        return Craft()
    centre = centre_of_mass(top)
    thrusters = thrusters_of(top, centre)
    assumed = (NO_CENTRE,) if thrusters and centre is None else ()
    return Craft(thrusters, wheels_of(top), limits_of(top), assumed)


class _Context(NamedTuple):
    """What an effect may need of the rest of the case."""

    body: Body
    stand_in: bool = False  # the body itself is at fault: judge nothing by it

    def torque_from_mu(self, mu: Sequence[Fraction]):
        return torque_from_mu(self.body, mu)


def physical_of(top: Table, craft: Craft,
              motion: StatedMotion) -> tuple[Scene | None, tuple | None, PrincipalAxes | None]:
    """The scene of [body], [effects] and hardware along principal axes, the dimensionless torque where the
    file gives it, the axes."""
    if "scaled" in top:
        for key in ("body", "effects", "thrusters", "wheels", "limits"):
            if key in top:
                top.fault("[scaled] stands for [body] and [effects]: keep one or the other", key)
        return None, None, None
    body, frame = body_of(top)
    built = _effects(top, body)
    if body is None or None in built:
        return None, None, frame
    try:
        full = added(built, craft.thrusters, craft.wheels)
        frame = fitted(frame, full, motion)
        full = turned_effects(top, full, frame)
    except InputError as error:  # numbers that are good one by one, but not added up or turned
        top.fault(f"added up along principal axes, {error}",
                  next(key for key in ("thrusters", "wheels", "effects") if key in top))
        return None, None, frame
    refused = [(effect, why) for effect in full if (why := effect.refused_by(body))]
    for effect, why in refused:
        top.fault(why, "effects", effect.name, effect.keys[0])
    if refused:
        return None, None, frame
    torque = (top.data.get("effects", {}).get("constant_torque") if isinstance(top.data.get("effects"), dict)
              else None)
    if not isinstance(torque, dict):  # absent, or no table, which is noted already
        return _scene(body, full, frame), None, frame
    mu = Table(("effects", "constant_torque"), torque, Faults(top.faults.lines)).vector("mu")
    if mu and any(thruster.stuck for thruster in craft.thrusters):
        top.fault("mu cannot be added to the torque of a thruster: give torque in N m", "effects",
                  "constant_torque", "mu")
    return _scene(body, full, frame), mu, frame


def _scene(body: Body, effects: Sequence[Effect], frame: PrincipalAxes | None) -> Scene:
    """The scene, which knows where its axes lie in the frame of the file."""
    scene = Scene(body, *effects)
    if frame is not None and not frame.as_given:
        object.__setattr__(scene, "frame", frame)
    return scene


def _effects(top: Table, body: Body | None) -> list:
    """The effects as the file gives them, None for one at fault."""
    effects = top.table("effects")
    if effects is None:
        return []
    built = []
    for name in effects.data:
        if name not in REGISTRY:
            cure = cure_of_key(effects.path, name, effects.data, REGISTRY)
            hint = f"; {cure}" if cure else did_you_mean(name, REGISTRY)
            resolved = f" Known effects: {', '.join(REGISTRY)}" if "did you mean" in hint else ""
            effects.fault(f"unknown effect{hint}{resolved}", name)
            continue
        table = effects.table(name)
        if table is None:
            continue
        cls = effect_class(name)
        table.known(cls.keys)
        try:
            built.append(cls.from_case(table, _Context(body or STAND_IN, body is None)))
        except InputError as error:  # numbers that are good one by one, but not together
            effects.fault(str(error), name)
    return built


def scaled_of(top: Table) -> ScaledGyrostat | None:
    """The system of [scaled]: the paper's a, b, mu, any real numbers."""
    table = top.table("scaled")
    if table is None:
        return None
    table.known(("a", "b", "mu"))
    table.required("a", "b", "mu")
    a, b, mu = table.number("a"), table.number("b"), table.vector("mu")
    return None if a is None or b is None or mu is None else ScaledGyrostat(a, b, mu)


def in_variables(top: Table, motion: StatedMotion, physical: Scene | None, scaled: ScaledGyrostat | None,
               mu: Sequence[Fraction] | None):
    """(scene, "physical" or "scaled", change of variables or None), by the rule in `load`."""
    if physical is None:
        return _in_range(top, scaled), "scaled", None
    try:
        physical.quadratic()  # refuses effects that the scaled system does not have
        twin, scaling = to_scaled(physical, mu)
    except InputError as error:
        for key in ("x", "tau"):
            if key in motion.table:
                motion.table.fault(f"{error}", key)
        return _in_range(top, physical), "physical", None
    if motion.state_key == "x" or (mu is not None and motion.state_key is None):
        return _in_range(top, twin), "scaled", scaling
    return _in_range(top, physical), "physical", scaling


def _in_range(top: Table, scene):
    """The scene, if its rates can be formed in doubles."""
    try:
        scene is None or scene.quadratic().coefficients
    except OverflowError:
        top.fault("the coefficients of the equations of motion exceed the largest double (about 1.8e308): "
                  "choose other units", "scaled" if "scaled" in top else "body")
    except InputError:  # other effects: their parameters, and these as rates
        for effect in scene.effects:
            if _too_large(effect, scene.body):
                top.fault("its numbers, or these over the moments of inertia, exceed the largest double "
                          "(about 1.8e308): "
                          "choose other units", "effects", effect.name)
    return scene


def _too_large(effect: Effect, body: Body) -> bool:
    try:
        return not all(math.isfinite(float(v)) and math.isfinite(float(v / min(body.exact)))
                       for v in effect.parameters().values())
    except OverflowError:
        return True
