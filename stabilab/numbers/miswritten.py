"""Numbers and units as people write them where they are no number here, and what to write instead.

Words alone: nothing here decides what a text means."""
from __future__ import annotations

import re

DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212\ufe63\uff0d"
_ONE = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
SUPERS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")

# words that are no unit here, and what is
INSTEAD = {"degs": "deg/s", "degps": "deg/s", "rads": "rad/s", "radps": "rad/s", "rps": "rev/s or rad/s",
          "kgf": "9.80665 N for each", "oz": "0.28349523125 N (a force) or 28.349523125 g",
           "ozf": "0.2780138509537812 N for each",
          "lbs": "lb (a mass) or lbf (a force)", "mdeg": "0.001 deg for each", "krpm": "1000 rpm for each",
           "ms^2": "m s^-2",
          "kip": "1000 lbf for each", "psi": "lbf/in^2", "kgms": "N m s", "nms": "N m s", "nm": "N m",
           "NMS": "N m s", "NM": "N m",
          "gauss": "1e-4 T for each", "G": "1e-4 T for each (gauss)", "yr": "365.25 day for each",
           "year": "365.25 day for each",
          "min.": "min", "sec.": "s", "orbit": "a time in min", "orbits": "a time in min",
           "dyn": "1e-5 N for each"}


def typed(text: str) -> str:
    """The text with the minus sign of typography (U+2212) as that of a keyboard: it has no other meaning."""
    return text.replace("\u2212", "-")


def instead(text: str, plain: bool) -> str:
    """What to write in place of a text that is no number; "" where nothing is known. plain: whether the
    number has no unit."""
    if len(text) > 100:
        return ""
    text = text.strip()
    readings = (_comma(text), _space(text), _dash(text), _power(text), _percent(text, plain), _range(text),
                _around(text), _turned(text), _pi(text), _parts(text))
    return next((reading for reading in readings if reading), "")


def _comma(text: str) -> str:
    """A decimal comma."""
    result = re.fullmatch(r"([-+]?\d+),(\d+)(?!\d*,)(.*)", text)
    if not result or "," in result[3]:
        return ""
    full, digits, rest = result.groups()
    if "." in rest[:1]:
        return f'write "{full}{digits}{rest}" without the comma'
    thousands = len(digits) == 3 and full.strip("+-0")
    other = (f', or "{full}{digits}{rest}" where the comma parts thousands' if thousands
             else "")
    return f'write "{full}.{digits}{rest}" with a point{other}'


def _space(text: str) -> str:
    """Blanks between digits, and blanks of print."""
    strange = next((c for c in text if c.isspace() and c not in " \t\n\r\f\v" or c in "\u200b\u2060\ufeff"),
                   "")
    if strange:
        keyed = "".join(" " if c.isspace() else "" if c in "\u200b\u2060\ufeff" else c for c in text)
        return f'write "{keyed}" with the blanks of a keyboard: U+{ord(strange):04X} stands in it'
    result = re.fullmatch(r"([-+]?\d{1,3}(?:[ '’]\d{3})+)(?!\d)(.*)", text)
    digits = re.sub("[^-+0-9]", "", result[1]) if result else ""
    return f'write "{digits}{result[2]}" without gaps between the digits' if result else ""


def _dash(text: str) -> str:
    """A dash of print in place of a minus."""
    if re.match(rf"[{DASHES}]\s*[\d.]", text):
        return f'write "-{text[1:].lstrip()}" with the minus of a keyboard: U+{ord(text[0]):04X} stands there'
    result = re.fullmatch(r"([-+])\s+(.*)", text)
    return (f'write "{result[1]}{result[2]}" with the sign beside the number'
            if result and result[2][:1].isdigit() else "")


def _power(text: str) -> str:
    """A power of ten."""
    plain = text.translate(SUPERS)
    result = re.fullmatch(rf"({_ONE})\s*[x×·*]\s*10\s*(?:\^|\*\*)?\s*\(?([-+]?\d+)\)?(.*)", plain)
    if result:
        return f'write "{result[1]}e{result[2]}{result[3]}"'
    result = re.fullmatch(r"([-+]?)10\s*(?:\^|\*\*)\s*\(?([-+]?\d+)\)?(.*)", plain)
    if result:
        return f'write "{result[1]}1e{result[2]}{result[3]}"'
    result = re.fullmatch(r"([-+]?(?:\d+\.?\d*|\.\d+))[dD]([-+]?\d+)(.*)", plain)
    return f'write "{result[1]}e{result[2]}{result[3]}"' if result else ""


def _percent(text: str, plain: bool) -> str:
    result = re.fullmatch(r"([-+]?\d+\.?\d*)\s*(?:%|percent|per cent|pct)", text)
    if not result:
        return ""
    if not plain:
        return f'per cent stand behind +-, as in "12 +- {result[1]} %", where a number takes an uncertainty'
    sign, digits = ("-", result[1][1:]) if result[1][0] == "-" else ("", result[1].lstrip("+"))
    full, _, rest = digits.partition(".")
    shifted = f"{full.zfill(3)[:-2]}.{full.zfill(3)[-2:]}{rest}".rstrip("0").rstrip(".")
    return f"write the share, {sign}{shifted}"


