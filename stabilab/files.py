"""Files and folders that appear whole or not at all, whatever ends the program while it writes them."""
from __future__ import annotations

import os
import shutil
from contextlib import contextmanager
from functools import partial
from glob import escape
from itertools import count
from pathlib import Path

from .errors import InputError
from .interrupt import undoing

try:
    import fcntl
except ImportError:  # no such locks on this system: what a killed run leaves stays there
    fcntl = None

_numbers = count(1)


@contextmanager
def whole_file(path):
    """A temporary name beside `path` that becomes `path` when the block ends well, and vanishes when it does
    not.

    Two runs may write one path at once: the last one to end gives the file. What a killed run left is
    removed. Raises InputError where the disk is full, the folder cannot be written, or `path` is a folder.
    """
    path = Path(path)
    with _explained(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        short = path.name[:60]  # of a name as long as names may be
        _remove_abandoned(path.parent, f".{escape(short)}.*.part")
        waiting = path.with_name(f".{short}.{os.getpid()}-{next(_numbers)}.part")
        waiting.touch()
        with undoing(waiting.unlink), _locked(waiting):
            try:
                yield waiting
                waiting.replace(path)
            finally:
                waiting.unlink(missing_ok=True)


def write_text(path, text: str) -> Path:
    """Write a text as a file, whole or not at all; its path. Raises InputError as `whole_file` does."""
    with whole_file(path) as waiting:
        waiting.write_text(text, encoding="utf-8", newline="")
    return Path(path)


@contextmanager
def new_folder(out):
    """A temporary folder inside `out` (on the same disk, even where `out` is a mount of its own) that
    vanishes at the end, however it comes, and `out` with it where it was made for it and nothing came into
    it. Raises InputError as `whole_file` does."""
    out = Path(out)
    fresh = not out.exists()
    with _explained(out):
        out.mkdir(parents=True, exist_ok=True)
        _remove_abandoned(out, ".new-*")
        folder = out / f".new-{os.getpid()}-{next(_numbers)}"
        remove = partial(_remove, folder, out if fresh else None)
        with undoing(remove):
            try:
                folder.mkdir()
                with _locked(folder):
                    yield folder
            finally:
                remove()


@contextmanager
def alone_in(folder, wait=True):
    """While the block runs, no other run that asks for it puts its files into the folder. BlockingIOError
    where one does, unless it is waited for."""
    with _locked(Path(folder), wait=wait):
        yield


def put_in_place(folder, out):
    """Rename every file of `folder` to its place under `out`: pages after what they show, the first page
    (index.html) last."""
    out = Path(out)
    for file in sorted(inside(folder), key=lambda f: (f.suffix == ".html", f.name == "index.html", f)):
        target = out / file.relative_to(folder)
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(file, target)


def inside(folder) -> list[Path]:
    """The files of a folder and of the folders in it, in the order of their names."""
    return sorted(f for f in Path(folder).rglob("*") if f.is_file())


@contextmanager
def _explained(path):
    try:
        yield
    except OSError as error:
        location = Path(os.fsdecode(error.filename or path))
        if location not in (path, *path.parents) and path.parent not in location.parents:
            raise  # something else than writing
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error


def _remove(folder, parent):
    shutil.rmtree(folder, ignore_errors=True)
    if parent:
        try:
            parent.rmdir()  # does nothing to a folder that holds something
        except OSError:
            pass


def _remove_abandoned(folder, pattern):
    """Remove what runs left that were killed: nobody holds its lock."""
    for left in folder.glob(pattern) if fcntl else ():
        try:
            with _locked(left):
                shutil.rmtree(left) if left.is_dir() else left.unlink()
        except OSError:  # it is being written, or another run removed it
            pass


@contextmanager
def _locked(path, wait=False):
    """Hold the lock of a file or folder: the system lets go of it with the process. OSError where another
    process has it."""
    if fcntl is None:
        yield
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        yield
    finally:
        os.close(handle)
