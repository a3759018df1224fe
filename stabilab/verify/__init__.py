"""A second look at a certificate, by code that shares only python-flint with the analysis.

Nothing of the rest of the package is imported here: equations, equilibria, stability and fate are worked out again from
the numbers of the scene (docs/certificate.md has the mathematics), and every claim is compared.
"""
from __future__ import annotations

import json
from dataclasses import dataclass

from .equilibria import check_equilibria
from .motion import check_motion
from .numbers import Malformed
from .rates import Rates

SCHEMA = "stabilab.certificate/1"


@dataclass(frozen=True)
class Finding:
    """One claim: what it says, "proved", "refuted" or "not checked", and why."""

    claim: str
    status: str
    reason: str


@dataclass(frozen=True)
class Verification:
    """All findings on a certificate. status: "refuted" if any claim is, "proved" if all are, else "partly"."""

    findings: tuple[Finding, ...]

    @property
    def status(self) -> str:
        found = {f.status for f in self.findings}
        return "refuted" if "refuted" in found else "proved" if found <= {"proved"} and found else "partly"


def verify(certificate: dict) -> Verification:
    """Check a certificate as read from its file. Raises `Malformed` (a ValueError) where it is no such thing."""
    if not isinstance(certificate, dict) or certificate.get("schema") != SCHEMA:
        got = certificate.get("schema") if isinstance(certificate, dict) else type(certificate).__name__
        raise Malformed(f"schema: expected {SCHEMA!r}, got {got!r}")
    parts = [name for name in ("equilibria", "motion") if certificate.get(name) is not None]
    if not parts and certificate.get("scene") is None:
        return Verification(())  # a certificate of nothing: its `uncertified` says why
    rates = Rates.of_scene(certificate.get("scene"))
    findings = []
    note = lambda claim, status, reason="": findings.append(Finding(claim, status, reason))  # noqa: E731
    if "equilibria" in parts:
        check_equilibria(rates, certificate["equilibria"], note)
    if "motion" in parts:
        check_motion(rates, certificate["motion"], note)
    return Verification(tuple(findings))


def verify_file(path) -> Verification:
    """`verify` of a JSON file. OSError where it cannot be read, `Malformed` where it is no certificate."""
    with open(path, encoding="utf-8") as file:
        try:
            certificate = json.load(file)
        except (ValueError, RecursionError) as error:
            raise Malformed(f"not JSON: {error}") from None
    return verify(certificate)
