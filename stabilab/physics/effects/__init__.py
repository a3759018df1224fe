"""The registry of effects: table name in a case file -> (module, class). A module is imported when a scene
names it."""
from __future__ import annotations

from importlib import import_module
from typing import Any

REGISTRY: dict[str, tuple[str, str]] = {
    "gyrostat": ("gyrostat", "Gyrostat"),
    "constant_torque": ("constant_torque", "ConstantTorque"),
    "charge": ("charge", "Charge"),
    "resistance": ("resistance", "Resistance"),
    "liquid_cavity": ("liquid_cavity", "LiquidCavity"),
    "viscous_damper": ("viscous_damper", "ViscousDamper"),
    "damper_wheel": ("damper_wheel", "DamperWheel"),
    "damper_mass": ("damper_mass", "DamperMass"),
    "rate_damper": ("rate_damper", "RateDamper"),
    "eddy_currents": ("eddy_currents", "EddyCurrents"),
    "wheel_motor": ("wheel_motor", "WheelMotor"),
    "newtonian_field": ("newtonian_field", "NewtonianField"),
    "gravity": ("gravity", "Gravity"),
    "body_force": ("body_force", "BodyForce"),
}


def effect_class(name: str) -> Any:
    """The class of the effect called `name` in case files; KeyError if there is none."""
    module, cls = REGISTRY[name]
    return getattr(import_module(f"{__name__}.{module}"), cls)
