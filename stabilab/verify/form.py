"""The form of a certificate, and what it is about in words."""
from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from .diagram import claims as diagram
from .numbers import Malformed, field, number, quoted, shown

if TYPE_CHECKING:
    from pathlib import Path

# --- The form of a certificate's file: JSON of bounded size whose keys stand once, and the keys that have a
# meaning
SCHEMA = "stabilab.certificate/1"
MOST_BYTES = 1 << 22  # the longest certificates of the program have some ten thousand

PIECE = dict.fromkeys(("t", "linear", "verdict"))
KEYS = {
    "schema": None, "program": None, "uncertified": None, "scene": None,
    "equilibria": {
        "kind": None, "points": [dict.fromkeys(("box", "linear", "verdict"))],
        "curves": [{"numerators": None, "denominator": None, "segments": [PIECE], "folds": [PIECE]}],
        "planes": [{**dict.fromkeys(("base", "directions", "linear", "verdict")),
                    "centre": dict.fromkeys(("at", "verdict"))}]},
    "motion": {**dict.fromkeys(("state", "fate", "axis", "sense", "extremes", "period")),
               "closed": dict.fromkeys(("law", "direction", "gain", "most")),
               "spin_up": {**dict.fromkeys(("about", "axis", "sense", "orders", "t", "cone", "least",
                                            "gain")), "way": [dict.fromkeys(("t", "box"))]}}}
SCENES = {"physical": ("variables", "inertia", "momentum", "torque"), "scaled": ("variables", "a", "b", "mu")}


def read(path: Path) -> dict:
    """The object in a file. OSError where it cannot be read, `Malformed` where it is no JSON of this form."""
    with open(path, "rb") as file:
        return parsed(file.read(MOST_BYTES + 1))


def parsed(text: bytes) -> dict:
    """The object in the bytes of a file. `Malformed` where they are no JSON of this form."""
    if len(text) > MOST_BYTES:
        raise Malformed(f"expected at most {MOST_BYTES} bytes")
    try:
        return json.loads(text.decode("utf-8"), object_pairs_hook=_once, parse_constant=_no_number)
    except Malformed:
        raise
    except (ValueError, RecursionError) as error:
        raise Malformed(f"not JSON: {error}") from None


def _once(pairs) -> dict:
    table = dict(pairs)
    if len(table) != len(pairs):
        names = [name for name, _ in pairs]
        raise Malformed(
            f"the key {shown(next(n for n in names if names.count(n) > 1))} stands twice in one object")
    return table


def _no_number(word):
    raise Malformed(f"{word} is no number of JSON")


def check_frame(certificate, schema: str = SCHEMA) -> None:
    """Schema, and what is no claim: who wrote it, and what it leaves out. Raises `Malformed`."""
    got = certificate.get("schema") if isinstance(certificate, dict) else certificate
    if got != schema or not isinstance(certificate, dict):
        raise Malformed(f"schema: expected {schema!r}, got {shown(got)}")
    if not isinstance(certificate.get("program", ""), str):
        raise Malformed(f"program: expected a name, got {shown(certificate['program'])}")
    left = certificate.get("uncertified", [])
    if not isinstance(left, list) or not all(isinstance(why, str) for why in left):
        raise Malformed(f"uncertified: expected a list of sentences, got {shown(left)}")
    if left and all(certificate.get(part) is not None for part in ("equilibria", "motion")):
        raise Malformed(f"uncertified: everything is claimed, yet {shown(left[0])} is left out")


def strangers(certificate, keys=None) -> list[str]:
    """Where keys stand that have no meaning: nothing is known of what they say."""
    scene = certificate.get("scene")
    resolved = SCENES.get(field(scene, "variables", "scene", str), ()) if scene is not None else ()
    return list(_strangers(certificate, (KEYS if keys is None else keys) | {"scene": dict.fromkeys(resolved)},
                           ""))


def _strangers(value, resolved, where):
    if isinstance(resolved, list) and isinstance(value, list):
        for i, entry in enumerate(value):
            yield from _strangers(entry, resolved[0], f"{where}[{i}]")
    elif isinstance(resolved, dict) and isinstance(value, dict):
        for key, entry in value.items():
            if key not in resolved:
                yield f"{quoted(key)}{where and ' in ' + where}"
            else:
                yield from _strangers(entry, resolved[key], f"{where and where + '.'}{key}")


# --- What a certificate is about: the numbers of its scene and state, in a line, and compared with those of
# a case
BODY_LABELS = {"inertia": "moments", "momentum": "wheel"}
# of a scene that is not scaled
UNITS = {"inertia": "kg m²", "momentum": "N m s", "torque": "N m", "state": "rad/s"}


def about(certificate: dict) -> dict:
    """Its scene and state as plain strings, in the order of the form: {"variables": .., "inertia": [..], ..,
    "state": [..]}; empty where it names no scene. For a certificate that `verify` has read without
    complaint."""
    if diagram.is_one(certificate):
        return diagram.about(certificate)
    scene, motion = certificate.get("scene"), certificate.get("motion")
    if scene is None:
        return {}
    return ({key: scene[key] for key in SCENES[scene["variables"]]}
            | ({"state": motion["state"]} if motion else {}))


def line(text: dict) -> str:
    """The line that `stabilab verify` prints first."""
    if "range" in text:
        return diagram.line(text)
    units = UNITS if text.get("variables") == "physical" else {}
    parts = [f"{BODY_LABELS.get(key, key)} {_short(value)} {units.get(key, '')}".rstrip()
             for key, value in text.items() if key != "variables"]
    return f"about: {', '.join(parts) or 'no scene'}" + ("" if "state" in text or not text else ", no state")


def differences(printed: dict, case: dict) -> list[str]:
    """What a certificate is about that a case is not: both as `about` tells it, numbers compared exactly. A
    certificate without a motion says nothing of a state, so the case's may be any."""
    if "range" in printed:
        return diagram.differences(printed, case)
    keys = [*printed, *(key for key in case if key not in printed and key != "state")]
    return [f"{BODY_LABELS.get(key, key)}: the certificate's {_short(printed.get(key))}, the case's "
            f"{_short(case.get(key))}"
            for key in keys if _exact(printed.get(key)) != _exact(case.get(key))]


def _exact(value):
    """Words as they are, numbers and lists of them as fractions."""
    if isinstance(value, (list, tuple)):
        return [number(v, "about") for v in value]
    return value if value is None or value in SCENES else number(value, "about")


def _short(value: str | Sequence[str] | None) -> str:
    if value is None:
        return "none"
    return " ".join(v if len(v) <= 24 else shown(v) for v in ([value] if isinstance(value, str) else value))
