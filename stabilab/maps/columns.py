"""What a sweep may be asked, and the columns that each answer fills: one row a column, with its unit and how
it is read off what was found, of one state and of many."""
from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..answers.caveats import CONDITIONS, HOLDS, NO_SUCH_BODY, UNSTABLE_POINT
from ..errors import InputError, printable
from ..orbit.fate import Basis
from ..orbit.result import Fate, Order
from ..reasons import Sentence

if TYPE_CHECKING:
    from ..answers.passage import TimeTo

LEVELS = ("undecided", "certified", "exact", "proved")
LIMIT_LEVELS = ("run", "exact", "proved")
ISLANDS = ("none", "may_exist", "seen")
# equilibria without number; not all of them known; numbers that make no case
ENDLESS, OPEN, NONE = -1, -2, -3
NO_CASE = len(Fate)  # in the place of a fate: the numbers make no case (moments that no body has)
RATE, ENERGY, TIME, PACE = "rate", "energy", "time", "pace"  # units that depend on the variables of a case


class Column(NamedTuple):
    """A number for each point. kind: of NumPy; unit: RATE, ENERGY, TIME or "" (a count or a word);
    description: what it is; many, one: it, off what the module of its answer found of all states of a scene
    (n,), and of one state where these are answered one by one; flags: words of its values, from 0 on; shape:
    of one point's numbers; note: what values beside the plain ones mean; no_case: of a count or a word, what
    stands where the numbers make no case."""

    name: str
    kind: str
    unit: str
    description: str
    many: Callable[[Any], Any]
    one: Callable[[Any], Any]
    flags: tuple[str, ...] = ()
    shape: tuple[int, ...] = ()
    note: str = ""
    no_case: int = 0

    @property
    def default(self) -> float:
        """What stands where the numbers make no case: NaN of a number that is measured."""
        return np.nan if self.kind == "f8" else self.no_case


class Answer(NamedTuple):
    """module: in `maps.filling`, loaded where it is asked; cost: seconds for a state of a scene with an
    orbit, and for one whose motions are followed, measured, to size chunks alone."""

    module: str
    cost: tuple[float, float]
    columns: tuple[Column, ...]


NOT_KNOWN = "NaN where it is not known"
COUNTS = Sentence(
    "column-counts", "{curves}: curves of them, {open}: not all of them are known, {none}: no case")
FOLLOWED = "over all time, or over the span of the case where no law holds and the motion is followed"
# of motions that have none
PERIODS = {Fate.EQUILIBRIUM: 0.0, Fate.SPIN_UP: np.inf, Fate.SEPARATRIX: np.inf}


def _ends(which: int) -> Callable[[Any], Any]:
    """The least (0) or greatest (1) of each rate of a motion."""
    return lambda motion: motion.extremes and [pair[which] for pair in motion.extremes]


def _limit_level(result: TimeTo) -> list[int]:
    """How well each time to a limit is known."""
    return [LIMIT_LEVELS.index(word) if word in LIMIT_LEVELS else 0 for word in np.ravel(result.level)]


def _counted(name: str) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """A count of equilibria, which are those of all states of a scene."""
    return (lambda result: result[name],) * 2


