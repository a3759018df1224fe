"""Figures 2-24 of Galal et al., charged rigid body: families in lambda3, e and M1, each beside the exact
motion."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ...theories.charged import body_of, one_frequency
from ...theories.charged import circle as by_35
from ...theories.charged_modes import SMALL_ANGLE, horizon
from .. import families
from ..families import Span
from . import panels
from .figure import Figure, family_figures, links, listed, model_figure

PAPER = "Galal et al., charged rigid body with a gyrostatic moment (short form: Elneklawy)"
FAMILIES, SPAN = families.FAMILIES["charged"], families.SPANS["charged"]
MOMENTUM = r"kg m$^2$/s"
# kind of figure -> (title, its rows)
PANELS: dict[str, tuple[str, tuple[panels.Row, ...]]] = panels.RATES | {
    "angles": ("Angles of the 3-1-2 sequence",
               panels.histories("angles", (r"$\psi$", r"$\phi$", r"$\theta$"), "rad")),
    "momentum": ("Angular momentum by (33)",
                 (*panels.histories("momentum", ("$G_1$", "$G_2$"), MOMENTUM),
                  panels.plane("momentum", 0, 1, ("$G_1$", "$G_2$"), MOMENTUM))),
    "velocity": ("Velocity", panels.histories("velocity", ("$v_1$", "$v_2$", "$v_3$"), "m/s")),
    "place": ("Displacement", panels.histories("position", (r"$\eta_1$", r"$\eta_2$", r"$\eta_3$"), "m"))}
PANELS["circle"] = "Angular momentum by (35)", PANELS["momentum"][1]


def _columns(name: str, span: Span = SPAN, marked: bool = True):
    """A column for each value, marked where the tilt is no longer small."""
    marks = [float(horizon(body)) if marked else None for body in _bodies(name)]
    return [replace(c, mark=mark) for c, mark in zip(panels.columns_of(FAMILIES[name], span), marks)]


def _lines(name: str, kind: str):
    """(row, columns) of every row of a figure; of "circle" with the momentum of (35) as the printed one."""
    columns = _columns(name)
    # ahead of the misprinted integrals the corrected motion is the printed one
    if kind not in ("velocity", "place"):
        columns = [_without_corrected(c) for c in columns]
    if kind == "circle":
        columns = [_by_35(body, c) for body, c in zip(_bodies(name), columns)]
    return [(row, columns) for row in PANELS[kind][1]]


def _without_corrected(column):
    return replace(column, runs={name: run for name, run in column.runs.items() if name != "corrected"})


def _by_35(body, column):
    """The column with the printed momentum of (35) in place of (33)."""
    run = column.runs["printed"]
    momentum = np.hstack([by_35(body, run.t), np.asarray(run.state["momentum"])[:, 2:]])
    printed = replace(run, state=run.state | {"momentum": momentum})
    return replace(column, runs=column.runs | {"printed": printed})


def _circle_lines():
    """Of Fig. 11: three spans of time."""
    body, parts = _bodies("M1")[0], []
    for end in (2.0, 10.0, SPAN.end):
        column = _without_corrected(_columns("M1", Span(end, SPAN.count), marked=False)[0])
        parts.append(replace(_by_35(body, column), heading=f"0 to {end:g} s", point=_centre(body)))
    return [(row, parts) for row in PANELS["circle"][1][2:]]


def _centre(body) -> tuple[float, float]:
    """Of the circle (35): (-M2, M1)/r0."""
    return -float(body.torque[1]) / float(body.spin), float(body.torque[0]) / float(body.spin)


def circle(plt):
    """Fig. 11: the momentum across the axis, by (35) and in truth, over three spans of time."""
    return panels.draw_lines(plt, f"Angular momentum across the axis $z_1$: "
                                  f"{FAMILIES['M1'].rest.removeprefix(', ')}, $M_1=4$ N m",
                             _circle_lines(), height=2.35,
                             words={"printed": "as printed: (35), a circle"}, own=True,
                             point_words="centre of (35), its mean")


def _pointing_lines():
    row = panels.Row("$v_1/v_3$", "$v_2/v_3$", _direction, limits=((-4.5, 8.5), (-4.5, 8.5)))
    return [(row, [replace(column, heading=column.heading + family.rest)
                   for column in _columns(name, marked=False)]) for name, family in FAMILIES.items()]


def pointing(plt):
    """Fig. 21: direction of the velocity; a line per family."""
    return panels.draw_lines(plt, "Direction of the velocity in inertial space", _pointing_lines(),
                             height=2.6)


AXIAL = 0.02  # m/s: below it the direction of the velocity is not drawn


def _direction(run):
    v = np.asarray(run.state["velocity"])[1:]
    axial = np.where(v[:, 2] > AXIAL, v[:, 2], np.nan)
    return v[:, 0] / axial, v[:, 1] / axial


# -- captions, with their numbers


def runs_of(name: str) -> list[dict]:
    """model -> run of each value of a family, over the figures' span."""
    return FAMILIES[name].runs(SPAN)


