"""stabilab: where a rotating body's equilibria are, which are stable, and whether a motion stays bounded."""
from __future__ import annotations

from importlib import import_module

__version__ = "0.1.0"

# Public name -> module; loaded on first use so that light commands stay light.
_HOME = {
    "load": "case.read", "Case": "case.read",
    "Body": "physics.body", "Scene": "physics.scene", "ScaledGyrostat": "physics.scene",
    "Gyrostat": "physics.effects.gyrostat", "ConstantTorque": "physics.effects.constant_torque",
    "Fate": "orbit.result",
    "equilibria": "answers.equilibria",
    "fate": "answers.fate", "fate_grid": "answers.fate_grid", "motion": "answers.motion",
    "extremes": "answers.extremes", "period": "answers.extremes", "spin_up": "unreduced.spin_up.follow",
    "separatrix": "orbit.separatrix.sheets", "stuck": "answers.stuck.ask",
    "time_to": "answers.time_to", "TimeTo": "answers.passage.result",
    "trajectory": "answers.trajectory", "ensemble": "integrate.ensemble",
    "simulate": "answers.simulate", "compare": "theories.comparison", "theory": "theories.theory",
    "Charge": "physics.effects.charge", "Resistance": "physics.effects.resistance", "LiquidCavity": "physics.effects.liquid_cavity",
    "NewtonianField": "physics.effects.newtonian_field", "Gravity": "physics.effects.gravity", "BodyForce": "physics.effects.body_force",
    "derive": "physics.equations", "validity": "physics.law_limits",
}
__all__ = [*_HOME, "__version__"]


def __getattr__(name: str):
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return sorted(__all__)
