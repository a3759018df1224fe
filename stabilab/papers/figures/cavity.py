"""Figures 2-13 of Galal et al., liquid cavity: families in lambda3, zeta, M3 and e, each beside the exact
motion."""
from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from ...theories.cavity.averaged import RTOL, polar
from . import panels
from .figure import Figure, listed, model_figure

PAPER = "Galal, Amer, Elneklawy, El-Kafly 2023, charged rigid body with a viscous liquid"
SPAN, POINTS = 20.0, 2001
FAMILIES: dict[str, tuple[str, str, dict[float, str]]] = {  # family -> (symbol, unit, value -> case file)
    "small": (r"\lambda_3", r"kg m$^2$/s",
              {0.1: "liquid-base", 0.15: "liquid-lambda3-0_15", 0.2: "liquid-lambda3-0_2"}),
    "large": (r"\lambda_3", r"kg m$^2$/s",
              {15: "liquid-lambda3-15", 20: "liquid-lambda3-20", 25: "liquid-lambda3-25"}),
    "zeta": (r"\zeta", r"s$^{-1}$", {1.5: "liquid-zeta-1_5", 2: "liquid-base", 2.5: "liquid-zeta-2_5"}),
    "M3": ("M_3", "N m", {-3: "liquid-torque-3", -6: "liquid-base", -9: "liquid-torque-9"}),
    "e": ("e", "C", {0.01: "liquid-base", 1e3: "liquid-charge-1e3", 1e4: "liquid-charge-1e4"})}
LAMBDA, ZETA, TORQUE, CHARGE = (r"$\lambda_3=0.1$ kg m$^2$/s", r"$\zeta=2$ s$^{-1}$", r"$M_3=-6$ N m",
                                r"$e=0.01$ C")
DATA = {name: ", ".join(given) for name, given in {
    "small": (ZETA, TORQUE, CHARGE), "large": (ZETA, TORQUE, CHARGE), "zeta": (LAMBDA, TORQUE, CHARGE),
    "M3": (LAMBDA, ZETA, CHARGE),
    "e": (LAMBDA, ZETA, TORQUE)}.items()}
RATES = (panels.history("omega", 0, "$p$", "rad/s"), panels.history("omega", 1, "$q$", "rad/s"))
PLANES = (panels.phase("omega", 0, "$p$", "rad/s"), panels.phase("omega", 1, "$q$", "rad/s"))


def _slow(name):
    """pick of the amplitude, spin or phase, of the exact motion by `polar`."""
    return lambda run: (run.t, run.state[name])


SLOW = (panels.Row(panels.TIME, "$a$ (rad/s)", _slow("amplitude")),
        panels.Row(panels.TIME, "$r$ (rad/s)", _slow("spin")),
        panels.Row(panels.TIME, r"$\varphi$ (rad)", _slow("phase")))


def _lines(family, rows):
    """(row, columns) of every row of the figure."""
    symbol, unit, files = FAMILIES[family]
    columns = [panels.Column(rf"${symbol}={value:g}$ {unit}", _runs(name),
                             refused=panels.refusals(name, "", SPAN, POINTS, crowd=2)) for value,
               name in files.items()]
    return [(row, columns) for row in rows]


def _family(plt, family, rows, title, own=False):
    return panels.draw_lines(plt, f"{title}: {DATA[family]}, $M_1=M_2=0$", _lines(family, rows), own=own)


# -- captions, with their numbers


@lru_cache(maxsize=16)
def _runs(name) -> dict:
    """model -> run of a case, the exact one with its amplitude, spin and phase: how the angle of (p, -q) goes
    on when p and q have died out is lost in p and q themselves."""
    runs, case = panels.motions(name, "", SPAN, POINTS, crowd=2), panels.sweep(name)[""]
    exact = runs["exact"]
    return runs | {"exact": replace(exact, state=exact.state | polar(case.scene, case.state, exact.t))}


def runs_of(family) -> list[dict]:
    """model -> run of each value of a family, over the figures' span."""
    return [_runs(name) for name in FAMILIES[family][2].values()]


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


