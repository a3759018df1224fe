"""Everything about the motion from one state: fate, margins, period, extremes, invariants."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ..integrate.quadratic_series import largest
from ..orbit.one_state import in_range
from ..orbit.reduction import energy_integral
from ..orbit.result import Fate, Motion
from ..orbit.result import Needs as Needs
from ..physics.coefficients import content, effective, gyrostat_scene, limits_of, loses, split
from ..physics.scene import AnyScene
from ..physics.symmetric_top import top_rates
from ..unreduced.flips import flips_of
from ..validation import checked_span, is_case, scene_and_state
from .caveats import limited
from .kinds import following, one

if TYPE_CHECKING:
    from ..case.read import Case


def motion(scene: Any, state: Any = None, span: Any = None, needs: Needs = Needs.ALL,
           exact: Sequence[Fraction] | None = None,
           follow: float | None = None, tell: Callable[..., Any] | None = None,
           proof: bool = False) -> Motion:
    """All that is known of the motion from `state` (three numbers in the scene's variables) at time 0.

    scene: a Scene or a ScaledGyrostat, or a case, whose own start and span hold where none are given.
    Where gamma is part of the state: six numbers (omega, gamma), or a dict of blocks. span: (from, to), in
    whose times, and from the start to them, extremes are searched where the motion is not integrable. needs:
    what is worked out beside the fate.
    exact: the three rates as they were given (Fractions), of which `state` is the rounding: where the motion
    has a reduction the answer is theirs. follow, tell: as of `fate`. proof: enclose the way of a motion that
    is followed, so that its fate is proved where it can be. Raises InputError as `fate` does.
    """
    case = scene if is_case(scene) else None
    own = case if state is None else None
    if case is not None and state is None:
        span, exact = case.span if span is None else span, case.exact_state
    scene, state = scene_and_state(scene, state)
    limits = limits_of(scene)
    if limits and needs:  # how far its law holds is seen by its extremes
        needs |= Needs.EXTREMES
    result = _found(scene, state, checked_span(span), needs, exact, follow, tell, proof)
    if result.fate == Fate.EQUILIBRIUM:
        from .at_equilibrium import with_stability
        result = with_stability(scene, result, exact)
    result = (replace(result, validity=limits.of_motion(scene, result)) if limits and result.validity is None
             else result)
    twin = effective(scene)
    integral = (None if not needs & Needs.INVARIANTS or not twin.plain
                else energy_integral(twin, exact or result.at[:3], result.margin_energy))
    result = replace(result, largest=_largest(twin, result) if needs & Needs.LARGEST else None,
                    flips=flips_of(scene, result) if needs & Needs.FLIPS else None, energy_integral=integral,
                    top=top_rates(scene, _start(exact, result)) if needs & Needs.INVARIANTS else None)
    result = limited(result, scene, case)
    return result if own is None or not needs & Needs.ENDING else with_ending(own, result)


def _start(exact: Sequence[Fraction] | None, result: Motion) -> Sequence[Any]:
    """The start as it was written, where that is all of it, else its doubles."""
    return exact if exact is not None and len(exact) >= len(result.at) else result.at


def with_ending(case: Case, result: Motion) -> Motion:
    """The motion of a case with how it ends and when, where something takes energy from it."""
    if result.ending is not None or not loses(case.scene):
        return result
    from .dissipation.ending import with_end
    return with_end(case, result)


def _largest(twin: AnyScene, result: Motion) -> float | None:
    """|omega| at the most, of a motion that repeats or rests, where its extremes are known over all time."""
    pairs = result.extremes
    if result.fate == Fate.EQUILIBRIUM:
        return math.hypot(*result.at[:3])
    if not twin.plain or result.period is None or pairs is None or not result.for_all_time:
        return None
    sizes = [max(map(abs, pair)) for pair in pairs if None not in pair]
    upper = (largest(twin.quadratic(), result.at[:3], result.period) if len(sizes) == 3
            and math.hypot(*sizes) < math.inf else None)
    return None if upper is None else min(max(upper, *sizes), math.hypot(*sizes))


def _found(scene: AnyScene, state: Any, span: tuple[float, float] | None, needs: Needs,
           exact: Sequence[Fraction] | None,
           follow: float | None, tell: Callable[..., Any] | None, proof: bool) -> Motion:
    """By the module that answers the kind of scene; where all effects together turn the body as a gyrostat
    does, that of the gyrostat."""
    parts = None if scene.plain else content(scene)
    with in_range():
        if parts is None or parts.kind != "gyrostat":
            return one(scene).motion(scene, state, span, exact, needs,
                                     **following(scene, follow, tell, proof))
        twin = gyrostat_scene(parts)
        result = one(twin).motion(twin, split(parts, state)[0], span, exact, needs,
                                 **following(twin, follow, tell, proof))
    return replace(result, reason=result.reason.then(parts.note))
