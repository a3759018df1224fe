"""Figures 2-7 of Amer et al. 2023, fast top in a Newtonian field: families in l_x and l_z, each beside the
exact motion."""
from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...theories.euler_angles import euler_angles
from ...theories.top import printed
from ...theories.top_expansion import fast_top
from .. import families
from ..families import compared, sweep
from . import panels
from .figure import family_figures, model_figure

PAPER = "Amer, Amer, Galal 2023, rigid body in a Newtonian field with a gyrostatic moment"
FAMILIES, SPAN = families.FAMILIES["top"], families.SPANS["top"]
REFERENCE = 15.0  # kg m^2: A0 of Table 1
THOUSAND = "10$^3$"  # unit of gamma1: numbers that fit above a panel
SIX = [("omega", 0, "$p_1$", ""), ("omega", 1, "$q_1$", ""), ("omega", 2, "$r_1$", ""),
       ("gamma", 0, r"$\gamma_1$", THOUSAND), ("gamma", 1, r"$\gamma_1'$", THOUSAND),
       ("gamma", 2, r"$\gamma_1''$", THOUSAND)]
# kind of figure -> (title, its rows)
PANELS = {"histories": ("Histories", tuple(panels.history(*row) for row in SIX)),
         "planes": ("Phase planes", tuple(panels.phase(*row) for row in SIX)),
         "angles": ("Euler angles",
                    panels.histories("euler", (r"$\theta$", r"$\varphi$", r"$\psi$"), "rad"))}


def _lines(name: str, kind: str):
    """(row, columns) of every row of a figure."""
    family, visited = FAMILIES[name], _with_angles if kind == "angles" else _scaled
    columns = [replace(column, runs=visited(*case))
               for column, case in zip(panels.columns_of(family, SPAN), family.cases.values())]
    return [(row, columns) for row in PANELS[kind][1]]


def _units() -> tuple[np.ndarray, float]:
    """The paper's units, its (4): c sqrt(gamma0'') of p1 and q1 and r0 of r1, rad/s; gamma0'' of gamma1."""
    case = sweep("top-lx30-lz30")[""]
    top = fast_top(case.scene, {"omega": case.state, "gamma": case.blocks["gamma"]})
    across, spin = top.epsilon * float(top.r0), float(top.r0)
    return np.array([across, across, spin]), float(top.gamma[2])


@lru_cache(maxsize=8)
def _scaled(file: str, variant: str):
    """The runs of a case in the paper's variables p1, q1, r1, and gamma1, gamma1', gamma1'' in thousands;
    times in s."""
    rates, vertical = _units()

    def scaled(state: dict[str, np.ndarray]):
        return state | {"omega": np.asarray(state["omega"]) / rates,
                        "gamma": np.asarray(state["gamma"]) / (1000 * vertical)}
    return {model: replace(run, state=scaled(run.state))
            for model, run in compared(file, variant, SPAN)[0].items()}


@lru_cache(maxsize=8)
def _with_angles(file, variant):
    """The runs of a case with a part "euler": theta, phi, psi."""
    case, result = sweep(file)[variant], {}
    for model, run in compared(file, variant, SPAN)[0].items():
        if model == "printed":
            a = printed(case.scene, {"omega": case.state, "gamma": case.blocks["gamma"]}, run.t)
        else:
            a = euler_angles(run.t, run.state["omega"], run.state["gamma"])
        result[model] = replace(run, state=run.state | {"euler": np.stack([a.theta, a.phi, a.psi], -1)})
    return result


def _runs(family: str):
    return FAMILIES[family].runs(SPAN)


def _fast(family: str, more: str = ""):
    """The caption of every figure: what is wrong with the data."""
    case = sweep("top-lx30-lz30")[""]
    top = fast_top(case.scene, {"omega": case.state, "gamma": case.blocks["gamma"]})
    run, A = _runs(family)[0]["exact"], float(case.scene.body.inertia[0])
    r = np.asarray(run.state["omega"])[:, 2]
    return (f"Table 1 is no fast top: M g L/(C r0^2) = {np.hypot.reduce([float(f) for f in top.force]):.2g} "
            f"and eps delta1 = {A / REFERENCE - 1:.2g} where both should be small, so r goes from {r[0]:.3g} "
            f"to {np.interp(0.1, run.t, r):.2g} rad/s in 0.1 s, and no expansion in 1/r0 follows, corrected "
            f"or not (its terms grow). {more}Models are drawn to where they leave the exact motion's range; "
            "the last panels have the printed curves alone.")


def _unit(family: str, more: str = ""):
    printed = [runs["printed"].state for runs in _runs(family)]
    length = max(np.linalg.norm(s["gamma"], axis=1).max() for s in printed)
    r = min(s["omega"][:, 2].min() for s in printed)
    return _fast(family,
                 f"The printed |gamma|, which is 1, reaches {length:.3g}; the printed r reaches {r:.3g} "
                 f"rad/s. {more}") + _variables()


def _free(family: str):
    return _fast(family,
                 "The text calls the closed printed curves stable and free of chaos; the true curves do not "
                 "close. ") + (f"{_variables()} Rates are per second; the paper's dot, the rate in tau = "
                               f"r0 t, is {1 / _units()[0][2]:g} s times these.")


def _variables():
    """The variables of Figs 2-5 and their units."""
    (across, _, spin), vertical = _units()
    return (f" Drawn in the paper's variables: p1 and q1 in units of c sqrt(gamma0'') = {across:.4g} rad/s, "
            f"r1 of r0 = {spin:g} rad/s, gamma1, gamma1' and gamma1'' of gamma0'' = {vertical:g}.")


def _nutation(family: str):
    runs = [_with_angles(*case) for case in FAMILIES[family].cases.values()]
    swing = max(np.ptp(run["exact"].state["euler"][:, 1]) for run in runs)
    r0 = _runs(family)[0]["exact"].state["omega"][0, 2]
    return _fast(family,
                 f"The printed nutation swings far with the period 2 pi/r0 = {2 * np.pi / r0:.3g} s, the "
                 f"true one little and irregularly; phi swings to and fro within {swing:.2g} rad, it does "
                 "not turn with r0 t. The printed psi has csc(eps theta0), where csc theta0 is meant. ")


FIGURES = (model_figure("top-lx30-lz30", "top"), *family_figures(
    "top", PANELS, _lines, "printed and corrected: their formulas",
    ((2, "lx", "histories", _unit,
      "The text sees l_x change q and gamma'' only; in truth it changes all six. "),
     (3, "lz", "histories", _unit), (4, "lx", "planes", _free), (5, "lz", "planes", _free),
     (6, "lx", "angles", _nutation), (7, "lz", "angles", _nutation)),
    lambda number, kind: {"words": {"lindstedt": "corrected expansion, order 2"}}))
