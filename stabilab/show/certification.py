"""Certificates as files, and what a check of one found, in words and as JSON."""
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import printable
from ..files import write_text
from ..representation import values_of
from .terminal import in_letters, some

if TYPE_CHECKING:
    from ..verify import Verification

SCHEMA = "stabilab.verification/1"
# what the checker, which knows no units, claims of a component x1 -> the same of the rate ω1 of a body
RATES = {f"{extreme} x{n}": f"{extreme} ω{n}" for extreme in ("least", "greatest") for n in (1, 2, 3)}


def write(certificate: dict, path: Path) -> Path:
    """The certificate as a JSON file, whole or not at all. Raises InputError where it cannot be written."""
    import json
    text = json.dumps(certificate, indent=1, ensure_ascii=False, allow_nan=False)
    return write_text(path, f"{text}\n")


def summary(certificate: dict) -> str:
    """A line on what is certified, and one for each thing that is not."""
    parts = []
    if certificate["equilibria"]:
        result = certificate["equilibria"]
        planes = f", {some(len(result['planes']), 'plane')}" if result.get("planes") else ""
        count = (f"{len(result['points'])} isolated, {some(len(result['curves']), 'curve')}{planes}"
                 if result["kind"] in ("points", "curves") else result["kind"])
        parts.append(f"equilibria ({count})")
    if certificate["motion"]:
        motion = certificate["motion"]
        numbers = [name for name in ("extremes", "period") if motion[name]]
        parts.append(", ".join([f"fate ({motion['fate']})", *numbers]))
    lines = [f"certified: {'; '.join(parts) or 'nothing'}"]
    return "\n".join(lines + [f"not certified: {why}" for why in certificate["uncertified"]])


def text(result: Verification, first: str, other: str = "", physical: bool = False) -> str:
    """The verdict on the whole, what it is about, then one line a claim. other: the case that it should be of
    and is not. physical: the checker's x1 is a rate in rad/s, which all other commands call ω1."""
    counts = {word: sum(f.status == word for f in result.findings)
              for word in ("proved", "not checked", "refuted")}
    count = ", ".join(f"{n} {word}" for word, n in counts.items() if n) or "no claims"
    claims = [RATES.get(f.claim, f.claim) if physical else f.claim for f in result.findings]
    lines = [f"{f.status:<12} {in_letters(claim)}{f': {in_letters(f.reason)}' if f.reason else ''}"
             for claim, f in zip(claims, result.findings)]
    silent = f"; nothing is claimed of: {', '.join(result.silent)}" if result.silent else ""
    another = f"OF ANOTHER CASE than {printable(str(other))}; its own claims: " if other else ""
    return "\n".join([f"{another}{result.status.upper()}: {count}{silent}", first, *lines])


def as_dict(result: Verification, about: dict) -> dict:
    """The object of `stabilab verify --json`."""
    return {"schema": SCHEMA, "status": result.status, "about": about, "silent": list(result.silent),
            "findings": [values_of(f, "claim status reason") for f in result.findings]}
