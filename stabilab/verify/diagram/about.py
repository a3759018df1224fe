"""What a certificate of a diagram is about: which number of which scene varies, and whether a case is one of its scenes."""
from __future__ import annotations

from typing import Any

from ..numbers import brief, number, q
from .claims import PLACES, SCHEMA


def is_one(certificate: dict) -> bool:
    """Whether a certificate is of a diagram."""
    return certificate.get("schema") == SCHEMA


def about(certificate: dict) -> dict[str, Any]:
    """Its number, range, scene and start, as they stand in it, for one that `verify` has read without complaint."""
    scene = certificate["scene"]
    rows = {key: scene[key] for key, _ in PLACES[scene["variables"]]}
    name = certificate.get("number")
    return {"number": name if isinstance(name, str) else "t", "range": certificate["range"], "variables": scene["variables"], **rows,
            **({"state": certificate["start"]} if certificate.get("start") else {})}


def line(told: dict) -> str:
    """The line that `stabilab verify` prints first."""
    low, high = (brief(number(end, "range")) for end in told["range"])
    keys = [key for key, _ in PLACES[told["variables"]]] + (["state"] if "state" in told else [])
    varying = [key for key in keys if any(len(row) > 1 for row in told[key])]
    return f"about: {', '.join(varying) or 'nothing'} as {_plain(told['number'])} goes from {low} to {high}; {_fixed(told, keys)}"


def _plain(name: str) -> str:
    return "".join(c for c in name if c.isprintable())[:80]


def _fixed(told: dict, keys: list[str]) -> str:
    parts = [f"{key} {' '.join(row[0] if len(row) == 1 else '*' for row in told[key])}" for key in keys]
    return f"{', '.join(parts):.200}" + (" (* varies)" if any("*" in part for part in parts) else "")


def differences(told: dict, case: dict) -> list[str]:
    """What a certificate is about that a case is not: no value of the number, inside the range or not, makes the scene the case's."""
    if told["variables"] != case.get("variables"):
        return [f"variables: the certificate's {told['variables']}, the case's {case.get('variables') or 'none'}"]
    out, common = [], None
    for key in [key for key, _ in PLACES[told["variables"]]] + (["state"] if "state" in told else []):
        values = case.get(key) if isinstance(case.get(key), (list, tuple)) else [case.get(key)]
        for n, (row, value) in enumerate(zip(told[key], values), 1):
            apart = _apart(row, value)
            if apart is None or apart.degree() == 0:
                out.append(f"{key}[{n}]: the certificate's {' '.join(row):.80}, the case's {value if value is not None else 'none'}")
            elif apart != 0:
                common = apart if common is None else common.gcd(apart)
    if not out and common is not None and not any(factor.degree() == 1 for factor, _ in common.factor()[1]):
        out.append(f"{told['number']}: no value of it gives all the case's numbers")
    return out


def _apart(row: list[str], value: str | None) -> Any:
    """The polynomial less the case's number; None where the case has none."""
    from flint import fmpq_poly
    if value is None:
        return None
    return fmpq_poly([q(number(c, "about")) for c in row]) - fmpq_poly([q(number(value, "about"))])
