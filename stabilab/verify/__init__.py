"""A second look at a certificate, by code that shares only python-flint with the analysis.

Nothing of the rest of the package is imported here: equations, equilibria, stability and fate are worked out
again from the numbers of the scene (docs/certificate.md has the mathematics), and every claim is compared.
"""
from __future__ import annotations

from dataclasses import dataclass

from .diagram.check import check_diagram
from .diagram.claims import KEYS as DIAGRAM_KEYS
from .diagram.claims import SCHEMA as DIAGRAM
from .diagram.claims import claims_of
from .equilibria import check_equilibria, equilibria_of
from .form import SCHEMA, check_frame, read, strangers
from .motion import check_motion, motion_of
from .numbers import Rates, working

__all__ = ["SCHEMA", "Finding", "Verification", "verify", "verify_file"]
OUTSIDE = 53  # bits where a check asks for no more: those of a double, which flint has by itself


@dataclass(frozen=True)
class Finding:
    """One claim: what it says, "proved", "refuted" or "not checked", and why."""

    claim: str
    status: str
    reason: str


@dataclass(frozen=True)
class Verification:
    """All findings on a certificate. status: "refuted" if any claim is, "proved" if all are, else "partly".
    silent: the parts of which it claims nothing."""

    findings: tuple[Finding, ...]
    silent: tuple[str, ...] = ()

    @property
    def status(self) -> str:
        result = {f.status for f in self.findings}
        return "refuted" if "refuted" in result else "proved" if result <= {"proved"} and result else "partly"


def verify(certificate: dict) -> Verification:
    """Check a certificate as read from its file. Raises `Malformed` (a ValueError) where it is no such thing.

    All of it is read before anything is worked out, so a certificate that is malformed anywhere is malformed
    at once.
    """
    if isinstance(certificate, dict) and certificate.get("schema") == DIAGRAM:
        return _verify_diagram(certificate)
    check_frame(certificate)
    silent = tuple(part for part in ("equilibria", "motion") if certificate.get(part) is None)
    findings = [Finding(f"key {where}", "not checked", "this key has no meaning here")
                for where in strangers(certificate)]
    note = lambda claim, status, reason="": findings.append(Finding(claim, status, reason))
    if len(silent) == 2 and certificate.get("scene") is None:
        return Verification(tuple(findings), silent)  # a certificate of nothing: its `uncertified` says why
    # a check is one question: what lies between its parts of more bits is of the same thread
    with working(OUTSIDE):
        rates = Rates.of_scene(certificate.get("scene"))
        equilibria = None if "equilibria" in silent else equilibria_of(certificate["equilibria"])
        motion = None if "motion" in silent else motion_of(certificate["motion"])
        if equilibria:
            check_equilibria(rates, equilibria, note)
        if motion:
            check_motion(rates, motion, note)
    return Verification(tuple(findings), silent)


def _verify_diagram(certificate: dict) -> Verification:
    """The same of a diagram over one number."""
    check_frame(certificate, DIAGRAM)
    findings = [Finding(f"key {where}", "not checked", "this key has no meaning here")
                for where in strangers(certificate, DIAGRAM_KEYS)]
    claims = claims_of(certificate)
    check_diagram(claims, lambda claim, status, reason="": findings.append(Finding(claim, status, reason)))
    return Verification(tuple(findings))


def verify_file(path) -> Verification:
    """`verify` of a JSON file. OSError where it cannot be read, `Malformed` where it is no certificate."""
    return verify(read(path))
