"""A CCSDS attitude parameter message (APM, 504.0-B-1 and 504.0-B-2, KVN or XML) as a case.

By annex F of 504.0-B-2 the quaternion, the Euler angles and the angular velocity lead from frame A to frame
B, M_BA takes components in A to those in B, and rates are those of B relative to A. Version 1 says by A2B or
B2A which of its two frames is the first. Its products of inertia are entries of the tensor ("a negative
double integral"), those of version 2 positive integrals: the tensor has -IXY.

Spin with nutation (annex F5) is the motion of a body that is symmetric about the z axis of its frame: the
axis turns about the angular momentum H at the rate phi', the body about the axis at psi', so that with the
moments A, A, C and the nutation angle nu

    omega = phi' h + psi' z,  h = H/|H| = (sin nu cos p, -sin nu sin p, cos nu),  phi' = |H|/A,
    psi' = (A/C - 1) phi' cos nu.

SPIN_ANGLE_VEL is psi', NUTATION_PER is 2 pi/phi'. One of the two says |H|; the other must agree with it.
Version 1 defines neither: there the spin may also be omega_z, and the period that in the body, 2 pi/|psi'|.
"""
from __future__ import annotations

import math
import re
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, printable
from ...numbers.units import pi
from ..write import exact_text
from .ccsds import AGAIN, EULER, INERTIA, MANEUVER, QUATERNION, RATE, SPIN, Block, Message, Value, message
from .imported import Craft
from .parts import cosine, full, is_positive, of_quaternion, solved, turn

BODY = re.compile(r"(SC_BODY|BODY_FRAME|INSTRUMENT|STAR_?TRACKER|SENSOR|ACTUATOR|ACC|AST|CSS|DSS|ESA|"
                  r"GYRO(_FRAME)?|IMU(_FRAME)?|MTA|RW|SA|TAM)(_?[A-Z0-9]+)?")
INERTIAL = re.compile(r"(ICRF|GCRF|EME2000|J2000|B1950|MOD|TOD|TEME|ALIGN)([_-]?[A-Z0-9]+)?|[A-Z]+_INERTIAL")
EARTH = re.compile(r"(ITRF|EFG|GRC|TDR|WGS84|GTOD|UTOD|FIXED_EARTH)([_-]?[A-Z0-9]+)?")
ORBIT = re.compile(r"(LVLH|QSW|RIC|RSW|RTN|TNW|NTW|NSW|VNC|VVLH|SEZ|EQW|PQW)(_ROTATING)?")
EARTH_RATE = Fraction("7.2921150e-5")  # rad/s (IERS Conventions 2010, table 1.1)
AGREES = Fraction(1, 100)  # of periods that a message states beside a spin
ALIKE = Fraction(1, 100)  # of |C - A|: how far moments across the axis of a symmetric body may differ
AXES = {"X": "1", "Y": "2", "Z": "3"}
RELATIVE = ("SPIN_ANGLE_VEL is the rate about the axis relative to the plane of the axis and the angular "
            "momentum, the period that of the axis about the angular momentum")
TOTAL = "SPIN_ANGLE_VEL is the component of the angular velocity, the period"
INSTEAD = "give the angular velocity (ANGVEL_X, ANGVEL_Y, ANGVEL_Z), or write [motion] in the case"


class Unknown(Exception):
    """Why the rates in the body's frame, relative to inertial space, are not known."""


class Frames(NamedTuple):
    """From frame `first` to frame `second`, in the direction of the block."""

    first: str
    second: str

    @property
    def body(self) -> str:
        """The one that is at rest in the spacecraft."""
        return self.second if BODY.fullmatch(self.second) else self.first

    @property
    def other(self) -> str:
        """The one that is not."""
        return self.first if self.body == self.second else self.second


