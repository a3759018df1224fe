"""What a spacecraft carries, as a case file states it: [[thrusters]], [[wheels]] and [limits]."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from ..errors import Caveat, InputError, Kind
from ..numbers.exact import Rounded, exact, sqrt_fraction
from ..numbers.principal import PrincipalAxes, crossed, settled
from ..numbers.units import FORCE, pi
from ..numbers.vectors import Exact3, dot
from ..physics.body import Body
from ..reasons import Length, Sentence
from . import sections
from .aliases import shown
from .table import Table, Written, described
from .uncertain import NORMAL, SIGMAS, Stated, Uncertain, states_uncertainty, uncertain_number

ZERO3 = (Fraction(0),) * 3
# as the caveats begin of an answer that does not look at them
THRUSTER = ("name", "position", "direction", "force", "misalignment", "force_tolerance", "stuck",
            *sections.BURN_KEYS)
WHEEL = ("name", "axis", "momentum", "inertia", "speed")
SAME = Fraction(1, 10**6)  # relative: momentum and inertia x speed given to six digits agree


@dataclass(frozen=True, repr=False)
class Thruster(Rounded):
    """position: m, structural frame; direction: unit vector of the force on the body, input frame; force: N;
    misalignment: half-angle of the cone that the true direction lies in, rad, or None; force_tolerance:
    half-width, N, or None; stuck: whether it fires for ever; torque: about the centre of mass, N m, input
    frame, of the force as stated; arm: from there to its position, m; burn: when it fires, None where the
    file does not say; path: of its table."""

    name: str
    position: Exact3
    direction: Exact3
    force: Fraction
    misalignment: Fraction | None
    force_tolerance: Fraction | None
    stuck: bool
    torque: Exact3
    arm: Exact3 = ZERO3
    burn: sections.Burn | None = None
    path: tuple = field(default=(), compare=False)


@dataclass(frozen=True, repr=False)
class Wheel(Rounded):
    """axis: unit vector, input frame; momentum: along it relative to the body, N m s; vector: both as a
    vector, input frame; inertia: kg m^2, about the axis, None where the file does not say; factors: the keys
    whose product the momentum is; path: of its table."""

    name: str
    axis: Exact3
    momentum: Fraction
    vector: Exact3
    inertia: Fraction | None = None
    factors: tuple[str, ...] = ("momentum",)
    path: tuple = field(default=(), compare=False)


@dataclass(frozen=True, repr=False)
class Limits(Rounded):
    """rate: largest |omega|, rad/s, or rates: largest |omega_i| along the axes of the input frame; the other
    one is None."""

    rate: Fraction | None = None
    rates: Exact3 | None = None

    def components(self, frame: PrincipalAxes) -> list[tuple[Exact3, Fraction]]:
        """(axis of the input frame as a unit vector along the principal axes, its limit) of `rates`."""
        return [(frame.turned([Fraction(int(n == m)) for n in range(3)]), rate) for m,
                rate in enumerate(self.rates or ())]


def thrusters_of(top: Table, centre: Exact3 | None) -> tuple[Thruster, ...]:
    """Those without a fault."""
    tables = top.tables("thrusters")
    rows = [_thruster(table, f"thruster {i}", centre or ZERO3) for i, table in enumerate(tables, 1)]
    _told_apart(tables, "thrusters", THRUSTER)
    return tuple(item for item in rows if item)


def wheels_of(top: Table) -> tuple[Wheel, ...]:
    """Those without a fault."""
    tables = top.tables("wheels")
    rows = [_wheel(table, f"wheel {i}") for i, table in enumerate(tables, 1)]
    _told_apart(tables, "wheels", WHEEL)
    return tuple(item for item in rows if item)


WIDE = Sentence(
    "size-beyond-thrusters", "the radius of gyration is {radius} and the farthest thruster stands {reach} "
    "from the centre of mass, beyond all reason for one craft: is the tensor in kg mm^2 or another unit that "
    "the file leaves out")
IMPLAUSIBLE = Sentence(
    "thrusters-beyond-size", "the radius of gyration is {radius} and the farthest thruster stands {reach} "
    "from the centre of mass, beyond all reason for one craft: is the position in mm, or the tensor in "
    "another unit that the file leaves out")
FARTHEST = 50  # times: a twentieth of the mass in booms that reach so far makes them 390 times as long


def far_off(body: Body | None, thrusters: Iterable[Thruster]) -> tuple[Caveat, ...]:
    """That the thrusters and the mass do not belong to one craft: of moments I a thruster with its mount at
    the distance d has at most I/(m d^2) of the mass, and a radius of gyration is no larger than the craft."""
    reach = max((math.sqrt(float(dot(thruster.arm, thruster.arm))) for thruster in thrusters), default=0.0)
    if (body is None or body.gyration is None or not reach
            or any(caveat.kind is Kind.SIZE for caveat in body.caveats)):
        return ()
    sizes = {"radius": Length(body.gyration, digits=4), "reach": Length(reach, digits=4)}
    if body.gyration > FARTHEST * reach:
        return (Caveat(Kind.SIZE, WIDE(**sizes)),)
    return (Caveat(Kind.SIZE, IMPLAUSIBLE(**sizes)),) if reach > FARTHEST * body.gyration else ()


def limits_of(top: Table) -> Limits | None:
    """The table [limits] of a case file; None where there is none."""
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
            table.fault(f"number {index + 1}: expected a positive number, got {float(value)!r}", "rate",
                        index)
            return None
    return None if rates is None else Limits(None, rates)


def judge_limits(top: Table, limits: Limits | None, state: Exact3 | None):
    """Note a limit that the motion has passed before it starts. state: rad/s, input frame."""
    if limits is None or state is None:
        return
    supplied = top.data["motion"].get("angular_velocity", ())
    plain = [shown(value) for value in supplied
             if (not isinstance(value, str) or isinstance(value, Written)) and float(value)]
    hint = ("" if not plain else
            f'; a number alone in angular_velocity is in rad/s, of degrees write "{plain[0]} deg/s"')
    table, degrees = Table(("limits",), top.data["limits"], top.faults), 180 / pi()
    if limits.rate is not None and dot(state, state) > limits.rate**2:
        _too_low(table, "", limits.rate, sqrt_fraction(dot(state, state)), degrees, hint, "rate")
    for index, (rate, now) in enumerate(zip(limits.rates or (), state)):
        if abs(now) > rate:
            _too_low(table, f"number {index + 1}: ", rate, abs(now), degrees, hint, "rate", index)


def _too_low(table: Table, which: str, limit, now, degrees, hint: str, *location):
    digits = 6 if f"{float(limit):.6g}" != f"{float(now):.6g}" else 17
    text = [f"{float(rate):.{digits}g} rad/s ({float(rate * degrees):.{digits}g} deg/s)"
            for rate in (limit, now)]
    table.fault(
        f"{which}the limit, {text[0]}, is below the rate that the motion starts with, {text[1]}: raise it or "
        f"start slower{hint}", *location)


def _told_apart(tables: list[Table], key: str, allowed: Sequence[str]):
    """Note what is no key, and names that two of them share."""
    visited = set()
    for table in tables:
        table.known(allowed)
        name = table.data.get("name")
        if isinstance(name, str) and name in visited:
            table.fault(
                f"two {key} have the name {described(name).removeprefix('the text ')}: give each its own",
                "name")
        visited |= {name} if isinstance(name, str) else set()


def _name(table: Table, otherwise: str) -> str:
    name = table.text("name", otherwise)
    if not name.strip():
        table.fault("expected a name, got an empty text", "name")
    return name


def _thruster(table: Table, otherwise: str, centre: Exact3) -> Thruster | None:
    name, stuck = _name(table, otherwise), table.truth("stuck")
    complete = table.required("position", "direction", "force",
                              position="add where it is, three numbers in m in the structural frame",
                              direction="add that of its force on the body, three numbers, any length",
                              force='add its size, such as force = "1 N"')
    position, direction = table.vector("position"), _direction(table, "direction")
    force, declared = _force(table)
    tolerance = declared and declared.half
    angle = table.positive("misalignment", zero=True)
    if angle is not None and 2 * angle >= pi():
        table.fault(f"expected the half-angle of a cone below 90 deg, got "
                    f"{float(angle * 180 / pi()):.6g} deg; "
                    'a number alone is in rad, write "1 deg"', "misalignment")
    burn = sections.burn_of(table)
    if not complete or None in (position, direction, force):
        return None
    if tolerance and (stuck or burn):  # the torque of a thruster that does not fire is certain: there is none
        path, supplied = (*table.path, "force"), table.data.get("name")
        label = supplied if isinstance(supplied, str) else table.path[-1] + 1
        table.faults.uncertain[path] = Uncertain(path, force, tolerance, f"thrusters.{label}.force",
                                                 declared.law, declared.sigma)
    raw, length = direction
    arm = tuple(p - c for p, c in zip(position, centre))
    torque = tuple(force * t / length for t in crossed(arm, raw))
    return Thruster(name, position, tuple(v / length for v in raw), force, angle, tolerance, stuck, torque,
                    arm, burn, table.path)


def _force(table: Table):
    """(force, N, None where it is at fault; what is stated of its tolerance or distribution, or None)."""
    text, number = table.data.get("force"), None
    if isinstance(text, str) and not isinstance(text, Written) and states_uncertainty(text):
        try:
            number = uncertain_number(text, FORCE)
            force, tolerance = number.middle, number.half
        except InputError as error:
            table.fault(str(error), "force")
            return None, None
        if "force_tolerance" in table:
            table.fault("the force has its tolerance already: keep one of them", "force_tolerance")
    else:
        force = table.number("force")
        tolerance = _tolerance(table, force)
        number = None if tolerance is None else Stated(force or Fraction(0), tolerance, True)
    if force is not None and force <= 0:
        table.fault(
            f"expected a positive force, got {float(force):.6g} N; turn the direction round for a force the "
            f"other way", "force")
        return None, None
    if force is not None and tolerance is not None and tolerance >= force:
        what = f"{SIGMAS} sigma" if number.law == NORMAL else "a tolerance"
        table.fault(f"expected {what} below the force, {float(force):.6g} N, got {float(tolerance):.6g} "
                    f"N: the force would have no sure direction",
                    "force_tolerance" if "force_tolerance" in table else "force")
        return None, None
    return force, number


def _tolerance(table: Table, force: Fraction | None):
    """In N, or in per cent of the force: "5 %"."""
    value = table.data.get("force_tolerance")
    if not isinstance(value, str) or not value.rstrip().endswith("%"):
        return table.positive("force_tolerance", zero=True)
    try:
        fraction = exact(value.rstrip()[:-1].strip())
    except InputError as error:
        table.fault(str(error), "force_tolerance")
        return None
    if fraction < 0:
        table.fault(f"expected a tolerance that is not negative, got {described(value)}", "force_tolerance")
    return None if force is None else abs(force) * fraction / 100


def _direction(table: Table, key: str):
    """(the vector as written, its length), or None. The length is exact where it is rational, else good to
    240 bits."""
    vector = table.vector(key)
    if vector is None:
        return None
    if not any(vector):
        table.fault("expected a direction, got zero: give a vector of any length but that", key)
        return None
    vector = settled(vector)
    return vector, sqrt_fraction(dot(vector, vector))


def _wheel(table: Table, otherwise: str) -> Wheel | None:
    name, complete = _name(table,
                           otherwise), table.required("axis",
                                                      axis="add the direction of its momentum, three "
                                                           "numbers, frame of the file, any length")
    axis, (momentum, inertia) = _direction(table, "axis"), _momentum(table)
    if not complete or axis is None or momentum is None:
        return None
    raw, length = axis
    return Wheel(name, tuple(v / length for v in raw), momentum, tuple(momentum * v / length for v in raw),
                 inertia, ("momentum",) if "momentum" in table else ("inertia", "speed"), table.path)


def _momentum(table: Table) -> tuple[Fraction | None, Fraction | None]:
    """(N m s along the axis: as given, or inertia x speed; the inertia, where it is given)."""
    momentum, inertia, speed = table.number("momentum"), table.positive("inertia"), table.number("speed")
    halves = [key for key in ("inertia", "speed") if key in table]
    if "momentum" not in table and len(halves) < 2:
        said = f"{halves[0]} alone is not enough: " if halves else ""
        table.fault(
            f"{said}expected momentum (N m s), or inertia (kg m^2, about the axis) and speed (rad/s, "
            f"relative to the body)", *halves, instead_of=("momentum", "inertia", "speed"))
        return None, None
    if len(halves) < 2 or inertia is None or speed is None:
        return momentum, inertia
    product = inertia * speed
    if momentum is not None and abs(product - momentum) > SAME * abs(momentum):
        table.fault(
            f"{float(momentum):.6g} N m s contradicts inertia x speed, {float(product):.6g} N m s: keep one "
            f"of them", "momentum")
    return (momentum if "momentum" in table else product), inertia
