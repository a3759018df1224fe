"""The body of a case: moments or a tensor of inertia, and frames turned against the principal axes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from ..errors import InputError
from ..numbers.exact import floats, half_unit
from ..numbers.principal import (
    IDENTITY,
    PrincipalAxes,
    entries,
    evened,
    fault_of,
    principal_axes,
    rounding,
    summed,
)
from ..numbers.units import INERTIA, half_digit
from ..numbers.vectors import Exact3
from ..physics.body import ROUNDING, Body, slack_of
from ..physics.effects import effect_class
from ..physics.scene import VECTORS_INSIDE, along_principal_axes
from .hardware import ZERO3, Thruster, Wheel
from .table import Faults, Table, Written, described
from .uncertain import NORMAL, SIGMAS, states_uncertainty, uncertain_number

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
