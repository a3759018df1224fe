"""A body whose inertia, gyrostatic moment, torque or state are known only within bounds: the box of all it
may be.

A point of the box is a tuple of numbers in [-1, 1], one for each uncertain number (times a reach that
stretches the whole box). `Box.at` gives the exact scene and state there, `Box.numbers` the same numbers over
many sub-boxes at once, and `rates` the equations of motion from either.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from ...errors import InputError
from ...numbers.affine import EPS, LEAST, Affine, root, sign_over, squared
from ...numbers.exact import floats
from ...numbers.principal import PrincipalAxes, principal_axes, without_trace
from ...numbers.vectors import Float3, Number, Triple
from ...physics.coefficients import to_scaled, torque_from_mu
from ...physics.effects import effect_class
from ...physics.scene import AnyScene, Body, QuadraticForm, ScaledGyrostat, Scene, euler_form, scaled_form

TRACE = Fraction(1, 1 << 180)  # of the largest number: what axes good to 240 bits leave, there and back
Point: TypeAlias = Any  # of a box: a number in [-1, 1] for each place, an array or a sequence
Numbers: TypeAlias = dict[str, tuple[Number, ...]]  # "inertia", "momentum", "torque" ... -> its numbers


@dataclass(frozen=True)
class Box:
    """middle: name -> exact numbers, of "inertia", "momentum", "torque" or "mu" (a body), or "a", "b", "mu"
    (a scaled system), and "state" (three, or absent); half: name -> their half-widths, zero where certain.
    variables: those of scene and state, "physical" or "scaled" (a body may be asked in scaled variables).
    frame: None where all numbers are along the principal axes; else the principal axes of the middle, and all
    numbers are in the frame of the file, with "products", the xy, xz and yz entries of the tensor."""

    middle: Numbers
    half: Numbers
    variables: str
    frame: PrincipalAxes | None = None

    @cached_property
    def places(self) -> tuple[tuple[str, int], ...]:
        """(name, index) of every uncertain number."""
        return tuple((name, i) for name, widths in self.half.items() for i, h in enumerate(widths) if h)

    @property
    def bodily(self) -> bool:
        """Whether it starts from a body rather than from a, b and mu."""
        return "inertia" in self.middle

    # -- one point, exactly
    def values(self, point: Point, reach: float = 1) -> Numbers:
        """The numbers at a point (one number in [-1, 1] for each place), exact: rounded toward the middle to
        what a case file can state, decimals of a double's digits (a state to the double itself)."""
        out = {name: list(numbers) for name, numbers in self.middle.items()}
        for (name, i), e in zip(self.places, point):
            middle = out[name][i]
            value = middle + Fraction(reach) * Fraction(e) * self.half[name][i]
            out[name][i] = (middle if value == middle
                            else _toward(value, middle, Fraction if name == "state" else _decimal))
        return {name: tuple(numbers) for name, numbers in out.items()}

    def at(self, point: Point, reach: float = 1) -> tuple[AnyScene, Float3 | None]:
        """(scene, state or None) at a point, exact. Raises InputError where there is no such body or no such
        scaling."""
        values = self.values(point, reach)
        state = tuple(map(float, values["state"])) if "state" in values else None
        if not self.bodily:
            return ScaledGyrostat(values["a"][0], values["b"][0], values["mu"]), state
        if self.frame is not None:
            return _turned(values)
        body, mu = Body(values["inertia"]), values.get("mu")
        torque = values["torque"] if mu is None else torque_from_mu(body, mu)
        scene = Scene(body, effect_class("gyrostat")(values["momentum"]),
                      effect_class("constant_torque")(torque))
        return (to_scaled(scene, mu)[0] if self.variables == "scaled" else scene), state

    # -- many boxes at once
    def numbers(self, centres: np.ndarray, widths: np.ndarray, reach: float = 1.0,
                cells: Any = None) -> Numbers:
        """Every number over n sub-boxes: `Affine`, or the exact number where it is certain.

        centres, widths: (n, places), within [-1, 1], times reach. cells: one more column of g, left free for
        another variable.
        """
        n, extra = len(centres), 0 if cells is None else 1
        out = {name: list(numbers) for name, numbers in self.middle.items()}
        for k, (name, i) in enumerate(self.places):
            middle, half = float(self.middle[name][i]), float(self.half[name][i]) * reach
            c, g = middle + half * centres[:, k], np.zeros((n, len(self.places) + extra))
            g[:, k] = half * widths[:, k]
            out[name][i] = Affine(c, g,
                                  8 * EPS * (abs(middle) + np.abs(half * centres[:, k]) + g[:, k]) + LEAST)
        return {name: tuple(numbers) for name, numbers in out.items()}

    def impossible(self, numbers: Numbers) -> np.ndarray | np.bool_:
        """True for each sub-box that surely holds no body: a moment of inertia not positive (for a body in
        scaled variables: moments not in falling order)."""
        if not self.bodily:
            return np.bool_(False)
        D = numbers["inertia"]
        wrong: np.ndarray | np.bool_ = np.bool_(False)
        for i in range(3):
            wrong = wrong | (sign_over(D[i]) < 0)
        if self.variables == "scaled" or "mu" in self.middle:
            wrong = wrong | (sign_over(D[0] - D[1]) < 0) | (sign_over(D[1] - D[2]) < 0)
        return wrong

    def rates(self, numbers: Numbers) -> QuadraticForm:
        """The equations of motion (coefficients of the kind of the numbers)."""
        if not self.bodily:
            return scaled_form(numbers["a"][0], numbers["b"][0], numbers["mu"])
        D, lam = numbers["inertia"], numbers["momentum"]
        if self.variables == "physical":
            return euler_form(D, lam, numbers["torque"] if "torque" in numbers else _torque(D, numbers["mu"]))
        return scaled_form(*_scaled(D, lam[0], numbers))