def read(text: str, path: Path, body: None = None) -> Craft:
    """What the message says. Raises InputError where it has no inertia, or is none."""
    item = message(text, path)
    craft = Craft(item.text("OBJECT_NAME") or "spacecraft")
    tensor, frame = _inertia(item, craft, path)
    rows = [list(row) for row in tensor]
    diagonal = not any(rows[i][j] for i in range(3) for j in range(3) if i != j)
    written = [[_decimal(v) for v in row] for row in rows]
    craft.inertia = [written[i][i] for i in range(3)] if diagonal else written
    attitudes = _attitudes(item)
    try:
        _motion(item, craft, tensor, frame, attitudes)
    except Unknown as error:
        craft.caveats.append(f"no motion: {error}; write [motion] angular_velocity relative to inertial "
                             "space, in the frame of the inertia")
    _attitude(craft, attitudes, frame, diagonal)
    for n, block in enumerate(item.all(MANEUVER), 1):
        _maneuver(craft, block, f"maneuver {n}", frame)
    epoch = item.text("EPOCH")
    if epoch:
        craft.said.append(f"time 0 is the epoch {epoch}")
    return craft


def _decimal(value: Fraction) -> str:
    return str(exact_text(value))


def _number(value: Value) -> Fraction:
    return Fraction(value.text)


# --- Inertia
def _inertia(item: Message, craft: Craft, path: Path) -> tuple[np.ndarray, str]:
    """The tensor, kg m^2, and the frame it is in ("" where the message does not say)."""
    blocks = item.all(INERTIA)
    if not blocks:
        keys = "I11, I22, I33, I12, I13, I23" if item.version == 1 else "IXX, IYY, IZZ, IXY, IXZ, IYZ"
        raise InputError(f"{printable(str(path))}:1: this attitude parameter message has no inertia, and "
                         f"without it no motion can be found: add {keys} in kg*m**2"
                         + ("" if item.version == 1 else " between INERTIA_START and INERTIA_STOP"))
    block = blocks[0]
    craft.omitted += ["a second block with inertia"] * (len(blocks) > 1)
    moments = [_number(block.needed(f"I{n}{n}", f"I{a}{a}")) for n, a in zip("123", "XYZ")]
    products = []
    for old, new in (("I12", "IXY"), ("I13", "IXZ"), ("I23", "IYZ")):
        value = block.needed(old, new)
        products.append(_number(value) * (-1 if value.key == new else 1))
    tensor = full(*moments, *products)
    if not is_positive(tensor):
        raise block.fault("inertia: no body has this tensor, one of its principal moments is not positive: "
                          f"correct {', '.join(block.values)}")
    if any(products):
        convention = ("the products are entries of the tensor, as version 1 has "
                      "them" if item.version == 1 else
                      "the products are positive integrals, so that the tensor has -IXY (504.0-B-2, annex "
                      "F6)")
        craft.said.append(convention)
    frame = block.value("INERTIA_REF_FRAME")
    if frame and not BODY.fullmatch(frame.text.upper()):
        raise frame.fault(f"expected a frame of the spacecraft such as SC_BODY_1, got {frame.text}: give the "
                          "inertia in the body's frame")
    return tensor, frame.text.upper() if frame else ""


# --- Frames and attitude
def _frames(block: Block, prefix: str, version: int) -> Frames:
    first, second = (block.needed(f"{prefix}_FRAME_{end}", f"REF_FRAME_{end}") for end in "AB")
    for value in (first, second):
        _known(value)
    if bool(BODY.fullmatch(first.text.upper())) == bool(BODY.fullmatch(second.text.upper())):
        raise second.fault(f"expected one frame of the spacecraft and one that is not, got {first.text} and "
                           f"{second.text}")
    frames = Frames(first.text.upper(), second.text.upper())
    direction = block.value(f"{prefix}_DIR")
    if direction is None:
        return frames
    if direction.text.upper() not in ("A2B", "B2A"):
        raise direction.fault(f"expected A2B or B2A, got {direction.text}")
    return frames if direction.text.upper() == "A2B" else Frames(*frames[::-1])


