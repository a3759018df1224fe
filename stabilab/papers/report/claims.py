"""What the texts of the other papers claim of their figures, each set against a number computed from the
equations."""
from __future__ import annotations

import math

import numpy as np

from ...theories.charged.model import body_of
from ...theories.charged.modes import horizon
from ...theories.top.model import paper_numbers
from ...theories.top.scaling import fast_top
from ..figures import cavity as figures_cavity
from ..figures import charged as figures_charged
from ..figures import panels
from ..figures.figure import listed
from ..figures.top import ORDER, POINTS, SPAN


def _row(says, is_so, right=False):
    return {"says": says, "is": is_so, "right": right}


# -- the charged body


def charged() -> list[dict]:
    """Claims of Galal et al., charged body."""
    family = {name: figures_charged.runs_of(name) for name in figures_charged.FAMILIES}
    base = body_of(panels.sweep(figures_charged.SWEEP)["-1-2-1"])
    M1, r0, D3 = base.torque[0], float(base.spin), base.inertia[2]
    held = D3 * r0 + float(base.gyrostat) - float(base.charge_moment)
    runs = family["lambda3"][0]
    tilt = np.hypot(*np.asarray(runs["printed"].state["angles"])[:, :2].T)
    amplitude = [np.ptp(np.asarray(r["linear"].state["omega"])[:, 0]) / 2 for r in family["M1"]]
    places = {name: [r["exact"].state["position"][-1, 2] for r in rows] for name, rows in family.items()}
    first = {name: _period(rows) for name, rows in family.items()}
    return [
        _row("psi and phi are small",
             f"a tilt of 0.1 rad is reached after {float(horizon(base)):.2g} s of 50 s; the printed "
             f"tilt goes to {tilt.max():.3g} rad"),
        _row("a larger lambda3 makes p and q smaller and faster", f"so it does: the true period falls, "
            f"{listed(first['lambda3'])} s", True),
        _row("a larger charge: amplitude and wavelength increase while their wavelengths decrease",
             f"both increase: the "
             f"true period is {listed(first['e'])} s"),
        _row("a larger M1: amplitude and wavelength decrease",
             f"the amplitude of p grows with M1, {listed(amplitude)} rad/s "
             f"in the linear model, whose period does not depend on M1"),
        _row("theta stays r0 t", f"{r0:.3g} t is {50 * r0:.3g} rad at 50 s; the true theta is "
            f"{runs['exact'].state['angles'][-1, 2]:.3g} rad"),
        _row("by (35) neither the gyrostatic moment, the charge nor M1 changes the circle of G",
             f"its radius is M1/r0, "
             f"{listed([m / r0 for m in (4, 4.5, 5)])} kg m^2/s; the charge does add to the momentum, and "
             f"the true G leaves "
             f"the circle"),
        _row("the direction of the velocity tends to the circle's centre M1/(D3 r0^2)",
             f"{M1 / (D3 * r0**2):.3g}, an angle "
             f"of {math.degrees(math.atan(M1 / (D3 * r0**2))):.0f} degrees; with the momentum that is there, "
             f"M1/(r0 (D3 r0 + "
             f"Lambda)) = {M1 / (r0 * held):.3g}"),
        _row("lambda3, e and M1 have no effect on the axial velocity and displacement", f"true eta3 at 50 s: "
             f"{listed(places['lambda3'])} m for lambda3, {listed(places['e'])} m for e, "
             f"{listed(places['M1'])} m for M1; the "
             f"print has "
             f"{runs['printed'].state['position'][-1, 2]:.3g} m"),
        _row("zero error against earlier work",
             "that compares the formulas with themselves at zero charge and gyrostatic "
             "moment; against the motion see the table"),
    ]


def _period(rows):
    """Time from the first to the second maximum of the true p, of each run."""
    found = []
    for runs in rows:
        p, t = np.asarray(runs["exact"].state["omega"])[:, 0], runs["exact"].t
        tops = np.nonzero((p[1:-1] > p[:-2]) & (p[1:-1] >= p[2:]))[0] + 1
        found.append(t[tops[1]] - t[tops[0]] if len(tops) > 1 else math.nan)
    return found


# -- the liquid


