"""A run as a CCSDS attitude ephemeris message (AEM, 504.0-B-2, KVN): quaternion and angular velocity
over time.

The same run gives the same bytes: CREATION_DATE is that of the environment's SOURCE_DATE_EPOCH, seconds since
1970 (https://reproducible-builds.org/specs/source-date-epoch), and else the date of time 0, which a comment
says.

The quaternion leads from inertial space (REF_FRAME_A) to the body (REF_FRAME_B), its scalar last; the
angular velocity is along the axes of the body, deg/s. Both are those of the frame of the file, also where its
tensor is not diagonal.
"""
from __future__ import annotations

import os
import re
from datetime import UTC, datetime, timedelta
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from ...answers.simulate import Simulation
from ...case.read import Case
from ...errors import InputError, printable
from ...numbers.principal import oblique
from ..results.variables import matrix_of, turned_to_file

DIGITS = 9  # of a second
EPOCH = re.compile(r"\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}(\.\d{1,9})?")
INERTIAL, BODY = "EME2000", "SC_BODY_1"
CONJUGATE = np.array([-1.0, -1.0, -1.0, 1.0])


def epoch_of(text: str | None) -> tuple[datetime, Fraction]:
    """(whole second, rest of it) of time 0. Raises InputError."""
    if text is None:
        raise InputError("--epoch: an attitude ephemeris has dates: give that of time 0, as in --epoch "
                         "2026-01-01T00:00:00")
    if not EPOCH.fullmatch(text):
        raise InputError("--epoch: expected a date such as 2026-01-01T00:00:00 or 2026-01-01T00:00:00.5, got "
                         f"{printable(text)[:40]}")
    whole, _, rest = text.partition(".")
    try:
        return datetime.fromisoformat(whole), Fraction(f"0.{rest or 0}")
    except ValueError as error:
        raise InputError(f"--epoch {text}: {error}") from None


def _date(epoch: tuple[datetime, Fraction], t: float) -> str:
    units = round((epoch[1] + Fraction(t)) * 10**DIGITS)
    seconds, rest = divmod(units, 10**DIGITS)
    try:
        return f"{(epoch[0] + timedelta(seconds=seconds)).isoformat()}.{rest:0{DIGITS}d}"
    except OverflowError:
        raise InputError(f"--epoch: the time {t:.6g} s after it is beyond the year 9999") from None


def creation_date(epoch: tuple[datetime, Fraction]) -> tuple[str, str]:
    """(date, comment on it or "") of when the message is made, which is not that of the clock. Raises
    InputError."""
    text = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not text:
        return epoch[0].isoformat(), ("CREATION_DATE is the date of time 0, so that one run gives one "
                                      "message; SOURCE_DATE_EPOCH sets it")
    try:
        return datetime.fromtimestamp(int(text), UTC).strftime("%Y-%m-%dT%H:%M:%S"), ""
    except (ValueError, OverflowError, OSError):
        raise InputError("SOURCE_DATE_EPOCH (environment): expected whole seconds since 1970 such as "
                         f"1767225600, got {printable(text)[:40]}") from None


def message(case: Case, run: Simulation, epoch: tuple[datetime, Fraction]) -> str:
    """The message as text. The run has its attitude as quaternions."""
    dates = [_date(epoch, float(t)) for t in run.t]
    if any(second <= first for first, second in zip(dates, dates[1:])) or len(dates) < 2:
        raise InputError("an attitude ephemeris has two times or more, each later than the one before by a "
                         "nanosecond: give others by --at")
    quaternions, rates = in_the_file(case, run.state["quaternion"], run.state["omega"])
    name = re.sub(r"\s+", " ", printable(case.title)).strip() or case.name
    date, remark = creation_date(epoch)
    head = [("CREATION_DATE", date), ("ORIGINATOR", "STABILAB")]
    meta = [("OBJECT_NAME", name), ("OBJECT_ID", "UNKNOWN"), ("REF_FRAME_A", INERTIAL), ("REF_FRAME_B", BODY),
            ("TIME_SYSTEM", "TAI"), ("START_TIME", dates[0]), ("STOP_TIME", dates[-1]),
            ("ATTITUDE_TYPE", "QUATERNION/ANGVEL"), ("ANGVEL_FRAME", BODY)]
    space = "space is the inertial frame of the run; the attitude at time 0 is that of [motion], or identity"
    comments = [f"COMMENT {line}" for line in (space, *(item.words for item in case.caveats))]
    lines = [f"{date} {' '.join(f'{v:.16g}' for v in (*(q + 0.0), *(np.degrees(w) + 0.0)))}"  # no -0
             for date, q, w in zip(dates, quaternions, rates)]
    return "\n".join(["CCSDS_AEM_VERS = 2.0", *[f"COMMENT {remark}"] * bool(remark),
                      *(f"{key} = {value}" for key, value in head), "", "META_START", *comments,
                      *(f"{key} = {value}" for key, value in meta), "META_STOP", "", "DATA_START", *lines,
                      "DATA_STOP", ""])


def in_the_file(case: Case, quaternions: ArrayLike,
                rates: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Quaternions (n, 4) from body to space, scalar last, and rates (n, 3) along the principal axes as
    those of the frame of the file."""
    quaternions, rates = np.asarray(quaternions, float), np.asarray(rates, float)
    axes = oblique(case.frame)
    if axes is None:
        return quaternions, rates
    rows = matrix_of(axes)
    turned = turned_to_file("quaternion", quaternions, rows)
    start = case.blocks.get("attitude")
    if start is None or tuple(start) == (0.0, 0.0, 0.0, 1.0):  # none is given: the file's axes are space's
        turned = CONJUGATE * turned_to_file("quaternion", CONJUGATE * turned, rows)
    return turned, turned_to_file("omega", rates, rows)
