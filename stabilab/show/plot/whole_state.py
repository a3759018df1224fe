"""Every part of a longer state over time, the analytic models beside the exact motion."""
from __future__ import annotations

from typing import Any

import numpy as np

from ...theories.comparison import side_by_side
from .. import style
from ..text import comparison
from . import which
from .measures import measures
from .path import SEEN, turning
from .subject import DEFAULT_SPAN, subject

POINTS = 801
CROWDED = 24  # turns of a rate: more of them are shown over the first so many, unless a span is asked for


def state(case: Any, start: Any = None, span: Any = None, size: tuple[float, float] | None = None, units: str | None = None) -> Any:
    """Draw every part of the state over time, a row a part and a column a component, and return the figure: rates, direction of the vertical,
    attitude, momentum, velocity, place, as far as the scene has them; the analytic models that apply are beside the exact motion. Of a case whose
    rates turn very often over its span the first turns are shown. size: (width, height) in inches; None: as many as the rows need. units: "deg" or
    "si", None for those of the case."""
    import matplotlib
    from matplotlib import pyplot as plt
    one = subject(case, start, span)
    which.check("state", one)
    scale = measures(one, units)
    begin, end = one.span or DEFAULT_SPAN
    runs, _ = side_by_side(one, np.linspace(begin, end, POINTS))
    if span is None and (turns := _turns(runs["exact"].state["omega"])) > CROWDED:
        runs, _ = side_by_side(one, np.linspace(begin, begin + (end - begin) * CROWDED / turns, POINTS))
    parts = [name for name in comparison.NAMES if name in runs["exact"].state]
    law = runs["exact"].validity
    with matplotlib.rc_context(style.RC | style.letters(size)):
        figure = comparison.picture(plt, one, runs, parts, size, scale.system)
        if law is not None and not law.held:
            figure.suptitle(style.literal(f"{one.heading}\n{law.short}"), fontsize=10 * style.share(), wrap=True)
    return figure


def _turns(rates: Any) -> int:
    """How often the rate turns that turns most; of one that all but stays the rounding is not counted."""
    still = SEEN * np.abs(rates).max()
    return max((turning(row) for row in np.asarray(rates).T if np.ptp(row) > still), default=0)
