"""Which kind of scene is answered by which module: a table with a row for each kind, whose modules all
answer the same questions.

One state: `motion(scene, state, span, exact, needs)` -> Motion; needs: what is worked out, as of
`answers.motion`. Many: `fates(scene, states, fast)` ->
FateResult, `extremes(scene, states, span, fast)` -> (n, 3, 2), `periods(scene, states, fast)` -> (n,), for
rows (n, 3). Kinds that follow motions also take `follow`, how long a motion is followed (None: as long as a
user waits), and `tell`, which hears of it on the way."""
from __future__ import annotations

import math
from collections.abc import Callable
from importlib import import_module
from typing import Any, NamedTuple

from ..errors import InputError
from ..orbit.reduction import reduce
from ..physics.scene import AnyScene, aligned


class Kind(NamedTuple):
    """holds: whether a scene is of this kind, when no row above holds it; one, many: the modules that answer
    for one state and for many; follows: whether these take `follow` and `tell` (see `following`)."""

    holds: Callable[..., bool]
    one: str
    many: str
    follows: bool = False


def _acting(scene: AnyScene) -> int:
    """Return the number of axes about which a torque acts."""
    return sum(m != 0 for m in scene.quadratic().m)


# The first row that holds a scene answers it: a new kind is a file and a row, above those that would hold it
# otherwise.
KINDS = {
    # liquid, medium, field: rows are refused, with the effect's name
    "bounds": Kind(lambda scene: not scene.plain, "unreduced.bounds", "orbit.extremes_arrays"),
    "orbit": Kind(lambda scene: reduce(scene) is not None, "orbit.one_state", "orbit.extremes_arrays"),
    # a wheel with no zero component
    "free": Kind(lambda scene: _acting(scene) == 0, "unreduced.free_gyrostat", "unreduced.free_gyrostat"),
    # a wheel along the torque
    "growth": Kind(lambda scene: _acting(scene) == 1, "unreduced.growth", "unreduced.growth"),
    # in the plane of two equal moments
    "aligned": Kind(lambda scene: aligned(scene) is not None, "unreduced.aligned", "unreduced.aligned"),
    "off axis": Kind(lambda scene: True, "unreduced.off_axis", "unreduced.off_axis", follows=True),
}


def kind_of(scene: AnyScene) -> str:
    """The kind of a scene, a key of KINDS; `physics.coefficients.effective` first, where other effects may
    turn as a wheel does."""
    return next(name for name, kind in KINDS.items() if kind.holds(scene))


def one(scene: AnyScene) -> Any:
    """The module that answers for one state of this scene."""
    return import_module(f"..{KINDS[kind_of(scene)].one}", __package__)


def many(scene: AnyScene) -> Any:
    """The module that answers for many states of this scene."""
    return import_module(f"..{KINDS[kind_of(scene)].many}", __package__)


def following(scene: AnyScene, follow: float | None = None, tell: Callable[..., Any] | None = None,
              proof: bool = False) -> dict[str, Any]:
    """The options of a kind whose motions are followed; none for the others, whose answers need no run."""
    if follow is not None and not (isinstance(follow, (int, float)) and math.isfinite(follow)
                                   and follow >= 0):
        raise InputError(f"follow: expected a time of at least 0, got {follow!r:.80}")
    return ({"follow": follow, "tell": tell} | ({"proof": True} if proof else {})
            if KINDS[kind_of(scene)].follows else {})
