"""A certificate that was dropped on the page, checked by the code that shares nothing with the analysis."""
from __future__ import annotations

from typing import Any

from ...verify import verify
from ...verify.about import about, line
from ...verify.form import parsed
from ...verify.numbers import Malformed
from .bag import Bag


def checked(asked: dict[str, Any]) -> bytes:
    """The findings on asked["text"], as a framed message: status, about and a row a claim; "error" where it is no certificate."""
    text = asked.get("text")
    try:
        claims = parsed(text.encode() if isinstance(text, str) else b"")
        found = verify(claims)
    except (Malformed, UnicodeError) as error:
        return Bag().framed({"error": f"This is no certificate of stabilab classify --certify: {error}"})
    silent = f"; nothing is claimed of: {', '.join(found.silent)}" if found.silent else ""
    return Bag().framed({"status": found.status, "about": line(about(claims)) + silent,
                         "findings": [{"claim": one.claim, "status": one.status, "reason": one.reason} for one in found.findings]})