def _known(value: Value) -> str:
    """The name of a frame; a fault where it is none that this reader knows."""
    name = value.text.upper()
    if not any(kind.fullmatch(name) for kind in (BODY, INERTIAL, EARTH, ORBIT)):
        raise value.fault(f"unknown frame {value.text}: expected a frame of the spacecraft (SC_BODY_1), an "
                          "inertial one (ICRF, EME2000), of the Earth (ITRF2000) or of the orbit (LVLH)")
    return name


def _attitudes(item: Message) -> list[tuple[Frames, np.ndarray]]:
    """(frames, what turns components of the first to the second) of every attitude of the message."""
    result = [(_frames(block, "Q", item.version), of_quaternion(*_quaternion(block)))
              for block in item.all(QUATERNION)]
    for block in item.all(EULER):
        if block.value("ANGLE_1", "X_ANGLE", "Y_ANGLE", "Z_ANGLE"):
            angles, sequence = _euler(block, "ANGLE_{}", "{}_ANGLE")
            result.append((_frames(block, "EULER", item.version), turn(angles, sequence)))
    for block in item.all(SPIN):
        alpha, delta, sigma = (_number(block.needed(f"SPIN_{key}")) for key in ("ALPHA", "DELTA", "ANGLE"))
        frames = _frames(block, "SPIN", item.version)
        result.append((Frames(frames.other, frames.body), turn((alpha + 90, 90 - delta, sigma), "313")))
    return result


def _quaternion(block: Block) -> tuple[Fraction, list[Fraction]]:
    vector = [_number(block.needed(key)) for key in ("Q1", "Q2", "Q3")]
    scalar = _number(block.needed("QC"))
    if not (scalar or any(vector)):
        raise block.needed("QC").fault("a quaternion of zeros is no attitude: give Q1, Q2, Q3, QC of length "
                                       "1")
    return scalar, vector


def _euler(block: Block, new: str, old: str) -> tuple[list[Fraction], str]:
    """Three angles or their rates in the order of the sequence, and this in digits."""
    value = block.needed("EULER_ROT_SEQ")
    sequence = "".join(AXES.get(letter, letter) for letter in value.text.upper())
    if not re.fullmatch(r"[123]{3}", sequence) or sequence[0] == sequence[1] or sequence[1] == sequence[2]:
        raise value.fault("expected three axes such as ZXZ or 321, none twice in succession, got "
                          f"{value.text}")
    numbers = []
    for n, digit in enumerate(sequence, 1):
        key = old.format("XYZ"[int(digit) - 1]) + AGAIN * (digit in sequence[:n - 1])
        numbers.append(_number(block.needed(new.format(n), key)))
    for key, second in block.values.items():
        if key.endswith(AGAIN) and sequence.count(str("XYZ".index(key[0]) + 1)) < 2:
            raise second.fault(f"given twice in this block, whose sequence is {value.text}: keep one")
    return numbers, sequence


def _between(attitudes: Sequence[tuple[Frames, np.ndarray]], frames: Frames, why: str) -> np.ndarray:
    """What turns components of the frame outside to the body's."""
    for item, matrix in attitudes:
        if {*item} == {*frames}:
            return matrix if item.second == frames.body else matrix.T
    raise Unknown(f"the message has no attitude between {frames.other} and {frames.body}, {why}")


def _attitude(craft: Craft, attitudes: Sequence[tuple[Frames, np.ndarray]], frame: str,
              diagonal: bool) -> None:
    """The attitude of the case, 3-1-2 angles, where the message has one relative to inertial space."""
    for frames, matrix in attitudes:
        if INERTIAL.fullmatch(frames.other) and frame in ("", frames.body):
            if not diagonal:
                craft.omitted.append(f"the attitude relative to {frames.other}: a case has one along "
                                     "principal axes alone")
                return
            rotation = (matrix if frames.second == frames.body else matrix.T).T.astype(float)  # body to space
            psi = math.atan2(rotation[2][1], math.hypot(rotation[2][0], rotation[2][2]))
            phi = math.atan2(-rotation[2][0], rotation[2][2])
            theta = math.atan2(-rotation[0][1], rotation[1][1])
            craft.attitude = [f"{v:.17g}" for v in (psi + 0.0, phi + 0.0, theta + 0.0)]
            return
    if attitudes:
        craft.omitted.append("the attitude: it is not relative to an inertial frame"
                             if not any(INERTIAL.fullmatch(f.other) for f, _ in attitudes) else
                             f"the attitude: it is not that of the frame of the inertia, {frame}")


