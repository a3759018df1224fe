"""Claims of the fast top's text that no formula says."""
from __future__ import annotations

SCENE = {"z": 0.1, "k": 0.2, "wheel": 0.0}  # z0', k and l_z/r0 of a top without l_z


def _lambda1(C: float, A=1.0, B=1.1) -> tuple[float, float]:
    """(lambda1 of (10), Omega^2) of a body with these moments."""
    A1, B1 = (C - B) / A, (A - C) / B
    square = -A1 * B1
    return (SCENE["z"] * (A1 / (B / C) - C / A) + SCENE["k"] * (A1 - square)) / (1 - square), square


def _poles():
    """Size of lambda1 where C is 1e-9 short of A + B over that at C = 1.4, less one; the residue of the pole
    seen 1e-6 short of it against 1e-9, relative."""
    (near, at), (closer, there), (far, _) = _lambda1(2.1 - 1e-6), _lambda1(2.1 - 1e-9), _lambda1(1.4)
    return abs(closer / far) - 1, closer * (1 - there) / (near * (1 - at)) - 1


TESTS = {"poles": _poles}
