"""The motion as a page draws it: in plain floats where these are sure of it, else in as many digits as it takes once the hand rests.

On an unstable plane, and on the separatrix itself, whatever a step in floats leaves grows until the line is another motion's.
"""
from __future__ import annotations

from ...case.read import Case
from ...integrate.quadratic_series import Path, followed, parting
from ...packages import present
from ...physics.quadratic import QuadraticForm
from . import other


def line(case: Case, form: QuadraticForm | None, until: float, moving: bool) -> Path:
    """(times, rates) of the motion from t = 0 on. form: its rates, where they are quadratic. moving: a hand that does not wait is shown the part of which
    floats are sure; so is a page without NumPy."""
    if form is None:
        return other.path(case, until)
    times, states = followed(form, case.state, until)
    known = parting(form, (times, states))
    if known < len(times) and not moving and present("numpy"):
        return other.path(case, times[-1])
    return times[:known], states[:known]
