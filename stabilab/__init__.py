"""stabilab: where a rotating body's equilibria are, which are stable, and whether a motion stays bounded."""
from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from .representation import seen_through
from .version import __version__ as __version__

if TYPE_CHECKING:  # what `_HOME` loads on first use, for editors and type checkers
    from .answers.attitude import attitude as attitude
    from .answers.circular_orbit import circular_orbit as circular_orbit
    from .answers.dissipation.flat_spin import flat_spin as flat_spin
    from .answers.equilibria import equilibria as equilibria
    from .answers.fate import extremes as extremes
    from .answers.fate import fate as fate
    from .answers.fate import fate_grid as fate_grid
    from .answers.fate import period as period
    from .answers.motions.angles import angles as angles
    from .answers.motions.one import motion as motion
    from .answers.motions.scenes import chaos as chaos
    from .answers.motions.scenes import derive as derive
    from .answers.motions.scenes import ensemble as ensemble
    from .answers.motions.scenes import separatrix as separatrix
    from .answers.motions.scenes import spin_up as spin_up
    from .answers.motions.scenes import time_to as time_to
    from .answers.motions.scenes import trajectory as trajectory
    from .answers.motions.scenes import validity as validity
    from .answers.passage import TimeTo as TimeTo
    from .answers.simulate import simulate as simulate
    from .answers.stuck.ask import stuck as stuck
    from .answers.stuck.burn import burn as burn
    from .answers.when import when as when
    from .case.read import load_orbiting as load_orbiting
    from .case.source import example as example
    from .errors import InputError as InputError
    from .maps.bifurcation.ask import bifurcation as bifurcation
    from .maps.percentiles import percentiles as percentiles
    from .orbit.result import Fate as Fate
    from .papers.report import report as report
    from .physics.body import Body as Body
    from .physics.effects.body_force import BodyForce as BodyForce
    from .physics.effects.charge import Charge as Charge
    from .physics.effects.constant_torque import ConstantTorque as ConstantTorque
    from .physics.effects.damper_mass import DamperMass as DamperMass
    from .physics.effects.damper_wheel import DamperWheel as DamperWheel
    from .physics.effects.eddy_currents import EddyCurrents as EddyCurrents
    from .physics.effects.gravity import Gravity as Gravity
    from .physics.effects.gyrostat import Gyrostat as Gyrostat
    from .physics.effects.liquid_cavity import LiquidCavity as LiquidCavity
    from .physics.effects.newtonian_field import NewtonianField as NewtonianField
    from .physics.effects.rate_damper import RateDamper as RateDamper
    from .physics.effects.resistance import Resistance as Resistance
    from .physics.effects.viscous_damper import ViscousDamper as ViscousDamper
    from .physics.effects.wheel_motor import WheelMotor as WheelMotor
    from .physics.scene import ScaledGyrostat as ScaledGyrostat
    from .physics.scene import Scene as Scene
    from .show import plot as plot
    from .show.maps.atlas import atlas as atlas
    from .show.maps.basins import basin as basin
    from .show.maps.sweep import sweep as sweep
    from .study import Case as Case
    from .study import load as load
    from .study import load_burning as load_burning
    from .theories.theory import compare as compare
    from .theories.theory import theory as theory

# Public name -> module; loaded on first use so that light commands stay light.
_HOME = {
    "load": "study", "example": "case.source", "Case": "study",
    "load_burning": "study", "burn": "answers.stuck.burn",
    "load_orbiting": "case.read", "circular_orbit": "answers.circular_orbit",
    "flat_spin": "answers.dissipation.flat_spin",
    "Body": "physics.body", "Scene": "physics.scene", "ScaledGyrostat": "physics.scene",
    "Gyrostat": "physics.effects.gyrostat", "ConstantTorque": "physics.effects.constant_torque",
    "Fate": "orbit.result",
    "equilibria": "answers.equilibria", "chaos": "answers.motions.scenes",
    "fate": "answers.fate", "fate_grid": "answers.fate", "motion": "answers.motions.one",
    "attitude": "answers.attitude", "angles": "answers.motions.angles",
    "extremes": "answers.fate", "period": "answers.fate",
    "spin_up": "answers.motions.scenes",
    "separatrix": "answers.motions.scenes", "stuck": "answers.stuck.ask",
    "time_to": "answers.motions.scenes", "TimeTo": "answers.passage",
    "when": "answers.when", "report": "papers.report",
    "trajectory": "answers.motions.scenes", "ensemble": "answers.motions.scenes",
    "simulate": "answers.simulate", "compare": "theories.theory", "theory": "theories.theory",
    "Charge": "physics.effects.charge", "Resistance": "physics.effects.resistance",
    "LiquidCavity": "physics.effects.liquid_cavity",
    "NewtonianField": "physics.effects.newtonian_field", "Gravity": "physics.effects.gravity",
    "BodyForce": "physics.effects.body_force", "ViscousDamper": "physics.effects.viscous_damper",
    "DamperWheel": "physics.effects.damper_wheel", "DamperMass": "physics.effects.damper_mass",
    "RateDamper": "physics.effects.rate_damper", "EddyCurrents": "physics.effects.eddy_currents",
    "WheelMotor": "physics.effects.wheel_motor",
    "derive": "answers.motions.scenes", "validity": "answers.motions.scenes",
    "plot": "show", "sweep": "show.maps.sweep", "atlas": "show.maps.atlas",
    "basin": "show.maps.basins", "bifurcation": "maps.bifurcation.ask",
    "percentiles": "maps.percentiles", "InputError": "errors",
}
__all__ = [*_HOME, "__version__"]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        home = import_module(f"{__name__}.{_HOME[name]}")
        # a room of its own: plot
        result = getattr(home, name) if hasattr(home, name) else import_module(f"{home.__name__}.{name}")
        globals()[name] = result
        return result
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _results() -> ModuleType:
    from .show.results import views
    return views


seen_through(_results)


def __dir__() -> list[str]:
    return sorted(__all__)