def _range(text: str) -> str:
    """Two numbers for one."""
    result = re.fullmatch(rf"({_ONE})\s*([^-–\d]*?)\s*(?:\.\.\.?|–|—| to | bis "
                         rf"|-|~)\s*({_ONE.removeprefix('[-+]?')})(.*)",
                         text)
    if not result or not re.search(r"[-–—~]|\.\.| to | bis ", text[1:]):
        return ""
    if re.search(r"[A-Za-z]\s*-\s*\d", text):
        return ""  # a power of a unit
    low, high = float(result[1]), float(result[3])
    if not low < high:
        return ""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    unit = (result[4] or result[2]).strip()
    return (f'of a range write the middle and the half-width, "{middle:.12g} +- '
            f'{half:.12g}{unit and " " + unit}", where '
            "the number takes an uncertainty, else one number")


def _around(text: str) -> str:
    """A word or a sign of comparison in front, and words behind in parentheses."""
    result = re.fullmatch(r"(?:[~≈<>≤≥=±$]+|about|approx\.?|ca\.?|circa|max\.?|min\.?|up to|at "
                         rf"most)\s*({_ONE}\b.*)", text, re.I)
    if result:
        return f'write the number alone, "{result[1]}"'
    result = re.fullmatch(rf"({_ONE}[^()\[\]]*?)\s*[\[(]([^()\d]+)[\])]", text)
    if not result:
        return ""
    behind = result[1].strip()
    return (f'write "{behind} {result[2].strip()}" without brackets' if re.fullmatch(_ONE, behind)
            else f'write "{behind}" alone')


def _turned(text: str) -> str:
    """A unit in front of its number."""
    result = re.fullmatch(rf"([A-Za-z°][A-Za-z°/^*. ]*?)\s*[=:]?\s*({_ONE})", text)
    return (f'write "{result[2]} {result[1].strip()}", the unit behind the number'
            if result and len(result[1]) < 10 else "")


def _pi(text: str) -> str:
    if "π" in text or re.search(r"\bpi\b", text):
        return ('write the decimals, such as 0.785398163397448, or an angle in degrees, such as "45 deg": '
                'nothing is worked out')
    return ""


def _parts(text: str) -> str:
    """Degrees, minutes and seconds."""
    if re.search(r"(°|deg)\s*\d+\s*['′m]", text):
        return 'write decimals of a degree, such as "5.5 deg"'
    if re.fullmatch(r"\d+:\d\d(:\d\d(\.\d+)?)?", text):
        return 'write one number and its unit, such as "90 min"'
    if re.fullmatch(r"\d+\s*(?:h|hr|d|day|days|min|m)\s*\d+\s*(?:min|m|s|sec|h)\.?", text):
        return 'write one number and its unit, such as "90 min"'
    return ""


# (expected, came), both as a quantity's name in words without its unit: what is meant, most often
MEANT = {
    ("angular momentum", "angular velocity"): "of a wheel write inertia and speed in place of momentum",
    ("angular momentum", "torque"): "an angular momentum is in N m s",
    ("angular momentum", "momentum"): "write N m s; ms is a millisecond",
    ("angular momentum", "moment of inertia"): "an angular momentum is in N m s",
    ("force", "mass"): "a force is in N or lbf; the weight of 1 kg on the Earth is 9.80665 N",
    ("force", "torque"): "a force is in N; a torque fixed in the body is [effects.constant_torque] torque",
    ("torque", "length"): "write N m: nm is a nanometre",
    ("torque", "force"): "a torque is in N m",
    ("torque", "m kg"): "a torque is in N m or ft lbf; lb is a mass",
    ("torque", "angular momentum"): "a torque is in N m",
    ("moment of inertia", "m kg"): "a moment of inertia is in kg m^2",
    ("moment of inertia", "mass"): "a moment of inertia is in kg m^2",
    ("moment of inertia", "angular momentum"): "a moment of inertia is in kg m^2",
    ("angular velocity", "angle"): "an angular velocity is in deg/s or rad/s",
    ("angular velocity", "rate"): "write rad/s, deg/s or rev/s: turns and radians are told apart",
    ("angular velocity", "s rad"): "write deg/s: what is divided by stands behind /",
    ("angular velocity", "angular acceleration"): "an angular velocity is in deg/s or rad/s",
    ("angular velocity", "velocity"): "an angular velocity is in deg/s or rad/s",
    ("time", "length"): "min is a minute, m a metre",
    ("length", "time"): "m is a metre, min a minute",
    ("angle", "angular velocity"): "an angle is in deg or rad",
    ("mass", "force"): "a mass is in kg; lbf is a force, lb a mass",
    ("mass flow", "mass"): "a mass flow is in kg/s or g/s",
}


def meant(expected: str, came: str) -> str:
    """"; ..." with what a unit of another dimension was to be, most often; "" where nothing is known."""
    text = MEANT.get((expected.partition(" (")[0], came.partition(" (")[0]), "")
    return f"; {text}" if text else ""
