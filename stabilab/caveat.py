"""What limits an answer: a tilt that it leaves out, a limit that comes first, a law that does not hold, a
tensor that no rigid body has, samples in place of a proof, numbers that are the middles of uncertain ones,
what a burn or a motor takes for granted.

A caveat belongs to the answer: every view of it (text, JSON, CSV, sweep, map, page, explorer) shows its
words.
"""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

KINDS = ("tilt", "limit", "law", "unphysical", "samples", "uncertain", "burn", "motor")


@dataclass(frozen=True)
class Caveat:
    """kind: one of KINDS; words: a sentence on its own, in SI units, without a full stop."""

    kind: str
    words: str


def key(caveats: Iterable[Caveat]) -> dict[str, list[dict[str, str]]]:
    """The key "caveats" of a JSON object: a list, empty where nothing limits the answer."""
    return {"caveats": [{"kind": one.kind, "words": one.words} for one in caveats]}


def cell(caveats: Iterable[Caveat]) -> str:
    """The column "caveats" of a CSV: the words of all, empty where nothing limits the answer."""
    return "; ".join(one.words for one in caveats)
