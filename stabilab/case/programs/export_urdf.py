"""The body of a case as a robot description (URDF) of one link, whose inertial is the body's.

The link's frame is that of the file: `origin` is the centre of mass in it, unturned, and the entries of
`inertia` are those of the tensor about the centre of mass, as `import_urdf` reads them. Decimals stay as they
are; other numbers (of a ratio, or of a unit that does not end in SI) have the 17 digits of doubles.
"""
from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from ...errors import CaseError, Kind, printable
from ..body import centre_of_mass, tensor_of
from ..read import Case, fires_on_schedule, load_all, load_burning, load_orbiting
from ..source import combinations, parsed, source_text
from ..table import Table
from .parts import ending_decimal

DIGITS = 17  # of doubles, which readers of URDF hold
LINK = "body"
OF_BODY, DECLARED = (Kind.UNPHYSICAL, Kind.SIZE), "stated-by-the-file"
# tables of a case that an inertial has no place for
WORDS = {"effects": "effects", "thrusters": "thrusters", "wheels": "wheels", "motion": "a motion",
         "limits": "limits", "circular_orbit": "an orbit"}


class Exported(NamedTuple):
    """case; text: of the robot description; left: what the description has no place for, in words; said: what
    limits the numbers, in words."""

    case: Case
    text: str
    left: tuple[str, ...]
    said: tuple[str, ...]


def exported(path: str) -> list[Exported]:
    """The description of the case in a file, of every combination where it has a [sweep]. Raises CaseError
    where the file has faults, has no body, or says nothing of its mass."""
    text = source_text(path)
    data, faults = parsed(path, text)
    cases = ([load_orbiting(path).craft] if "circular_orbit" in data
             else [load_burning(path).craft] if fires_on_schedule(path) else load_all(path))
    combined = dict(combinations(top := Table((), data, faults)))
    result = []
    for case in cases:
        own = Table((), combined.get(case.variant, data), faults)
        if "body" not in data:
            top.fault("a [scaled] system has no body, and without mass and moments there is no inertial to "
                      "write: give [body]", "scaled")
        elif case.physical is None or case.physical.body.mass is None:
            Table(("body",), data["body"], faults).fault(
                'mass is missing, and an inertial has one: add it, such as mass = "12 kg"')
        if faults.problems:
            raise CaseError(path, faults.ordered())
        result.append(_exported(case, own))
    return result


def _exported(case: Case, top: Table) -> Exported:
    body = Table(("body",), top.data["body"], top.faults)
    mass, tensor = body.positive("mass"), tensor_of(body)
    centre = centre_of_mass(top) or (Fraction(0),) * 3
    entries = {f"i{'xyz'[i]}{'xyz'[j]}": _number(tensor[i][j]) for i in range(3) for j in range(i, 3)}
    loose = any(item.path[0] == "body" for item in case.uncertain)
    said = tuple(caveat.words for caveat in case.caveats if caveat.kind in OF_BODY
                 or caveat.reason.code == DECLARED or loose and caveat.kind is Kind.UNCERTAIN)
    remarks = [f"  <!-- {_remark(line)} -->" for line in said]
    text = "\n".join([
        '<?xml version="1.0"?>', f"<robot name={quoteattr(_line(case.heading))}>", *remarks,
        f'  <link name="{LINK}">', "    <inertial>",
        f'      <origin xyz="{" ".join(_number(v) for v in centre)}" rpy="0 0 0"/>',
        f'      <mass value="{_number(mass or Fraction(0))}"/>',
        f"      <inertia {' '.join(f'{key}={quoteattr(value)}' for key, value in entries.items())}/>",
        "    </inertial>", "  </link>", "</robot>", ""])
    return Exported(case, text, tuple(words for key, words in WORDS.items() if top.data.get(key)), said)


def _number(value: Fraction) -> str:
    exact = ending_decimal(value)
    if exact is not None:
        return exact
    with localcontext() as context:
        context.prec = DIGITS
        return f"{Decimal(value.numerator) / Decimal(value.denominator)}"


def _line(text: str) -> str:
    return " ".join(printable(text).split())


def _remark(text: str) -> str:
    """Words in a comment of XML, which holds no two dashes."""
    return _line(text).replace("--", "- -").rstrip("-")
