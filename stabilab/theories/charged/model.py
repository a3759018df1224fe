"""The closed forms of the charged, nearly axisymmetric body as models of a case."""
from __future__ import annotations

from fractions import Fraction

from ...answers.simulate import Simulation
from .closed_form import solution
from .corrected import corrected
from .modes import ChargedBody
from .printed import printed
from .validity import spin_words

MODELS = ("linear", "corrected", "printed")
NEARLY = Fraction(1, 10)  # D1 - D2 over D1 up to which a body counts as nearly axisymmetric
COVERED = {"charge", "gyrostat", "constant_torque", "body_force"}


def applies(scene) -> bool:
    """Whether the linear model covers the scene: a gyrostatic moment along axis 3, a torque across it, D1
    near D2 (where a charge or a force asks for this theory it is followed beyond, and says how far r is from
    constant). Where the charge's angle follows the attitude the model holds it at its first value, as the
    paper does."""
    names = {e.name for e in scene.effects}
    if (scene.variables != "physical" or not names <= COVERED
            or any(scene.vector("gyrostat")[:2]) or scene.vector("constant_torque")[2]):
        return False
    D1, D2, _ = scene.body.exact
    return bool(names & {"charge", "body_force"}) or abs(D1 - D2) <= NEARLY * max(D1, D2)


def body_of(case):
    """The case as the closed forms take it."""
    scene, blocks = case.scene, case.blocks
    charge, force = scene.effect("charge"), scene.effect("body_force")
    p, q, r = case.state
    rest, k = (0.0, 0.0, 0.0), 0.0
    if charge is not None:
        k = charge.strength * (blocks["gamma"][2] if charge.follows_attitude else 1.0)
    return ChargedBody(scene.body.inertia, r, float(scene.vector("gyrostat")[2]), k,
                       tuple(float(v) for v in scene.vector("constant_torque")[:2]), (p, q),
                       blocks.get("attitude", rest),
                       force.vector if force else rest, scene.body.mass, blocks.get("velocity", rest),
                       blocks.get("position", rest))


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by the linear model, by the paper's single frequency with its integrals corrected, or
    as printed; the parts of the state that the exact motion has."""
    blocks, body = set(case.scene.blocks) | set(case.blocks), body_of(case)
    wanted = ["omega"] + ["angles", "momentum"] * bool(blocks & {"attitude", "velocity", "position"})
    wanted += ["velocity", "position"] * bool(blocks & {"velocity", "position"} and body.mass is not None)
    run, how = _motion(model, body, times, wanted)
    parts = {part: getattr(run, part) for part in wanted}
    held = case.scene.effect("charge") is not None and case.scene.effect("charge").follows_attitude
    held = "the charge's angle is held at its first value" if held else ""
    angles = f"{run.status}: {run.reason}" if "angles" in parts else "the rates ask for no small angles"
    told = angles, spin_words(body, run.omega, run.t)
    return Simulation(run.t, parts, model, how, None, status="reached",
                      reason="; ".join(filter(None, (*told, held))))


def _motion(model, body, times, wanted):
    """The motion by the model, and how it was found."""
    if model == "printed":
        return printed(body, times,
                       wanted), "Galal et al., charged body: formulas as printed, misprints and all"
    if model == "corrected":
        return corrected(body,
                         times), "Galal et al., charged body: its single frequency (8), integrals corrected"
    return solution(body, times), "closed forms of the linear model, both rates"