def box_of(case: Any) -> Box:
    """The box of a Case. Raises InputError for scenes beyond a gyrostat under a constant torque."""
    if not case.scene.plain:
        raise InputError("what uncertain numbers do to the verdicts is known for a gyrostat under a constant "
                         "torque alone; this scene has other effects")
    middle = {}
    oblique = case.frame if case.frame is not None and not case.frame.as_given else None
    if oblique:
        middle = _in_the_file(case, oblique)
    elif case.physical is not None:
        middle["inertia"] = case.physical.body.exact
        middle["momentum"] = case.physical.vector("gyrostat")
        middle.update({"torque": case.physical.vector("constant_torque")} if case.mu is None
                      else {"mu": case.mu})
    else:
        a, b = case.scene.exact_ab
        middle.update({"a": (a,), "b": (b,), "mu": case.scene.exact_mu})
    if case.state is not None and not oblique:
        middle["state"] = tuple(map(Fraction, case.state))
    half = {name: [Fraction(0)] * len(numbers) for name, numbers in middle.items()}
    for found in case.uncertain:
        half[_name(found.path)][found.path[-1] if isinstance(found.path[-1], int) else 0] = found.half
    box = Box(middle, {name: tuple(widths) for name, widths in half.items()}, case.variables, oblique)
    _scalable(box)
    return box


def _in_the_file(case: Any, frame: PrincipalAxes) -> Numbers:
    """The numbers of a case along principal axes, turned back to the frame of its file."""
    tensor = [[sum(m * axis[i] * axis[j] for m, axis in zip(frame.moments, frame.axes)) for j in range(3)]
              for i in range(3)]
    found = {"inertia": tuple(tensor[i][i] for i in range(3)),
             "products": (tensor[0][1], tensor[0][2], tensor[1][2]),
             "momentum": frame.back(case.physical.vector("gyrostat")),
             "torque": frame.back(case.physical.vector("constant_torque"))}
    found |= {"state": frame.back(case.exact_state)} if case.state is not None else {}
    return {name: tuple(_as_written(v, max(map(abs, values))) for v in values)
            for name, values in found.items()}


