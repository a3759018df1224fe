"""Numbers that no one here wrote: what other tools print of a body's rotation, held against ours, which know their error.

Printed values are data (`numbers/*.toml`: figures, with source, commit and licence); `findings` is the machine that judges them.
"""
from __future__ import annotations

from .findings import Finding, findings
from .record import Source, source, sources


def validated(name: str | None = None) -> tuple[tuple[Source, tuple[Finding, ...]], ...]:
    """(source, findings) of one source or of all on record. InputError for an unknown source."""
    return tuple((one, findings(one)) for one in map(source, [name] if name else sources()))
