"""What commands share: the cases that they are given, their motions, and their answers as text."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import Any

from ..answers.motion import Needs, motion
from ..case.limit_options import stated_tilt
from ..case.read import Case, blamed_on, load_all
from ..errors import InputError, printable
from ..numbers.units import NONE, TIME, quantity, split
from ..show.names import spare_case
from ..show.progress import each
from ..show.terminal import say
from ..show.text import headline
from ..show.units import DEG, DIGITS, SCALED, SI, Units, number, units_of
from ..streams import Progress

LONG = 1.0  # s from which the time of an answer is said beforehand


# --- The cases, times and units that a command line names
def load_cases(paths: Iterable[Path], motion: bool = False) -> list[Case]:
    """All cases and combinations of [sweep]; the faults of all files at once. motion: each must state one."""
    cases, faults = [], []
    for path in paths:
        try:
            cases.extend(read := load_all(path))
            list(map(spare_case, read))
        except InputError as error:
            faults.append(str(error))
    faults += dict.fromkeys(f"{case.path}: motion: expected x or angular_velocity in [motion]; this command "
                            f"needs a state"
                            for case in cases if motion and case.state is None)
    if faults:
        raise InputError("\n".join(faults))
    return cases


def one_by_one(cases: Sequence[Case]) -> Iterable[Case]:
    """The cases, told one by one to a terminal where they take their time."""
    return cases if len(cases) < 2 else each(cases, lambda case: printable(case.name))


def expected(case: Case, seconds: float) -> None:
    """Say how long an answer of a case will take, where that is long."""
    if seconds > LONG:
        say(f"{printable(case.name)}: so many digits take about {seconds:.2g} s")


def answers_of(cases: Sequence[Case], ask: Callable[[Case], Any]) -> list[tuple[Case, Any]]:
    """(case, ask(case)) of each, faults blamed on the file of the case."""
    rows = []
    for case in one_by_one(cases):
        with blamed_on(case):
            rows.append((case, ask(case)))
    return rows


def units_asked(cases: Sequence[Case], request: str | None, **options: str | None) -> list[Units]:
    """The units in which each case is told. options: angles and rates as typed, of which a message says that
    they came without a unit, where answers are in degrees: 1 may mean a degree."""
    systems = [units_of(case, request) for case in cases]
    if not options or systems[0].name in (SI.name, SCALED.name):
        return systems
    for option, text in options.items():
        result = split((text or "").rpartition("=")[2].strip())
        if result is None or result[1]:
            continue
        angular = option in ("tilt", "within", "nutation", "nutation_below")
        unit, degrees = ("rad", "deg") if angular else ("rad/s", "deg/s")
        with suppress(InputError):  # of a number that none can be: told where it is used
            taken = number(float(quantity(result[0], NONE)[0]) * DEG.rates[1], DIGITS)
            say(f'--{option.replace("_", "-")}: {result[0]} alone is in {unit}: {taken} {degrees}; for '
                f'degrees write "{result[0]} {degrees}"')
    return systems


def time_asked(text: str | None, case: Case, option: str = "follow") -> float | None:
    """A time of the command line: a number in the time of the case, or one with a unit where that is s."""
    if text is None:
        return None
    time = _time(text, case, option)
    if time <= 0:
        raise InputError(f"--{option}: expected a time above zero, got {text.strip()[:60]}")
    return float(time)


def times_asked(case: Case, at: Sequence[str] | None) -> list[float]:
    """The times asked for, in order; without any, 201 over the span of the case."""
    if not at:
        start, end = _span(case)
        return [start + (end - start) * i / 200 for i in range(200)] + [end]
    return sorted({float(time) for time in _each(at, case)})


def exact_times_asked(case: Case, at: Sequence[str] | None) -> list[Fraction]:
    """The times asked for as rationals, as they are written; without any, 201 over the span of the case."""
    if not at:
        start, end = (Fraction(repr(t)) for t in _span(case))
        return [start + (end - start) * i / 200 for i in range(201)]
    return sorted(set(_each(at, case)))


def _span(case: Case) -> tuple[float, ...]:
    if case.span is None:
        raise InputError(f"{case.path}: motion: no span; give --at T1,T2,... or span (or tau) in [motion]")
    return case.span


def _each(at: Sequence[str], case: Case) -> list[Fraction]:
    """The times between the commas of every --at, exact as they are written."""
    return [_time(word, case, "at") for item in at for word in item.split(",")]


def say_repeated(case: Case, at: Sequence[str] | None):
    """A message where --at names a time more than once: it is shown once."""
    supplied = _each(at or (), case)
    twice = sorted({time for time in supplied if supplied.count(time) > 1})
    if twice:
        say(f"--at: named more than once and shown once: {', '.join(f'{float(time):.6g}' for time in twice)}")


def _time(text: str, case: Case, option: str) -> Fraction:
    """A time in that of the case, or with a unit where that is s. Raises InputError that names the option."""
    try:
        return quantity(text.strip(), NONE if case.variables == "scaled" else TIME)[0]
    except InputError as error:
        raise InputError(f"--{option}: {error}") from None


# --- Percentiles over the uncertain numbers of a case
def drawn(samples: int | None, seed: int, workers: int | None, timed: Callable[[Case], bool], largest: bool,
          each: bool = False, **limits: str | None) -> Callable[[Case], Any] | None:
    """What finds them, None where no samples are asked for. timed: whether those of the time to the limit are
    asked of a case; largest: whether those of its largest rate are; each: of each thruster alone."""
    if samples is None:
        return None
    from ..maps.percentiles import of_case_drawn, of_each_thruster
    if each:
        return lambda case: of_each_thruster(case, samples, seed, workers)
    return lambda case: of_case_drawn(case, samples, seed, workers, timed(case), largest, **limits)


# --- The motion of a case, with what a tilt of its torque and uncertain numbers do to it
def motion_of(case, needs=Needs.ALL, follow=None, proof=False):
    """The motion of a case. needs: what is printed of it; follow: how long a run follows it, as typed; proof:
    it is enclosed."""
    long = time_asked(follow, case)
    with blamed_on(case), Progress() as progress:
        text = lambda t, steps, left: progress(
            f"{printable(case.name)}: followed to {t:.4g} {case.scene.time_unit}, {steps} steps")
        result = motion(case.scene, case.start, case.span, needs, case.exact_state, long,
                       text if progress.wanted else None, proof)
        return headline.judged(case, result)


def tilted(case, motion, angle: str | None):
    """The motion with what a tilt of its torque does, where asked for or given: a second of work."""
    declared = (case.limits is not None
              or any(thruster.stuck and thruster.misalignment for thruster in case.thrusters))
    if angle is None and not declared:
        return motion
    from ..answers.when import with_tilt
    with blamed_on(case):
        return with_tilt(case, motion, None if angle is None else stated_tilt(angle))
