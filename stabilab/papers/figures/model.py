"""Figure 1 of each paper: its model, drawn from a case by what the scene contains."""
from __future__ import annotations

from ...case.read import Case
from ...show.plot.body import BOX, PARTS, body
from . import panels
from .figure import Figure

SKETCH = ("a sketch: directions and the proportions of the box are those of the case, lengths of arrows are "
          "not")


def model_figure(name: str, paper: str = "") -> Figure:
    """Figure 1 of a paper, from a case file of the repository."""
    return Figure(1, "The model", lambda: words(panels.sweep(name)[""]),
                  lambda plt: draw(plt, panels.sweep(name)[""]), SKETCH, paper)


def words(case: Case) -> str:
    """The caption: the case, and what is drawn of it."""
    parts = ", ".join([BOX, *(PARTS[effect.name][0] for effect in case.physical.effects)])
    return f"Drawn from the case {case.name} by what its scene contains: {parts}."


def draw(plt, case: Case):
    """The body of a case with every effect of its scene."""
    return body(case, size=(7.2, 6.6), bare=True).figure
