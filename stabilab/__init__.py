"""stabilab: where a rotating body's equilibria are, which are stable, and whether a motion stays bounded."""
from __future__ import annotations

from importlib import import_module

__version__ = "0.1.0"

# Public name -> module; loaded on first use so that light commands stay light.
_HOME = {
    "load": "case", "Case": "case",
    "Body": "body", "Scene": "scene", "ScaledGyrostat": "scene",
    "Gyrostat": "effects.gyrostat", "ConstantTorque": "effects.constant_torque",
    "Fate": "analysis.results",
    "equilibria": "analysis.equilibria",
    "fate": "analysis.fate", "motion": "analysis.motion",
    "extremes": "analysis.extremes", "period": "analysis.extremes",
    "separatrix": "analysis.separatrix",
    "trajectory": "analysis.trajectories", "ensemble": "analysis.ensembles",
    "simulate": "analysis.simulation", "compare": "analysis.comparison", "theory": "analysis.theory",
    "Charge": "effects.charge", "Resistance": "effects.resistance", "LiquidCavity": "effects.liquid_cavity",
    "NewtonianField": "effects.newtonian_field", "Gravity": "effects.gravity", "BodyForce": "effects.body_force",
    "derive": "equations", "validity": "law_limits",
}
__all__ = [*_HOME, "__version__"]


def __getattr__(name: str):
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return sorted(__all__)
