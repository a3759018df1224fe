"""Numbers that no one here wrote: what other tools print of a body's rotation, held against ours, which know
their error.

Printed values are data (`numbers/*.toml`: figures, with source, commit and licence); `findings` is the
machine that judges them.
"""
from __future__ import annotations

from collections.abc import Callable

from .comparison import Finding, Source, findings, source, sources


def validated(name: str | None = None, tell: Callable[[int, int, str], None]
              | None = None) -> tuple[tuple[Source, tuple[Finding, ...]], ...]:
    """(source, findings) of one source or of all on record. tell(done, count, words): before each value.
    InputError for an unknown source."""
    chosen = [source(item) for item in ([name] if name else sources())]
    count, done, result = sum(len(printed.values) for item in chosen for printed in item.printed), 0, []
    for x in chosen:
        result.append((x,
                      findings(x, tell and (lambda n, text, before=done: tell(before + n, count, text)))))
        done += sum(len(printed.values) for printed in x.printed)
    return tuple(result)
