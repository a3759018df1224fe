"""What uncertain numbers do to the verdicts on equilibria and motion.

A case may state inertia, gyrostatic moment, torque and state with half-widths; together they span a box. For the whole box a
verdict holds (proved), or it depends (with a point of the box on each side), or it stays undecided (with the reason); and the
smallest change that flips it is bracketed: proved to be safe below one factor of the stated uncertainties, seen to flip at another.
"""
from __future__ import annotations

from dataclasses import dataclass

from ..errors import InputError
from .uncertain_results import Over


@dataclass(frozen=True)
class Uncertainty:
    """numbers: the uncertain numbers of the case; equilibria, fate: what they do to each (fate None without a state)."""

    numbers: tuple
    equilibria: Over
    fate: Over | None


def uncertain(case) -> Uncertainty | None:
    """What the uncertain numbers of a Case do to its verdicts, None where it has none."""
    if not case.uncertain:
        return None
    from .uncertain_box import box_of
    from .uncertain_equilibria import equilibria_over
    from .uncertain_fate import fate_over
    try:
        box = box_of(case)
    except InputError as error:
        undecided = Over("undecided", "", str(error))
        return Uncertainty(case.uncertain, undecided, undecided if case.state is not None else None)
    return Uncertainty(case.uncertain, equilibria_over(box), fate_over(box))


__all__ = ["Over", "Uncertainty", "uncertain"]
