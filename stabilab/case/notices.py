"""What a case file limits of every answer: uncertain numbers, thrusters that do not fire."""
from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..errors import Caveat, Kind
from ..physics.scene import ScaledGyrostat, Scene
from ..reasons import Quantity, Sentence, chained
from .correlations import Correlation
from .hardware import Thruster, far_off
from .uncertain import BEYOND, NORMAL, SIGMAS, Uncertain

SIZES = Sentence("tolerance-not-looked-at", "the tolerance of the force of {thrusters} is not looked at "
                 "here; stabilab fate and stabilab when look at it")
TILTS = Sentence("misalignment-not-looked-at", "the misalignment of {thrusters} is not looked at here; "
                 "stabilab fate and stabilab when look at it")
MIDDLES = Caveat(Kind.UNCERTAIN, Sentence(
    "of-the-middles", "of the middles of the uncertain numbers; stabilab fate says what their box does")())
NORMALS = Sentence(
    "normal-numbers", "{keys}: normal; what is said of all values of the uncertain numbers is said of those "
    "within {sigmas} sigma, beyond which at most {percent} % of the draws lie")
CORRELATED = Sentence(
    "correlated-numbers", "correlations of uncertain numbers ({pairs}) count in samples (--samples); what is "
    "said of all values holds for every correlation")
PAIR = Sentence("correlated-pair", "{first} with {second}: {value}")
STATED = Sentence("stated-by-the-file", "{statement}")
SILENT = Sentence("no-thruster-fires",
                  "no thruster fires: stuck = true in a table [[thrusters]] makes one act for ever "
                  "({thrusters})")


def caveats_of(declared: Iterable[str], physical: Scene | None, scene: Scene | ScaledGyrostat,
               thrusters: tuple[Thruster, ...], uncertain: tuple[Uncertain, ...],
               correlations: tuple[Correlation, ...]) -> tuple[Caveat, ...]:
    """All of them, in the order in which answers list them. declared: what the file itself says."""
    return (*(Caveat(Kind.STATED, STATED(statement=item)) for item in declared),
            *(physical.body.caveats if physical else ()),
            *(far_off(physical.body, thrusters) if physical else ()),
            *(caveat for effect in scene.effects for caveat in effect.caveats),
            *_silent(thrusters), *_of_middles(uncertain, thrusters), *_distributed(uncertain, correlations))


def _silent(thrusters: tuple[Thruster, ...]) -> tuple[Caveat, ...]:
    """That there are thrusters and none of them acts: whoever describes them asks what they do."""
    if not thrusters or any(thruster.stuck or thruster.burn for thruster in thrusters):
        return ()
    return (Caveat(Kind.THRUSTERS, SILENT(thrusters=", ".join(thruster.name for thruster in thrusters))),)


def _of_middles(uncertain: tuple[Uncertain, ...], thrusters: tuple[Thruster, ...]) -> list[Caveat]:
    """That an answer is of the middles of the uncertain numbers; of forces by itself, as more questions look
    at these than at others."""
    firing = [thruster for thruster in thrusters if thruster.stuck or thruster.burn]
    sized = tuple(item.name for item in firing if item.force_tolerance)
    tilts = tuple(item.name for item in firing if item.misalignment)
    return [*([MIDDLES] if len(uncertain) > len(sized) else []),
            *(Caveat(kind, sentence(thrusters=names)) for kind, sentence, names in (
                (Kind.TOLERANCE, SIZES, sized), (Kind.MISALIGNMENT, TILTS, tilts)) if names)]


def _distributed(uncertain: tuple[Uncertain, ...], correlations: tuple[Correlation, ...]) -> Iterator[Caveat]:
    """How far the box of normal numbers reaches, and what correlations count for."""
    normal = tuple(item.key for item in uncertain if item.law == NORMAL)
    if normal:
        outside = Quantity(100 * BEYOND * len(normal), digits=3).upper
        yield Caveat(Kind.DISTRIBUTION, NORMALS(keys=normal, sigmas=SIGMAS, percent=outside))
    if correlations:
        pairs = [PAIR(first=row.first, second=row.second, value=Quantity(float(row.value), digits=6))
                 for row in correlations]
        yield Caveat(Kind.DISTRIBUTION, CORRELATED(pairs=chained(*pairs, joint=", ")))
