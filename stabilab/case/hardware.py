"""What a spacecraft carries, as a case file states it: [[thrusters]], [[wheels]] and [limits]."""
from __future__ import annotations

from fractions import Fraction

from ..errors import InputError
from ..numbers.exact import exact, sqrt_fraction
from ..numbers.principal import PrincipalAxes
from ..numbers.vectors import Exact3, cross, dot
from ..record import record
from .table import Table, described
from .uncertainty import plus_minus, states_uncertainty
from .units import FORCE, pi

Exact3 = Exact3
ZERO3 = (Fraction(0),) * 3
THRUSTER = ("name", "position", "direction", "force", "misalignment", "force_tolerance", "stuck")
WHEEL = ("name", "axis", "momentum", "inertia", "speed")
SAME = Fraction(1, 10**6)  # relative: momentum and inertia x speed given to six digits agree


@record
class Thruster:
    """position: m, structural frame; direction: unit vector of the force on the body, input frame; force: N; misalignment: half-angle
    of the cone that the true direction lies in, rad, or None; force_tolerance: half-width, N, or None; stuck: whether it fires for
    ever; torque: about the centre of mass, N m, input frame, of the force as stated; arm: from there to its position, m."""

    name: str
    position: Exact3
    direction: Exact3
    force: Fraction
    misalignment: Fraction | None
    force_tolerance: Fraction | None
    stuck: bool
    torque: Exact3
    arm: Exact3 = ZERO3


@record
class Wheel:
    """axis: unit vector, input frame; momentum: along it relative to the body, N m s; vector: both as a vector, input frame."""

    name: str
    axis: Exact3
    momentum: Fraction
    vector: Exact3


@record
class Limits:
    """rate: largest |omega|, rad/s, or rates: largest |omega_i| along the axes of the input frame; the other one is None."""

    rate: Fraction | None = None
    rates: Exact3 | None = None

    def components(self, frame: PrincipalAxes) -> list[tuple[Exact3, Fraction]]:
        """(axis of the input frame as a unit vector along the principal axes, its limit) of `rates`."""
        return [(frame.turned([Fraction(int(n == m)) for n in range(3)]), most) for m, most in enumerate(self.rates or ())]


def thrusters_of(top: Table, centre: Exact3 | None) -> tuple[Thruster, ...]:
    """Those without a fault."""
    found = [_thruster(table, f"thruster {i}", centre or ZERO3) for i, table in enumerate(top.tables("thrusters"), 1)]
    _told_apart(top, "thrusters", THRUSTER)
    return tuple(one for one in found if one)


def wheels_of(top: Table) -> tuple[Wheel, ...]:
    """Those without a fault."""
    found = [_wheel(table, f"wheel {i}") for i, table in enumerate(top.tables("wheels"), 1)]
    _told_apart(top, "wheels", WHEEL)
    return tuple(one for one in found if one)


def limits_of(top: Table) -> Limits | None:
    table = top.table("limits")
    if table is None:
        return None
    table.known(("rate",))
    if not table.required("rate"):
        return None
    if not isinstance(table.data["rate"], list):
        rate = table.positive("rate")
        return None if rate is None else Limits(rate)
    rates = table.vector("rate")
    for index, value in enumerate(rates or ()):
        if value <= 0:
            table.fault(f"number {index + 1}: expected a positive number, got {float(value)!r}", "rate", index)
            return None
    return None if rates is None else Limits(None, rates)


def judge_limits(top: Table, limits: Limits | None, state: Exact3 | None):
    """Note a limit that the motion has passed before it starts. state: rad/s, input frame."""
    if limits is None or state is None:
        return
    table, degrees = Table(("limits",), top.data["limits"], top.faults), 180 / pi()
    if limits.rate is not None and dot(state, state) > limits.rate**2:
        _too_low(table, "", limits.rate, sqrt_fraction(dot(state, state)), degrees, "rate")
    for index, (most, now) in enumerate(zip(limits.rates or (), state)):
        if abs(now) > most:
            _too_low(table, f"number {index + 1}: ", most, abs(now), degrees, "rate", index)


def _too_low(table: Table, which: str, limit, now, degrees, *place):
    digits = 6 if f"{float(limit):.6g}" != f"{float(now):.6g}" else 17
    told = [f"{float(rate):.{digits}g} rad/s ({float(rate * degrees):.{digits}g} deg/s)" for rate in (limit, now)]
    table.fault(f"{which}the limit, {told[0]}, is below the rate that the motion starts with, {told[1]}: raise it or start slower", *place)


def _told_apart(top: Table, key: str, allowed):
    """Note what is no key, and names that two of them share."""
    first = {}
    for table in top.tables(key) if isinstance(top.data.get(key), list) and all(isinstance(t, dict) for t in top.data[key]) else ():
        table.known(allowed)
        name = table.data.get("name")
        if isinstance(name, str) and name in first:
            table.fault(f"two {key} have the name {described(name).removeprefix('the text ')}: give each its own", "name")
        elif isinstance(name, str):
            first[name] = table


