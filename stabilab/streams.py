"""The standard streams, which may be closed, full or without a reader: what is lost there, and how that is
reported; and a sign on stderr of a long silence."""
from __future__ import annotations

import _thread
import errno
import os
import sys
import time
from contextlib import contextmanager

from .errors import BAD_INPUT, StabilabError

PIPE_CLOSED = 141  # what a shell reports for a program that a closed pipe ended
# s after which a program that has not written anything says so; not where STABILAB_QUIET is set
SILENCE, WORKING = 1.0, "stabilab: working ..."
LOST = (errno.EPIPE, errno.ENOSPC, errno.EDQUOT, errno.EBADF, errno.EIO, errno.EFBIG)


class OutputLost(StabilabError):
    """The answer could not be written to stdout; silent, with PIPE_CLOSED, where its reader went away."""

    def __init__(self, number: int | None = None):
        gone = number == errno.EPIPE
        why = os.strerror(number) if number else "it is closed"
        super().__init__("" if gone else "stdout: cannot be written: " + why)
        self.exit_code = PIPE_CLOSED if gone else BAD_INPUT


def occupy():
    """Put /dev/null where the caller closed a standard stream: else the next file that is opened gets its
    number, and what a library prints there goes into that file."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free, which is this one
            os.set_inheritable(number, True)


@contextmanager
def guarded(silence: float | None = None):
    """While the block runs, a write to stdout that fails raises OutputLost, and one to stderr is passed over:
    nobody could read of it. silence: seconds after which stderr says that the program works, where neither
    has been written to."""
    before, sign = (sys.stdout, sys.stderr), Sign(sys.stderr)
    sys.stdout, sys.stderr = _Guarded(sys.stdout, _lose,
                                      sign.end), _Guarded(sys.stderr, lambda number: None, sign.end)
    if silence is not None:
        _thread.start_new_thread(sign.wait, (silence,))
    try:
        yield
    finally:
        sign.end()
        sys.stdout, sys.stderr = before


class Sign:
    """A line that the program works, after a silence: on a terminal until something else is written,
    elsewhere once."""

    def __init__(self, stream):
        self._stream, self._silent, self._waiting, self._shown = stream, _thread.allocate_lock(), True, False
        self._silent.acquire()

    def wait(self, seconds: float) -> None:
        """Write the line, unless the silence ends within so many seconds."""
        if self._stream is not None and not self._silent.acquire(timeout=seconds):
            self._shown = self._stream.isatty()
            self._write(WORKING + ("" if self._shown else "\n"))

    def end(self) -> None:
        """Something is about to be written."""
        if self._waiting:
            self._waiting = False
            self._silent.release()
        if self._shown:
            self._shown = False
            self._write("\r\x1b[K")

    def _write(self, text):
        try:
            self._stream.write(text)
            self._stream.flush()
        except (OSError, ValueError):  # nobody reads it
            pass


class Progress:
    """A line on stderr that tells how far a long answer is, once a second has passed; nothing where nobody
    watches a terminal. As a context it wipes its line in the end."""

    def __init__(self, after: float = 1.0, every: float = 0.2):
        self.wanted = bool(sys.stderr and sys.stderr.isatty())
        self._next, self._every, self._shown = time.monotonic() + after, every, 0

    def __call__(self, text: str):
        now = time.monotonic()
        if self.wanted and now >= self._next:
            self._next = now + self._every
            self._write(text)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._shown:
            self._write("")

    def _write(self, text):
        sys.stderr.write("\r" + text.ljust(self._shown) + ("" if text else "\r"))
        sys.stderr.flush()
        self._shown = len(text)


def _lose(number):
    raise OutputLost(number) from None


class _Guarded:
    """A text stream (None: a closed one) that hands its loss to lost(errno or None), and again whenever it is
    written to; before(): first of all then."""

    def __init__(self, stream, lost, before):
        self._stream, self._lost, self._before = stream, lost, before
        self._gone, self._number = stream is None, None

    def write(self, text):
        self._before()
        self._tried(lambda: self._stream.write(text))
        return len(text)

    def flush(self):
        self._tried(lambda: self._stream.flush())

    def isatty(self):
        return self._stream is not None and self._stream.isatty()

    def _tried(self, action):
        if not self._gone:
            try:
                return action()
            except OSError as error:
                self._gone, self._number = True, error.errno
                _silence(self._stream)
        self._lost(self._number)

    def __getattr__(self, name):
        if name.startswith("_") or name == "buffer":  # what is written underneath would pass the guard
            raise AttributeError(name)
        return getattr(self._stream, name)


def _silence(stream):
    """What is still in the buffer goes nowhere when the interpreter ends, instead of failing once more."""
    try:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, stream.fileno())
        os.close(null)
    except (OSError, ValueError):  # no file is behind it
        pass