# what may be asked
ANSWERS: dict[str, Answer] = {
    "fate": Answer("motions", (1e-6, 1e-3), (
        Column("fate", "i1", "", "what becomes of the motion",
               lambda rows: rows.fates.labels, lambda motion: motion.fate,
               (*(fate.word for fate in Fate), "no_case"), no_case=NO_CASE),
        Column("spin_axis", "i1", "", "axis of a spin-up with the direction of spin as its sign",
               lambda rows: rows.fates.axis * rows.fates.sense, lambda motion: motion.axis * motion.sense,
               note="0 where there is none, or it lies between equal moments"))),
    "level": Answer("motions", (0, 0), (
        Column("level", "i1", "", "how well the fate is known",
               lambda rows: rows.fates.level_numbers(LEVELS), lambda motion: LEVELS.index(motion.level),
               LEVELS, note="-1: no case", no_case=-1),)),
    "reason": Answer("motions", (0, 0), (
        Column("reason", "i1", "", "why the fate is known",
               lambda rows: rows.fates.reasons, lambda motion: -1,
               tuple(reason.name.lower() for reason in Basis), no_case=-1,
               note="-1 where a motion is answered by itself: stabilab fate tells why"),)),
    "island": Answer("motions", (0, 0), (
        Column("island", "i1", "", "whether bounded islands are suspected where the motion is",
               lambda rows: 0 if rows.fates.followed is None else rows.fates.followed.islands,
               lambda motion: 0, ISLANDS,
               note="of undecided motions alone; 0 where a motion is answered by itself"),)),
    "margin": Answer("motions", (0, 0), (
        Column("margin", "f8", ENERGY, "height of the barrier ahead less the energy",
               lambda rows: rows.fates.margins, lambda motion: motion.margin_energy,
               note="-inf without a barrier ahead, +inf where none bounds the motion, " + NOT_KNOWN),)),
    "distance": Answer("motions", (3e-2, 0), (
        Column("distance", "f8", RATE, "smallest change of the rates that reaches the separatrix",
               lambda rows: rows.fates.velocity_margins, lambda motion: motion.margin_velocity,
               note=f"+inf without one, {NOT_KNOWN}"),)),
    "extremes": Answer("motions", (1e-5, 2e-2), (
        Column("least", "f8", RATE, "least rate about each principal axis",
               lambda rows: rows.extremes[..., 0], _ends(0), shape=(3,),
               note=f"-inf where unbounded, {NOT_KNOWN}; {FOLLOWED}"),
        Column("greatest", "f8", RATE, "greatest rate about each principal axis",
               lambda rows: rows.extremes[..., 1], _ends(1), shape=(3,),
               note=f"+inf where unbounded, {NOT_KNOWN}; {FOLLOWED}"))),
    "period": Answer("motions", (1e-5, 0), (
        Column("period", "f8", TIME, "period of the motion", lambda rows: rows.periods,
               lambda motion: (PERIODS.get(motion.fate, np.nan) if motion.period is None else motion.period),
               note="+inf where it never repeats, " + NOT_KNOWN + ", 0 at rest"),)),
    "when": Answer("limit", (0.1, 0.1), (
        Column("when_low", "f8", TIME, "the limit is not reached before",
               lambda result: result.low, lambda result: result.low, note="+inf: never"),
        Column("when_high", "f8", TIME, "the limit is reached by",
               lambda result: result.high, lambda result: result.high,
               note="+inf: never; NaN where that is not known"),
        Column("when_level", "i1", "", "how well the time is known", _limit_level,
               lambda result: _limit_level(result)[0], LIMIT_LEVELS, note="-1: no case", no_case=-1))),
    "largest": Answer("largest", (1e-3, 5e-2), (
        Column("largest", "f8", RATE, "largest |omega| over all time", lambda result: result.rate,
               lambda result: result.rate, note=f"+inf where it grows without end, {NOT_KNOWN}"),
        Column("size", "f8", RATE, "|omega| at the start", lambda result: result.size,
               lambda result: result.size))),
    "equilibria": Answer("equilibria", (0, 0), (
        Column("equilibria", "i4", "", "number of equilibria", *_counted("equilibria"),
               note=COUNTS(curves=ENDLESS, open=OPEN, none=NONE).text(),
               no_case=NONE),)),
    "verdict": Answer("equilibria", (0, 0), (
        Column("stable", "i4", "", "stable equilibria, and stable pieces of curves of them",
               *_counted("stable"), note=f"{NONE}: no case", no_case=NONE),
        Column("unstable", "i4", "", "unstable equilibria, and unstable pieces of curves of them",
               *_counted("unstable"), note=f"{NONE}: no case", no_case=NONE),
        Column("open", "i4", "", "equilibria and pieces whose stability is undecided",
               *_counted("open"), note=f"{NONE}: no case", no_case=NONE))),
    "chaos": Answer("chaos", (2e-2, 5e-2), (
        Column("chaos", "i1", "", "what is seen of the motion up to the time it is followed",
               lambda result: result.labels, lambda result: result.labels,
               tuple(order.word for order in Order), note="-1: no case", no_case=-1),
        Column("megno", "f8", "", "MEGNO: 2 on tori, grows where chaotic",
               lambda result: result.megno, lambda result: result.megno,
               note="mean exponential growth of nearby orbits; NaN where the motion spins up or leaves the "
                    "doubles"),
        Column("lyapunov", "f8", PACE, "rate at which neighbours part",
               lambda result: result.lyapunov, lambda result: result.lyapunov,
               note="0 where regular, NaN where it is not known"))),
}
# of burns, whose draws are answered whole (`percentiles`); a sweep takes a torque that stays
BURNS: dict[str, Answer] = {
    "burn_when": Answer("burn", (0.02, 0.02), (
        Column("when_low", "f8", TIME, "the limit is not reached before", lambda result: result.when[0],
               lambda result: result.when[0], note="+inf: never"),
        Column("when_high", "f8", TIME, "the limit is reached by", lambda result: result.when[1],
               lambda result: result.when[1], note="+inf: never; NaN where that is not known"))),
    "burn": Answer("burn", (0.05, 0.05), (
        Column("fate", "i1", "", "what becomes of the motion after the last closing",
               lambda result: result.fate, lambda result: result.fate, no_case=NO_CASE),
        Column("largest", "f8", RATE, "largest |omega| over all time", lambda result: result.largest,
               lambda result: result.largest, note=NOT_KNOWN),
        Column("size", "f8", RATE, "|omega| at the start", lambda result: result.size,
               lambda result: result.size))),
    "closing": Answer("burn", (0.3, 0.3), (
        Column("closing_low", "f8", TIME, "closed by then it stays below for ever",
               lambda result: result.closing[0], lambda result: result.closing[0],
               note="+inf: whenever it closes, 0: however early"),
        Column("closing_high", "f8", TIME, "closed later it does not", lambda result: result.closing[1],
               lambda result: result.closing[1], note="NaN where that is not known"))),
}
ALL = ANSWERS | BURNS
# of every sweep, read off the numbers of a point's own case by `parts`
CAVEATS = Column("caveats", "i1", "", "what limits the answer", lambda codes: codes, lambda codes: codes,
                 # those of a point, which its numbers make
                 tuple("; ".join(str(part) for part in parts if part) for parts in product(
                     (None, UNSTABLE_POINT), (None, NO_SUCH_BODY),
                     [condition and HOLDS(condition=condition) for condition in CONDITIONS])))
