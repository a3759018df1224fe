"""When numba is to answer: asked for, or so many states that loading it pays."""
from __future__ import annotations

from collections.abc import Callable, Container
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any
from zlib import crc32

from ..errors import InputError
from . import error_free


@lru_cache(maxsize=1)
def installed() -> bool:
    """Whether numba is installed; it is not imported."""
    return find_spec("numba") is not None


def wanted(n: int, fast: bool | None, loaded: bool, cold: int, warm: int) -> bool:
    """fast: True always, False never, None from `cold` states on (from `warm` once the code is loaded) where
    numba is installed.

    Raises InputError for fast=True without numba.
    """
    if fast is None:
        return n >= (warm if loaded else cold) and installed()
    if fast and not installed():
        raise InputError(
            "fast=True needs numba, which is not installed: pip install numba, or leave fast out")
    return bool(fast)


def compiled(module: ModuleType, inlined: Container[str] = (), variant: str = "", allocating: bool = True,
             entries: Container[str] | None = None, **instead: Any) -> dict[str, Any]:
    """The names of a module of straight-line kernels with all its functions compiled, those named and sums of
    twofold numbers inlined; kept on disk where there is a place for it.

    instead: what stands for names of the module, for compiled code; variant: names the code that has these,
    which the disk keeps apart; allocating: whether a function makes arrays. Where none does, nothing counts
    the references to those that they take: in a short function that costs more than what it does; entries:
    the functions that Python calls (None: any), the others compile in three quarters of the time."""
    return _kept(lambda cache: _compiled(module, inlined, cache, variant, allocating, entries, instead))


def twins(module: ModuleType, make: Callable[[str, FunctionType], Any], variant: str = "",
          **instead: Any) -> dict[str, Any]:
    """The names of a module and of those below it (`_below`) with `make` of a twin of each of their
    functions, which sees these names; instead, variant: as of `compiled`."""
    modules, names = (*_below(module), module), dict[str, Any]()
    for each in modules:
        names |= vars(each)
    names |= instead
    files = {each.__name__ for each in modules}
    for name, function in list(names.items()):
        if isinstance(function, FunctionType) and function.__module__ in files:
            twin = FunctionType(function.__code__, names, name)
            twin.__qualname__ += variant
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
    # numba's cache on disk watches the file of a function alone, not what is inlined from another
    stamp = crc32(b"".join(Path(str(each.__file__)).read_bytes() for each in _below(module)))

    def make(name: str, twin: FunctionType) -> Any:
        inline = name in inlined or hasattr(error_free, name)
        options: dict[str, Any] = {  # of which numba's types know nothing
            "_nrt": allocating, "no_cfunc_wrapper": True,
            "no_cpython_wrapper": entries is not None and name not in entries}
        return njit(cache=cache, error_model="numpy", forceinline=inline, **options)(twin)
    return twins(module, make, f"{variant}_{stamp:x}_", **instead)
