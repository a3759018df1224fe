"""Results of slow derivations, on disk."""
from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

from .version import __version__

T = TypeVar("T")
MOST = 256  # files of a kind: beyond, the older half goes


def cache_folder() -> Path | None:
    """The folder for what is kept: STABILAB_CACHE where it is set (None where it is "off"), else under
    XDG_CACHE_HOME, else the platform's place."""
    named, given = os.environ.get("STABILAB_CACHE"), os.environ.get("XDG_CACHE_HOME")
    if named:
        return None if named == "off" else Path(named)
    if given and Path(given).is_absolute():  # the XDG rule: relative paths are to be ignored
        return Path(given) / "stabilab"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "stabilab"
    if sys.platform == "win32":
        return (Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
                / "stabilab" / "Cache")
    return Path.home() / ".cache" / "stabilab"


def kept(kind: str, content: str, sources: Path, versions: tuple[str, ...], make: Callable[[], T],
         records: Mapping[str, type]) -> T:
    """What `make` returns, from the disk where it was made before from the same content; made anew each time
    where it is not to be written down.

    kind: the folder; content: everything that the result depends on, in words; sources: the folder of the
    code that makes it, of which any change counts; versions: of the packages that make it; records: the
    dataclasses, by their names, of which the result is one and may hold others.
    """
    path = _path(kind, content, sources, versions)
    if path is None:
        return make()
    found = _from_json(path, records)
    if found is None:
        found = make()
        _write(path, found)
    return found  # type: ignore[return-value]  # of the same content, versions and code


def in_words(thing: Any) -> str:
    """All that makes a dataclass equal to another, as a text: a repr may leave out the unrounded numbers
    beside the doubles."""
    if isinstance(thing, tuple):
        return f"({', '.join(map(in_words, thing))})"
    if not is_dataclass(thing):
        return repr(thing)
    shown = (f"{field.name}={in_words(getattr(thing, field.name))}" for field in fields(thing)
             if field.compare)
    return f"{type(thing).__module__}.{type(thing).__qualname__}({', '.join(shown)})"


def _path(kind: str, content: str, sources: Path, versions: tuple[str, ...]) -> Path | None:
    try:
        folder = cache_folder()
        if folder is None:
            return None
        files = sorted((file.name, stat.st_size, stat.st_mtime_ns) for file in sources.rglob("*.py")
                       for stat in (file.stat(),))
        made_by = __version__, sys.version_info[:3], versions, files
    except (OSError, RuntimeError):  # no home, or a package that is no folder of files
        return None
    return folder / kind / f"{sha256(repr((content, made_by)).encode()).hexdigest()[:32]}.json"


def _from_json(path: Path, records: Mapping[str, type]) -> object | None:
    try:
        said, _, data = path.read_bytes().partition(b"\n")
        if said.decode() != sha256(data).hexdigest():
            return None
        found = from_json(json.loads(data), records)
        return found if type(found) in records.values() else None
    except Exception:  # whatever a strange file holds: it is no answer
        return None


def _write(path: Path, made: object) -> None:
    try:
        data = json.dumps(to_json(made), separators=(",", ":")).encode()
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        waiting = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            waiting.write_bytes(sha256(data).hexdigest().encode() + b"\n" + data)
            waiting.replace(path)
        finally:
            waiting.unlink(missing_ok=True)
        files = sorted(path.parent.glob("*.json"), key=lambda file: file.stat().st_mtime)
        for file in files[:len(files) - MOST // 2] if len(files) > MOST else ():
            file.unlink(missing_ok=True)
    except (OSError, TypeError, ValueError, RecursionError):  # it is derived again next time
        return


# --- symbolic values as JSON and back: texts that hold numbers, names and sums, and nothing that could be run
SUM, PRODUCT, POWER, RATIO, SYMBOL, FRACTION, ROW, TABLE, RECORD = ("+", "*", "^", "q", "x", "/", "()", "{}",
                                                                    "record")


def to_json(thing: Any) -> Any:
    """SymPy's sums, products, powers, rationals and symbols, fractions, and dataclasses, tuples and dicts of
    them, as lists for JSON.

    Raises TypeError for anything else.
    """
    if thing is None or isinstance(thing, (str, int, float)):
        return thing
    if isinstance(thing, Fraction):
        return [FRACTION, thing.numerator, thing.denominator]
    if isinstance(thing, tuple):
        return [ROW, *map(to_json, thing)]
    if isinstance(thing, dict):
        return [TABLE, *([to_json(key), to_json(value)] for key, value in thing.items())]
    if is_dataclass(thing):
        return [RECORD, type(thing).__name__,
                {one.name: to_json(getattr(thing, one.name)) for one in fields(thing) if one.init}]
    return _symbolic(thing)


def _symbolic(thing: Any) -> list[Any]:
    from sympy import Add, Mul, Pow, Rational, Symbol
    if isinstance(thing, Rational):
        return [RATIO, int(thing.p), int(thing.q)]
    if type(thing) is Symbol:
        return [SYMBOL, thing.name,
                {word: value for word, value in thing.assumptions0.items() if word != "commutative"}]
    for sign, kind in ((SUM, Add), (PRODUCT, Mul), (POWER, Pow)):
        if type(thing) is kind:
            return [sign, *map(to_json, thing.args)]
    raise TypeError(f"{type(thing).__name__} is not written down")


def from_json(data: Any, records: Mapping[str, type]) -> Any:
    """What `to_json` wrote. records: the dataclasses that may stand in it, by their names. Raises ValueError,
    KeyError or TypeError for what it did not write."""
    if data is None or isinstance(data, (str, int, float)):
        return data
    sign, *rest = data
    if sign == ROW:
        return tuple(from_json(one, records) for one in rest)
    if sign == TABLE:
        return {from_json(key, records): from_json(value, records) for key, value in rest}
    if sign == RECORD:
        name, parts = rest
        return records[name](**{key: from_json(part, records) for key, part in parts.items()})
    if sign == FRACTION:
        return Fraction(*map(_whole, rest))
    return _read_symbolic(sign, rest, records)


def _read_symbolic(sign: Any, rest: list[Any], records: Mapping[str, type]) -> Any:
    """Sums and products keep the order in which they stand: nothing is worked out again."""
    from sympy import Add, Expr, Mul, Pow, Rational, Symbol
    if sign == RATIO:
        return Rational(*map(_whole, rest))
    if sign == SYMBOL:
        name, assumptions = rest
        if not isinstance(name, str):
            raise TypeError("a symbol's name is a text")
        return Symbol(name, **assumptions)
    parts = [from_json(one, records) for one in rest]
    if not all(isinstance(part, Expr) for part in parts):
        raise TypeError("sums, products and powers are of expressions")
    return {SUM: Add, PRODUCT: Mul, POWER: Pow}[sign](*parts, evaluate=False)


def _whole(number: Any) -> int:
    if type(number) is not int:
        raise TypeError("expected a whole number")
    return number
