"""What uncertain numbers do to the verdicts on equilibria and motion.

A case may state inertia, gyrostatic moment, torque and state with half-widths; together they span a box. For
the whole box a verdict holds (proved), or it depends (with a point of the box on each side), or it stays
undecided (with the reason); and the smallest change that flips it is bracketed: proved to be safe below one
factor of the stated uncertainties, seen to flip at another.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...caveat import Caveat
from ...errors import InputError
from .box import box_of
from .equilibria import equilibria_over
from .fate import fate_over
from .result import Over


@dataclass(frozen=True)
class Uncertainty:
    """numbers: the uncertain numbers of the case; equilibria, fate: what they do to each, None where not
    asked (and the fate where there is no state). caveats: that samples stand in place of a proof, where they
    do."""

    numbers: tuple[Any, ...]
    equilibria: Over | None
    fate: Over | None

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        sampled = ((name, over.samples) for name,
                   over in (("equilibria", self.equilibria), ("fate", self.fate)) if over)
        return tuple(Caveat("samples",
                            f"{name} over the uncertain numbers by samples, not by proof: {found.words}")
                     for name, found in sampled if found)


def uncertain(case: Any, questions: Sequence[str] = ("equilibria", "fate")) -> Uncertainty | None:
    """What the uncertain numbers of a Case do to its verdicts, None where it has none; questions: those to be
    answered."""
    if not case.uncertain:
        return None
    ask = {"equilibria": equilibria_over, "fate": fate_over}
    asked = [name for name in questions if name == "equilibria" or case.state is not None]
    try:
        box = box_of(case)
        found = {name: ask[name](box) for name in asked}
    except InputError as error:
        found = {name: Over("undecided", None, str(error)) for name in asked}
    return Uncertainty(case.uncertain, found.get("equilibria"), found.get("fate"))


__all__ = ["Over", "Uncertainty", "uncertain"]