def _as_written(value: Fraction, size: Fraction) -> Fraction:
    """The decimal that a number good to 240 bits denotes, where there is one, or zero; size: of the largest
    number beside it."""
    near, slack = Fraction(repr(float(value))) if value else value, size * TRACE
    return Fraction(0) if abs(value) <= slack else near if abs(near - value) <= slack else value


def _turned(values: Numbers) -> tuple[AnyScene, Float3 | None]:
    """(scene, state or None) along the principal axes of a tensor, of numbers in the frame of the file."""
    (x, y, z), (xy, xz, yz) = values["inertia"], values["products"]
    frame = principal_axes(((x, xy, xz), (xy, y, yz), (xz, yz, z)))
    wheel, torque = (frame.turned(values[name]) for name in ("momentum", "torque"))
    wheel = without_trace(wheel, torque) if any(torque) else wheel
    scene = Scene(Body(frame.moments), effect_class("gyrostat")(wheel),
                  effect_class("constant_torque")(torque))
    return scene, floats(frame.turned(values["state"])) if "state" in values else None


def _scalable(box: Box) -> None:
    """Scaled variables, and mu, need three moments in falling order and the gyrostatic moment along axis 1.
    """
    if not box.bodily or box.frame is not None or (box.variables == "physical" and "mu" not in box.middle):
        return
    D, h = box.middle["inertia"], box.half["inertia"]
    if not all(D[i] - h[i] > D[i + 1] + h[i + 1] for i in (0, 1)):
        raise InputError("within the uncertainties the moments are not surely in falling order, as the "
                         "scaled variables and mu need: give the torque in N m and the motion as "
                         "angular_velocity")
    if box.variables == "scaled" and any(box.half["momentum"][1:]):
        raise InputError("the scaled variables need the gyrostatic moment along axis 1, without uncertainty "
                         "across it: use physical variables")


def _name(path: tuple[Any, ...]) -> str:
    key = path[-2] if isinstance(path[-1], int) else path[-1]
    return "state" if key in ("angular_velocity", "x") else key


def _toward(value: Fraction, middle: Fraction, read: Callable[[float], Fraction]) -> Fraction:
    """The number next to a value, on the middle's side, among those that `read` makes of doubles."""
    rounded = float(value)
    while (read(rounded) - value) * (value - middle) > 0:
        rounded = math.nextafter(rounded, -math.inf if value > middle else math.inf)
    found = read(rounded)
    return found if (found - middle) * (value - middle) >= 0 else middle


def _decimal(number: float) -> Fraction:
    """What the double's shortest decimal denotes."""
    return Fraction(repr(number))


def _shape_factors(D: Sequence[Number]) -> Triple:
    return (D[1] - D[2]) / D[0], (D[0] - D[2]) / D[1], (D[0] - D[1]) / D[2]


def _torque(D: Sequence[Number], mu: Sequence[Number]) -> Triple:
    """M from the dimensionless torque with u = 1 (Amer et al. 2024, eq. (4))."""
    ks = _shape_factors(D)
    k = ks[0] * ks[1] * ks[2]
    return tuple(d * root(k * kj) * m if present(m) else m for d, kj, m in zip(D, ks, mu))


def _scaled(D: Sequence[Number], lam1: Number, numbers: Numbers) -> Triple:
    """(a, b, mu) of a body (`scaling.to_scaled`)."""
    ks = _shape_factors(D)
    k = ks[0] * ks[1] * ks[2]
    if "mu" in numbers:
        mu, strength = numbers["mu"], root(ks[0])
    else:
        rates = [m / d for m, d in zip(numbers["torque"], D)]
        u = root(sum(squared(rates[i]) * ks[(i + 1) % 3] * ks[(i + 2) % 3] for i in range(3))) / k
        mu = tuple(r / (u * root(k * kj)) if present(r) else r for r, kj in zip(rates, ks))
        strength = root(u * ks[0])
    return lam1 / ((D[0] - D[2]) * strength), lam1 / ((D[0] - D[1]) * strength), mu


def present(value: Number) -> bool:
    return isinstance(value, Affine) or value != 0
