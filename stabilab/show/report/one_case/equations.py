"""The equations of motion and the laws of a case, typeset."""
from __future__ import annotations

from ....physics.equations import derive
from ....physics.laws import invariants
from ...axes import axes_of
from ...text.notation import latex
from ...units import parameter_unit
from .. import typeset
from .measures import spoken, told


def equations(case) -> dict:
    """Equations, parameters and laws for the template."""
    made = derive(case.scene)
    laws = invariants(case.scene)
    return {"equations": typeset.equations_of_motion(made), "latex": latex(made),
            "parameters": [(typeset.symbol(name), told(float(value), _unit(case, name), 6)) for name, value in made.parameters.items()],
            "laws": [(spoken(axes_of(case).sentence(law.words)), typeset.law(law)) for law in laws]}


def _unit(case, name):
    return parameter_unit(name).replace("^2", "²").replace("^3", "³") if case.variables == "physical" else ""
