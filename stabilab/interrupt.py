"""Ctrl-C: the program ends at once with 130, whatever it was doing, and takes its unfinished files with it.

A KeyboardInterrupt is no way to do that: a library in the middle of an import or a callback may swallow it,
turn it into an error of its own, or never see it while compiled code runs. So the signal itself ends the
process.
"""
from __future__ import annotations

import os
import signal
from contextlib import contextmanager
from typing import Any

from .errors import INTERRUPTED

# s that the main thread has to answer the signal itself; compiled code may keep it busy for hours
GRACE_SECONDS = 0.3
_undo: list[Any] = []   # what to undo on the way out, last first


def arm():
    """From now on an interrupt ends the process. A program that was started with the signal ignored goes on
    ignoring it."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        return
    signal.signal(signal.SIGINT, _end)
    if os.name == "posix":
        _watch()


def disarm():
    """The answer is given: what is left is the interpreter's own end, which an interrupt shall not spoil."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def undoing(action):
    """While the block runs, an interrupt calls action() before the process ends."""
    _undo.append(action)
    try:
        yield
    finally:
        _undo.remove(action)


def end_with_parent(hear=lambda line: None):
    """From now on the process ends when its standard input does: a child whose parent was ended, by whatever,
    shall not go on. hear(line) is given what comes before."""
    import _thread

    def listen():
        with open(0, "rb", closefd=False) as lines:
            for line in lines:
                hear(line)
        _end()
    _thread.start_new_thread(listen, ())


def _end(*_):
    for action in reversed(_undo):
        try:
            action()
        except Exception:  # nothing may keep the process from ending
            pass
    os._exit(INTERRUPTED)


def _watch():
    """A second pair of eyes: a thread that ends the process where the main thread is deaf inside compiled
    code."""
    import _thread
    import time
    heard, mouth = os.pipe()
    os.set_blocking(mouth, False)
    signal.set_wakeup_fd(mouth, warn_on_full_buffer=False)

    def listen():
        while os.read(heard, 1)[0] != signal.SIGINT:
            pass
        time.sleep(GRACE_SECONDS)
        _end()
    _thread.start_new_thread(listen, ())
