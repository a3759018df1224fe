"""The same chunks on the workers of a Dask scheduler that is there already: numbers go out, records come back, this process writes the parts.

The workers need no common disk. One that dies costs the chunks it was at, which others do again; who computes a chunk does not change its bytes.
"""
from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import InputError, StabilabError, printable
from ..packages import demand
from ..version import __version__
from . import parts
from .chunk import answered
from .plan import Plan, from_json

ADDRESS = re.compile(r"\w+://[^\s/]+:\d+")
PATIENCE = 10  # seconds in which a scheduler answers, and its first worker shows up
AHEAD = 3  # chunks that wait at each thread of a worker: none is idle, and no more records lie about than that


def by_cluster(plan: Plan, folder: Path, left: list[int], address: str) -> Iterator[int]:
    """The chunks `left`, computed by the workers of the scheduler at `address`, each as soon as its part is there. Raises InputError where no scheduler
    answers, where it has no worker, and where one lacks this version of stabilab."""
    demand("distributed")
    from distributed import as_completed
    client = _client(address)
    try:
        threads = _checked(client, address)
        text, waiting = plan.as_json(), iter(left)
        asked = {}

        def ask() -> Any:
            number = next(waiting, None)
            if number is None:
                return None
            future = client.submit(computed, text, number, pure=False)
            asked[future.key] = number
            return future
        first = [ask() for _ in range(max(2, AHEAD * threads))]
        running = as_completed([future for future in first if future is not None], loop=client.loop)
        for future in running:
            number = asked.pop(future.key)
            parts.write(plan, folder, number, _records(future, address))
            if (more := ask()) is not None:
                running.add(more)
            yield number
    finally:
        client.close(timeout=PATIENCE)


def computed(text: str, number: int) -> tuple[str, bytes | str]:
    """What a worker does: ("records", bytes) of a chunk of the plan, or ("fault", words) of what the case has wrong."""
    try:
        return "records", answered(from_json(text), number).tobytes()
    except StabilabError as error:
        return "fault", str(error)


def _client(address: str) -> Any:
    import logging

    from distributed import Client
    if not ADDRESS.fullmatch(address):
        raise InputError(f"scheduler: expected an address such as tcp://127.0.0.1:8786, got {printable(address)[:80]}")
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # of a scheduler that is gone it would print a page
    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError, ImportError) as error:
        raise InputError(f"scheduler {printable(address)[:80]}: does not answer ({_first_line(error)}): start one with `dask scheduler` and give the "
                         "address that it prints, such as tcp://127.0.0.1:8786") from None


def _checked(client: Any, address: str) -> int:
    """How many threads the workers have, once every worker is known to have this version."""
    from importlib.metadata import version
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        raise InputError(f"scheduler {printable(address)[:80]}: has no workers: start some with `dask worker {printable(address)[:60]}`") from None
    found = client.run(version, "stabilab", on_error="return")
    for worker, answer in found.items():
        if answer != __version__:
            has = f"has stabilab {answer}" if isinstance(answer, str) else f"lacks the package stabilab ({_first_line(answer)})"
            raise InputError(f"worker {worker}: {has}: install stabilab {__version__} there, as here, with the same libraries")
    return sum(client.nthreads().values())


def _records(future: Any, address: str) -> bytes:
    """The bytes of a chunk that is done."""
    try:
        kind, what = future.result()
    except Exception as error:  # of any kind that a worker's environment may raise
        name = type(error).__name__
        if name == "KilledWorker":
            why = "one chunk after another lost its worker: they may have run out of memory"
        elif isinstance(error, ImportError):
            why = f"a worker lacks a package: {_first_line(error)}"
        else:
            why = f"{name}: {_first_line(error)}"
        raise InputError(f"scheduler {printable(address)[:80]}: {why}; finished chunks are kept where --out names a file, and the same command goes on "
                         "from them") from None
    if kind == "fault":
        raise InputError(what)
    return what


def _first_line(error: BaseException) -> str:
    lines = str(error).strip().splitlines()
    return printable(lines[0])[:160] if lines else type(error).__name__
