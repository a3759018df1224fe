"""[body] of a case file: moments, a full tensor, or moments beside products of inertia; mass and centre of mass."""
from __future__ import annotations

from fractions import Fraction

from ..errors import InputError
from ..numbers.exact import half_unit
from ..numbers.principal import IDENTITY, PrincipalAxes, fault_of, principal_axes
from ..numbers.vectors import Exact3
from ..physics.body import ROUNDING, Body
from .table import Faults, Table, Written, described
from .uncertainty import plus_minus, states_uncertainty
from .units import INERTIA, in_dimension, split

KEYS = ("inertia", "products", "mass", "centre_of_mass")
PAIRS = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
CONVENTIONS = ('"positive" (the products are the integrals of x y dm and so on, the entries of the tensor are minus these; '
               'NASA 42 and many mass-property reports) or "negative" (the products are the entries of the tensor themselves)')


def body_of(top: Table) -> tuple[Body | None, PrincipalAxes | None]:
    """The body in its principal axes and these, (None, None) where it is at fault."""
    table = top.table("body")
    if table is None:
        if "body" not in top:
            top.fault("expected a table [body] with inertia (kg m^2), or [scaled] with a, b and mu")
        return None, None
    table.known(KEYS)
    mass = table.positive("mass")
    table.vector("centre_of_mass")
    frame = _frame(table) if table.required("inertia") else None
    try:
        return (None, None) if frame is None or (mass is None and "mass" in table) else (Body(frame.moments, mass, _slack(table)), frame)
    except InputError as error:
        table.fault(str(error).removeprefix("inertia: "), "inertia")
        return None, None


def centre_of_mass(top: Table) -> Exact3 | None:
    """Where the centre of mass is in the structural frame, m; None where the file does not say. Faults are noted by `body_of`."""
    body = top.data.get("body")
    if not isinstance(body, dict) or "centre_of_mass" not in body:
        return None
    return Table(("body",), body, Faults(top.faults.lines)).vector("centre_of_mass")


def _frame(table: Table) -> PrincipalAxes | None:
    value = table.data["inertia"]
    nested = isinstance(value, list) and any(isinstance(row, list) for row in value) and all(isinstance(row, list) for row in value)
    if not nested and "products" not in table:
        moments = table.vector("inertia")
        return PrincipalAxes(moments, IDENTITY, True) if moments and _good(table, moments) else None
    rows = _tensor(table) if nested else _with_products(table)
    wrong = rows and fault_of(rows)
    if wrong:
        table.fault(wrong, "inertia")
    return None if wrong or rows is None else principal_axes(rows)


def _tensor(table: Table):
    """The 3 x 3 tensor as it is written, the mean of two entries that differ by the rounding of doubles."""
    if "products" in table:
        table.fault("a full tensor has the products of inertia in it: keep one of them", "products")
        return None
    rows = table.matrix("inertia")
    if rows is None:
        return None
    slack = ROUNDING * max(abs(v) for row in rows for v in row)
    return [[(v + rows[j][i]) / 2 if abs(v - rows[j][i]) <= slack else v for j, v in enumerate(row)] for i, row in enumerate(rows)]


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
        products.fault(f"products of inertia are printed with either sign: add convention = {CONVENTIONS}{came}", *keys)
        return None
    rows = [[moments[i] if i == j else Fraction(0) for j in range(3)] for i in range(3)]
    for name, (i, j) in PAIRS.items():
        value = products.number(name) if name in products else Fraction(0)
        if value is None:
            return None
        rows[i][j] = rows[j][i] = signs[convention] * value
    return rows


def _good(table: Table, moments) -> bool:
    """Whether three principal moments are positive, within their uncertainties too; the faults of both."""
    negative = [index for index, moment in enumerate(moments) if moment <= 0]
    for index in negative:
        table.fault(f"number {index + 1} is {float(moments[index])!r}; principal moments are positive", "inertia", index)
    return not negative and _possible(table, moments)


def _possible(table: Table, moments) -> bool:
    """Whether all moments within the uncertainties are positive; a fault where not."""
    for index, moment in enumerate(moments):
        given = table.faults.uncertain.get(table.path + ("inertia", index))
        if given and moment <= given.half:
            table.fault(f"number {index + 1}: the uncertainty reaches moments down to {float(moment - given.half)!r}; no rigid body has these: "
                        "make it smaller", "inertia", index)
            return False
    return True


def _slack(table: Table) -> Fraction:
    """How far the digits of the tensor leave open by how much its largest moment exceeds the sum of the others, kg m^2.

    With half units e_ij of the entries that is at most e_11 + e_22 + e_33 + 2 max_i sum_(j != i) e_ij: the trace changes by the
    first, and an eigenvalue of the tensor less half its trace by at most the largest sum of a row (Gershgorin).
    """
    inertia, products = table.data["inertia"], table.data.get("products", {})
    if isinstance(inertia[0], list):
        halves = [[_half(value) for value in row] for row in inertia]
    else:
        halves = [[_half(inertia[i]) if i == j else Fraction(0) for j in range(3)] for i in range(3)]
        for name, (i, j) in PAIRS.items():
            halves[i][j] = halves[j][i] = _half(products.get(name, 0))
    return sum(halves[i][i] for i in range(3)) + 2 * max(sum(row) - row[i] for i, row in enumerate(halves))


def _half(value: object) -> Fraction:
    """The uncertainty of a number of the file, else half a unit of its last digit, kg m^2."""
    if not isinstance(value, str) or isinstance(value, Written):
        return half_unit(value)
    if states_uncertainty(value):
        return plus_minus(value, INERTIA)[1]
    number, unit = split(value) or (value, "")
    return half_unit(number) * (in_dimension(unit, INERTIA).size if unit else 1)
