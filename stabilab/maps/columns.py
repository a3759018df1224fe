"""What a sweep may be asked, and the columns that each answer fills."""
from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from ..answers.caveats import CONDITIONS, HOLDS, NO_SUCH_BODY, UNSTABLE_POINT
from ..answers.chaos import Order
from ..errors import InputError, printable
from ..orbit.fate import Basis
from ..orbit.result import Fate

LEVELS = ("undecided", "certified", "exact", "proved")
LIMIT_LEVELS = ("run", "exact", "proved")
ISLANDS = ("none", "may_exist", "seen")
# equilibria without number; not all of them known; numbers that make no case
ENDLESS, OPEN, NONE = -1, -2, -3
NO_CASE = len(Fate)  # in the place of a fate: the numbers make no case (moments that no body has)
RATE, ENERGY, TIME, PACE = "rate", "energy", "time", "pace"  # units that depend on the variables of a case


class Column(NamedTuple):
    """A number for each point. kind: of NumPy; unit: RATE, ENERGY, TIME or "" (a count or a word); words:
    what it is; flags: words of its values, from 0 on; shape: of one point's numbers; note: what values beside
    the plain ones mean."""

    name: str
    kind: str
    unit: str
    words: str
    flags: tuple[str, ...] = ()
    shape: tuple[int, ...] = ()
    note: str = ""


NOT_KNOWN = "NaN where it is not known"
FOLLOWED = "over all time, or over the span of the case where no law holds and the motion is followed"
# what may be asked -> its columns
ANSWERS: dict[str, tuple[Column, ...]] = {
    "fate": (Column("fate", "i1", "", "what becomes of the motion",
                    (*(fate.word for fate in Fate), "no_case")),
             Column("spin_axis", "i1", "", "axis of a spin-up with the direction of spin as its sign",
                    note="0 where there is none, or it lies between equal moments")),
    "level": (Column("level", "i1", "", "how well the fate is known", LEVELS, note="-1: no case"),),
    "reason": (Column("reason", "i1", "", "why the fate is known",
                      tuple(reason.name.lower() for reason in Basis),
                      note="-1 where a motion is answered by itself: stabilab fate tells why"),),
    "island": (Column("island", "i1", "", "whether bounded islands are suspected where the motion is",
                      ISLANDS,
                      note="of undecided motions alone; 0 where a motion is answered by itself"),),
    "margin": (Column("margin", "f8", ENERGY, "height of the barrier ahead less the energy",
                      note=f"-inf without a barrier ahead, +inf where none bounds the motion, {NOT_KNOWN}"),),
    "distance": (Column("distance", "f8", RATE, "smallest change of the rates that reaches the separatrix",
                        note=f"+inf without one, {NOT_KNOWN}"),),
    "extremes": (Column("least", "f8", RATE, "least rate about each principal axis", shape=(3,),
                        note=f"-inf where unbounded, {NOT_KNOWN}; {FOLLOWED}"),
                 Column("greatest", "f8", RATE, "greatest rate about each principal axis", shape=(3,),
                        note=f"+inf where unbounded, {NOT_KNOWN}; {FOLLOWED}")),
    "period": (Column("period", "f8", TIME, "period of the motion",
                      note=f"+inf where it never repeats, {NOT_KNOWN}, 0 at rest"),),
    "when": (Column("when_low", "f8", TIME, "the limit is not reached before", note="+inf: never"),
             Column("when_high", "f8", TIME, "the limit is reached by",
                    note="+inf: never; NaN where that is not known"),
             Column("when_level", "i1", "", "how well the time is known", LIMIT_LEVELS, note="-1: no case")),
    "equilibria": (Column("equilibria", "i4", "", "number of equilibria",
                          note=f"{ENDLESS}: curves of them, {OPEN}: not all of them are known, {NONE}: no "
                               "case"),),
    "verdict": (Column("stable", "i4", "", "stable equilibria, and stable pieces of curves of them",
                       note=f"{NONE}: no case"),
                Column("unstable", "i4", "", "unstable equilibria, and unstable pieces of curves of them",
                       note=f"{NONE}: no case"),
                Column("open", "i4", "", "equilibria and pieces whose stability is undecided",
                       note=f"{NONE}: no case")),
    "chaos": (Column("chaos", "i1", "", "what is seen of the motion up to the time it is followed",
                     tuple(order.word for order in Order), note="-1: no case"),
              Column("megno", "f8", "", "MEGNO: 2 on tori, grows where chaotic",
                     note="mean exponential growth of nearby orbits; NaN where the motion spins up or leaves "
                          "the doubles"),
              Column("lyapunov", "f8", PACE, "rate at which neighbours part",
                     note="0 where regular, NaN where it is not known")),
}
CAVEATS = Column("caveats", "i1", "", "what limits the answer",
                 # those of a point, which its numbers make
                 tuple("; ".join(str(one) for one in parts if one) for parts in product(
                     (None, UNSTABLE_POINT), (None, NO_SUCH_BODY),
                     [one and HOLDS(condition=one) for one in CONDITIONS])))
DEFAULT = ("fate", "level", "margin")
VALID = Column("valid", "i1", "", "whether the numbers make a case", ("no", "yes"))


def asked_answers(asked) -> tuple[str, ...]:
    """The answers asked for, "fate,margin" or names in a row, in the order of ANSWERS. Raises InputError for
    others."""
    names = [word.strip() for word in asked.split(",")] if isinstance(asked, str) else list(asked or DEFAULT)
    for name in names:
        if name not in ANSWERS:
            from difflib import get_close_matches
            near = get_close_matches(str(name).lower()[:40], ANSWERS, n=1)
            raise InputError(f"answer {printable(str(name))[:40]!r}: "
                             f"{f'did you mean {near[0]}? ' if near else ''}expected {', '.join(ANSWERS)}")
    return tuple(name for name in ANSWERS if name in names)


def columns_of(answers: tuple[str, ...]) -> tuple[Column, ...]:
    """The columns of some answers."""
    # what says that a motion stays bounded, or never reaches a limit
    steady = {"fate", "when"} & set(answers)
    return (VALID, *(column for name in answers for column in ANSWERS[name]), *([CAVEATS] if steady else []))


def record(answers: tuple[str, ...]) -> np.dtype:
    """How the columns of one point lie in memory and in part files."""
    return np.dtype([(column.name, f"<{column.kind}" if column.kind != "i1" else "i1", column.shape)
                     for column in columns_of(answers)])
