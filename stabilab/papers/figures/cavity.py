"""Figures 2-13 of Galal et al., liquid cavity: families in lambda3, zeta, M3 and e, each beside the exact
motion."""
from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...theories.cavity import RTOL, polar
from .. import families
from ..families import compared, sweep
from . import panels
from .figure import family_figures, listed, model_figure

PAPER = "Galal, Amer, Elneklawy, El-Kafly 2023, charged rigid body with a viscous liquid"
FAMILIES, SPAN = families.FAMILIES["cavity"], families.SPANS["cavity"]
# kind of figure -> (title, its rows); amplitude, spin and phase of the exact motion by `polar`
PANELS = panels.RATES | {"slow": ("Amplitude, spin and phase", (
    panels.history("amplitude", None, "$a$", "rad/s"), panels.history("spin", None, "$r$", "rad/s"),
    panels.history("phase", None, r"$\varphi$", "rad")))}


def _lines(name: str, kind: str):
    """(row, columns) of every row of a figure."""
    columns = [replace(column, runs=runs)
               for column, runs in zip(panels.columns_of(FAMILIES[name], SPAN), runs_of(name))]
    return [(row, columns) for row in PANELS[kind][1]]


# -- captions, with their numbers


@lru_cache(maxsize=16)
def _runs(file: str, variant: str) -> dict:
    """model -> run of a case, the exact one with its amplitude, spin and phase: how the angle of (p, -q) goes
    on when p and q have died out is lost in p and q themselves."""
    runs, case = compared(file, variant, SPAN)[0], sweep(file)[variant]
    exact = runs["exact"]
    return runs | {"exact": replace(exact, state=exact.state | polar(case.scene, case.state, exact.t))}


def runs_of(name: str) -> list[dict]:
    """model -> run of each value of a family, over the figures' span."""
    return [_runs(*case) for case in FAMILIES[name].cases.values()]


def turn(runs) -> float:
    """Angle of (p, -q) of the exact motion at the end, rad, from 0."""
    return float(runs["exact"].state["phase"][-1])


def gone(runs) -> float:
    """Last time at which the amplitude of the exact motion is above 1 %, s."""
    return float(runs["exact"].t[np.nonzero(runs["exact"].state["amplitude"] > 0.01)[0][-1]])


def turning(runs) -> float:
    """When the printed phase turns back, s."""
    return float(runs["printed"].t[int(np.argmax(runs["printed"].state["phase"]))])


def liquid_mass(liquid) -> float:
    """kg of liquid in a sphere of the cavity's P0 = 8 pi h^7/525."""
    return 4 / 3 * math.pi * radius(liquid)**3 * liquid.density


def radius(liquid) -> float:
    """Radius h of a spherical cavity of that P0, m."""
    return (525 * liquid.P0 / (8 * math.pi)) ** (1 / 7)


def _done(text: str = "", own: bool = False):
    """own: whether each panel has limits of its own, and no column shows the printed curves alone."""
    scene = sweep("liquid-base")[""].scene
    liquid, body = scene.effect("liquid_cavity"), scene.body.inertia[2]
    return (f"{text}Completed data: values in the title where the paper gives none; P0 = "
            f"{float(liquid.P0):g} m^7 means {liquid_mass(liquid) / 1000:.2g} t of liquid in a body of "
            f"{float(body):g} kg m^2. Models are drawn to where they leave the exact motion's "
            f"range{'' if own else '; where printed ones do, the last panels have them alone'}.")


def _real(family):
    """Fig. 2: where the printed q loses its real value."""
    ends = {value: runs["printed"].t[-1] for value, runs in zip(FAMILIES[family].cases, runs_of(family))
            if runs["printed"].status != "reached"}
    return _done("Exact: a = sqrt(p^2 + q^2) and the angle of (p, −q); averaged, second order: the averaged "
                 f"variables, which start beside them. At lambda3 = {listed(ends, '{:g}')} the printed q "
                 f"loses its real value at {listed(ends.values())} s, where d2 r = Gamma/eps; the true "
                 "motion is regular there. ")


def _liquid(family, more=""):
    return _done(f"{more}{_dying(family)}")


def _short(family):
    return _done("The printed polynomials of second degree turn back: phi falls from "
                 f"{listed([turning(r) for r in runs_of(family)])} s on, in truth it still grows at "
                 f"{SPAN.end:g} s. ")


def _waves(family, more=""):
    return _done(f"{COMPLETED}In {SPAN.end:g} s the vector (p, q) turns by "
                 f"{listed([turn(r) for r in runs_of(family)], '{:.3g}')} rad. {_dying(family)}{more}")


def _spirals(family):
    return _waves(family, "Curves spiral in. ")


def _dying(family):
    """How the exact motion dies out beside the printed wave."""
    return ("The printed liquid torque is that of a body without rotor; with this one the true motion dies "
            f"out within {listed([gone(r) for r in runs_of(family)], '{:.2g}')} s (1 %), the printed wave "
            "hardly decays. ")


def _charge(family, more="", own=False):
    return _done("1000 and 10,000 C are not charges that a body can hold. At 10,000 C the liquid's own time "
                 "exceeds that of the turn: "
                 f"averaging refuses, and the law of the liquid torque itself no longer holds. {more}", own)


COMPLETED = (f"No figure states its wheel. The waves with nodes that the text describes need one of Fig. 3: "
             f"lambda3 = {families.WHEEL}; with the 0.1 of Fig. 2 (p, q) does not make a tenth of a turn. ")
OWN = (11, 13)  # figures whose panels have limits of their own
FIGURES = (model_figure("liquid-base", "cavity"), *family_figures(
    "cavity", PANELS, _lines, f"averaged: relative tolerance {RTOL:g}; printed: its polynomials",
    ((2, "small", "slow", _real), (3, "large", "rates", _liquid),
     (4, "large", "planes", _liquid,
      "The text has closed curves; the true motion spirals in within one turn. "),
     (5, "zeta", "slow", _short), (6, "zeta waves", "rates", _waves), (7, "zeta waves", "planes", _spirals),
     (8, "M3", "slow", _short), (9, "M3 waves", "rates", _waves), (10, "M3 waves", "planes", _spirals),
     (11, "e", "slow", _charge, "", True),
     (12, "e waves", "rates", _charge, f"{COMPLETED}The text says that the charge acts slightly: the printed "
      "liquid torque does not know of it. "),
     (13, "e waves", "planes", _charge, COMPLETED, True)),
    lambda number, kind: {"own": number in OWN}))
