"""Claims of the fast top's text that no formula says."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ....answers.simulate import simulate
from ....case.read import load_all
from ...table import cases_folder
from .trend import trend

FAMILIES = {"lx": ("lx30-lz30", "lx60-lz30", "lx90-lz30"), "lz": ("lx30-lz30", "lx30-lz60", "lx30-lz90")}
END = 1.3  # s, of the paper's figures
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


@lru_cache
def _run(name):
    """The exact motion of a case of Table 1."""
    case, = load_all(cases_folder() / f"top-{name}.toml")
    return simulate(case, times=np.linspace(0, END, 1301))


def _trend(part, axis, measure, family, goes, truth=""):
    """How the amplitude of a component of the exact motion, or how often it turns, goes along a family."""
    parts = [np.asarray(_run(name).state[part])[:, axis - 1] for name in FAMILIES[family]]
    measured = {"amplitude": lambda x: np.ptp(x) / 2,
                "turns": lambda x: (np.diff(np.sign(np.diff(x))) != 0).sum()}
    return trend([float(measured[measure](x)) for x in parts], goes, truth)


def _closed():
    """Least distance of the exact (p, q, r, gamma) from its start after 0.1 s, over its distance at most: a
    closed curve comes back; the share of the three cases of a family in which it does."""
    shares = []
    for name in FAMILIES["lx"]:
        state = _run(name).state
        away = np.linalg.norm(np.hstack([state["omega"], state["gamma"]])
                              - np.hstack([state["omega"][0], state["gamma"][0]]), axis=1)
        shares.append(float(away[100:].min() / away.max()))
    return min(shares), sum(share < 1e-2 for share in shares)


TESTS = {"poles": _poles, "trend": _trend, "closed": _closed}
