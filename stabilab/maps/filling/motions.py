"""Fates, levels, margins, extremes and periods of a sweep's states."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...answers.kinds import KINDS, kind_of
from ...answers.motion import Needs, motion
from ...answers.motions import rows
from ...case.read import Case
from ...equilibrium.stability import coefficients as invariants_of
from ...errors import InputError
from ...orbit.extremes_arrays import extremes_and_periods
from ...orbit.fate_arrays import FateResult
from ...orbit.result import Motion
from ...physics.coefficients import effective
from ...validation import reach_of
from ..plan import Plan


@dataclass(frozen=True)
class Rows:
    """The states (n, 3) of a scene whose answers come in arrays, each worked out when a column reads it."""

    plan: Plan
    case: Case
    states: np.ndarray
    known: dict[tuple[bool, bool], tuple[Any, Any]] = field(default_factory=dict)

    @cached_property
    def fates(self) -> FateResult:
        many: dict[str, Any] = {}
        pointed = self.plan.pointed
        if pointed is not None and KINDS[kind_of(effective(self.case.scene))].follows:
            many = {"proof": pointed.certify}
        return rows.fates(self.case.scene, self.states, follow=self.plan.longest, **many)

    @property
    def extremes(self) -> np.ndarray:
        """(n, 3, 2)."""
        return self._extremes_and_periods(True, "period" in self.plan.answers)[0]

    @property
    def periods(self) -> np.ndarray:
        """(n,)."""
        return self._extremes_and_periods("extremes" in self.plan.answers, True)[1]

    def _extremes_and_periods(self, box: bool, times: bool) -> tuple[Any, Any]:
        """Both at once where a sweep has both, each worked out once."""
        if (box, times) not in self.known:
            self.known[box, times] = self._worked_out(box, times)
        return self.known[box, times]

    def _worked_out(self, box: bool, times: bool) -> tuple[Any, Any]:
        scene, kind = self.case.scene, kind_of(effective(self.case.scene))
        if kind == "orbit":
            return extremes_and_periods(scene, self.states, box=box, period=times)
        try:
            result = rows.extremes(scene, self.states, reach_of(self.case.span)) if box else None
        except InputError:
            if not KINDS[kind].follows:
                raise
            result = np.full((*self.states.shape, 2), np.nan)  # no state of this scene has bounds
        return result, rows.periods(scene, self.states) if times else None


of_many = Rows


def of_one(plan: Plan, case: Case) -> Motion:
    """The motion of a case with what the columns asked for read."""
    needs = Needs.RETURN | (Needs.DISTANCE if "distance" in plan.answers else Needs.FATE)
    return motion(case.scene, case.start, case.span, needs, case.exact_state, plan.longest)


def depart(case: Case, states: np.ndarray) -> np.ndarray:
    """Which states (n, 3) of equilibrium are not known to be stable. Of a gyrostat by the signs of m and n in
    z^3 + m z + n, exactly where these are zero in doubles."""
    twin = effective(case.scene)
    open_ = np.ones(len(states), bool)
    if twin.plain:
        form, x = twin.quadratic(), states.T
        J = form.jacobian([*x], np.ones(len(states)))
        m, n = (np.asarray(v, float) for v in invariants_of(J))
        open_, result = (m == 0) | (n == 0) & (m > 0) & (form.m != (0, 0, 0)), (n != 0) | (m < 0)
    else:
        result = open_.copy()
    for row in np.nonzero(open_ & ~result if twin.plain else open_)[0].tolist():
        here = replace(case, state=tuple(states[row].tolist()))
        stability = motion(here.scene, here.start, needs=Needs.FATE).stability
        result[row] = stability is not None and not stability.stable
    return result
