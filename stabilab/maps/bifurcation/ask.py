"""The question: a case and one or two ranges in, a diagram out."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from ...case.read import Case, read_text
from ...case.source import parsed
from ...errors import InputError
from ...numbers.balls import Unclear
from ...physics.coefficients import effective
from ..axes import spans_of
from ..plan import place_and_text
from .connections import with_connections
from .diagram import diagram
from .family import Diagram, Family
from .plane import Plane, plane


def bifurcation(case: Case | str | os.PathLike[str], vary: Mapping[str, Any] | Sequence[tuple[str, Any]],
                curve: bool = False) -> Diagram | Plane:
    """All equilibria of a case over the range of one number or of two, exactly: where they appear, vanish or
    go to infinity, and which are stable.

    case: a Case, or the path of a case file. vary: name of a number -> its range, "0:0.5 N m" or two numbers
    in SI units; names are those of `stabilab.sweep`. Off the principal axes isolated equilibria are counted;
    of a torque on one, those on the curve that the motion of the case keeps to, or, with `curve` or without a
    motion, the points of the curve of equilibria where stability changes. Critical values are roots of
    discriminants and resultants with rational coefficients, isolated by balls: no step size, and none is
    missed. Over two numbers these are curves, with their cusps. Raises InputError for what cannot be
    eliminated.
    """
    family = family_of(case, vary)
    try:
        return with_connections(diagram(family, curve)) if len(family.spans) == 1 else plane(family, curve)
    except Unclear:
        raise InputError(f"{family.case.place}: undecided: what happens at one value of this range is open "
                         "at any number of bits, where the equations degenerate: divide the range, or move "
                         "its ends") from None


def family_of(case: Case | str | os.PathLike[str],
              vary: Mapping[str, Any] | Sequence[tuple[str, Any]]) -> Family:
    """The scenes over the ranges. Raises InputError for what cannot vary, and for effects that no diagram
    covers."""
    path, text = place_and_text("bifurcation", case)
    read = read_text(path, text)
    data = {key: value for key, value in parsed(path, text)[0].items() if key not in ("sweep", "expect")}
    family = Family(read, data, spans_of(data, _pairs(vary)))
    scene = effective(read.scene)
    if not scene.plain:
        others = ", ".join(one.with_article for one in scene.beyond)
        raise InputError(f"{read.place}: a diagram is exact for a body with wheels under a constant torque; "
                         f"this case also has {others}: stabilab sweep --answer equilibria,verdict counts "
                         "there")
    return family


def _pairs(vary: Mapping[str, Any] | Sequence[tuple[str, Any]]) -> list[tuple[str, Any]]:
    try:
        return [(str(name), asked) for name, asked in (vary.items() if isinstance(vary, Mapping) else vary)]
    except (TypeError, ValueError):
        raise InputError(
            f'vary: expected names and ranges such as {{"torque[3]": "0:0.5"}}, got {vary!r:.80}') from None
