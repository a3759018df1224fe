"""The certificate of a case, written beside its page and checked by the code that shares nothing with the analysis."""
from __future__ import annotations

from pathlib import Path

from ....answers.certificate import certificate
from ....verify import verify_file
from ...text import certification


def certificate_of(case, folder: Path, stem: str) -> dict:
    """The file's name, what is certified, and what the check found claim by claim."""
    made = certificate(case.scene, case.exact_state)
    path = certification.write(made, folder / f"{stem}-certificate.json")
    found = verify_file(path)
    return {"file": path.name, "summary": certification.summary(made).splitlines(), "status": found.status,
            "findings": [{"claim": one.claim, "status": one.status, "reason": one.reason} for one in found.findings]}
