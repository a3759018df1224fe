"""The registry of effects: table name in a case file -> (module, class). A module is imported when a scene names it."""
from __future__ import annotations

from importlib import import_module

REGISTRY: dict[str, tuple[str, str]] = {
    "gyrostat": ("gyrostat", "Gyrostat"),
    "constant_torque": ("constant_torque", "ConstantTorque"),
}


def effect_class(name: str):
    """The class of the effect called `name` in case files; KeyError if there is none."""
    module, cls = REGISTRY[name]
    return getattr(import_module(f"{__name__}.{module}"), cls)