def cavity() -> list[dict]:
    """Claims of Galal et al., liquid cavity."""
    family = {name: figures_cavity.runs_of(name) for name in figures_cavity.FAMILIES}
    liquid = panels.sweep("liquid-base")[""].scene.effect("liquid_cavity")
    radius, mass, base = figures_cavity.radius(liquid), figures_cavity.liquid_mass(liquid), family["zeta"][1]
    turning = figures_cavity.turning(base)
    return [
        _row("P0 = 1.9 m^7, a body of 9 kg m^2",
             f"a sphere of {radius:.3g} m radius: {mass / 1000:.3g} t of liquid"),
        _row("p and q are waves for all data",
             f"with lambda3 = 0.1 the vector (p, q) turns by {figures_cavity.turn(base):.2g} rad in 20 "
             f"s; waves need a lambda3 that the text does not give"),
        _row("a larger lambda3 increases the frequency", f"from 0.1 to 0.2 it falls: "
            f"{listed([figures_cavity.turn(r) for r in family['small']], '{:.2g}')} rad in 20 s; from 15 "
            f"to 25 "
             f"it rises: {listed([abs(figures_cavity.turn(r)) for r in family['large']])} rad"),
        _row("closed curves in Fig. 4", f"the true amplitude falls below 1 % after "
            f"{listed([figures_cavity.gone(r) for r in family['large']], '{:.2g}')} s: with the rotor the "
             "liquid brakes much more than the printed torque, which is that of a body without one"),
        _row("phi grows and then falls",
             f"the printed polynomial turns back at {turning:.3g} s; the true phi grows through "
            f"all 20 s"),
        _row("a smaller M3 increases the number of oscillations", f"the turn in 20 s shrinks: "
            f"{listed([figures_cavity.turn(r) for r in family['M3']], '{:.2g}')} rad for "
             "M3 = -3, -6, -9"),
        _row("the charge acts slightly", f"the true amplitude after 20 s is "
            f"{listed([_left(r) for r in family['e']], '{:.2g}')} rad/s for the three charges; the "
             "printed liquid torque does not know of the charge"),
        _row("amplitudes decay, the motion is stable",
             "so they do, with the resistance; what attracts is the spin about "
             "axis 3 that the torque and the resistance hold", True),
    ]


def _left(runs):
    return float(runs["exact"].state["amplitude"][-1])


# -- the top


def top() -> list[dict]:
    """Claims of Amer et al. 2023, fast top."""
    case = panels.sweep("top-lx30-lz30")[""]
    state = {"omega": case.state, "gamma": case.blocks["gamma"]}
    numbers, scaled = paper_numbers(case.scene, state), fast_top(case.scene, state)
    runs = panels.motions("top-lx30-lz30", "", SPAN, POINTS, ORDER)
    t, r = runs["exact"].t, np.asarray(runs["exact"].state["omega"])[:, 2]
    printed = runs["printed"].state
    weight = math.hypot(*map(float, scaled.force))
    A, _, C = map(float, case.scene.body.inertia)
    fast = panels.sweep("top-fast")[""]
    sure = fast_top(fast.scene, {"omega": fast.state, "gamma": fast.blocks["gamma"]})
    return [
        _row("the top is fast, the parameter small",
             f"M g L/(C r0^2) = {weight:.2g}; A exceeds its reference value 15 kg "
             f"m^2 by {(A - 15) / 15:.2g} of it; r goes from {r[0]:.3g} to {np.interp(0.1, t, r):.3g} rad/s "
             f"in 0.1 s"),
        _row("gamma0 = 0.001 and gamma0'' = 0.001",
             "gamma1 = tan theta0 at the start means gamma0 = 0.9999995; lambda is "
             "missing; the scaling needs |(x0', y0', z0')| = 1, the data have 0.77"),
        _row("periodic solutions, closed curves, free of chaos", f"the printed r swings to "
            f"{printed['omega'][:, 2].min():.3g} rad/s and the printed |gamma|, "
             f"which is 1, to {np.linalg.norm(printed['gamma'], axis=1).max():.3g}; the true curves do "
             f"not close"),
        _row("no singular point for any frequency",
             f"Omega = 1, that is C* = A + B, is a pole of (41), and so are C = B and "
             f"Omega = 0; here Omega^2 = {numbers.Omega2:.3g} as printed, {float(scaled.Omega2):.3g} with C* "
             f"in full"),
        _row("p and r hardly change with l_x", "(41) leaves out the permanent part l_x/(C* - A) of p, "
             f"{listed([lx / (C + 30 / r[0] - A) for lx in (30, 60, 90)])} rad/s for l_x = 30, 60, 90"),
        _row("valid for the data of Table 1",
             f"a valid top: r0 = {fast.state[2]:.3g} rad/s, M g L/(C r0^2) = "
             f"{math.hypot(*map(float, sure.force)):.2g} (below)"),
    ]