def _bodies(name: str):
    return [body_of(case) for case in FAMILIES[name].members]


def _state(family: str, model: str, part: str):
    return [np.asarray(runs[model].state[part]) for runs in runs_of(family)]


def _rates(family: str, more: str = ""):
    spins = listed([w[:, 2].max() for w in _state(family, "exact", "omega")], "{:.2f}")
    return ("p and q obey Euler's equations, which do not ask for small angles; the models hold r at r0, in "
            "truth it grows to "
            f"{spins} rad/s and shortens the period. The print adds a wrong frequency (8). {more}").rstrip()


def _rates_by_torque(family: str):
    period = 2 * np.pi / abs(float(one_frequency(_bodies(family)[0]).root))
    return _rates(family,
                  "The text says that amplitude and wavelength fall with M1; by its own formulas the "
                  f"amplitude is proportional to M1 and the period, {period:.3g} s, does not change.")


def _angles(family: str, more: str = ""):
    tilts = [np.hypot(*a[:, :2].T).max() for a in _state(family, "printed", "angles")]
    until = dict.fromkeys(f"{float(horizon(b)):.2f}" for b in _bodies(family))
    return (f"The print lets the tilt of psi and phi swing to {listed(tilts)} rad as if it were small. In "
            f"truth {SMALL_ANGLE:g} rad is outgrown after {listed(until, '{}')} s (dash-dotted), psi turns "
            f"back before pi/2, phi runs on, and theta is not r0 t. {more}{_CUT}.")


def _circle(family: str, more: str = ""):
    radii = dict.fromkeys(f"{b.torque[0] / float(b.spin):.1f}" for b in _bodies(family))
    return (f"By (35) G runs on a circle of radius M1/r0 = {listed(radii, '{}')} kg m^2/s. It leaves out the "
            "charge, whose force does change the momentum, and holds while the torque keeps its direction in "
            f"the tilted body, some seconds. {more}").rstrip()


def mean_pointing(body) -> float:
    """Angle of the mean momentum of (35) from z1, rad, with D3 r0 + lambda3 along the axis."""
    return float(np.arctan2(np.hypot(*_centre(body)), float(body.inertia[2]) * float(body.spin)
                            + float(body.gyrostat)))


def exact_mean_pointing() -> float:
    """Angle of the mean of the exact momentum from z1 over the time of the figures, rad; at the least M1."""
    run = runs_of("M1")[0]["exact"]
    mean = np.trapezoid(np.asarray(run.state["momentum"]), run.t, axis=0)
    return float(np.arctan2(np.hypot(*mean[:2]), mean[2]))


def _mean_pointing():
    printed, true = np.degrees([mean_pointing(_bodies("M1")[0]), exact_mean_pointing()])
    return (f"Its centre (0, M1/r0) is the mean momentum, which with D3 r0 + lambda3 along the axis points "
            f"{printed:.0f} degrees off z1, where the paper takes the mean pointing error sigma1 << 1 rad; "
            f"the mean of the exact momentum over {SPAN.end:g} s points {true:.0f} degrees off.")


def _by_33(family: str, more: str):
    return (
        f"By (33), {more} The exact momentum follows for some seconds only: the torque is fixed in the body, "
        f"and the body tips over.")


def _misprinted(family: str, part: str, unit: str):
    """How far the misprinted integrals are off, and where they divide by little."""
    off = [np.abs(a - b).max()
           for a, b in zip(_state(family, "printed", part), _state(family, "corrected", part))]
    down = [float(b.spin) - abs(float(one_frequency(b).root)) for b in _bodies(family)]
    return (f"The misprinted integrals are off by up to {listed(off)} {unit} from those that (44) and (49) "
            "define, the more the smaller r0 − W is "
            f"({listed(dict.fromkeys(f'{d:.2g}' for d in down), '{}')} 1/s), whose powers divide them"
            + ("; the changes that the text describes fit the corrected ones. " if family != "M1" else ". "))


def _thrust(family: str) -> tuple[float, float]:
    """(force along z, N; over the mass, m/s^2)."""
    scene = FAMILIES[family].members[0].scene
    force = float(scene.effect("body_force").exact[2])
    return force, force / float(scene.body.mass)


def _speed(family: str, more: str = ""):
    last, thrust = _state(family, "printed", "velocity")[0][-1, 2], _thrust(family)
    largest = max(np.abs(v).max() for v in _state(family, "exact", "velocity"))
    return (f"{_NAMED}Small angles keep the thrust of {thrust[0]:g} N along z1: the print has v3 = "
            f"{thrust[1]:g} t, {last:.3g} m/s at {SPAN.end:g} s. In truth the thrust turns with the body; "
            f"no component passes {largest:.2g} m/s. "
            f"{more}{_misprinted(family, 'velocity', 'm/s')}{_THIN}")


