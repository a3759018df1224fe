"""The closed forms of the charged, nearly axisymmetric body as models of a case."""
from __future__ import annotations

from .simulation import Simulation

MODELS = ("linear", "corrected", "printed")
COVERED = {"charge", "gyrostat", "constant_torque", "body_force"}


def applies(scene) -> bool:
    """Whether the linear model covers the scene: a charge or a force, a gyrostatic moment along axis 3, a torque across
    it. Where the charge's angle follows the attitude the model holds it at its first value, as the paper does."""
    names = {e.name for e in scene.effects}
    return (names <= COVERED and bool(names & {"charge", "body_force"})
            and not any(scene.vector("gyrostat")[:2]) and not scene.vector("constant_torque")[2])


def body_of(case):
    """The case as the closed forms take it."""
    from .axisymmetric_modes import ChargedBody
    scene, blocks = case.scene, case.blocks
    charge, force = scene.effect("charge"), scene.effect("body_force")
    p, q, r = case.state
    rest, k = (0.0, 0.0, 0.0), 0.0
    if charge is not None:
        k = charge.strength * (blocks["gamma"][2] if charge.follows_attitude else 1.0)
    return ChargedBody(scene.body.inertia, r, float(scene.vector("gyrostat")[2]), k,
                       tuple(float(v) for v in scene.vector("constant_torque")[:2]), (p, q), blocks.get("attitude", rest),
                       force.vector if force else rest, scene.body.mass, blocks.get("velocity", rest), blocks.get("position", rest))


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by the linear model, by the paper's single frequency with its integrals corrected, or as printed;
    the parts of the state that the exact motion has."""
    blocks, body = set(case.scene.blocks) | set(case.blocks), body_of(case)
    wanted = ["omega"] + ["angles", "momentum"] * bool(blocks & {"attitude", "velocity", "position"})
    wanted += ["velocity", "position"] * bool(blocks & {"velocity", "position"} and body.mass is not None)
    run, how = _motion(model, body, times, wanted)
    parts = {part: getattr(run, part) for part in wanted}
    held = case.scene.effect("charge") is not None and case.scene.effect("charge").follows_attitude
    note = "; the charge's angle is held at its first value" if held else ""
    return Simulation(run.t, parts, model, how, None, status="reached", reason=f"{run.status}: {run.reason}{note}")


def _motion(model, body, times, wanted):
    """The motion by the model, and how it was found."""
    if model == "printed":
        from .axisymmetric_printed import printed
        return printed(body, times, wanted), "Galal et al., charged body: formulas as printed, misprints and all"
    if model == "corrected":
        from .axisymmetric_corrected import corrected
        return corrected(body, times), "Galal et al., charged body: its single frequency (8), integrals corrected"
    from .axisymmetric import solution
    return solution(body, times), "closed forms of the linear model, both rates"
