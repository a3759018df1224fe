"""All comparisons. A topic is a module with `measurements(small=False)`, a list of calls of which each
gives a row or several; small ones only show that they run."""
from __future__ import annotations

import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

from .record import Results, Run
from .rows import Row

ROOT = Path(__file__).parents[1]


def calls_of(topic: str, small: bool = False) -> list[Callable[[], Row | list[Row]]]:
    """The measurements of a topic, none of them made."""
    return import_module(f"benchmarks.{topic}").measurements(small)


def topic_rows(topic: str, small: bool = False) -> Iterator[Row]:
    """All rows of a topic."""
    for call in calls_of(topic, small):
        made = call()
        yield from [made] if isinstance(made, Row) else made


def measure(results: Results, topics: list[str], run: Run, small: bool, path: Path) -> None:
    """Measure topics into results, which are written after each; what fails is noted and its older rows stay,
    as do those that Ctrl-C forestalls."""
    number = results.begin(run)
    for topic in topics:
        began, seen = time.perf_counter(), set()
        failed: list[str] = []
        print(f"{topic}: ", end="", file=sys.stderr, flush=True)
        try:
            calls = calls_of(topic, small)
        except Exception as error:
            calls = []
            failed.append(_said(topic, error))
        for call in calls:
            try:
                made = call()
            except KeyboardInterrupt:
                results.finish(topic, number, seen, [f"{topic}: ended by Ctrl-C"])
                results.write(path)
                raise
            except Exception as error:
                failed.append(_said(topic, error))
                continue
            for row in [made] if isinstance(made, Row) else made:
                results.put(topic, row, number)
                seen.add(row.key)
                print(".", end="", file=sys.stderr, flush=True)
        results.finish(topic, number, seen, failed)
        results.write(path)
        print(f" {len(seen)} rows, {time.perf_counter() - began:.0f} s", file=sys.stderr, flush=True)


def _said(topic: str, error: Exception) -> str:
    """What failed, for the page; all of it on stderr."""
    traceback.print_exc()
    return f"{topic}: {type(error).__name__}: {' '.join(str(error).split())[:200]}"


def machine() -> str:
    """Machine and versions in one line."""
    import os
    import platform
    from importlib.metadata import PackageNotFoundError, version
    found = []
    for package in ("numpy", "scipy", "numba", "heyoka", "vtk"):
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            found.append(f"no {package}")
    return (f"{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}, "
            f"{', '.join(found)}")


def commit() -> str:
    """The commit that is measured, with a plus where files of it were changed; `unknown` without git."""
    try:
        name = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=ROOT, check=True,
                              capture_output=True, text=True).stdout.strip()
        changed = subprocess.run(["git", "status", "--porcelain", "stabilab"], cwd=ROOT, check=True,
                                 capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return name + "+" * bool(changed)
