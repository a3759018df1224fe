"""From the frame that a case is written in to principal axes: what the parts add up to, effects and motion turned."""
from __future__ import annotations

from dataclasses import replace

from ..numbers.exact import floats
from ..numbers.principal import PrincipalAxes, without_trace
from ..physics.effects import effect_class
from .table import Table

OBLIQUE = "the tensor is not diagonal, and"
REFUSED = {"x": f"{OBLIQUE} x counts along principal axes: give angular_velocity in rad/s, in the frame of the tensor",
           "attitude": f"{OBLIQUE} an attitude is not turned to principal axes: give principal moments",
           "velocity": f"{OBLIQUE} a velocity is not turned to principal axes: give principal moments",
           "position": f"{OBLIQUE} a position is not turned to principal axes: give principal moments"}  # keys of [motion]


def added(effects: list, thrusters, wheels) -> list:
    """The effects with the torques of stuck thrusters and the momenta of wheels, all in the input frame."""
    torque = _sum([t.torque for t in thrusters if t.stuck])
    momentum = _sum([w.vector for w in wheels])
    return _with(_with(effects, "gyrostat", momentum), "constant_torque", torque)


def _sum(vectors):
    return tuple(map(sum, zip(*vectors))) if vectors else None


def _with(effects, name, vector):
    if vector is None:
        return effects
    given = next((e for e in effects if e.name == name), None)
    if given is None:
        return [*effects, effect_class(name)(vector)]
    whole = effect_class(name)(tuple(a + b for a, b in zip(given.exact, vector)))
    return [whole if e is given else e for e in effects]


def turned_effects(top: Table, effects: list, frame: PrincipalAxes | None) -> list:
    """The effects along principal axes; a fault for each that cannot be turned."""
    if frame is None or frame.as_given:
        return effects
    turned = [effect.turned(frame) for effect in effects]
    for effect, found in zip(effects, turned):
        if found is None:
            top.fault(f"{OBLIQUE} {effect.name.replace('_', ' ')} is known along principal axes alone: give principal moments, and "
                      "the rest of the case along them", "effects", effect.name)
    return _at_right_angles([effect for effect in turned if effect is not None])


def _at_right_angles(effects: list) -> list:
    """Momentum across the torque in the input frame is across it along irrational axes too: whether it is decides what becomes of a motion."""
    torque = next((e.exact for e in effects if e.name == "constant_torque"), None)
    if torque is None:
        return effects
    return [type(e)(without_trace(e.exact, torque)) if e.name == "gyrostat" else e for e in effects]


def judge_oblique(top: Table, frame: PrincipalAxes | None):
    """Note every number that speaks of principal axes beside a tensor that is not diagonal."""
    if frame is None or frame.as_given:
        return
    motion, torque = top.data.get("motion"), top.data.get("effects")
    for key, words in REFUSED.items():
        if isinstance(motion, dict) and key in motion:
            top.fault(words, "motion", key)
    torque = torque.get("constant_torque") if isinstance(torque, dict) else None
    if isinstance(torque, dict) and "mu" in torque:
        top.fault(f"{OBLIQUE} mu counts along principal axes: give torque in N m, in the frame of the tensor", "effects", "constant_torque", "mu")


def turned_motion(motion, frame: PrincipalAxes | None):
    """[motion] with its angular velocity and vertical along principal axes."""
    if frame is None or frame.as_given or motion.state_key == "x":
        return motion
    state = motion.exact and frame.turned(motion.exact)
    try:
        vertical = {"gamma": floats(frame.turned(motion.exact_vertical))} if motion.exact_vertical else {}
        return replace(motion, exact=state, state=state and floats(state), blocks=motion.blocks | vertical)
    except OverflowError:
        motion.table.fault("exceeds the largest double (about 1.8e308) along the principal axes", motion.state_key)
        return motion
