"""The reference: an entry of Sphinx's autodoc for every public name, in groups, and what makes plain
docstrings readable to it."""
from __future__ import annotations

import inspect
import re
from dataclasses import MISSING, fields, is_dataclass
from importlib import import_module

GROUPS = {
    "A case": ("load", "load_burning", "load_orbiting", "example", "Case", "Body", "Scene",
               "ScaledGyrostat", "Gyrostat", "ConstantTorque", "Charge", "Resistance", "LiquidCavity",
               "NewtonianField", "Gravity", "BodyForce", "ViscousDamper", "DamperWheel", "DamperMass",
               "RateDamper", "EddyCurrents",
               "WheelMotor",
               "report"),
    "Questions about a motion": ("fate", "Fate", "fate_grid", "motion", "extremes", "period", "attitude",
                                 "angles",
                                 "spin_up", "stuck", "burn", "flat_spin", "chaos", "when", "time_to",
                                 "TimeTo", "validity"),
    "Questions about all motions": ("equilibria", "circular_orbit", "separatrix"),
    "Many cases at once": ("sweep", "percentiles", "atlas", "basin", "bifurcation"),
    "Motions in time": ("trajectory", "ensemble", "simulate", "compare", "theory", "derive"),
    "Errors": ("InputError",),
}
# What the questions answer, and the plots: name -> module
ANSWERS = {"Motions": "stabilab.answers.motions.result", "Values": "stabilab.answers.motions.result",
           "Motion": "stabilab.orbit.result",
           "Equilibria": "stabilab.equilibrium.result",
           "EquilibriumPoint": "stabilab.equilibrium.result",
           "EquilibriumCurve": "stabilab.equilibrium.result",
           "CurveSegment": "stabilab.equilibrium.result",
            "Separatrix": "stabilab.orbit.separatrix.homoclinic",
           "Branch": "stabilab.orbit.separatrix.homoclinic",
           "SpinUp": "stabilab.unreduced.spin_up.result", "Trajectory": "stabilab.integrate.trajectory",
           "Simulation": "stabilab.answers.simulate",
           "Ensemble": "stabilab.integrate.ensemble", "Stuck": "stabilab.answers.stuck.margins",
           "Attitude": "stabilab.answers.turning.result", "Crossings": "stabilab.answers.when",
           "Angles": "stabilab.answers.motions.angles",
           "Burned": "stabilab.answers.stuck.burn",
           "Closed": "stabilab.answers.stuck.burn",
           "Latest": "stabilab.answers.stuck.burn",
           "CircularOrbit": "stabilab.answers.circular_orbit",
           "OrbitEquilibria": "stabilab.equilibrium.circular_orbit",
           "OrbitEquilibrium": "stabilab.equilibrium.circular_orbit",
           "MomentumSpan": "stabilab.equilibrium.circular_orbit",
           "FlatSpin": "stabilab.answers.dissipation.flat_spin",
           "Span": "stabilab.answers.dissipation.changes",
           "Ending": "stabilab.answers.dissipation.ending",
           "Comparison": "stabilab.theories.theory"}


def text() -> str:
    """A heading a group, an entry a public name. A public name that no group has is an error: the page is
    whole."""
    import stabilab
    placed = {name for names in GROUPS.values() for name in names} | {"plot", "__version__"}
    if missing := set(stabilab.__all__) ^ placed:
        raise ValueError(
            f"docs/making/reference.py, GROUPS: {', '.join(sorted(missing))} stand in one of it and "
            f"stabilab.__all__ only")
    parts = [
        "# Reference\n\nEvery public name of `import stabilab`. Arrays have their components in the last "
        "place. Wherever a scene or a case is taken, the other one, the path of a case file, its text or a "
        "dict with its tables will do, and text with a unit for a number ([From Python](python.md)).\n"]
    for title, names in GROUPS.items():
        parts.append(f"## {title}\n")
        parts += [_entry(f"stabilab.{name}", getattr(stabilab, name)) for name in names]
    parts.append("## Pictures\n")
    parts += [_entry(f"stabilab.plot.{name}", getattr(stabilab.plot, name)) for name in stabilab.plot.__all__]
    parts.append("## What the answers hold\n")
    parts += [_entry(f"{module}.{name}", getattr(import_module(module), name)) for name,
              module in ANSWERS.items()]
    return "\n".join(parts)


def _entry(name, thing) -> str:
    kind = ("function" if not inspect.isclass(thing) else "exception" if issubclass(thing, Exception)
            else "class")
    members = "\n   :members:" if kind == "class" else ""
    members += "\n   :inherited-members:" if thing.__name__ == "Case" else ""  # the questions it answers
    return f"```{{eval-rst}}\n.. auto{kind}:: {name}{members}\n```\n"


def as_rst(app, what, name, obj, options, lines):
    """Docstrings are plain sentences with names in single backticks: as literals, and nothing else as markup.
    """
    found = re.sub(r"(?<!`)`([^`\n]+)`(?!`)", r"``\1``", "\n".join(lines))
    parts = re.split(r"(``[^`]+``)", found)
    lines[:] = "".join(part if part.startswith("``") else re.sub(r"([*|\\]|_(?=\W|$))", r"\\\1", part)
                       for part in parts).split("\n")


def of_fields(app, what, name, obj, options, signature, returned):
    """The signature of a record by its fields: what makes them takes anything, to say in words what is
    missing, or has defaults that are no expressions."""
    if what != "class" or not is_dataclass(obj):
        return None
    given = []
    for one in fields(obj):
        if one.init:
            made = (f" = {one.default_factory.__name__}()" if one.default_factory is not MISSING
                    else f" = {one.default!r}" if one.default is not MISSING else "")
            given.append(f"{one.name}: {one.type}{made}")
    return f"({', '.join(given)})", returned