# --- Angular velocity
def _motion(item: Message, craft: Craft, tensor: np.ndarray, frame: str,
            attitudes: Sequence[tuple[Frames, np.ndarray]]) -> None:
    """The rates of the craft, deg/s, in the frame of the inertia, relative to inertial space."""
    for kind, rates_of in ((RATE, _stated), (QUATERNION, _of_quaternion_rate), (EULER, _of_euler_rate),
                           (SPIN, _of_spin)):
        for block in item.all(kind):
            result = rates_of(block, item, craft, tensor, attitudes)
            if result is None:
                continue
            frames, rates = result
            if frame and frames.body != frame:
                raise Unknown(f"the rates are those of the frame {frames.body}, the inertia is in the frame "
                              f"{frame}, and the message does not say how one lies in the other")
            if ORBIT.fullmatch(frames.other):
                raise Unknown(f"the rates are relative to the orbit frame {frames.other}, and the message "
                              "has no orbit")
            if EARTH.fullmatch(frames.other):
                own = _attitudes(Message(item.version, [block]))
                to_body = _between([*own, *attitudes], frames,
                                   "with which the Earth's rotation would be added")
                rates = rates + to_body @ np.array([Fraction(0), Fraction(0), EARTH_RATE * 180 / pi()])
                craft.said.append(f"the Earth's rotation is added to rates relative to {frames.other}")
            craft.rate, craft.rate_unit = [_rate(v) for v in rates], "deg/s"
            craft.said.append(f"the rates are those of the block {kind}")
            craft.omitted += [f"the rates of the block {other}: those of the block {kind} are read"
                              for other in (QUATERNION, EULER, SPIN)
                              if other != kind and any(map(_has_rates, item.all(other)))]
            return
    raise Unknown("the message has no angular velocity, no rates and no spin")


def _has_rates(block: Block) -> bool:
    return any(key.endswith(("_DOT", "_RATE", "_VEL")) for key in block.values)


def _rate(value: Fraction) -> str:
    return repr(float(value)) if Fraction(repr(float(value))) == value else f"{float(value):.15g}"


def _turned(frames: Frames, of_second: np.ndarray, to_second: np.ndarray) -> np.ndarray:
    """The rates of the body from those of the second frame relative to the first, along the second's axes."""
    if frames.body == frames.second:
        return of_second
    return -(to_second.T @ of_second)


def _stated(block: Block, item: Message, craft: Craft, tensor: np.ndarray, attitudes: Any) -> Any:
    """ANGVEL_X, ANGVEL_Y, ANGVEL_Z of version 2."""
    frames, along = _frames(block, "REF", item.version), block.needed("ANGVEL_FRAME")
    rates = np.array([_number(block.needed(f"ANGVEL_{axis}")) for axis in "XYZ"])
    return frames, _along_body(rates, frames, _known(along), along, attitudes)


def _along_body(rates: np.ndarray, frames: Frames, along: str, value: Value, attitudes: Any) -> np.ndarray:
    """Components, in one of the two frames, of the rate of the second relative to the first, as the
    body's."""
    if along not in frames:
        raise value.fault(f"expected one of the frames {frames.first} and {frames.second}, got {value.text}")
    if along != frames.body:
        rates = _between(attitudes, frames, "in which the rates are given") @ rates
    return rates if frames.body == frames.second else -rates


