"""A body known within bounds as a box.

The box holds all that inertia, gyrostatic moment, torque and state may be.

A point of the box is a tuple of numbers in [-1, 1], one for each uncertain number (times a reach that
stretches the whole box). `Box.at` gives the exact scene and state there, `Box.numbers` the same numbers over
many sub-boxes at once, and `rates` the equations of motion from either."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import prod
from typing import Any, TypeAlias

import numpy as np

from ...errors import InputError
from ...numbers.affine import EPS, LEAST, Affine, root, sign_over, squared
from ...numbers.exact import floats
from ...numbers.principal import PrincipalAxes, principal_axes, without_trace
from ...numbers.vectors import Exact3, Float3, Number, Triple
from ...physics.body import Body
from ...physics.coefficients import to_scaled, torque_from_mu
from ...physics.effects import effect_class
from ...physics.scene import AnyScene, QuadraticForm, ScaledGyrostat, Scene, euler_form, scaled_form

# --- The box
TRACE = Fraction(1, 1 << 180)  # of the largest number: what axes good to 240 bits leave, there and back
HARDWARE = ("thrusters", "wheels")  # tables whose numbers turn no axes
PRODUCTS = ("xy", "xz", "yz")
STRAIGHT = ("the products of inertia are uncertain about zero, so that the tensor is diagonal in the middle "
            "alone, and what the turn of its axes does is not followed")
NO_PART = {("body", "mass")}  # numbers that no verdict on a gyrostat hangs on
Line: TypeAlias = tuple[tuple[tuple[str, int], ...], Exact3]
Point: TypeAlias = Any  # of a box: a number in [-1, 1] for each place, an array or a sequence
Numbers: TypeAlias = dict[str, tuple[Number, ...]]  # "inertia", "momentum", "torque" ... -> its numbers


@dataclass(frozen=True)
class Box:
    """middle: name -> exact numbers, of "inertia", "momentum", "torque" or "mu" (a body), or "a", "b", "mu"
    (a scaled system), "force" (N, of every firing thruster whose force is uncertain), "wheel_momentum",
    "wheel_inertia", "wheel_speed" (of every wheel of which one is uncertain) and "state" (three, or absent);
    half: name -> their half-widths, zero where certain. arms: of each force, the torque of one newton of it,
    m; "torque" of the middle is that of all else. lines: of each of those wheels, (name, index) of the
    numbers whose product its momentum is, and its axis; "momentum" of the middle is that of all else.
    variables: those of scene and state, "physical" or "scaled" (a body may be asked in scaled variables).
    frame: None where all numbers are along the principal axes; else the principal axes of the middle, and all
    numbers are in the frame of the file, with "products", the xy, xz and yz entries of the tensor."""

    middle: Numbers
    half: Numbers
    variables: str
    frame: PrincipalAxes | None = None
    arms: tuple[Exact3, ...] = ()
    lines: tuple[Line, ...] = ()

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
        return self._with_hardware({name: tuple(numbers) for name, numbers in out.items()})

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
        return self._with_hardware({name: tuple(numbers) for name, numbers in out.items()})

    def _with_hardware(self, numbers: Numbers) -> Numbers:
        """With the torque of the uncertain forces in "torque", and the momentum of the uncertain wheels in
        "momentum", on the line of each: its components are not independent, which `Affine` numbers keep."""
        torque, momentum = (list(numbers.get(name, ())) for name in ("torque", "momentum"))
        for force, arm in zip(numbers.get("force", ()), self.arms):
            torque = [m + force * along if along else m for m, along in zip(torque, arm)]
        for factors, axis in self.lines:
            size: Any = prod((numbers[name][i] for name, i in factors), start=Fraction(1))
            momentum = [m + size * along if along else m for m, along in zip(momentum, axis)]
        return numbers | {name: tuple(vector)
                          for name, vector in (("torque", torque), ("momentum", momentum)) if vector}

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

    def rigid(self, points: np.ndarray) -> np.ndarray:
        """Whether some rigid body has the moments at points (n, places): none exceeds the sum of the others.
        True everywhere where the middle itself is no rigid body's, whose answers are told all the same."""
        points = np.asarray(points, float)
        D = np.tile([float(d) for d in self.middle.get("inertia", (1, 1, 1))], (1 + len(points), 1))
        for k, (name, i) in enumerate(self.places):
            if name == "inertia":
                D[1:, i] += float(self.half[name][i]) * points[:, k]
        result = 2 * D.max(1) <= D.sum(1) * (1 + 8 * EPS)
        return result[1:] | ~result[0]

    def rates(self, numbers: Numbers) -> QuadraticForm:
        """The equations of motion (coefficients of the kind of the numbers)."""
        if not self.bodily:
            return scaled_form(numbers["a"][0], numbers["b"][0], numbers["mu"])
        D, lam = numbers["inertia"], numbers["momentum"]
        if self.variables == "physical":
            return euler_form(D, lam, numbers["torque"] if "torque" in numbers else _torque(D, numbers["mu"]))
        return scaled_form(*_scaled(D, lam[0], numbers))


