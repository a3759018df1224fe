"""Figures 2-24 of Galal et al., charged rigid body: families in lambda3, e and M1, each beside the exact
motion."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ...theories.charged.corrected import one_frequency
from ...theories.charged.model import body_of
from ...theories.charged.model import circle as by_35
from ...theories.charged.modes import horizon
from ...theories.charged.modes import horizon as until
from . import panels
from .figure import Figure, listed, model_figure

PAPER = "Galal et al., charged rigid body with a gyrostatic moment (short form: Elneklawy)"
SWEEP, SPAN, POINTS = "charged-sweep", 50.0, 2001
# family -> (symbol, values as in the sweep file, unit, variant of the i-th value; the others stand at 1.3,
# 0.003, 4)
FAMILIES = {"lambda3": (r"\lambda_3", (1.3, 1.6, 1.9), r"kg m$^2$/s", "-{}-2-1"),
            "e": ("e", (0.001, 0.003, 0.005), "C", "-1-{}-1"),
            "M1": ("M_1", (4.0, 4.5, 5.0), "N m", "-1-2-{}")}
OTHERS = {"lambda3": r"$e=0.003$ C, $M_1=4$ N m", "e": r"$\lambda_3=1.3$ kg m$^2$/s, $M_1=4$ N m",
          "M1": r"$\lambda_3=1.3$ kg m$^2$/s, $e=0.003$ C"}
RATES = (panels.history("omega", 0, "$p$", "rad/s"), panels.history("omega", 1, "$q$", "rad/s"))
PLANES = (panels.phase("omega", 0, "$p$", "rad/s"), panels.phase("omega", 1, "$q$", "rad/s"))
ANGLES = tuple(panels.history("angles", i, name, "rad") for i,
               name in enumerate((r"$\psi$", r"$\phi$", r"$\theta$")))
MOMENTUM = (panels.history("momentum", 0, "$G_1$", r"kg m$^2$/s"),
            panels.history("momentum", 1, "$G_2$", r"kg m$^2$/s"),
            panels.plane("momentum", 0, 1, ("$G_1$", "$G_2$"), r"kg m$^2$/s"))
VELOCITY = tuple(panels.history("velocity", i, rf"$v_{i + 1}$", "m/s") for i in range(3))
PLACE = tuple(panels.history("position", i, rf"$\eta_{i + 1}$", "m") for i in range(3))


def _columns(family, end=SPAN, horizon=True):
    symbol, values, unit, variant = FAMILIES[family]
    for i, value in enumerate(values, 1):
        name = variant.format(i)
        mark = float(until(body_of(panels.sweep(SWEEP)[name]))) if horizon else None
        yield panels.Column(rf"${symbol}={value:g}$ {unit}", panels.motions(SWEEP, name, end, POINTS), mark)


def _lines(family, rows, circle=False):
    """(row, columns) of every row of the figure."""
    columns = list(_columns(family))
    # ahead of the misprinted integrals the corrected motion is the printed one
    if rows not in (VELOCITY, PLACE):
        columns = [_without(c, "corrected") for c in columns]
    if circle:
        columns = [replace(c, runs={name: _by_35(family, i, run) if name == "printed" else run for name,
                                    run in c.runs.items()})
                   for i, c in enumerate(columns, 1)]
    return [(row, columns) for row in rows]


def _family(plt, family, rows, title, circle=False):
    words = {"printed": "as printed: (35)" if circle else "as printed: (33)"} if rows is MOMENTUM else {}
    return panels.draw_lines(plt, f"{title}, {OTHERS[family]}", _lines(family, rows, circle), words=words,
                             mark_words="tilt reaches 0.1 rad")


def _without(column, model):
    return replace(column, runs={name: run for name, run in column.runs.items() if name != model})


def _by_35(family, i, run):
    """The printed run with the momentum of (35) in place of (33)."""
    across = by_35(body_of(panels.sweep(SWEEP)[FAMILIES[family][3].format(i)]), run.t)
    return replace(run, state=run.state
                   | {"momentum": np.hstack([across, np.asarray(run.state["momentum"])[:, 2:]])})


def _circle_lines():
    parts = []
    for end in (2.0, 10.0, SPAN):
        c = _without(next(iter(_columns("M1", end, horizon=False))), "corrected")
        parts.append(replace(c, heading=f"0 to {end:g} s",
                             runs={n: _by_35("M1", 1, r) if n == "printed" else r for n,
                                   r in c.runs.items()}))
    return [(row, parts) for row in MOMENTUM[2:]]


def circle(plt):
    """Fig. 11: the momentum across the axis, by (35) and in truth, over three spans of time."""
    return panels.draw_lines(plt, rf"Angular momentum across the axis $z_1$: {OTHERS['M1']}, $M_1=4$ N m",
                             _circle_lines(), height=2.35,
                             words={"printed": "as printed: (35), a circle"}, own=True)


def _pointing_lines():
    row = panels.Row("$v_1/v_3$", "$v_2/v_3$", _direction, limits=((-4.5, 8.5), (-4.5, 8.5)))
    return [(row, list(_columns(family, horizon=False))) for family in FAMILIES]


def pointing(plt):
    """Fig. 21: direction of the velocity; a line per family."""
    return panels.draw_lines(plt, "Direction of the velocity in inertial space", _pointing_lines(),
                             height=2.6)


def _direction(run):
    v = np.asarray(run.state["velocity"])[1:]
    axial = np.where(v[:, 2] > 0.02, v[:, 2], np.nan)
    return v[:, 0] / axial, v[:, 1] / axial


# -- captions, with their numbers


def runs_of(family) -> list[dict]:
    """model -> run of each value of a family, over the figures' span."""
    return [panels.motions(SWEEP, FAMILIES[family][3].format(i), SPAN, POINTS) for i in (1, 2, 3)]