def _of_quaternion_rate(block: Block, item: Message, craft: Craft, tensor: np.ndarray, attitudes: Any) -> Any:
    """2 q* dq/dt, of any length of q."""
    if block.value("Q1_DOT", "Q2_DOT", "Q3_DOT", "QC_DOT") is None:
        return None
    w, v = _quaternion(block)
    dv = [_number(block.needed(f"Q{n}_DOT")) for n in "123"]
    dw, length = _number(block.needed("QC_DOT")), w * w + sum(x * x for x in v)
    rates = np.array([2 * (w * dv[i] - dw * v[i] - (v[(i + 1) % 3] * dv[(i + 2) % 3]
                                                  - v[(i + 2) % 3] * dv[(i + 1) % 3])) / length * 180 / pi()
                      for i in range(3)])
    frames = _frames(block, "Q", item.version)
    return frames, _turned(frames, rates, of_quaternion(w, v))


def _of_euler_rate(block: Block, item: Message, craft: Craft, tensor: np.ndarray, attitudes: Any) -> Any:
    """Rates of angles (version 2), or components along the axes of RATE_FRAME (version 1)."""
    frames = _frames(block, "EULER", item.version)
    if block.value("ANGLE_1_DOT", "ANGLE_2_DOT", "ANGLE_3_DOT"):
        angles, sequence = _euler(block, "ANGLE_{}", "{}_ANGLE")
        speeds, _ = _euler(block, "ANGLE_{}_DOT", "{}_RATE")
        result = np.array([Fraction(0)] * 3)
        for n, (speed, axis) in enumerate(zip(speeds, sequence)):
            unit = np.array([Fraction(int(axis) == i) for i in (1, 2, 3)])
            result = result + speed * (turn(angles[n + 1:], sequence[n + 1:]) @ unit)
        return frames, _turned(frames, result, turn(angles, sequence))
    if block.value("X_RATE", "Y_RATE", "Z_RATE") is None:
        return None
    if twice := [key.removesuffix(AGAIN) for key in block.values if key.endswith("_RATE" + AGAIN)]:
        raise Unknown(f"it gives {twice[0]} twice, which are no components of an angular velocity")
    rates = np.array([_number(block.needed(f"{axis}_RATE")) for axis in "XYZ"])
    if block.value("X_ANGLE", "Y_ANGLE", "Z_ANGLE"):  # of its own angles first, then of other blocks
        attitudes = [(frames, turn(*_euler(block, "ANGLE_{}", "{}_ANGLE"))), *attitudes]
    along = block.needed("RATE_FRAME")
    name = block.text(along.text.upper()) or along.text
    craft.said.append("X_RATE, Y_RATE and Z_RATE count as components of the angular velocity of the frame to "
                      "which EULER_DIR leads relative to the other, along the axes of RATE_FRAME")
    return frames, _along_body(rates, frames, name.upper(), along, attitudes)


# --- Spin and nutation
def _of_spin(block: Block, item: Message, craft: Craft, tensor: np.ndarray, attitudes: Any) -> Any:
    frames = _frames(block, "SPIN", item.version)
    frames = Frames(frames.other, frames.body)
    spin = _number(block.needed("SPIN_ANGLE_VEL"))
    momentum = block.value("MOMENTUM_ALPHA", "MOMENTUM_DELTA", "NUTATION_VEL")
    nutation = block.value("NUTATION", "NUTATION_PER", "NUTATION_PHASE")
    craft.said.append(f"the spin axis is the z axis of {frames.body}")
    if momentum is None and (nutation is None or not _number(block.needed("NUTATION"))):
        return frames, np.array([Fraction(0), Fraction(0), spin])
    if momentum is not None:
        direction, period = _momentum(block)
        named = block.needed("NUTATION_VEL")
    else:
        angle, phase = _number(block.needed("NUTATION")), _number(block.needed("NUTATION_PHASE"))
        across = cosine(angle - 90)
        direction = np.array([across * cosine(phase), -across * cosine(phase - 90), cosine(angle)])
        named = block.needed("NUTATION_PER")
        period = _number(named)
    if period <= 0:
        raise named.fault("expected a positive number: a free body's axis goes round its angular momentum "
                          "forwards")
    size = _momentum_size(block, tensor, spin, direction, period, named, item.version, craft)
    return frames, solved(tensor, size * direction)