def box_of(case: Any) -> Box:
    """The box of a Case, without its state where that is stated as it is observed: such a start is no linear
    function of its numbers. Raises InputError for scenes beyond a gyrostat under a constant torque."""
    if not case.scene.plain:
        raise InputError("what uncertain numbers do to the verdicts is known for a gyrostat under a constant "
                         "torque alone; this scene has other effects")
    middle = {}
    oblique = case.frame if case.frame is not None and not case.frame.as_given else None
    forces = [item for item in case.uncertain if item.path[0] == "thrusters"]
    # numbers that turn no axes leave all along them
    if oblique and all(item.path[0] in HARDWARE or item.path in NO_PART for item in case.uncertain):
        oblique = None
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
    if case.observed:
        middle.pop("state", None)
    arms = tuple(_arm(case, item, oblique) for item in forces)
    if forces:
        middle |= {"force": tuple(item.middle for item in forces),
                   "torque": _without(middle["torque"], [tuple(item.middle * v for v in arm)
                                                         for item, arm in zip(forces, arms)])}
    factors, lines = _wheels(case, oblique)
    if lines:
        middle |= {name: tuple(number for _, number in rows) for name, rows in factors.items()}
        middle["momentum"] = _without(middle["momentum"], [
            tuple(prod((factors[name][i][1] for name, i in places), start=Fraction(1)) * v for v in axis)
            for places, axis in lines])
    half = {name: [Fraction(0)] * len(numbers) for name, numbers in middle.items()}
    for result in case.uncertain:
        if case.observed and result.path[0] == "motion" or result.path in NO_PART:
            continue
        if result.path[0] == "wheels":
            for name, rows in factors.items():  # none: the inertia beside a momentum has no part
                for i, (path, _) in enumerate(rows):
                    half[name][i] = result.half if path == result.path else half[name][i]
            continue
        if result.path[:2] == ("body", "products"):
            if not oblique:
                raise InputError(STRAIGHT)
            half["products"][PRODUCTS.index(result.path[-1])] = result.half
            continue
        at = forces.index(result) if result in forces else result.path[-1]
        half[_name(result.path)][at if isinstance(at, int) else 0] = result.half
    box = Box(middle, {name: tuple(widths) for name, widths in half.items()}, case.variables, oblique, arms,
              lines)
    _scalable(box)
    return box


def _without(vector: Exact3, parts: Sequence[Exact3]) -> Exact3:
    """What is left of a vector without these parts of it."""
    size = max(map(abs, vector))
    return tuple(_as_written(v - sum((part[i] for part in parts), Fraction(0)), size)
                 for i, v in enumerate(vector))


def _wheels(case: Any, oblique: PrincipalAxes | None) -> tuple[
        dict[str, list[tuple[tuple[Any, ...], Fraction]]], tuple[Line, ...]]:
    """(of each name the paths and middles of the numbers that make the momenta of uncertain wheels; of each
    of these wheels its factors, and its axis in the frame of the box)."""
    loose = {item.path for item in case.uncertain}
    factors: dict[str, list[tuple[tuple[Any, ...], Fraction]]] = {}
    lines = []
    for wheel in case.wheels:
        paths = [(*wheel.path, key) for key in wheel.factors]
        if loose.isdisjoint(paths):
            continue
        stated = [wheel.momentum] if len(paths) == 1 else [wheel.inertia, wheel.momentum / wheel.inertia]
        for key, path, number in zip(wheel.factors, paths, stated):
            factors.setdefault(f"wheel_{key}", []).append((path, number))
        axis = wheel.axis if oblique or case.frame is None else case.frame.turned(wheel.axis)
        lines.append((tuple((name, len(factors[name]) - 1)
                            for name in (f"wheel_{key}" for key in wheel.factors)), axis))
    return factors, tuple(lines)


def _arm(case: Any, force: Any, oblique: PrincipalAxes | None) -> Exact3:
    """The torque of one newton of a thruster, m, in the frame of the box."""
    thruster = next(item for item in case.thrusters if item.path == force.path[:-1])
    arm = tuple(m / thruster.force for m in thruster.torque)
    return arm if oblique or case.frame is None else case.frame.turned(arm)


def _in_the_file(case: Any, frame: PrincipalAxes) -> Numbers:
    """The numbers of a case along principal axes, turned back to the frame of its file."""
    tensor = [[sum(m * axis[i] * axis[j] for m, axis in zip(frame.moments, frame.axes)) for j in range(3)]
              for i in range(3)]
    entries = {"inertia": tuple(tensor[i][i] for i in range(3)),
             "products": (tensor[0][1], tensor[0][2], tensor[1][2]),
             "momentum": frame.back(case.physical.vector("gyrostat")),
             "torque": frame.back(case.physical.vector("constant_torque"))}
    entries |= {"state": frame.back(case.exact_state)} if case.state is not None else {}
    return {name: tuple(_as_written(v, max(map(abs, values))) for v in values)
            for name, values in entries.items()}


def _as_written(value: Fraction, size: Fraction) -> Fraction:
    """The decimal that a number good to 240 bits denotes, where there is one, or zero; size: of the largest
    number beside it."""
    nearby, slack = Fraction(repr(float(value))) if value else value, size * TRACE
    return Fraction(0) if abs(value) <= slack else nearby if abs(nearby - value) <= slack else value


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
    if box.variables == "scaled" and (any(box.half["momentum"][1:])
                                      or any(any(axis[1:]) for _, axis in box.lines)):
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
    result = read(rounded)
    return result if (result - middle) * (value - middle) >= 0 else middle


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
    """(a, b, mu) of a body (`coefficients.to_scaled`)."""
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
