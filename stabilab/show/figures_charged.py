"""Figures 2-24 of Galal et al., charged rigid body: families in lambda3, e and M1, each beside the exact motion."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from . import panels
from .figure import Figure

PAPER = "Galal et al., charged rigid body with a gyrostatic moment (short form: Elneklawy)"
SWEEP, SPAN, POINTS = "charged-sweep", 50.0, 2001
# family -> (symbol, values as in the sweep file, unit, variant of the i-th value; the others stand at 1.3, 0.003, 4)
FAMILIES = {"lambda3": (r"\lambda_3", (1.3, 1.6, 1.9), r"kg m$^2$/s", "-{}-2-1"), "e": ("e", (0.001, 0.003, 0.005), "C", "-1-{}-1"),
            "M1": ("M_1", (4.0, 4.5, 5.0), "N m", "-1-2-{}")}
OTHERS = {"lambda3": r"$e=0.003$ C, $M_1=4$ N m", "e": r"$\lambda_3=1.3$ kg m$^2$/s, $M_1=4$ N m",
          "M1": r"$\lambda_3=1.3$ kg m$^2$/s, $e=0.003$ C"}
RATES = (panels.history("omega", 0, "$p$", "rad/s"), panels.history("omega", 1, "$q$", "rad/s"))
PLANES = (panels.phase("omega", 0, "$p$", "rad/s"), panels.phase("omega", 1, "$q$", "rad/s"))
ANGLES = tuple(panels.history("angles", i, name, "rad") for i, name in enumerate((r"$\psi$", r"$\phi$", r"$\theta$")))
MOMENTUM = (panels.history("momentum", 0, "$G_1$", r"kg m$^2$/s"), panels.history("momentum", 1, "$G_2$", r"kg m$^2$/s"),
            panels.plane("momentum", 0, 1, ("$G_1$", "$G_2$"), r"kg m$^2$/s"))
VELOCITY = tuple(panels.history("velocity", i, rf"$\omega_{i + 1}$", "m/s") for i in range(3))
PLACE = tuple(panels.history("position", i, rf"$\eta_{i + 1}$", "m") for i in range(3))


def _columns(family, end=SPAN, horizon=True):
    from ..analysis.axisymmetric_limits import horizon as until
    from ..analysis.axisymmetric_model import body_of
    symbol, values, unit, variant = FAMILIES[family]
    for i, value in enumerate(values, 1):
        name = variant.format(i)
        mark = float(until(body_of(panels.sweep(SWEEP)[name]))) if horizon else None
        yield panels.Column(rf"${symbol}={value:g}$ {unit}", panels.motions(SWEEP, name, end, POINTS), mark)


def _family(plt, family, rows, title, circle=False):
    columns = list(_columns(family))
    if circle:
        columns = [replace(c, runs={name: _by_35(family, i, run) if name == "printed" else run for name, run in c.runs.items()})
                   for i, c in enumerate(columns, 1)]
    words = {"printed": "as printed: (35)" if circle else "as printed: (33)"} if rows is MOMENTUM else {}
    return panels.draw(plt, f"{title}, {OTHERS[family]}", columns, rows, words=words, mark_words="tilt reaches 0.1 rad")


def _by_35(family, i, run):
    """The printed run with the momentum of (35) in place of (33)."""
    from ..analysis.axisymmetric_model import body_of
    from ..analysis.axisymmetric_printed import printed
    found = printed(body_of(panels.sweep(SWEEP)[FAMILIES[family][3].format(i)]), run.t)
    G3 = np.asarray(run.state["momentum"])[:, 2:]
    return replace(run, state=run.state | {"momentum": np.hstack([found.momentum_circle, G3])})


def circle(plt):
    """Fig. 11: the momentum across the axis, by (35) and in truth, over three spans of time."""
    parts = []
    for end in (2.0, 10.0, SPAN):
        c = next(iter(_columns("M1", end, horizon=False)))
        parts.append(replace(c, heading=f"0 to {end:g} s", runs={n: _by_35("M1", 1, r) if n == "printed" else r
                                                                 for n, r in c.runs.items()}))
    return panels.draw(plt, rf"Angular momentum across the axis $z_1$: {OTHERS['M1']}, $M_1=4$ N m", parts, MOMENTUM[2:], height=3.4,
                       words={"printed": "as printed: (35), a circle"}, own=True)


def pointing(plt):
    """Fig. 21: direction of the velocity; a line per family."""
    row = panels.Row(r"$\omega_1/\omega_3$", r"$\omega_2/\omega_3$", _direction, limits=((-4.5, 8.5), (-4.5, 8.5)))
    return panels.draw_lines(plt, "Direction of the velocity in inertial space",
                             [(row, list(_columns(family, horizon=False))) for family in FAMILIES], height=2.6)


def _direction(run):
    v = np.asarray(run.state["velocity"])[1:]
    axial = np.where(v[:, 2] > 0.02, v[:, 2], np.nan)
    return v[:, 0] / axial, v[:, 1] / axial


_TOL = "exact motion: Taylor integration, relative tolerance 1.1e-16; models: closed forms to rounding; 2001 points"
_PLANE = f"{_TOL}; rates by central differences"
_RATES = ("p and q obey Euler's equations, which do not ask for small angles; the models hold r at r0, in truth it grows to "
          "{} rad/s and shortens the period. The print adds a wrong frequency (8).")
_ANGLES = ("The print lets the tilt of psi and phi swing to {} rad as if it were small. In truth 0.1 rad is outgrown after "
           "{} s (green), psi turns back before pi/2, phi runs on, and theta is not r0 t.")
_CIRCLE = ("By (35) G runs on a circle of radius M1/r0 = {} kg m^2/s. It leaves out the charge, whose force does change the "
           "momentum, and holds while the torque keeps its direction in the tilted body, some seconds.")
_BY_33 = ("By (33), {} The exact momentum follows for some seconds only: the torque is fixed in the body, and the body tips "
          "over.")
_SPEED = ("Small angles keep the thrust of 3 N along z1: the print has omega3 = 0.3 t, 15 m/s at 50 s. In truth the thrust "
          "turns with the body; no component passes {} m/s. {}")
_WAY = "The parabola eta3 = 0.15 t^2 (375 m at 50 s) needs an axis that stays upright; in truth eta3 is {} m. {}"
_CUT = "Models that leave the exact motion's range are cut."


def _figures():
    rates, planes, angles = partial(_family, rows=RATES), partial(_family, rows=PLANES), partial(_family, rows=ANGLES)
    momentum, speed, way = partial(_family, rows=MOMENTUM), partial(_family, rows=VELOCITY), partial(_family, rows=PLACE)
    for n, family, draw, title, words, tolerance in (
            (2, "lambda3", rates, "Angular velocities", _RATES.format("0.59, 0.51 and 0.45"), _TOL),
            (3, "lambda3", planes, "Phase planes", "The printed ellipses are those of linear equations; the true curves are "
             "egg-shaped, because r is not constant.", _PLANE),
            (4, "e", rates, "Angular velocities", _RATES.format("0.54, 0.59 and 0.66") + " The text has amplitude and "
             "wavelength increase \"while their wavelengths decrease\": both increase.", _TOL),
            (5, "e", planes, "Phase planes", "The curves widen with e, which takes k = e H l^2 cos sigma off lambda3. True "
                "curves: egg-shaped.", _PLANE),
            (6, "M1", rates, "Angular velocities", _RATES.format("0.59, 0.65 and 0.70") + " The text says that amplitude and "
             "wavelength fall with M1; by its own formulas the amplitude is proportional to M1 and the period, 31.9 s, does "
             "not change.", _TOL),
            (7, "M1", planes, "Phase planes", "The text says that the curves shrink with growing M1; they grow, in print in "
                "proportion to M1.", _PLANE),
            (8, "lambda3", angles, "Angles of the 3-1-2 sequence", _ANGLES.format("15.9, 13.9 and 12.2", "0.66"), _TOL),
            (9, "e", angles, "Angles of the 3-1-2 sequence", _ANGLES.format("14.5, 15.9 and 17.3", "0.66"), _TOL),
            (10, "M1", angles, "Angles of the 3-1-2 sequence", _ANGLES.format("15.9, 17.8 and 19.8", "0.66, 0.62 and "
                "0.59") + " The text "
             "sees a marginal change of psi and phi with M1; in print they are proportional to it.", _TOL),
            (12, "lambda3", momentum, "Angular momentum by (33)", _BY_33.format("lambda3 hardly matters."), _TOL),
            (14, "e", momentum, "Angular momentum by (33)", _BY_33.format("the charge widens the loops."), _TOL),
            (16, "M1", momentum, "Angular momentum by (33)", _BY_33.format("G is proportional to M1; the text has a marginal "
                "rise."), _TOL),
            (13, "lambda3", partial(momentum, circle=True), "Angular momentum by (35)", _CIRCLE.format("14.1"), _TOL),
            (15, "e", partial(momentum, circle=True), "Angular momentum by (35)", _CIRCLE.format("14.1") + " That the charge "
             "has no influence is an artefact.", _TOL),
            (17, "M1", partial(momentum, circle=True), "Angular momentum by (35)", _CIRCLE.format("14.1, 15.9 and "
                "17.7") + " The text says "
             "that M1 makes no difference.", _TOL),
            (18, "lambda3", speed, "Velocity", _SPEED.format("3.1", ""), _TOL),
            (19, "e", speed, "Velocity", _SPEED.format("2.4", "The charge does change omega3."), _TOL),
            (20, "M1", speed, "Velocity", _SPEED.format("2.7", "M1 does change omega3."), _TOL),
            (22, "lambda3", way, "Displacement", _WAY.format("35, 15 and 76", ""), _TOL),
            (23, "e", way, "Displacement", _WAY.format("62, 35 and 19", "So the charge does matter to eta3."), _TOL),
            (24, "M1", way, "Displacement", _WAY.format("35, 60 and 8", "So M1 does matter to eta3."), _TOL)):
        title = f"{title}: {NAMES[family]}"
        yield Figure(n, title, f"{words} {_CUT}" if n > 7 else words, partial(draw, family=family, title=title.split(":")[0]), tolerance, "charged")
    yield Figure(11, "Angular momentum across z1", _CIRCLE.format("14.1") + " The print draws the small circle of a body "
            "that hardly tilts.",
                 circle, _TOL, "charged")
    yield Figure(21, "Direction of the velocity", "The print has spirals into the point (0, M1/(D3 r0^2)) = (0, 4.5): a "
                 "direction 77 degrees off the axis, from equations for small angles. It should be M1/(r0 (D3 r0 + Lambda)) "
                 "= 3.4 in the linear "
                 "model; the true direction goes nowhere near. Exact curve: where the axial velocity exceeds 0.02 "
                 "m/s.", pointing, _TOL, "charged")


NAMES = {"lambda3": "family of lambda3", "e": "family of e", "M1": "family of M1"}
FIGURES = tuple(sorted(_figures(), key=lambda row: row.number))