def _name(table: Table, otherwise: str) -> str:
    name = table.text("name", otherwise)
    if not name.strip():
        table.fault("expected a name, got an empty text", "name")
    return name


def _thruster(table: Table, otherwise: str, centre: Exact3) -> Thruster | None:
    name, stuck = _name(table, otherwise), table.truth("stuck")
    complete = table.required("position", "direction", "force", position="add where it is, three numbers in m in the structural frame",
                              direction="add that of its force on the body, three numbers, any length", force='add its size, such as force = "1 N"')
    position, direction = table.vector("position"), _direction(table, "direction")
    force, tolerance = _force(table)
    angle = table.positive("misalignment", zero=True)
    if angle is not None and 2 * angle >= pi():
        table.fault(f"expected the half-angle of a cone below 90 deg, got {float(angle * 180 / pi()):.6g} deg; "
                    'a number alone is in rad, write "1 deg"', "misalignment")
    if not complete or None in (position, direction, force):
        return None
    raw, length = direction
    arm = tuple(p - c for p, c in zip(position, centre))
    torque = tuple(force * t / length for t in cross(arm, raw))
    return Thruster(name, position, tuple(v / length for v in raw), force, angle, tolerance, stuck, torque, arm)


def _force(table: Table):
    """(force, its tolerance or None), N; None for a force that is at fault."""
    text, tolerance = table.data.get("force"), None
    if isinstance(text, str) and states_uncertainty(text):
        try:
            force, tolerance, _ = plus_minus(text, FORCE)
        except InputError as error:
            table.fault(str(error), "force")
            return None, None
        if "force_tolerance" in table:
            table.fault("the force has its tolerance already: keep one of them", "force_tolerance")
    else:
        force = table.number("force")
        tolerance = _tolerance(table, force)
    if force is not None and force <= 0:
        table.fault(f"expected a positive force, got {float(force):.6g} N; turn the direction round for a force the other way", "force")
        return None, None
    if force is not None and tolerance is not None and tolerance >= force:
        table.fault(f"expected a tolerance below the force, {float(force):.6g} N, got {float(tolerance):.6g} N: the force would have no sure direction",
                    "force_tolerance" if "force_tolerance" in table else "force")
        return None, None
    return force, tolerance


def _tolerance(table: Table, force):
    """In N, or in per cent of the force: "5 %"."""
    value = table.data.get("force_tolerance")
    if not isinstance(value, str) or not value.rstrip().endswith("%"):
        return table.positive("force_tolerance", zero=True)
    try:
        share = exact(value.rstrip()[:-1].strip())
    except InputError as error:
        table.fault(str(error), "force_tolerance")
        return None
    if share < 0:
        table.fault(f"expected a tolerance that is not negative, got {described(value)}", "force_tolerance")
    return None if force is None else abs(force) * share / 100


def _direction(table: Table, key: str):
    """(the vector as written, its length), or None. The length is exact where it is rational, else good to 240 bits."""
    vector = table.vector(key)
    if vector is None:
        return None
    if not any(vector):
        table.fault("expected a direction, got zero: give a vector of any length but that", key)
        return None
    return vector, sqrt_fraction(dot(vector, vector))


def _wheel(table: Table, otherwise: str) -> Wheel | None:
    name, complete = _name(table, otherwise), table.required("axis", axis="add the direction of its momentum, three numbers, frame of the file, any length")
    axis, momentum = _direction(table, "axis"), _momentum(table)
    if not complete or axis is None or momentum is None:
        return None
    raw, length = axis
    return Wheel(name, tuple(v / length for v in raw), momentum, tuple(momentum * v / length for v in raw))


def _momentum(table: Table) -> Fraction | None:
    """N m s along the axis: as given, or inertia x speed."""
    momentum, inertia, speed = table.number("momentum"), table.positive("inertia"), table.number("speed")
    halves = [key for key in ("inertia", "speed") if key in table]
    if "momentum" not in table and len(halves) < 2:
        said = f"{halves[0]} alone is not enough: " if halves else ""
        table.fault(f"{said}expected momentum (N m s), or inertia (kg m^2, about the axis) and speed (rad/s, relative to the body)", *halves)
        return None
    if len(halves) < 2 or inertia is None or speed is None:
        return momentum
    product = inertia * speed
    if momentum is not None and abs(product - momentum) > SAME * abs(momentum):
        table.fault(f"{float(momentum):.6g} N m s contradicts inertia x speed, {float(product):.6g} N m s: keep one of them", "momentum")
    return momentum if "momentum" in table else product
