"""Claims that no formula says of a charged body, of a liquid in a cavity and of the fast top, measured.
TESTS: name -> (residual of the printed claim, of the corrected one), with the arguments that a row gives."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Scene
from ...theories.cavity_normal_form import constants
from ...theories.charged import body_of, circle, one_frequency, solution
from ..families import FAMILIES, sweep, with_wheel
from ..figures import cavity
from ..figures import charged as charged_figures
from .trends import MODELS, followed, measured, missed, several


# --- The charged body, in the linear model that its paper solves
def _waves(name):
    """Amplitudes of p and wavelengths by (11) of a family, from rest: p1 + i q1 = (i A/W)(1 - e^(i W t))."""
    bodies = [body_of(case) for case in FAMILIES["charged"][name].members]
    rates = [abs(float(one_frequency(body).root)) for body in bodies]
    return ([body.torque[0] / body.inertia[0] / rate for body, rate in zip(bodies, rates)],
            [2 * math.pi / rate for rate in rates])


def _wheel_lowers():
    amplitudes, lengths = _waves("lambda3")
    return missed(amplitudes, "falls") + missed(lengths, "falls"), 0


def _charge_wavelength():
    amplitudes, lengths = _waves("e")
    return missed(lengths, "falls"), missed(amplitudes, "rises") + missed(lengths, "rises")


def _torque_amplitude():
    amplitudes, _ = _waves("M1")
    return missed(amplitudes, "falls"), amplitudes[-1] / amplitudes[0] - 1.25


def _radii(name):
    """Of the circle (35), of each motion of a family."""
    bodies = [body_of(case) for case in FAMILIES["charged"][name].members]
    return [float(np.hypot(*circle(body, np.array(math.pi / body.spin)))) for body in bodies]


def _circle_stays(family: str):
    return (missed(_radii(family), "stays"),) * 2


def _circle_of_35():
    """Change of the radius between M1 = 4 and 5; its departure from proportionality."""
    radii = _radii("M1")
    return radii[-1] / radii[0] - 1, radii[-1] / radii[0] - 1.25


def _axial(names, goes):
    """At the end: at how many steps of the families axial velocity and displacement do not both go as said;
    their largest relative change."""
    steps, largest = 0, 0.0
    for name in names:
        ends = [measured(f"charged {name}", part, "end", 3) for part in ("velocity", "position")]
        for pairs in zip(*(zip(values, values[1:]) for values in ends)):
            steps += any(missed(pair, goes) for pair in pairs)
            largest = max(largest, *(abs(after / before - 1) for before, after in pairs))
    return steps, largest


def _pointing_error():
    """sigma1 of the paper's first torque, rad; of a hundredth of it."""
    body = body_of(FAMILIES["charged"]["M1"].members[0])
    small = replace(body, torque=tuple(value / 100 for value in body.torque))
    return charged_figures.mean_pointing(body), charged_figures.mean_pointing(small)


def _pointing():
    """Mean direction of the velocity at 1e5 s less M1/(D3 r0^2), as printed, and less M1/(r0 (D3 r0 + lambda3
    - charge's moment)), relative."""
    body = body_of(FAMILIES["charged"]["M1"].members[0])
    velocity = solution(body, np.linspace(0.9e5, 1e5, 2001)).velocity
    visited = float((velocity[:, 1] / velocity[:, 2]).mean())
    M1, D3, r0 = body.torque[0], body.inertia[2], body.spin
    momentum = D3 * r0 + body.gyrostat - body.charge_moment
    return visited / (M1 / (D3 * r0**2)) - 1, visited / (M1 / (r0 * momentum)) - 1


# --- The liquid in a cavity. No figure states its wheel but those on the wheel itself
WHEELS = (0.1, 15, 20, 25)


def _falls_throughout(family, part, model=None, wheels=(None,)):
    """How many parts of motions of a family do not fall all the time; how many do."""
    runs = [followed("cavity", *case, model or MODELS["cavity"], wheel)
            for case in FAMILIES["cavity"][family].cases.values() for wheel in wheels]
    steps = [np.diff(run.state[name]) for run in runs for name in several(part)]
    missed_ones = sum(bool((step > 1e-12).any()) for step in steps)
    return missed_ones, len(steps) - missed_ones


def _decaying_waves(family, wheels, model=None):
    """How many motions of a family do not decay all the time, or have fewer than three nodes in p or q; how
    many are such waves."""
    runs = [followed("cavity", *case, model or MODELS["cavity"], wheel)
            for case in FAMILIES["cavity"][family].cases.values() for wheel in wheels]
    waves = sum(bool((np.diff(run.state["amplitude"]) <= 1e-12).all())
                and min((np.diff(np.sign(run.state["omega"][:, n])) != 0).sum() for n in (0, 1)) >= 3
                for run in runs)
    return len(runs) - waves, waves


