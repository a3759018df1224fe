"""One line on a terminal that says what is being worked on; silent elsewhere."""
from __future__ import annotations

import sys
from contextlib import contextmanager

CLEAR = "\r\x1b[K"


@contextmanager
def told():
    """Context giving tell(words), or None where stderr is no terminal; the line vanishes at the end."""
    if not sys.stderr.isatty():
        yield None
        return

    def tell(words: str):
        sys.stderr.write(f"{CLEAR}{words} ...")
        sys.stderr.flush()
    try:
        yield tell
    finally:
        sys.stderr.write(CLEAR)
        sys.stderr.flush()
