"""SciPy's DOP853 in the place of the Taylor series, where heyoka is not installed: its steps, and roots on their interpolants."""
from __future__ import annotations

import numpy as np

from .trajectory import ATOL_SHARE, FALLBACK_RTOL


def stand_in(rate, state, end: float, t: float = 0.0, rtol: float = FALLBACK_RTOL, atol: float | None = None):
    """The solver from a state (n,) at time t until `end`; rate: of a list of floats. atol: by default `floor` of the state."""
    from scipy.integrate import DOP853
    return DOP853(lambda _, x: np.array(rate(x.tolist())), t, state, end, rtol=rtol, atol=floor(state, rtol) if atol is None else atol)


def floor(state, rtol: float) -> float:
    """The absolute tolerance that keeps a relative one meaningful at zero crossings."""
    return rtol * ATOL_SHARE * (np.abs(state).max() or 1.0)


def sign_changes(values) -> np.ndarray:
    """The places n of a row at which entries n and n + 1 have opposite signs."""
    return np.nonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)[0]


def root_between(function, dense, low: float, high: float) -> float:
    """The time between two at which a function of the interpolant's state is zero."""
    from scipy.optimize import brentq
    return brentq(lambda t: function(dense(t)), low, high, xtol=1e-300, rtol=1e-15)
