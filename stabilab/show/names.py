"""What users call things: cases, thrusters, wheels, keys, files. Text is passed through patterns that set
letters, units and names of axes; these names are taken out of it before and put in again after, as written.

A view that is about a case calls `spare` with what its user named; only names that a pattern would change are
remembered."""
from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import lru_cache, wraps
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec

if TYPE_CHECKING:
    from ..case.read import Case

P = ParamSpec("P")
FIRST, MANY = 0xF0000, 60_000  # letters of private use that stand for the names in a text; so many at most
# what some pattern looks for: a letter's name, a number with its unit, an axis, a sign, the end of a clause
SUSPECT = re.compile(
    r"omega|lambda|mu|gamma|alpha|sigma|zeta|tau|beta|delta|eps|eta|theta|kappa|nu|pi|phi|psi|rho|sqrt|inf"
    r"|ax[ei]s [123]|l_|_[ijk]|\^|\+-|-\+|[<>]=|-[\d.(\w]| - | x | \. |[MHωλγ]\.|\d\.\d{6}|\de[-+]?\d"
    r"|\d (?:rad|deg|days?|min|h|s|m|J|tau|N m)\b|; ", re.IGNORECASE)
VARIANT = r"(?:-\d+)*"  # which combination of a [sweep] it is, behind the name of a case
_spared: dict[str, None] = {}
_found: list[re.Pattern[str]] = []  # of all of them, the longest first; empty where it is to be made


def spare(names: Iterable[str]) -> None:
    """Leave these names as they are, wherever a text holds them."""
    for name in names:
        if name in _spared or not _suspect(name):
            continue
        _found.clear()
        _spared.update(dict.fromkeys((name, escape(name), escape(name).replace("&#x27;", "&#39;"))))


def spare_case(case: Case) -> None:
    """Leave what the user of a case named."""
    if not hasattr(case, "swept"):  # no case of a file
        return
    path = Path(case.path)
    spare((case.name.removesuffix(case.variant), case.title, case.source, case.path, str(path), path.name,
           path.stem, *(thruster.name for thruster in case.thrusters), *(wheel.name for wheel in case.wheels),
           *(key for key, _ in case.swept if "." in key),  # others are names of ours
           *(caveat.words for caveat in case.caveats if caveat.reason.code == "stated-by-the-file")))


@lru_cache(maxsize=4096)
def _suspect(name: str) -> bool:
    return any(map(str.isalpha, name)) and SUSPECT.search(name) is not None


def around(change: Callable[P, str]) -> Callable[P, str]:
    """A function that changes a text, its first argument of this type, but for the names that are spared."""
    @wraps(change)
    def changed(*source: P.args, **named: P.kwargs) -> str:
        if not _spared:
            return change(*source, **named)
        at = next(n for n, item in enumerate(source) if isinstance(item, str))
        text, taken = source[at], []  # type: ignore[var-annotated]

        def hidden(out: re.Match[str]) -> str:
            taken.append(out[0])
            return chr(FIRST + len(taken) - 1)
        bare = _pattern().sub(hidden, str(text), count=MANY)
        if not taken:
            return change(*source, **named)
        result = change(*source[:at], _like(text, bare), *source[at + 1:], **named)  # type: ignore[arg-type]
        # escaped on the way, where it is of another type than what was given
        shown = taken if type(result) is type(text) else list(map(escape, taken))
        return _like(result, str(result).translate(dict(enumerate(shown, FIRST))))
    return changed


def _like(text: Any, phrase: str) -> Any:
    """Words of the same type: what is escaped stays so."""
    return phrase if type(text) is str else type(text)(phrase)


def _pattern() -> re.Pattern[str]:
    if not _found:
        longest = sorted(_spared, key=len, reverse=True)
        _found.append(re.compile("|".join(
            f"{_edge(name[0], '<!')}{re.escape(name)}{VARIANT}{_edge(name[-1], '!')}" for name in longest)))
    return _found[0]


def _edge(letter: str, look: str) -> str:
    """That a name which ends in a letter is no part of a longer word."""
    return rf"(?{look}\w)" if letter.isalnum() or letter == "_" else ""