def _bodies(family):
    return [body_of(panels.sweep(SWEEP)[FAMILIES[family][3].format(i)]) for i in (1, 2, 3)]


def _state(family, model, part):
    return [np.asarray(runs[model].state[part]) for runs in runs_of(family)]


def _rates(family, more=""):
    spins = listed([w[:, 2].max() for w in _state(family, "exact", "omega")], "{:.2f}")
    return ("p and q obey Euler's equations, which do not ask for small angles; the models hold r at r0, in "
            "truth it grows to "
            f"{spins} rad/s and shortens the period. The print adds a wrong frequency (8). {more}").rstrip()


def _rates_by_torque(family):
    period = 2 * np.pi / abs(float(one_frequency(_bodies(family)[0]).root.value()))
    return _rates(family,
                  "The text says that amplitude and wavelength fall with M1; by its own formulas the "
                  "amplitude is proportional "
                          f"to M1 and the period, {period:.3g} s, does not change.")


def _angles(family, more=""):
    tilts = [np.hypot(*a[:, :2].T).max() for a in _state(family, "printed", "angles")]
    until = dict.fromkeys(f"{float(horizon(b)):.2f}" for b in _bodies(family))
    return (f"The print lets the tilt of psi and phi swing to {listed(tilts)} rad as if it were small. In "
            f"truth 0.1 rad is outgrown after "
            f"{listed(until, '{}')} s (green), psi turns back before pi/2, phi runs on, and theta is not r0 "
            f"t. {more}{_CUT}.")


def _circle(family, more=""):
    radii = dict.fromkeys(f"{b.torque[0] / float(b.spin):.1f}" for b in _bodies(family))
    return (f"By (35) G runs on a circle of radius M1/r0 = {listed(radii, '{}')} kg m^2/s. It leaves out the "
            f"charge, whose force does "
            f"change the momentum, and holds while the torque keeps its direction in the tilted body, some "
            f"seconds. {more}").rstrip()


def _by_33(family, more):
    return (
        f"By (33), {more} The exact momentum follows for some seconds only: the torque is fixed in the body, "
        f"and the body tips over.")


def _misprinted(family, part, unit):
    """How far the misprinted integrals are off, and where they divide by little."""
    off = [np.abs(a - b).max() for a,
           b in zip(_state(family, "printed", part), _state(family, "corrected", part))]
    down = [float(b.spin) - abs(float(one_frequency(b).root.value())) for b in _bodies(family)]
    return (f"The misprinted integrals are off by up to {listed(off)} {unit} from those that (44) and (49) "
            f"define, the more the smaller "
            f"r0 − W is ({listed(dict.fromkeys(f'{d:.2g}' for d in down), '{}')} 1/s), whose powers "
            f"divide them"
            + ("; the changes that the text describes fit the corrected ones. " if family != "M1" else ". "))


def _speed(family, more=""):
    last, largest = _state(family, "printed",
                           "velocity")[0][-1,
                                          2], max(np.abs(v).max()
                                                  for v in _state(family, "exact", "velocity"))
    return (f"{_NAMED}Small angles keep the thrust of 3 N along z1: the print has v3 = 0.3 t, {last:.3g} m/s "
            f"at 50 s. In truth the thrust "
            f"turns with the body; no component passes {largest:.2g} m/s. "
            f"{more}{_misprinted(family, 'velocity', 'm/s')}{_THIN}")


def _way(family, more=""):
    printed, true = _state(family, "printed",
                           "position"), [x[-1, 2] for x in _state(family, "exact", "position")]
    start = [float(np.hypot(*x[0, :2])) for x in printed]
    return (f"The parabola eta3 = 0.15 t^2 ({printed[0][-1, 2]:.3g} m at 50 s) needs an axis that stays "
            f"upright; in truth eta3 is "
            f"{listed(true, '{:.0f}')} m. {more}{_misprinted(family, 'position', 'm')}By (61) as printed the "
            f"way does not even start at 0, "
            f"but {listed(start)} m off. {_THIN}")


