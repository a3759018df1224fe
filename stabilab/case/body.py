"""The body of a case: moments or a tensor of inertia, hardware (wheels, thrusters, limits), and frames turned
against the principal axes."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from ..errors import Caveat, InputError, Kind
from ..numbers.exact import Rounded, exact, floats, half_unit, sqrt_fraction
from ..numbers.principal import (
    IDENTITY,
    PrincipalAxes,
    crossed,
    entries,
    evened,
    fault_of,
    principal_axes,
    rounding,
    settled,
    summed,
)
from ..numbers.units import FORCE, INERTIA, half_digit, pi
from ..numbers.vectors import Exact3, dot
from ..physics.effects import effect_class
from ..physics.scene import ROUNDING, VECTORS_INSIDE, Body, along_principal_axes, slack_of
from ..reasons import Length, Sentence
from . import sections
from .aliases import shown
from .table import Faults, Table, Written, described
from .uncertain import NORMAL, SIGMAS, Stated, Uncertain, states_uncertainty, uncertain_number

# --- [body] of a case file: moments, a full tensor, or moments beside products of inertia; mass and centre
# of mass
KEYS = ("inertia", "products", "mass", "centre_of_mass")
PAIRS = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
CONVENTIONS = ('"positive" (the products are the integrals of x y dm and so on, the entries of the tensor '
               'are minus these; '
               'NASA 42 and many mass-property reports) or "negative" (the products are the entries of the '
               'tensor themselves)')


def body_of(top: Table) -> tuple[Body | None, PrincipalAxes | None]:
    """The body in its principal axes and these, (None, None) where it is at fault."""
    table = top.table("body")
    if table is None:
        if "body" not in top:
            top.fault("expected a table [body] with inertia (kg m^2), or [scaled] with a, b and mu",
                      instead_of=("body",))
        return None, None
    table.known(KEYS)
    mass = table.positive("mass")
    table.vector("centre_of_mass")
    frame = _frame(table) if table.required("inertia") else None
    try:
        if frame is None or (mass is None and "mass" in table):
            return None, None
        return Body(frame.moments, mass, _slack(table)), frame
    except InputError as error:
        table.fault(str(error).removeprefix("inertia: "), "inertia")
        return None, None


def centre_of_mass(top: Table) -> Exact3 | None:
    """Where the centre of mass is in the structural frame, m; None where the file does not say. Faults are
    noted by `body_of`."""
    body = top.data.get("body")
    if not isinstance(body, dict) or "centre_of_mass" not in body:
        return None
    return Table(("body",), body, Faults(top.faults.lines)).vector("centre_of_mass")


def _frame(table: Table) -> PrincipalAxes | None:
    value = table.data["inertia"]
    nested = (isinstance(value, list) and any(isinstance(row, list) for row in value)
              and all(isinstance(row, list) for row in value))
    if not nested and "products" not in table:
        moments = table.vector("inertia")
        return PrincipalAxes(moments, IDENTITY, True) if moments and _good(table, moments) else None
    rows, off = _tensor(table) if nested else (_with_products(table), Fraction(0))
    wrong = rows and fault_of(rows)
    if wrong:
        table.fault(wrong.text(), "inertia")
    return None if wrong or rows is None else principal_axes(rows, off)


def tensor_of(table: Table) -> Sequence[Sequence[Fraction]]:
    """The tensor of [body] as it is stated, in the frame of the file, kg m^2: of a table without a fault."""
    if isinstance(table.data["inertia"][0], list):
        return _tensor(table)[0]
    return _with_products(table) if "products" in table else _diagonal(table.vector("inertia"))


def _diagonal(moments: Sequence[Fraction] | None) -> list[list[Fraction]]:
    return [[moment * (i == j) for j in range(3)] for i, moment in enumerate(moments or ZERO3)]


def _tensor(table: Table):
    """(the 3 x 3 tensor, the mean of two entries that differ by the rounding of doubles; what its digits
    leave open), None where it is at fault."""
    if "products" in table:
        table.fault("a full tensor has the products of inertia in it: keep one of them", "products")
        return None, Fraction(0)
    rows = table.matrix("inertia")
    return (None, Fraction(0)) if rows is None else (evened(rows, ROUNDING), rounding(entries(rows)))


def _with_products(table: Table):
    """Three moments and [body.products] as a tensor."""
    moments, products = table.vector("inertia"), table.table("products")
    if products is None or moments is None:
        return None
    products.known((*PAIRS, "convention"))
    signs = {"positive": -1, "negative": 1}
    convention = products.data.get("convention")
    if convention not in signs:
        came = "" if convention is None else f", got {described(convention)}"
        keys = () if convention is None else ("convention",)
        products.fault(
            f"products of inertia are printed with either sign: add convention = {CONVENTIONS}{came}", *keys)
        return None
    rows = _diagonal(moments)
    for name, (i, j) in PAIRS.items():
        value = products.number(name) if name in products else Fraction(0)
        if value is None:
            return None
        rows[i][j] = rows[j][i] = signs[convention] * value
    return rows


def _good(table: Table, moments: Sequence[Fraction]) -> bool:
    """Whether three principal moments are positive, within their uncertainties too; the faults of both."""
    negative = [index for index, moment in enumerate(moments) if moment <= 0]
    for index in negative:
        table.fault(f"number {index + 1} is {float(moments[index])!r}; principal moments are positive",
                    "inertia", index)
    return not negative and _possible(table, moments)


def _possible(table: Table, moments: Sequence[Fraction]) -> bool:
    """Whether all moments within the uncertainties are positive; a fault where not."""
    for index, moment in enumerate(moments):
        supplied = table.faults.uncertain.get(table.path + ("inertia", index))
        if supplied and moment <= supplied.half:
            size = "the uncertainty" if supplied.law != NORMAL else f"{SIGMAS} sigma"
            table.fault(f"number {index + 1}: {size} reaches moments down to "
                        f"{float(moment - supplied.half)!r}; no rigid body has these: "
                        "make it smaller", "inertia", index)
            return False
    return True


def _slack(table: Table) -> Fraction:
    """How far the digits of the tensor leave open by how much its largest moment exceeds the sum of the
    others, kg m^2."""
    inertia, products = table.data["inertia"], table.data.get("products", {})
    if isinstance(inertia[0], list):
        halves = [[_half(value) for value in row] for row in inertia]
    else:
        halves = [[_half(inertia[i]) if i == j else Fraction(0) for j in range(3)] for i in range(3)]
        for name, (i, j) in PAIRS.items():
            halves[i][j] = halves[j][i] = _half(products.get(name, 0))
    return slack_of(halves)


def _half(value: object) -> Fraction:
    """The uncertainty of a number of the file, else half a unit of its last digit, kg m^2."""
    if not isinstance(value, str) or isinstance(value, Written):
        return half_unit(value)
    if states_uncertainty(value):
        return uncertain_number(value, INERTIA).half
    return half_digit(value, INERTIA)


# --- What a spacecraft carries, as a case file states it: [[thrusters]], [[wheels]] and [limits]
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
    hint = (f'; a number alone is in rad/s, of degrees write "{plain[0]} deg/s"' if plain else "")
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


# --- From the frame that a case is written in to principal axes: what the parts add up to, effects and
# motion turned
OBLIQUE = "the tensor is not diagonal, and"
REFUSED = {"x": f"{OBLIQUE} x counts along principal axes: give angular_velocity in rad/s, in the frame of "
                f"the tensor",
           "attitude": f"{OBLIQUE} an attitude is not turned to principal axes: give principal moments",
           "velocity": f"{OBLIQUE} a velocity is not turned to principal axes: give principal moments",
           # keys of [motion]
           "position": f"{OBLIQUE} a position is not turned to principal axes: give principal moments"}


def added(effects: list, thrusters: Sequence[Thruster], wheels: Sequence[Wheel]) -> list:
    """The effects with the torques of stuck thrusters and the momenta of wheels, all in the input frame."""
    torques, momenta = [t.torque for t in thrusters if t.stuck], [w.vector for w in wheels]
    return _with(_with(effects, "gyrostat", momenta), "constant_torque", torques)


def _with(effects, name, vectors):
    if not vectors:
        return effects
    supplied = next((e for e in effects if e.name == name), None)
    if supplied is None:
        return [*effects, effect_class(name)(summed(vectors))]
    full = effect_class(name)(summed([supplied.exact, *vectors]))
    return [full if e is supplied else e for e in effects]


def fitted(frame: PrincipalAxes | None, effects: list, motion) -> PrincipalAxes | None:
    """The axes of a tensor that is not diagonal, chosen where moments are equal by the directions of torque,
    wheels, weight, motion and vertical."""
    if frame is None or frame.as_given:
        return frame
    resolved = {effect.name: effect.exact for effect in effects if effect}
    vectors = [resolved.get(name) for name in ("constant_torque", "gyrostat", "gravity")]
    return frame.fitted([v for v in (*vectors, motion.exact, motion.exact_vertical) if v])


def turned_effects(top: Table, effects: list, frame: PrincipalAxes | None) -> list:
    """The effects along principal axes; a fault for each that cannot be turned."""
    if frame is None:
        return effects
    turned = along_principal_axes(effects, frame)
    for effect, result in zip(effects, turned):
        if result is None:
            top.fault(f"{OBLIQUE} {effect.name.replace('_', ' ')} is known along principal axes alone: give "
                      f"principal moments, and "
                      "the rest of the case along them", "effects", effect.name)
    return [effect for effect in turned if effect is not None]


def judge_oblique(top: Table, frame: PrincipalAxes | None):
    """Note every number that speaks of principal axes beside a tensor that is not diagonal."""
    if frame is None or frame.as_given:
        return
    motion, torque = top.data.get("motion"), top.data.get("effects")
    for key, value in REFUSED.items():
        if isinstance(motion, dict) and key in motion:
            top.fault(value, "motion", key)
    torque = torque.get("constant_torque") if isinstance(torque, dict) else None
    if isinstance(torque, dict) and "mu" in torque:
        top.fault(f"{OBLIQUE} mu counts along principal axes: give torque in N m, in the frame of the tensor",
                  "effects", "constant_torque", "mu")


def turned_motion(motion, frame: PrincipalAxes | None):
    """[motion] with its angular velocity, vertical, damper and wheel along principal axes."""
    if frame is None or frame.as_given or motion.state_key == "x":
        return motion
    state = motion.exact and frame.turned(motion.exact)
    try:
        turned = {"gamma": floats(frame.turned(motion.exact_vertical))} if motion.exact_vertical else {}
        turned |= {name: floats(frame.turned(tuple(map(Fraction, motion.blocks[name]))))
                   for name in VECTORS_INSIDE if name in motion.blocks}
        return replace(motion, exact=state, state=state and floats(state), blocks=motion.blocks | turned)
    except OverflowError:
        motion.table.fault("exceeds the largest double (about 1.8e308) along the principal axes",
                           motion.state_key)
        return motion
