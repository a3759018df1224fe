"""results.json: every row that was measured, the run it comes from, and a fingerprint of the code it timed.

Nothing here runs a benchmark or imports one: tests read the file without heyoka or VTK.
"""
from __future__ import annotations

import ast
import hashlib
import json
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
DATA = Path(__file__).with_name("results.json")
FORMAT = "stabilab.benchmarks/1"

# Topic -> its heading, and the code that it measures, in stabilab/: files, and rooms without their wings
TOPICS: dict[str, tuple[str, tuple[str, ...]]] = {
    "fates": ("Outcomes of many states", ("orbit",)),
    "memory": ("Memory", ("orbit",)),
    "orbit_extremes": ("Extremes of many orbits", ("orbit",)),
    "periods": ("Periods of many orbits", ("orbit",)),
    "surfaces": ("Separatrix surfaces", ("orbit/separatrix", "show/surface.py")),
    "trajectories": ("Motions followed in time",
                     ("integrate", "physics", "answers/simulate.py", "unreduced/crossing.py")),
    "closed_forms": ("The charged body", ("theories",)),
    "startup": ("Start-up", (".", "cli", "commands", "case", "answers", "physics")),
    "late_times": ("States at late times", ("orbit",)),
    "explorer": ("The explorer", ("show/explore", "orbit", "orbit/separatrix", "equilibrium")),
    "waits": ("What one waits for", (".", "cli", "commands", "show/report", "numbers/numba_door.py")),
    "sweeps": ("Sweeps", ("maps", "maps/filling", "orbit", "unreduced/spin_up")),
    "spin_up": ("Torques off the axes", ("unreduced/spin_up", "unreduced/enclosure.py",
                                         "unreduced/enclosure_kernel.py")),
    "arrays": ("Loops plain and compiled", ("orbit", "numbers/numba_door.py")),
    "digits": ("Many digits", ("orbit", "numbers", "answers/digits.py", "answers/attitude.py")),
    "maps": ("Atlas, basins, diagrams and other maps",
             ("maps", "maps/filling", "maps/bifurcation", "unreduced", "unreduced/spin_up", "equilibrium")),
    "proofs": ("Certificates and distances", ("verify", "answers/certificate.py", "orbit/separatrix")),
    "scenes": ("Random scenes", ("orbit", "orbit/separatrix", "show/surface.py")),
}


@dataclass(frozen=True)
class Run:
    """One run of the command: when, of which commit, where, and how busy the machine was at its start.

    load: jobs that ran or waited, the mean of a minute, None where unknown; command: what was typed.
    """

    date: str
    commit: str
    machine: str
    load: float | None
    command: str


@dataclass
class Results:
    """Rows by key, each with its `topic`, its `run` and the fingerprint `code`; what failed, by topic."""

    runs: dict[str, dict[str, Any]] = field(default_factory=dict)
    rows: dict[str, dict[str, Any]] = field(default_factory=dict)
    failed: dict[str, list[str]] = field(default_factory=dict)

    def begin(self, run: Run) -> str:
        """The number of a new run."""
        number = str(max(map(int, self.runs), default=0) + 1)
        self.runs[number] = asdict(run)
        return number

    def put(self, topic: str, row: Any, run: str) -> None:
        """A row in place of the one with its key."""
        self.rows[row.key] = {**asdict(row), "topic": topic, "run": run, "code": code_of(topic)}

    def finish(self, topic: str, run: str, seen: set[str], failed: list[str]) -> None:
        """Rows that the topic has no longer go, unless part of it failed; runs without rows go."""
        self.failed.pop(topic, None)
        if failed:
            self.failed[topic] = failed
        else:
            self.rows = {key: row for key, row in self.rows.items() if row["topic"] != topic or key in seen}
        used = {row["run"] for row in self.rows.values()} | {run}
        self.runs = {number: about for number, about in self.runs.items() if number in used}

    def changed(self, key: str) -> bool:
        """Whether the code that the row timed has changed since."""
        row = self.rows[key]
        return row["code"] != code_of(row["topic"])

    def write(self, path: Path = DATA) -> None:
        """The file; a line of it for each number, so that differences can be read."""
        path.write_text(json.dumps({"format": FORMAT, **asdict(self)}, indent=1, ensure_ascii=False) + "\n",
                        encoding="utf-8")


def read(path: Path = DATA) -> Results:
    """What the file has; nothing where there is none."""
    if not path.exists():
        return Results()
    data = json.loads(path.read_text(encoding="utf-8"))
    return Results(data["runs"], data["rows"], data["failed"])


@cache
def code_of(topic: str) -> str:
    """A fingerprint of the code that a topic measures, and of the topic's own."""
    whole = hashlib.sha256()
    for place in TOPICS[topic][1]:
        path = ROOT / "stabilab" / place
        files = sorted(path.glob("*.py")) if path.is_dir() else [path]
        if not files:
            raise FileNotFoundError(f"{path}: has no code, but is what the topic {topic} measures")
        for file in files:
            whole.update(f"{file.relative_to(ROOT).as_posix()}\n{_code(file)}".encode())
    whole.update(_code(Path(__file__).with_name(f"{topic}.py")).encode())
    return whole.hexdigest()[:16]


@cache
def _code(file: Path) -> str:
    """The lines of a file that run: without docstrings, comments and empty lines."""
    text = file.read_text(encoding="utf-8")
    skipped: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        body = getattr(node, "body", None)
        if isinstance(body, list) and body and isinstance(body[0], ast.Expr) \
                and isinstance(body[0].value, ast.Constant) and isinstance(body[0].value.value, str):
            skipped.update(range(body[0].lineno, (body[0].end_lineno or body[0].lineno) + 1))
    return "\n".join(line.rstrip() for number, line in enumerate(text.splitlines(), 1)
                     if number not in skipped and line.strip() and not line.strip().startswith("#"))