def _momentum(block: Block) -> tuple[np.ndarray, Fraction]:
    """(direction of the angular momentum in the body's frame, nutation period in s)."""
    alpha, delta = (_number(block.needed(f"MOMENTUM_{key}")) for key in ("ALPHA", "DELTA"))
    right, up, phase = (_number(block.needed(f"SPIN_{key}")) for key in ("ALPHA", "DELTA", "ANGLE"))
    level = cosine(delta)
    outside = np.array([level * cosine(alpha), level * cosine(alpha - 90), cosine(delta - 90)])
    speed = _number(block.needed("NUTATION_VEL"))
    return turn((right + 90, 90 - up, phase), "313") @ outside, 360 / speed if speed else Fraction(0)


def _momentum_size(block: Block, tensor: np.ndarray, spin: Fraction, direction: np.ndarray, period: Fraction,
                   named: Value, version: int, craft: Craft) -> Fraction:
    """|H|, kg m^2 deg/s, of the free motion with this spin, whose nutation period must be that of the
    message."""
    first, second, along = (tensor[i][i] for i in range(3))
    across = (first + second) / 2
    products = max(abs(tensor[i][j]) for i, j in ((0, 1), (0, 2), (1, 2)))
    uneven = max(abs(first - second) / 2, products)
    if uneven > ALIKE * abs(along - across):
        raise block.fault("spin: nutation at a constant angle is a motion of a body that is symmetric about "
                          f"the z axis of its frame, and this one is not (moments {_six(first)}, "
                          f"{_six(second)}, {_six(along)}, products up to {_six(products)} kg m^2): "
                          f"{INSTEAD}")
    level = direction[2]
    readings = [(RELATIVE, spin * across * along / ((across - along) * level)
                 if level and across != along else Fraction(0), False)]
    if version == 1 and level:
        readings += [(f"{TOTAL} {words}", spin * along / level, in_body)
                     for words, in_body in (("that of the axis about the angular momentum", False),
                                            ("that in the body", True))]
    wanted = []
    for words, size, in_body in readings:
        if size <= 0:
            continue
        rate = size / across if not in_body else abs((across / along - 1) * size / across * level)
        own = 360 / rate
        if abs(own - period) <= AGREES * period:
            craft.said.append(f"spin and nutation: {words}")
            return size
        wanted.append(_six(own))
    allowed = (f"with these moments and this spin it is {' or '.join(wanted)} s" if wanted else
               "with these moments the axis of a free body nutates at no rate beside a spin of this sign")
    raise named.fault(f"a nutation period of {_six(period)} s does not agree with SPIN_ANGLE_VEL "
                      f"{_six(spin)} deg/s: {allowed}; {INSTEAD}")


def _six(value: Fraction) -> str:
    return f"{float(value):.6g}"


# --- Maneuvers
def _maneuver(craft: Craft, block: Block, name: str, frame: str) -> None:
    torque = [block.needed(f"MAN_TOR_{n}", f"MAN_TOR_{axis}").text for n, axis in zip("123", "XYZ")]
    begins, lasts = block.needed("MAN_EPOCH_START").text, block.needed("MAN_DURATION").text
    along = _known(block.needed("MAN_REF_FRAME"))
    text = f"{name}: torque [{', '.join(torque)}] N m along {along} for {lasts} s from {begins}"
    if not BODY.fullmatch(along) or frame and along != frame:
        craft.omitted.append(f"{text}; a torque that is not fixed in the frame of the inertia")
        return
    craft.torques.append({"name": name, "torque": [_decimal(Fraction(v)) for v in torque],
                          "caveat": f"{text} does not act in this case: it is the motion before"})
    craft.said.append(f'{text} does not act; --stuck "{name}" lets it act for ever')
