"""What accuracy costs in time for one motion."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...cost.accuracy import Precision, precision
from ...errors import InputError
from .. import style
from ..report.precision_picture import meanings, panel, picture
from . import canvas, which
from .subject import subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

EFFORTS = ("full", "quick", "brief", "glance")
SIZE = (7.6, 6.2)


def budget(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, question: str = "span", effort: str = "quick",
           size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Measure what the digits of a motion cost, draw time against error, and return the axes.

    A line a method; the grey band is the front: no method is both faster and more accurate. question: "span" (states along the span), "end"
    (the state at its end), "period" or "extremes", where the motion has them. effort: "full" (a minute), "quick", "brief" or "glance" (a
    second). The times are measured, so two runs differ; everything else in the picture does not.
    """
    found = measured(case, state, span, effort)
    if question not in found.questions:
        raise InputError(f"question: expected one of {', '.join(found.questions) or 'none: ' + found.reference.reason}, got {question!r:.40}")
    with canvas.on(ax, size or SIZE) as target:
        panel(target, found, question)
        if legend:
            canvas.legend(target, meanings(found, (question,)), ax is None)
    return target


def measured(case: Any, state: Any = None, span: Any = None, effort: str = "quick") -> Precision:
    """The measurement that a plot shows."""
    one = subject(case, state, span)
    which.check("budget", one)
    if effort not in EFFORTS:
        raise InputError(f"effort: expected one of {', '.join(EFFORTS)}, got {effort!r:.40}")
    return precision(one, effort)


def whole(case: Any, plt: Any, size: tuple[float, float] | None = None) -> Any:
    """The figure with a panel for every question that the motion has, or for as many as a figure of this size has room for."""
    import matplotlib
    with matplotlib.rc_context(style.RC | style.letters(size)):
        return picture(plt, measured(case), size)