def _way(family: str, more: str = ""):
    printed = _state(family, "printed", "position")
    true = [x[-1, 2] for x in _state(family, "exact", "position")]
    start = [float(np.hypot(*x[0, :2])) for x in printed]
    return (f"The parabola eta3 = {_thrust(family)[1] / 2:g} t^2 ({printed[0][-1, 2]:.3g} m at "
            f"{SPAN.end:g} s) needs an axis that stays upright; in truth eta3 is {listed(true, '{:.0f}')} m. "
            f"{more}{_misprinted(family, 'position', 'm')}By (61) as printed the way does not even start at "
            f"0, but {listed(start)} m off. {_THIN}")


def _pointing():
    body = _bodies("M1")[0]
    M1, r0, D3 = float(body.torque[0]), float(body.spin), float(body.inertia[2])
    held, aim = D3 * r0 + float(body.gyrostat) - float(body.charge_moment), M1 / (D3 * r0**2)
    return (f"{_NAMED}The text has spirals into the point (0, M1/(D3 r0^2)) = (0, {aim:.2g}): a direction "
            f"{np.degrees(np.arctan(aim)):.0f} degrees off the axis, from equations for small angles. It "
            f"should be M1/(r0 (D3 r0 + Lambda)) = {M1 / (r0 * held):.2g} in the linear model; the true "
            f"direction goes nowhere near. Exact curve: where the axial velocity exceeds {AXIAL:g} m/s. As "
            "printed: by (43) and (47).")


_NAMED = "The paper writes omega1, omega2, omega3 for the velocity v1, v2, v3. "
_CUT = (
    "Models are drawn to where they leave the exact motion's range; the last panels have the printed "
    "curves alone")
_THIN = _CUT + ", thin those with corrected integrals where they differ."


CLOSED = "models: closed forms"


def _exactness(names):
    runs = [run for name in names for run in runs_of(name)]
    return f"{panels.exactness(runs)}; {CLOSED}; {SPAN.count} points"


AS_PRINTED = {"momentum": "as printed: (33)", "circle": "as printed: (35)"}  # kind -> of its printed curves
FIGURES = tuple(sorted((
    model_figure("charged-body", "charged"), *family_figures(
        "charged", PANELS, _lines, CLOSED,
        ((2, "lambda3", "rates", _rates),
         (3, "lambda3", "planes", "The printed ellipses are those of linear equations; the true curves are "
          "egg-shaped, because r is not constant."),
         (4, "e", "rates", _rates, "The text has amplitude and wavelength increase \"while their wavelengths "
          "decrease\": both increase."),
         (5, "e", "planes", "The curves widen with e, which takes k = e H l^2 cos sigma off lambda3. True "
          "curves: egg-shaped."),
         (6, "M1", "rates", _rates_by_torque),
         (7, "M1", "planes", "The text says that the curves shrink with growing M1; they grow, in print in "
          "proportion to M1."),
         (8, "lambda3", "angles", _angles), (9, "e", "angles", _angles),
         (10, "M1", "angles", _angles, "The text sees a marginal change of psi and phi with M1; in print "
          "they are proportional to it. "),
         (12, "lambda3", "momentum", _by_33, "lambda3 hardly matters."),
         (14, "e", "momentum", _by_33, "the charge widens the loops."),
         (16, "M1", "momentum", _by_33, "G is proportional to M1; the text has a marginal rise."),
         (13, "lambda3", "circle", _circle),
         (15, "e", "circle", _circle, "That the charge has no influence is an artefact."),
         (17, "M1", "circle", _circle, "The text says that M1 makes no difference."),
         (18, "lambda3", "velocity", _speed),
         (19, "e", "velocity", _speed, "The charge does change v3. "),
         (20, "M1", "velocity", _speed, "M1 does change v3. "),
         (22, "lambda3", "place", _way), (23, "e", "place", _way, "So the charge does matter to eta3. "),
         (24, "M1", "place", _way, "So M1 does matter to eta3. ")),
        lambda number, kind: {"words": {"printed": AS_PRINTED[kind]} if kind in AS_PRINTED else None,
                              "mark_words": f"tilt reaches {SMALL_ANGLE:g} rad"}),
    Figure(11, "Angular momentum across z1",
           lambda: _circle("lambda3", "The print draws the small circle of a body that hardly tilts. "
                           + _mean_pointing()),
           circle, partial(_exactness, ("M1",)), "charged", _circle_lines,
           cases=dict(list(links(FAMILIES["M1"]).items())[:1])),
    Figure(21, "Direction of the velocity", _pointing, pointing, partial(_exactness, tuple(FAMILIES)),
           "charged", _pointing_lines, cases=links(*FAMILIES.values()))), key=lambda row: row.number))
