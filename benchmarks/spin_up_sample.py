"""The large sample of random scenes: how many are decided, by what work, at both levels; the table of
docs/spin-up.md is made of it.

python -m benchmarks.spin_up_sample run FILE FIRST COUNT SECONDS: appends one row of JSON for each of the
scenes FIRST, FIRST + 1, ... of `spin_up.random_scene` with seed 7 to FILE, until COUNT are done or so many
seconds of processor time are gone. Pieces may be run in any order, or at once into different files.
python -m benchmarks.spin_up_sample write FILE...: puts the table and what is left undecided into
docs/spin-up.md.
"""
from __future__ import annotations

import json
import random
import sys
import time
from collections import Counter
from pathlib import Path

from stabilab.unreduced.enclosure import proved
from stabilab.unreduced.spin_up.follow import spin_up

from .rows import numba_available
from .spin_up import KINDS, WHEELS, random_scene

SEED = 7
# of the scenes this many-th is proved as well: a way that cannot be enclosed costs seconds to find out
EVERY = 4
PAGE = Path(__file__).parents[1] / "docs" / "spin-up.md"
BEGIN, END = "<!-- made by benchmarks.spin_up_sample -->", "<!-- end -->"


def scenes(first: int, count: int):
    """(number, scene, state, kind, wheel) of the sample."""
    rng = random.Random(SEED)
    for number in range(first + count):
        drawn = random_scene(rng)
        if number >= first:
            yield number, *drawn


def row_of(number, scene, state, kind, wheel) -> dict:
    """What is found of one scene, with processor times in ms: of the certificate, and of the proof on top."""
    fast, begun = numba_available(), time.process_time()
    found = spin_up(scene, state, fast=fast)
    certified = time.process_time()
    tried = number % EVERY == 0
    level = (proved(scene, state, found, fast=fast).level if tried and found.level == "certified"
             else found.level)
    end = time.process_time()
    return {"number": number, "kind": kind, "wheel": wheel, "level": level, "axis": found.axis,
            "sense": found.sense, "t": found.t, "steps": found.steps,
            "passed": found.passed, "condition": found.condition, "ms": 1e3 * (certified - begun),
            "proof_ms": 1e3 * (end - certified) if tried else None,
            "cause": found.cause if level == "undecided" else ""}


def run(path, first=0, count=20_000, seconds=1500.0):
    """Append the rows of scenes to a file."""
    begun = time.process_time()
    spin_up(*next(scenes(0, 1))[1:3], fast=numba_available(), proof=True)  # what is compiled is compiled here
    with open(path, "a", encoding="utf-8", buffering=1) as file:
        for drawn in scenes(first, count):
            file.write(json.dumps(row_of(*drawn)) + "\n")
            if time.process_time() - begun > seconds:
                break


def rows_of(paths) -> list[dict]:
    """The rows of files, each scene once, in order."""
    rows = {row["number"]: row for path in paths
            for row in map(json.loads, Path(path).read_text(encoding="utf-8").splitlines())}
    return [rows[number] for number in sorted(rows)]


def groups(rows):
    """(name, rows) by wheel and body."""
    yield from ((f"wheel {w}", [r for r in rows if r["wheel"] == w]) for w in WHEELS)
    yield from ((kind, [r for r in rows if r["kind"] == kind]) for kind in KINDS)
    yield "generic, wheel ≤ 1", [r for r in rows if r["kind"] == "generic" and r["wheel"] <= 1]
    yield "all", rows


def table(rows) -> str:
    """Shares in per cent as Markdown."""
    head = ["", "scenes", "t < 100", "1e3", "5e3", "steps < 1e3", "1e4", "1e5", "certified",
            "asked for proof", "proved"]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for name, group in groups(rows):
        good, asked = [r for r in group
                       if r["level"] != "undecided"], [r for r in group if r["proof_ms"] is not None]
        sure = [r for r in asked if r["level"] in ("proved", "exact")]
        of_all = ([sum(r["t"] < t for r in good) for t in (100, 1e3, 5e3)]
                  + [sum(r["steps"] < k for r in good) for k in (1e3, 1e4, 1e5)] + [len(good)])
        shares = lambda counts, whole: " | ".join(f"{100 * count / max(1, len(whole)):.1f}"
                                                  for count in counts)
        lines.append(f"| {name} | {len(group)} | {shares(of_all, group)} | {len(asked)} | "
                     f"{shares([len(sure)], asked)} |")
    return "\n".join(lines)


def left(rows) -> str:
    """What is undecided, by the first cause seen, as a list."""
    undecided = [r for r in rows if r["level"] == "undecided"]
    first = [(" ".join(r["cause"].split(";")[0].split(",")[0].split(":")[0].split("about axis")[0].split()),
              r["number"]) for r in undecided]
    scenes = lambda cause: ", ".join(str(number) for named, number in first if named == cause)
    kinds = Counter((r["kind"], r["wheel"]) for r in undecided)
    causes = Counter(cause for cause, _ in first).most_common()
    counts = ", ".join(f"{cause} {n}" for cause, n in causes)
    by_kind = ", ".join(f"{kind} {wheel}: {n}" for (kind, wheel), n in kinds.most_common())
    return "\n".join([f"Undecided: {len(undecided)} of {len(rows)}, by the first cause that their words "
                      f"name: {counts}. By body and wheel: {by_kind}.", "",
                      "<details><summary>Their numbers in the sample, counted from 0</summary>", ""]
                     + [f"- {cause}: {scenes(cause)}" for cause, _ in causes]
                     + ["", "</details>"])


def write(*paths):
    """The table into the page."""
    rows, text = rows_of(paths), PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    PAGE.write_text(before + BEGIN + "\n" + table(rows) + "\n\n" + left(rows) + "\n" + END
                    + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["write"]:
        write(*sys.argv[2:])
    else:
        kinds = (str, int, int, float)
        run(*(kind(v) for kind, v in zip(kinds, sys.argv[2:])))