DEFAULT = ("fate", "level", "margin")
VALID = Column("valid", "i1", "", "whether the numbers make a case", lambda info: info, lambda info: info,
               ("no", "yes"))


def asked_answers(query) -> tuple[str, ...]:
    """The answers asked for, "fate,margin" or names in a row, in the order of ANSWERS. Raises InputError for
    others."""
    names = [word.strip() for word in query.split(",")] if isinstance(query, str) else list(query or DEFAULT)
    for name in names:
        if name not in ANSWERS:
            from difflib import get_close_matches
            close = get_close_matches(str(name).lower()[:40], ANSWERS, n=1)
            raise InputError(f"answer {printable(str(name))[:40]!r}: "
                             f"{f'did you mean {close[0]}? ' if close else ''}expected {', '.join(ANSWERS)}")
    return tuple(name for name in ANSWERS if name in names)


def columns_of(answers: tuple[str, ...]) -> tuple[Column, ...]:
    """The columns of some answers."""
    # what says that a motion stays bounded, or never reaches a limit
    steady = {"fate", "when"} & set(answers)
    return (VALID, *(column for name in answers for column in ALL[name].columns),
            *([CAVEATS] if steady else []))


def record(answers: tuple[str, ...]) -> np.dtype:
    """How the columns of one point lie in memory and in part files."""
    return np.dtype([(column.name, f"<{column.kind}" if column.kind != "i1" else "i1", column.shape)
                     for column in columns_of(answers)])
