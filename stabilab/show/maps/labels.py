"""What the dimensions and columns of a sweep are called, and their units."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from ...answers.caveats import HOLDS, UNPHYSICAL, stated, unseen
from ...caveat import Caveat
from ...maps.columns import ENERGY, PACE, RATE, TIME, Column
from ...maps.plan import Plan

SAMPLE = "sample"
LETTERS = {"angular_velocity": "ω", "mu": "μ"}  # of keys that have one


def names(keys: Sequence[str]) -> list[str]:
    """A short name for each key, in letters, digits and underscores: its last word, or as many of its words as tell it from the others."""
    parts = [re.split(r"\.", key) for key in keys]
    for words in range(1, max(map(len, parts), default=0) + 1):
        found = [_plain("_".join(part[-words:])) for part in parts]
        if len(set(found)) == len(found) and not set(found) & {SAMPLE, "axis"}:
            return found
    return [_plain(f"{key}_{n}") for n, key in enumerate(keys, 1)]


def said(keys: Sequence[str]) -> list[str]:
    """The keys as people read them beside each other: torque[3], ω[1]; as few of their last words as tell each from the others."""
    parts = [[LETTERS.get(stem, stem) + index for stem, index in (re.match(r"([^\[]*)(.*)", word, re.S).groups() for word in key.split("."))] for key in keys]
    for words in range(1, max(map(len, parts), default=0) + 1):
        found = [".".join(part[-words:]) for part in parts]
        if len(set(found)) == len(found):
            return found
    return list(keys)


def drawn(name: str) -> str:
    """The same on an axis of a picture: a letter with its index set as in formulas, ω[1] as ω with 1 below it; other keys as they are."""
    return re.sub(r"^([ωμx])\[([123])\]$", r"$\1_\2$", name)


def _plain(text: str) -> str:
    plain = re.sub(r"[^0-9A-Za-z]+", "_", text).strip("_") or "key"
    return plain if plain[0].isalpha() else f"key_{plain}"


def dimensions(plan: Plan) -> list[str]:
    """The names of the dimensions, in the user's order."""
    return names([axis.key.name for axis in plan.axes]) + ([SAMPLE] if plan.sampled else [])


def unit(plan: Plan, column: Column) -> str:
    """The unit of a column; "1" where it has none."""
    return {RATE: "rad/s", ENERGY: "J", TIME: "s", PACE: "1/s"}.get(column.unit, "1") if plan.case.variables == "physical" else "1"


def meanings(column: Column) -> str:
    """The flags as NetCDF lists them, a word each."""
    return " ".join(flag.replace(" ", "_") or "none" for flag in column.flags)


def limiting(case: Any, records: Any) -> list[Caveat]:
    """What limits the answers of a map: what the file says itself, on what its points rest, a limit that was not looked at."""
    found, numbers = [*case.caveats, *unseen(case)], records["caveats"].ravel().tolist() if "caveats" in records.dtype.names else []
    told = Counter(number % len(HOLDS) for number in numbers)
    parts = [("tilt", HOLDS[n], count) for n, count in sorted(told.items()) if n]
    if all(one.kind != "unphysical" for one in found):
        parts += [("unphysical", UNPHYSICAL, sum(number >= len(HOLDS) for number in numbers))]
    found += [Caveat(kind, words if count == len(numbers) else f"{words} ({count:,} of {len(numbers):,} points)") for kind, words, count in parts if count]
    if case.limits is not None and "when_low" not in records.dtype.names:
        found.append(Caveat("limit", f"the limit of the file, {stated(case.limits)}, is not looked at here"))
    return found
