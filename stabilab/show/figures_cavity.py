"""Figures 2-13 of Galal et al., liquid cavity: families in lambda3, zeta, M3 and e, each beside the exact motion."""
from __future__ import annotations

from functools import partial

import numpy as np

from . import panels
from .figure import Figure

PAPER = "Galal, Amer, Elneklawy, El-Kafly 2023, charged rigid body with a viscous liquid"
SPAN, POINTS = 20.0, 2001
FAMILIES = {  # family -> (symbol, unit, value -> case file)
    "small": (r"\lambda_3", r"kg m$^2$/s", {0.1: "liquid-base", 0.15: "liquid-lambda3-0_15", 0.2: "liquid-lambda3-0_2"}),
    "large": (r"\lambda_3", r"kg m$^2$/s", {15: "liquid-lambda3-15", 20: "liquid-lambda3-20", 25: "liquid-lambda3-25"}),
    "zeta": (r"\zeta", r"s$^{-1}$", {1.5: "liquid-zeta-1_5", 2: "liquid-base", 2.5: "liquid-zeta-2_5"}),
    "M3": ("M_3", "N m", {-3: "liquid-torque-3", -6: "liquid-base", -9: "liquid-torque-9"}),
    "e": ("e", "C", {0.01: "liquid-base", 1e3: "liquid-charge-1e3", 1e4: "liquid-charge-1e4"})}
DATA = {"small": r"$\zeta=2$, $M_3=-6$, $e=0.01$", "large": r"$\zeta=2$, $M_3=-6$, $e=0.01$",
        "zeta": r"$\lambda_3=0.1$, $M_3=-6$, $e=0.01$", "M3": r"$\lambda_3=0.1$, $\zeta=2$, $e=0.01$",
        "e": r"$\lambda_3=0.1$, $\zeta=2$, $M_3=-6$"}
RATES = (panels.history("omega", 0, "$p$", "rad/s"), panels.history("omega", 1, "$q$", "rad/s"))
PLANES = (panels.phase("omega", 0, "$p$", "rad/s"), panels.phase("omega", 1, "$q$", "rad/s"))


def _slow(name):
    """pick of the amplitude, spin or phase: the model's own, or sqrt(p^2 + q^2), r and the angle of (p, -q) of the motion."""
    def pick(run):
        if name in run.state:
            return run.t, run.state[name]
        p, q, r = np.asarray(run.state["omega"]).T
        return run.t, {"amplitude": np.hypot(p, q), "spin": r, "phase": np.unwrap(np.arctan2(-q, p))}[name]
    return pick


SLOW = (panels.Row(panels.TIME, "$a$ (rad/s)", _slow("amplitude")), panels.Row(panels.TIME, "$r$ (rad/s)", _slow("spin")),
        panels.Row(panels.TIME, r"$\varphi$ (rad)", _slow("phase")))


def _family(plt, family, rows, title, own=False):
    symbol, unit, files = FAMILIES[family]
    columns = [panels.Column(rf"${symbol}={value:g}$ {unit}", panels.motions(name, "", SPAN, POINTS, crowd=2)) for value, name in files.items()]
    return panels.draw(plt, f"{title}: {DATA[family]}, $M_1=M_2=0$", columns, rows, own=own)


_TOL = ("exact motion: Taylor integration, relative tolerance 1.1e-16; averaged: relative tolerance 1e-12; printed: its "
        "polynomials to rounding; 2001 points")
_PLANE = f"{_TOL}; rates by central differences"
_HOW = ("Exact: a = sqrt(p^2 + q^2) and the angle of (p, -q); averaged, second order: the averaged variables, which start "
            "beside them. ")
_SHORT = "The printed polynomials of second degree turn back: phi falls from {} s on, in truth it still grows at 20 s. "
_SLOW = ("In 20 s the body turns {} rad, not a tenth of a turn: with lambda3 = 0.1 there are no waves. The print must have "
         "taken a lambda3 it does not state. ")
_LIQUID = ("The printed liquid torque is that of a body without rotor; with this one the true motion dies out within {} s (1 "
           "%), the printed wave hardly decays. ")
_DONE = ("Completed data: values in the title where the paper gives none; P0 = 1.9 m^7 means 25 t of liquid in a body of 9 kg "
         "m^2. Models out of the exact motion's range are cut.")
_CHARGE = ("1000 and 10,000 C are not charges that a body can hold. At 10,000 C the liquid's own time exceeds that of the "
           "turn: averaging refuses, and the law of the liquid torque itself no longer holds. ")


def _figures():
    slow, rates, planes = partial(_family, rows=SLOW), partial(_family, rows=RATES), partial(_family, rows=PLANES)
    for n, family, draw, title, words, tolerance in (
            (2, "small", slow, "Amplitude, spin and phase", _HOW + "At lambda3 = 0.15 and 0.2 the printed q loses its real "
                "value at 15.5 and 7.7 s, where d2 r = Gamma/eps; "
             "the true motion is regular there. ", _TOL),
            (3, "large", rates, "Angular velocities", _LIQUID.format("4.3, 2.7 and 1.9"), _TOL),
            (4, "large", planes, "Phase planes", "The text has closed curves; the true motion spirals in within one turn. "
                + _LIQUID.format("4.3, 2.7 and 1.9"), _PLANE),
            (5, "zeta", slow, "Amplitude, spin and phase", _SHORT.format("18.8, 16.6 and 14.9"), _TOL),
            (6, "zeta", rates, "Angular velocities", _SLOW.format("0.47, 0.46 and 0.44"), _TOL),
            (7, "zeta", planes, "Phase planes", "The text has spirals; over 20 s with these data the curves are arcs. ",
             _PLANE),
            (8, "M3", slow, "Amplitude, spin and phase", _SHORT.format("18.0, 16.6 and 15.5"), _TOL),
            (9, "M3", rates, "Angular velocities", _SLOW.format("0.48, 0.46 and 0.43"), _TOL),
            (10, "M3", planes, "Phase planes", "The text has spirals; over 20 s with these data the curves are arcs. ", _PLANE),
            (11, "e", partial(slow, own=True), "Amplitude, spin and phase", _CHARGE, _TOL),
            (12, "e", rates, "Angular velocities", _CHARGE + "The text says that the charge acts slightly: the printed "
                "liquid torque does not know of it. ", _TOL),
            (13, "e", partial(planes, own=True), "Phase planes", _CHARGE, _PLANE)):
        yield Figure(n, f"{title}: {NAMES[family]}", words + _DONE, partial(draw, family=family, title=title), tolerance, "cavity")


NAMES = {"small": "lambda3 = 0.1 to 0.2", "large": "lambda3 = 15 to 25", "zeta": "family of zeta", "M3": "family of M3", "e": "family of e"}
FIGURES = tuple(_figures())
