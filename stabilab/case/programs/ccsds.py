"""CCSDS attitude parameter messages (APM) as blocks of keywords, from KVN or XML.

CCSDS 504.0-B-1 (version 1) and 504.0-B-2 (version 2): the tables 3-3. Version 1 has no marks around its
blocks in KVN: which block a keyword is of follows from it, and `EPOCH`, `COMMENT` and the frames with a
letter in front. Units stand in brackets behind a value, or as an attribute, and must be those of the table.
"""
from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import InputError, printable
from ...numbers.exact import exact
from .xml_tree import Element, tree

HEAD, META, QUATERNION, EULER, RATE, SPIN, INERTIA, MANEUVER = (
    "header", "metadata", "quaternion", "Euler angles", "angular velocity", "spin", "inertia", "maneuver")
DEGREES, PER_SECOND = "deg", "deg/s"
# keyword: (block, unit or "" of a pure number, None of a text); of both versions
KEYWORDS: dict[str, tuple[str, str | None]] = {
    **dict.fromkeys(("CREATION_DATE", "ORIGINATOR", "MESSAGE_ID"), (HEAD, None)),
    **dict.fromkeys(("OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "TIME_SYSTEM", "EPOCH"), (META, None)),
    **dict.fromkeys(("Q_FRAME_A", "Q_FRAME_B", "Q_DIR"), (QUATERNION, None)),
    **dict.fromkeys(("Q1", "Q2", "Q3", "QC"), (QUATERNION, "")),
    **dict.fromkeys(("Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT"), (QUATERNION, "1/s")),
    **dict.fromkeys(("EULER_FRAME_A", "EULER_FRAME_B", "EULER_DIR", "EULER_ROT_SEQ", "RATE_FRAME"),
                    (EULER, None)),
    **dict.fromkeys(("X_ANGLE", "Y_ANGLE", "Z_ANGLE", "ANGLE_1", "ANGLE_2", "ANGLE_3"), (EULER, DEGREES)),
    **dict.fromkeys(("X_RATE", "Y_RATE", "Z_RATE", "ANGLE_1_DOT", "ANGLE_2_DOT", "ANGLE_3_DOT"),
                    (EULER, PER_SECOND)),
    "ANGVEL_FRAME": (RATE, None),
    **dict.fromkeys(("ANGVEL_X", "ANGVEL_Y", "ANGVEL_Z"), (RATE, PER_SECOND)),
    **dict.fromkeys(("SPIN_FRAME_A", "SPIN_FRAME_B", "SPIN_DIR"), (SPIN, None)),
    **dict.fromkeys(("SPIN_ALPHA", "SPIN_DELTA", "SPIN_ANGLE", "NUTATION", "NUTATION_PHASE", "MOMENTUM_ALPHA",
                     "MOMENTUM_DELTA"), (SPIN, DEGREES)),
    **dict.fromkeys(("SPIN_ANGLE_VEL", "NUTATION_VEL"), (SPIN, PER_SECOND)),
    "NUTATION_PER": (SPIN, "s"),
    "INERTIA_REF_FRAME": (INERTIA, None),
    **dict.fromkeys(("I11", "I22", "I33", "I12", "I13", "I23", "IXX", "IYY", "IZZ", "IXY", "IXZ", "IYZ"),
                    (INERTIA, "kg*m**2")),
    **dict.fromkeys(("MAN_EPOCH_START", "MAN_REF_FRAME"), (MANEUVER, None)),
    "MAN_DURATION": (MANEUVER, "s"), "MAN_DELTA_MASS": (MANEUVER, "kg"),
    **dict.fromkeys(("MAN_TOR_1", "MAN_TOR_2", "MAN_TOR_3", "MAN_TOR_X", "MAN_TOR_Y", "MAN_TOR_Z"),
                    (MANEUVER, "N*m"))}
FRAMES = ("REF_FRAME_A", "REF_FRAME_B")
# of version 1: angles of a sequence such as 212, which has one of them twice, and their rates
REPEATED, AGAIN = re.compile(r"[XYZ]_(ANGLE|RATE)"), " (second)"
STARTS = {"QUAT": QUATERNION, "EULER": EULER, "ANGVEL": RATE, "SPIN": SPIN, "INERTIA": INERTIA,
          "MAN": MANEUVER}
TAGS = {"quaternionState": QUATERNION, "eulerElementsThree": EULER, "eulerAngleState": EULER,
        "angularVelocityState": RATE, "angVelState": RATE, "eulerElementsSpin": SPIN, "spin": SPIN,
        "spinState": SPIN, "spinNutation": SPIN, "spinNutationMom": SPIN, "inertia": INERTIA,
        "inertiaState": INERTIA, "spacecraftParameters": INERTIA, "maneuverParameters": MANEUVER,
        "angularVelocity": RATE}
_LINE = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*(?:\[([^\]]*)\]\s*)?")


@dataclass
class Value:
    """text: as it is written; line: of the keyword."""

    key: str
    text: str
    line: int
    path: Path

    def fault(self, words: str) -> InputError:
        """The error with file, line and keyword."""
        return InputError(f"{printable(str(self.path))}:{self.line}: {self.key}: {printable(words)}")


@dataclass
class Block:
    """kind: one of the blocks above; values: by keyword, in their order."""

    kind: str
    line: int
    path: Path
    values: dict[str, Value] = field(default_factory=dict)

    def text(self, *keys: str) -> str | None:
        """The value of the first of these keywords, None where there is none."""
        return next((self.values[key].text for key in keys if key in self.values), None)

    def value(self, *keys: str) -> Value | None:
        """The first of these keywords that is given."""
        return next((self.values[key] for key in keys if key in self.values), None)

    def needed(self, *keys: str) -> Value:
        """The same; a fault where there is none."""
        result = self.value(*keys)
        if result is None:
            raise self.fault(f"{' or '.join(keys)} is missing from the block {self.kind}")
        return result

    def fault(self, words: str) -> InputError:
        """The error with file and line of the block."""
        return InputError(f"{printable(str(self.path))}:{self.line}: {printable(words)}")

    def add(self, value: Value, unit: str | None) -> None:
        """Take a keyword in; its number and its unit are checked."""
        key = value.key
        if REPEATED.fullmatch(key) and key in self.values and key + AGAIN not in self.values:
            key += AGAIN
        if key in self.values:
            raise value.fault(f"given twice in this block, first in line {self.values[value.key].line}: keep "
                              "one")
        wanted = None if value.key in FRAMES else KEYWORDS[value.key][1]
        if wanted is not None:
            try:
                exact(value.text)
            except InputError as error:
                raise value.fault(str(error)) from None
            if unit is not None and _plain(unit) != _plain(wanted):
                raise value.fault(f"expected the unit {f'[{wanted}]' if wanted else 'none'}, got [{unit}]: "
                                  "write the number in that unit, or leave the brackets away where it is")
        self.values[key] = value


def _plain(unit: str) -> str:
    return unit.strip().lower().replace("^", "**").replace(" ", "").replace("n/a", "")


@dataclass
class Message:
    """version: 1 or 2; blocks: in their order, the head and metadata first."""

    version: int
    blocks: list[Block]

    def all(self, kind: str) -> list[Block]:
        """The blocks of a kind."""
        return [block for block in self.blocks if block.kind == kind]

    def text(self, key: str) -> str:
        """A keyword of the head, "" where it is missing."""
        return next((block.values[key].text for block in self.blocks[:1] if key in block.values), "")


def message(text: str, path: Path) -> Message:
    """The message of a text in KVN or XML."""
    return _of_xml(tree(text, path), path) if text.lstrip().startswith("<") else _of_kvn(text, path)


def _version(text: str, where: str) -> int:
    number = text.strip().partition(".")[0]
    if number not in ("1", "2"):
        raise InputError(f"{where}: CCSDS_APM_VERS: expected version 1.0 or 2.0, got {printable(text)[:40]}")
    return int(number)


def _of_kvn(text: str, path: Path) -> Message:
    version, blocks, inside = 0, [Block(HEAD, 1, path)], ""
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.split()[0] == "COMMENT" or line.strip() in ("META_START", "META_STOP"):
            continue
        mark = re.fullmatch(r"\s*(\w+)_(START|STOP)\s*", line)
        if mark and mark[1] in STARTS:
            inside = STARTS[mark[1]] if mark[2] == "START" else ""
            if inside:
                blocks.append(Block(inside, number, path))
            continue
        match = _LINE.fullmatch(line)
        if not match:
            raise InputError(f"{printable(str(path))}:{number}: expected KEYWORD = value, got "
                             f"{printable(line.strip())[:60]!r}")
        value = Value(match[1], match[2], number, path)
        if value.key == "CCSDS_APM_VERS":
            version = _version(value.text, f"{printable(str(path))}:{number}")
            continue
        _take(value, match[3], inside, blocks)
    return Message(version, blocks)


def _take(value: Value, unit: str | None, inside: str, blocks: list[Block]) -> None:
    """Put a keyword into its block."""
    if value.key in FRAMES and inside:
        blocks[-1].add(value, unit)
        return
    if value.key not in KEYWORDS:
        from difflib import get_close_matches
        close = get_close_matches(value.key, (*KEYWORDS, *FRAMES), n=1)
        raise value.fault("no keyword of an attitude parameter message"
                          + (f"; did you mean {close[0]}?" if close else ""))
    kind, wanted = KEYWORDS[value.key]
    if inside:
        if kind != inside:
            raise value.fault(f"is of the block {kind}, and stands in the block {inside}")
        blocks[-1].add(value, unit)
    elif kind in (HEAD, META):
        if value.key != "EPOCH" or "EPOCH" not in blocks[0].values:
            blocks[0].add(value, unit)
    else:  # version 1: a maneuver begins with its epoch, each other block is there once
        fresh = value.key == "MAN_EPOCH_START" or not any(block.kind == kind for block in blocks)
        if fresh:
            blocks.append(Block(kind, value.line, value.path))
        next(block for block in reversed(blocks) if block.kind == kind).add(value, unit)


def _of_xml(root: Element, path: Path) -> Message:
    apm = next((element for element in root.within() if element.tag == "apm"), None)
    if apm is None:
        raise root.fault("expected the element <apm> of an attitude parameter message")
    blocks = [Block(HEAD, apm.line, path)]
    version = _version(apm.attributes.get("version", ""), f"{printable(str(path))}:{apm.line}")
    _walk(apm, "", blocks, path)
    return Message(version, blocks)


def _walk(element: Element, inside: str, blocks: list[Block], path: Path) -> None:
    for child in element.children:
        if child.tag == "COMMENT":
            continue
        kind = TAGS.get(child.tag) if not inside else None
        if kind:
            blocks.append(Block(kind, child.line, path))
            _walk(child, kind, blocks, path)
        elif child.children:
            _walk(child, inside, blocks, path)
        else:
            key = child.attributes.get("angle") or child.attributes.get("rate") or child.tag
            value = Value(key, child.text.strip(), child.line, path)
            _take(value, child.attributes.get("units"), "" if key == "EPOCH" else inside, blocks)