def _pointing():
    body = _bodies("M1")[0]
    M1, r0, D3 = float(body.torque[0]), float(body.spin), float(body.inertia[2])
    held, aim = D3 * r0 + float(body.gyrostat) - float(body.charge_moment), M1 / (D3 * r0**2)
    return (f"{_NAMED}The text has spirals into the point (0, M1/(D3 r0^2)) = (0, {aim:.2g}): a direction "
            f"{np.degrees(np.arctan(aim)):.0f} degrees off "
            f"the axis, from equations for small angles. It should be M1/(r0 (D3 r0 + Lambda)) = "
            f"{M1 / (r0 * held):.2g} in the linear model; "
            "the true direction goes nowhere near. Exact curve: where the axial velocity exceeds 0.02 m/s. "
            "As printed: by (43) and (47).")


_NAMED = "The paper writes omega1, omega2, omega3 for the velocity v1, v2, v3. "
_CUT = (
    "Models are drawn to where they leave the exact motion's range; the last panels have the printed "
    "curves alone")
_THIN = _CUT + ", thin those with corrected integrals where they differ."


def _exactness(families=tuple(FAMILIES), more=""):
    return (
        f"{panels.exactness([r for f in families for r in runs_of(f)])}; models: closed forms; {POINTS} "
        f"points{more}")


def _figures():
    rates, planes, angles = partial(_family,
                                    rows=RATES), partial(_family, rows=PLANES), partial(_family, rows=ANGLES)
    momentum, speed, way = partial(_family,
                                   rows=MOMENTUM), partial(_family,
                                                           rows=VELOCITY), partial(_family, rows=PLACE)
    across, by_35 = partial(momentum, circle=True), "Angular momentum by (35)"
    three = "Angles of the 3-1-2 sequence"
    for n, family, draw, title, words in (
            (2, "lambda3", rates, "Angular velocities", _rates),
            (3, "lambda3", planes, "Phase planes",
             "The printed ellipses are those of linear equations; the true curves are "
             "egg-shaped, because r is not constant."),
            (4, "e", rates, "Angular velocities",
             partial(_rates, more="The text has amplitude and wavelength increase \"while their "
                                                          "wavelengths decrease\": both increase.")),
            (5, "e", planes, "Phase planes",
             "The curves widen with e, which takes k = e H l^2 cos sigma off lambda3. True curves: "
             "egg-shaped."),
            (6, "M1", rates, "Angular velocities", _rates_by_torque),
            (7, "M1", planes, "Phase planes",
             "The text says that the curves shrink with growing M1; they grow, in print in proportion "
             "to M1."),
            (8, "lambda3", angles, three, _angles), (9, "e", angles, three, _angles),
            (10, "M1", angles, three,
             partial(_angles,
                     more="The text sees a marginal change of psi and phi with M1; in print they are "
                                              "proportional to it. ")),
            (12, "lambda3", momentum, "Angular momentum by (33)",
             partial(_by_33, more="lambda3 hardly matters.")),
            (14, "e", momentum, "Angular momentum by (33)",
             partial(_by_33, more="the charge widens the loops.")),
            (16, "M1", momentum, "Angular momentum by (33)",
             partial(_by_33, more="G is proportional to M1; the text has a marginal rise.")),
            (13, "lambda3", across, by_35, _circle),
            (15, "e", across, by_35,
             partial(_circle, more="That the charge has no influence is an artefact.")),
            (17, "M1", across, by_35, partial(_circle, more="The text says that M1 makes no difference.")),
            (18, "lambda3", speed, "Velocity", _speed),
            (19, "e", speed, "Velocity", partial(_speed, more="The charge does change v3. ")),
            (20, "M1", speed, "Velocity", partial(_speed, more="M1 does change v3. ")),
            (22, "lambda3", way, "Displacement", _way),
            (23, "e", way, "Displacement", partial(_way, more="So the charge does matter to eta3. ")),
            (24, "M1", way, "Displacement", partial(_way, more="So M1 does matter to eta3. "))):
        more = "; rates by central differences" if draw is planes else ""
        yield Figure(n, f"{title}: {NAMES[family]}", partial(words, family) if callable(words) else words,
                     partial(draw, family=family, title=title), partial(_exactness, (family,), more),
                     "charged",
                     partial(_lines, family, draw.keywords["rows"], draw.keywords.get("circle", False)))
    yield model_figure("charged-body", "charged")
    yield Figure(11, "Angular momentum across z1",
                 partial(_circle, "lambda3", "The print draws the small circle of a body that hardly "
                                                           "tilts."), circle, partial(_exactness, ("M1",)),
                 "charged", _circle_lines)
    yield Figure(21, "Direction of the velocity", _pointing, pointing, _exactness, "charged", _pointing_lines)


NAMES = {"lambda3": "family of λ3", "e": "family of e", "M1": "family of M1"}
FIGURES = tuple(sorted(_figures(), key=lambda row: row.number))