def _done(words="", own=False):
    """own: whether each panel has limits of its own, and no column shows the printed curves alone."""
    scene = panels.sweep("liquid-base")[""].scene
    liquid, body = scene.effect("liquid_cavity"), scene.body.inertia[2]
    return (f"{words}Completed data: values in the title where the paper gives none; P0 = "
            f"{float(liquid.P0):g} m^7 means "
            f"{liquid_mass(liquid) / 1000:.2g} t of liquid in a body of {float(body):g} kg m^2. Models are "
            f"drawn to where they leave the exact "
            f"motion's range{'' if own else '; where printed ones do, the last panels have them alone'}.")


def _real(family):
    """Fig. 2: where the printed q loses its real value."""
    ends = {value: runs["printed"].t[-1] for value, runs in zip(FAMILIES[family][2], runs_of(family))
            if runs["printed"].status != "reached"}
    return _done("Exact: a = sqrt(p^2 + q^2) and the angle of (p, −q); averaged, second order: the averaged "
                 "variables, which start beside "
                 f"them. At lambda3 = {listed(ends, '{:g}')} the printed q loses its real value at "
                 f"{listed(ends.values())} s, where "
                 "d2 r = Gamma/eps; the true motion is regular there. ")


def _liquid(family, more=""):
    return _done(f"{more}The printed liquid torque is that of a body without rotor; with this one the true "
                 f"motion dies out within "
                 f"{listed([gone(r) for r in runs_of(family)], '{:.2g}')} s (1 %), the printed wave hardly "
                 f"decays. ")


def _short(family):
    return _done("The printed polynomials of second degree turn back: phi falls from "
                 f"{listed([turning(r) for r in runs_of(family)])} s on, in truth it still grows at "
                 f"{SPAN:g} s. ")


def _arcs(family):
    return _done("The text has spirals; over 20 s with these data the curves are arcs. ")


def _few(family):
    return _done(f"In {SPAN:g} s the vector (p, q) turns by "
                 f"{listed([turn(r) for r in runs_of(family)], '{:.2g}')} rad, not a tenth of a turn: with "
                 "lambda3 = 0.1 there are no waves. The print must have taken a lambda3 it does not state. ")


def _charge(family, more="", own=False):
    return _done("1000 and 10,000 C are not charges that a body can hold. At 10,000 C the liquid's own time "
                 "exceeds that of the turn: "
                 f"averaging refuses, and the law of the liquid torque itself no longer holds. {more}", own)


def _exactness(family, more=""):
    return (
        f"{panels.exactness(runs_of(family))}; averaged: relative tolerance {RTOL:g}; printed: its "
        f"polynomials; {POINTS} points{more}")


def _figures():
    slow, rates, planes = partial(_family,
                                  rows=SLOW), partial(_family, rows=RATES), partial(_family, rows=PLANES)
    three = "Amplitude, spin and phase"
    for n, family, draw, title, words in (
            (2, "small", slow, three, _real), (3, "large", rates, "Angular velocities", _liquid),
            (4, "large", planes, "Phase planes",
             partial(_liquid, more="The text has closed curves; the true motion spirals in within one "
                                                         "turn. ")),
            (5, "zeta", slow, three, _short), (6, "zeta", rates, "Angular velocities", _few),
            (7, "zeta", planes, "Phase planes", _arcs),
            (8, "M3", slow, three, _short), (9, "M3", rates, "Angular velocities", _few),
            (10, "M3", planes, "Phase planes", _arcs),
            (11, "e", partial(slow, own=True), three, partial(_charge, own=True)),
            (12, "e", rates, "Angular velocities",
             partial(_charge, more="The text says that the charge acts slightly: the printed liquid "
                                                           "torque does not know of it. ")),
            (13, "e", partial(planes, own=True), "Phase planes", partial(_charge, own=True))):
        more = "; rates by central differences" if title == "Phase planes" else ""
        yield Figure(n, f"{title}: {NAMES[family]}", partial(words, family),
                     partial(draw, family=family, title=title),
                     partial(_exactness, family, more), "cavity",
                     partial(_lines, family, draw.keywords["rows"]))


NAMES = {"small": "λ3 = 0.1 to 0.2", "large": "λ3 = 15 to 25", "zeta": "family of ζ", "M3": "family of M3",
         "e": "family of e"}
FIGURES = (model_figure("liquid-base", "cavity"), *_figures())
