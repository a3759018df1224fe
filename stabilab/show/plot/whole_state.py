"""Every part of a longer state over time, the analytic models beside the exact motion."""
from __future__ import annotations

from typing import Any

import numpy as np

from ...theories.comparison import side_by_side
from ..terminal.letters import written
from ..text import comparison
from . import which
from .subject import DEFAULT_SPAN, subject

POINTS = 801


def state(case: Any, start: Any = None, span: Any = None) -> Any:
    """Draw every part of the state over time, a row a part and a column a component, and return the figure: rates, direction of the vertical,
    attitude, momentum, velocity, place, as far as the scene has them; the analytic models that apply are beside the exact motion."""
    from matplotlib import pyplot as plt
    one = subject(case, start, span)
    which.check("state", one)
    begin, end = one.span or DEFAULT_SPAN
    runs, _ = side_by_side(one, np.linspace(begin, end, POINTS))
    parts = [name for name in comparison.NAMES if name in runs["exact"].state]
    figure, law = comparison.picture(plt, one, runs, parts), runs["exact"].validity
    if law is not None and not law.held:
        figure.suptitle(f"{written(one.heading)}\n{law.short}", fontsize=10, parse_math=False, wrap=True)
    return figure
