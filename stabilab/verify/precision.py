"""python-flint's working precision, for one thread at a time.

It belongs to the whole process, which may run the analysis in another thread meanwhile. So whoever needs it holds one lock,
and the lock stands on the library: the one thing that checker and analysis share, and neither has to know the other.
"""
from __future__ import annotations

from contextlib import contextmanager
from threading import RLock


@contextmanager
def working(bits: int):
    """Context in which python-flint works with so many bits, for this thread alone."""
    import flint
    with vars(flint).setdefault("stabilab_lock", RLock()), flint.ctx.workprec(bits):
        yield
