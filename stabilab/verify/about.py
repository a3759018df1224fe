"""What a certificate is about: the numbers of its scene and state, in a line, and compared with those of a case."""
from __future__ import annotations

from .diagram import claims as diagram
from .form import SCENES
from .numbers import number, shown

WORDS = {"inertia": "moments", "momentum": "wheel"}
UNITS = {"inertia": "kg m^2", "momentum": "N m s", "torque": "N m", "state": "rad/s"}  # of a scene that is not scaled


def about(certificate: dict) -> dict:
    """Its scene and state as plain strings, in the order of the form: {"variables": .., "inertia": [..], .., "state": [..]};
    empty where it names no scene. For a certificate that `verify` has read without complaint."""
    if diagram.is_one(certificate):
        return diagram.about(certificate)
    scene, motion = certificate.get("scene"), certificate.get("motion")
    if scene is None:
        return {}
    return {key: scene[key] for key in SCENES[scene["variables"]]} | ({"state": motion["state"]} if motion else {})


def line(told: dict) -> str:
    """The line that `stabilab verify` prints first."""
    if "number" in told:
        return diagram.line(told)
    units = UNITS if told.get("variables") == "physical" else {}
    parts = [f"{WORDS.get(key, key)} {_short(value)} {units.get(key, '')}".rstrip() for key, value in told.items() if key != "variables"]
    return f"about: {', '.join(parts) or 'no scene'}" + ("" if "state" in told or not told else ", no state")


def differences(told: dict, case: dict) -> list[str]:
    """What a certificate is about that a case is not: both as `about` tells it, numbers compared exactly. A certificate
    without a motion says nothing of a state, so the case's may be any."""
    if "number" in told:
        return diagram.differences(told, case)
    keys = [*told, *(key for key in case if key not in told and key != "state")]
    return [f"{WORDS.get(key, key)}: the certificate's {_short(told.get(key))}, the case's {_short(case.get(key))}"
            for key in keys if _exact(told.get(key)) != _exact(case.get(key))]


def _exact(value):
    """Words as they are, numbers and lists of them as fractions."""
    if isinstance(value, (list, tuple)):
        return [number(v, "about") for v in value]
    return value if value is None or value in SCENES else number(value, "about")


def _short(value) -> str:
    if value is None:
        return "none"
    return " ".join(v if len(v) <= 24 else shown(v) for v in ([value] if isinstance(value, str) else value))
