"""Claims of the fast top's text that no formula says."""
from __future__ import annotations


def _lambda1(square, numerator=0.3):
    """lambda1 of (10) as a function of Omega^2, with a numerator that does not vanish."""
    return numerator / (1 - square)


def _poles():
    near, far = _lambda1(1 - 1e-9), _lambda1(0.25)
    return near / far - 1, (near * 1e-9 - far * 0.75) / 0.3


TESTS = {"poles": _poles}
