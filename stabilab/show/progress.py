"""One line on a terminal that says what is being worked on; silent elsewhere."""
from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ..streams import Progress

CLEAR = "\r\x1b[K"


@contextmanager
def told():
    """Context giving tell(words), or None where stderr is no terminal; the line vanishes at the end."""
    if not sys.stderr.isatty():
        yield None
        return

    def tell(text: str):
        sys.stderr.write(f"{CLEAR}{text} ...")
        sys.stderr.flush()
    try:
        yield tell
    finally:
        sys.stderr.write(CLEAR)
        sys.stderr.flush()


def each(items: Iterable[Any], name: Callable[[Any], str]) -> Iterator[Any]:
    """The items one by one; where they take longer than a second, a terminal is told which of how many it is,
    and about how long the rest takes."""
    rows = list(items)
    with counted() as tell:
        for done, item in enumerate(rows):
            if len(rows) > 1:
                tell(done, len(rows), name(item))
            yield item


@contextmanager
def counted() -> Iterator[Callable[[int, int, str], None]]:
    """Context giving tell(done, count, words), silent where no terminal is."""
    begin = time.monotonic()
    with Progress() as progress:
        def tell(done: int, count: int, text: str) -> None:
            if progress.wanted:  # if the others take as long as those that are done
                rest = (time.monotonic() - begin) / done * (count - done) if done else 0.0
                left = f", about {rest:.0f} s left" if done else ""
                progress(f"{done + 1} of {count}{left}: {text}")
        yield tell
