"""Figures 2-7 of Amer et al. 2023, fast top in a Newtonian field: families in l_x and l_z, each beside the exact motion."""
from __future__ import annotations

from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from . import panels
from .figure import Figure

PAPER = "Amer, Amer, Galal 2023, rigid body in a Newtonian field with a gyrostatic moment"
SPAN, POINTS, ORDER = 1.3, 2601, 2
FAMILIES = {"lx": [(30, 30), (60, 30), (90, 30)], "lz": [(30, 30), (30, 60), (30, 90)]}
SIX = [("omega", 0, "$p$", "rad/s"), ("omega", 1, "$q$", "rad/s"), ("omega", 2, "$r$", "rad/s"), ("gamma", 0, r"$\gamma$", ""),
       ("gamma", 1, r"$\gamma\,'$", ""), ("gamma", 2, r"$\gamma\,''$", "")]
HISTORIES = tuple(panels.history(*row) for row in SIX)
PLANES = tuple(panels.phase(*row) for row in SIX)
ANGLES = tuple(panels.history("euler", i, name, "rad") for i, name in enumerate((r"$\theta$", r"$\varphi$", r"$\psi$")))


def _columns(family, angles=False):
    for lx, lz in FAMILIES[family]:
        value, name = (lx, r"\ell_x") if family == "lx" else (lz, r"\ell_z")
        case = f"top-lx{lx}-lz{lz}"
        runs = panels.motions(case, "", SPAN, POINTS, ORDER)
        yield panels.Column(rf"${name}={value}$ kg m$^2$/s", _with_angles(case) if angles else runs)


@lru_cache(maxsize=8)
def _with_angles(name):
    """The runs of a case with a part "euler": theta, phi, psi."""
    from ..analysis.small_parameter_angles import euler_angles
    from ..analysis.small_parameter_printed import printed
    case, found = panels.sweep(name)[""], {}
    for model, run in panels.motions(name, "", SPAN, POINTS, ORDER).items():
        if model == "printed":
            a = printed(case.scene, {"omega": case.state, "gamma": case.blocks["gamma"]}, run.t)
        else:
            a = euler_angles(run.t, run.state["omega"], run.state["gamma"])
        found[model] = replace(run, state=run.state | {"euler": np.stack([a.theta, a.phi, a.psi], -1)})
    return found


def _family(plt, family, rows, title):
    other = r"$\ell_z=30$" if family == "lx" else r"$\ell_x=30$"
    return panels.draw(plt, f"{title}, {other} kg m$^2$/s", list(_columns(family, rows is ANGLES)), rows, width=3.1, height=1.38,
                       words={"lindstedt": "corrected expansion, order 2"})


_TOL = ("exact motion: Taylor integration, relative tolerance 1.1e-16; printed and corrected: their formulas to rounding; "
            "2601 points")
_FAST = ("Table 1 is no fast top: M g L/(C r0^2) = 8.2 and eps delta1 = 4.5 where both should be small, so r goes from 5 to "
         "-4.7 rad/s in 0.1 s, and no expansion in 1/r0 follows, corrected or not (its terms grow). {}Curves out of the "
            "exact motion's range are "
            "cut.")
_UNIT = "The printed |gamma|, which is 1, reaches 13; the printed r reaches -73 rad/s. "
_FREE = "The text calls the closed printed curves stable and free of chaos; the true curves do not close. "
_PSI = ("The printed nutation swings far with the period 2 pi/r0 = 1.26 s, the true one little and irregularly; phi swings "
        "to and fro by 1.1 rad, it does not turn with r0 t. ")


def _figures():
    for n, family, rows, title, words in (
            (2, "lx", HISTORIES, "Histories", _UNIT + "The text sees l_x change q and gamma'' only; in truth it changes all "
                "six. "),
            (3, "lz", HISTORIES, "Histories", _UNIT), (4, "lx", PLANES, "Phase planes", _FREE), (5, "lz", PLANES, "Phase planes", _FREE),
            (6, "lx", ANGLES, "Euler angles", _PSI), (7, "lz", ANGLES, "Euler angles", _PSI)):
        name = "l_x = 30, 60, 90" if family == "lx" else "l_z = 30, 60, 90"
        yield Figure(n, f"{title}: {name}", _FAST.format(words), partial(_family, family=family, rows=rows, title=title),
                     _TOL + ("; rates by central differences" if rows is PLANES else ""), "top")


FIGURES = tuple(_figures())