def _frequency(scene: Scene) -> float:
    """omega of (11) at the start, r = 1 rad/s; an imaginary one by its size."""
    n = {name: float(value) for name, value in constants(scene).items()}
    first, second = (n["d"] + sign * n["h"] - n["Gamma"] for sign in (1, -1))
    return math.sqrt(abs(first * second)) / n["J0"]


def _wheel_frequency():
    """Share of the paper's steps of lambda3 at which the frequency does not grow; at which it does other than
    whether Gamma is above d r says."""
    falls = parted = steps = 0
    for name in ("small", "large"):
        scenes = [case.scene for case in FAMILIES["cavity"][name].members]
        for scene, other in zip(scenes, scenes[1:]):
            n = {key: float(value) for key, value in constants(scene).items()}
            grows = _frequency(other) > _frequency(scene)
            falls, parted = falls + (not grows), parted + (grows != (n["Gamma"] > n["d"] + abs(n["h"])))
            steps += 1
    return falls / steps, parted / steps


def _liquid_mass():
    """Moment of inertia of the frozen liquid as a sphere over the body's, less 1; how far the liquid's is
    below the body's, which holds it."""
    scene = sweep("liquid-base")[""].scene
    liquid = scene.effect("liquid_cavity")
    share = 2 / 5 * cavity.liquid_mass(liquid) * cavity.radius(liquid)**2 / float(scene.body.inertia[2])
    return share - 1, max(0.0, 1 - share)


def _liquid_charge():
    """Relative change of the frequency from e = 0.01 to 10,000 C, the least of all wheels that the text
    leaves open; of that with the charge's moment taken off the wheel instead, the largest."""
    changes = []
    for wheel in WHEELS:
        plain, _, charged = (with_wheel(case, wheel).scene for case in FAMILIES["cavity"]["e"].members)
        instead = Scene(plain.body, Gyrostat((0, 0, constants(charged)["Gamma"])))
        changes.append([abs(_frequency(charged) / _frequency(other) - 1) for other in (plain, instead)])
    least, largest = zip(*changes)
    return min(least), max(largest)


def _turns_back(family: str, model: str | None = None):
    """How many motions of a family have their largest phase at the end; how many have not."""
    grown = [fall == 0 for fall in measured(f"cavity {family}", "phase", "fall at the end", model=model)]
    return sum(grown), len(grown) - sum(grown)


# --- The fast top
def _lambda1(C: float) -> tuple[float, float]:
    """(lambda1 of (10), Omega^2) of a top with A = 1, B = 1.1, z0' = 0.1, k = 0.2 and no l_z."""
    A1, B1 = C - 1.1, (1 - C) / 1.1
    square = -A1 * B1
    return (0.1 * (A1 / (1.1 / C) - C) + 0.2 * (A1 - square)) / (1 - square), square


def _poles():
    """Size of lambda1 where C is 1e-9 short of A + B over that at C = 1.4, less one; the residue of the pole
    seen 1e-6 short of it against 1e-9, relative."""
    (nearby, at), (closer, there), (far, _) = _lambda1(2.1 - 1e-6), _lambda1(2.1 - 1e-9), _lambda1(1.4)
    return abs(closer / far) - 1, closer * (1 - there) / (nearby * (1 - at)) - 1


def _closed(model=None):
    """Least distance of (p, q, r, gamma) from its start after 0.1 s, over its distance at most: a closed
    curve comes back; how many of the motions do so to 1 %."""
    shares = []
    for case in FAMILIES["top"]["lx"].cases.values():
        run = followed("top", *case, model or MODELS["top"], None)
        states = np.hstack([run.state["omega"], run.state["gamma"]])[::2]  # one each millisecond
        away = np.linalg.norm(states - states[0], axis=1)
        shares.append(float(away[100:].min() / away.max()))
    return max(shares), sum(fraction < 1e-2 for fraction in shares)


TESTS: dict[str, Callable[..., tuple]] = {
    "wheel lowers": _wheel_lowers, "charge wavelength": _charge_wavelength,
    "torque amplitude": _torque_amplitude, "circle stays": _circle_stays, "circle": _circle_of_35,
    "pointing": _pointing, "pointing error": _pointing_error,
    "axial by wheel": lambda: _axial(("lambda3",), "falls"),
    "axial by charge and torque": lambda: _axial(("e", "M1"), "rises"),
    "turns back": _turns_back, "falls throughout": _falls_throughout, "waves": _decaying_waves,
    "mass": _liquid_mass, "wheel frequency": _wheel_frequency,
    "charge": _liquid_charge, "poles": _poles, "closed": _closed,
}
