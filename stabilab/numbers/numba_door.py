"""Loops of floats as they are written or compiled by numba: whichever the work of this process repays.

Compiled code has to be loaded, and compiled before where nothing of it is on disk: both cost seconds that a
row or a step in plain Python does not. Nobody knows what a process will be asked for next, so it is the
question whether to rent or to buy: a `Kernel` counts the work that plain Python has done, and loads what is
compiled when this and what is to come now would cost as much as loading, or compiling, costs. Whatever comes
afterwards, a process takes at most twice the time of the better choice, and no call more than what was spent
before and is asked now. All kernels of a process rent together for numba itself (`Account`), each for its
own code. Loading has two parts, and the first comes when its own price is reached, before half of the whole:
never do both fall between some number of calls and twice as many. Work is counted in rows and steps, by what
each costs beyond compiled code; no clock is read.

Both give the same bytes: neither numba nor the interpreter fuses or rearranges operations, and sines,
exponentials and their like come from the C library for both (`FROM_C`)."""
from __future__ import annotations

import gc
import math
import os
import sys
from collections.abc import Callable, Container, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from threading import RLock
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any
from zlib import crc32

import numpy as np

from ..errors import InputError
from . import error_free

# s of a processor: importing numba, what it does in the first compiled call, and another kernel from disk
IMPORT, BEGIN, LOAD = 0.15, 0.25, 0.02
# NumPy's functions that have digits of their own, beside those of the C library that numba calls
FROM_C: dict[str, Callable[..., float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "arcsin": math.asin, "arccos": math.acos,
    "arctan": math.atan, "arctan2": math.atan2, "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh,
    "arcsinh": math.asinh, "arccosh": math.acosh, "arctanh": math.atanh, "exp": math.exp,
    "expm1": math.expm1, "log": math.log, "log1p": math.log1p, "log2": math.log2}
COMPILING = ("stabilab: compiling loops that this computer runs for the first time, some {seconds:.0f} s; "
             "`stabilab doctor --compile` does so beforehand")
_announced: list[bool] = []  # once is enough, of several kernels


@dataclass(eq=False)
class Account:
    """Of a process: s of plain work that all its kernels have done, and which functions below them (`below`
    of a kernel) it has compiled."""

    spent: float = 0.0
    compiled: set[str] = field(default_factory=set)


PROCESS = Account()


@lru_cache(maxsize=1)
def installed() -> bool:
    """Whether numba is installed; it is not imported."""
    return find_spec("numba") is not None


@dataclass(eq=False)
class Kernel:
    """Straight-line functions of a module, as they are written or compiled.

    entry: the function that others call; inlined, variant: as of `compiled`; instead: what stands for names
    of the module, compiled or not; options: others of `compiled`, and what stands for names in compiled code
    alone; seconds: what compiling the module costs once per computer; below: a function of the modules below
    it that all kernels above these call, and what compiling these costs beside. spent: s of plain work since
    the process began, beyond what compiled code would have taken.
    """

    module: ModuleType
    entry: str
    seconds: float
    inlined: Container[str] = ()
    variant: str = ""
    instead: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    below: tuple[str, float] = ("", 0.0)
    spent: float = 0.0
    account: Account = field(default_factory=lambda: PROCESS)
    ready: bool = False  # compiled code is loaded, or compiled at its first call
    _lock: Any = field(default_factory=RLock, repr=False)
    _functions: dict[str, Any] = field(default_factory=dict, repr=False)
    _plain: dict[str, Any] = field(default_factory=dict, repr=False)
    _stored: bool = False  # on disk when it was looked for
    _below_stored: bool = False

    def pays(self, work: float, fast: bool | None = None) -> bool:
        """Whether compiled code serves for work that would take so many seconds more in plain Python; else
        this is counted as done. fast: True or False where the user has chosen.

        Raises InputError for fast=True without numba.
        """
        if fast is None and self.ready:
            return True
        if fast is not None or not installed():
            if fast and not installed():
                raise InputError(
                    "fast=True needs numba, which is not installed: pip install numba, or leave fast out")
            return bool(fast)
        with self._lock:
            if not self.ready and work >= self.left():
                self._step()
                while not self.ready and work >= self.left():
                    self._step()
            if not self.ready:
                self.spent += work
                self.account.spent += work
            return self.ready

    def left(self) -> float:
        """s of plain work after which `pays` says yes, or looks whether compiled code is on disk."""
        if self.ready or not installed():
            return 0.0 if self.ready else math.inf
        if self._functions and not self._stored:
            return max(0.0, self._compiling() - self.spent)
        if _begun() or (not self._functions and "numba" in sys.modules):
            return max(0.0, LOAD - self.spent)
        return max(0.0, IMPORT + BEGIN * bool(self._functions) - max(self.spent, self.account.spent))

    def functions(self, fast: bool) -> dict[str, Any]:
        """The module's names: compiled, or as they are written."""
        if fast and self.ready:
            return self._functions
        with self._lock:
            if fast:
                while not self.ready:
                    self._step()
                return self._functions
            if not self._plain:
                self._plain = twins(self.module, lambda name, twin: twin, np=by_the_c_library(),
                                    **self.instead)
            return self._plain

    def _compiling(self) -> float:
        """s that compiling takes, of what is neither on disk nor compiled by this process."""
        name, seconds = self.below
        return self.seconds + (0.0 if self._below_stored or name in self.account.compiled else seconds)

    def on_disk(self) -> bool:
        """Whether compiled code of it is on disk now; numba is imported."""
        return stored(self.functions(True)[self.entry])

    def folder(self) -> str:
        """Where numba puts compiled code; empty where it has no folder to write to."""
        return getattr(self.functions(True)[self.entry].stats, "cache_path", None) or ""

    def _step(self) -> None:
        """Import numba and see whether this code is on disk; after that begin with it, or say on stderr that
        compiling takes its time."""
        if not self._functions:
            with _nothing_collected():
                self._functions = compiled(self.module, self.inlined, self.variant, **self.options,
                                            **self.instead)
            self._stored = stored(self._functions[self.entry])
            self._below_stored = bool(self.below[0]) and stored(self._functions[self.below[0]])
            return
        if not self._stored:
            if not (_announced or sys.stderr is None or os.environ.get("STABILAB_QUIET")):
                _announced.append(True)
                print(COMPILING.format(seconds=self._compiling()), file=sys.stderr, flush=True)
            self.account.compiled.add(self.below[0])
        self.ready = True


@contextmanager
def _nothing_collected() -> Iterator[None]:
    """Garbage is not looked for meanwhile: among modules that come there is none, and to look takes a quarter
    of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _begun() -> bool:
    """Whether numba has done what it does in the first compiled call: it imports this module there."""
    return "numba.np.arraymath" in sys.modules


def stored(function: Any) -> bool:
    """Whether numba has compiled code of a function of its own on disk, for this computer and as the source
    stands; False where this version of numba does not say so."""
    cache: Any = getattr(function, "_cache", None)
    try:
        computer = cache._index_key(None, function.targetctx.codegen())[1:]
        return any(key[1:] == computer for key in cache._cache_file._load_index())
    except (AttributeError, TypeError, OSError):
        return False


@lru_cache(maxsize=1)
def by_the_c_library() -> SimpleNamespace:
    """NumPy with the functions of one number that are the C library's, as compiled code has them."""
    return SimpleNamespace(**vars(np) | {name: _from_c(function, getattr(np, name))
                                         for name, function in FROM_C.items()})


def _from_c(function: Callable[..., float], as_numpy: Callable[..., Any]) -> Callable[..., Any]:
    def value(*numbers: float) -> Any:
        try:
            return np.float64(function(*numbers))
        except (ValueError, OverflowError):  # NaN or infinite, which `math` refuses
            return as_numpy(*numbers)
    return value


def compiled(module: ModuleType, inlined: Container[str] = (), variant: str = "", allocating: bool = True,
             entries: Container[str] | None = None, **instead: Any) -> dict[str, Any]:
    """The names of a module of straight-line kernels with all its functions compiled, those named and sums of
    twofold numbers inlined; kept on disk where there is a place for it.

    instead: what stands for names of the module, for compiled code; variant: names the code that has these,
    which the disk keeps apart; allocating: whether a function makes arrays. Where none does, nothing counts
    the references to those that they take: in a short function that costs more than what it does; entries:
    the functions that Python calls (None: any), the others compile in three quarters of the time."""
    return _kept(lambda cache: _compiled(module, inlined, cache, variant, allocating, entries, instead))


def twins(module: ModuleType, make: Callable[[str, FunctionType], Any],
          variant: Callable[[ModuleType], str] = lambda module: "", **instead: Any) -> dict[str, Any]:
    """The names of a module and of those below it (`_below`) with `make` of a twin of each of their
    functions, which sees these names; instead: as of `compiled`; variant: what is added to the names of a
    module's functions."""
    modules, names = (*_below(module), module), dict[str, Any]()
    for each in modules:
        names |= vars(each)
    names |= instead
    files = {each.__name__: variant(each) for each in modules}
    for name, function in list(names.items()):
        if isinstance(function, FunctionType) and function.__module__ in files:
            twin = FunctionType(function.__code__, names, name)
            twin.__qualname__ += files[function.__module__]
            names[name] = make(name, twin)
    return names


def _below(module: ModuleType) -> tuple[ModuleType, ...]:
    """The modules whose functions a module's call: sums of twofold numbers, and what its `BELOW` names."""
    return error_free, *getattr(module, "BELOW", ())


def _kept(make: Callable[[bool], Any]) -> Any:
    """make(True), or make(False) where numba finds no folder that it may write to: then each process compiles
    anew."""
    try:
        return make(True)
    except RuntimeError:
        return make(False)


def _compiled(module: ModuleType, inlined: Container[str], cache: bool, variant: str,
              allocating: bool, entries: Container[str] | None, instead: dict[str, Any]) -> dict[str, Any]:
    from numba import njit

    def named(module: ModuleType) -> str:
        """numba's cache on disk watches the file of a function alone, not what is inlined from another. So
        names hold what is below their own module, whichever kernel they are compiled for: what several call
        is compiled once."""
        stamp = crc32(b"".join(Path(str(each.__file__)).read_bytes() for each in _below(module)))
        return f"{variant}_{stamp:x}_"

    def make(name: str, twin: FunctionType) -> Any:
        inline = name in inlined or hasattr(error_free, name)
        options: dict[str, Any] = {  # of which numba's types know nothing
            "_nrt": allocating, "no_cfunc_wrapper": True,
            "no_cpython_wrapper": entries is not None and name not in entries}
        return njit(cache=cache, error_model="numpy", forceinline=inline, **options)(twin)
    return twins(module, make, named, **instead)
