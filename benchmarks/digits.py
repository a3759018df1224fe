"""Numbers of one motion to many digits, beside arb's own elliptic integral where there is one."""
from __future__ import annotations

import time
from functools import partial
from pathlib import Path

from stabilab import attitude, extremes, load, period, when

from .rows import Row

CASES = Path(__file__).parents[1] / "cases"
FREE, TORQUE = CASES / "torque-free-body.toml", CASES / "minor-axis-100.toml"
DIGITS = (15, 50, 100, 1000, 10_000)
ASKED = {"period-free": (period, FREE), "extremes-free": (extremes, FREE), "attitude-free": (attitude, FREE),
         "period": (period, TORQUE), "extremes": (extremes, TORQUE)}


def measurements(small=False):
    if small:
        return [partial(to_digits, key, 15) for key in ASKED] + [partial(limit, 15)]
    return [partial(to_digits, key, digits) for key in ASKED for digits in DIGITS] + [
        partial(limit, 300)]


def to_digits(key: str, digits: int) -> Row:
    """Processor time of one question, the case read before; of a period of a free body beside arb's complete
    elliptic integral of the first kind at as many digits."""
    ask, path = ASKED[key]
    case = load(path)
    what = f"{ask.__name__} to {digits:,} digits, {path.stem}"
    ours = _time(lambda: ask(case, digits=digits))
    if key != "period-free":
        return Row(f"digits-{key}-{digits}", what, ours)
    theirs = _time(partial(_elliptic, digits))
    return Row(f"digits-{key}-{digits}", what, ours, "each", theirs, "arb's elliptic integral alone",
               theirs / ours, theirs / ours, theirs / ours)


def _elliptic(digits: int) -> None:
    import flint
    before, flint.ctx.prec = flint.ctx.prec, int(3.33 * digits) + 20
    try:
        flint.acb(flint.arb(1) / 3).elliptic_k()
    finally:
        flint.ctx.prec = before


def limit(digits: int) -> Row:
    """The time to a limit under a torque, an integral of another kind."""
    case = load(CASES / "minor-axis-100.toml")
    spinning = (1.375, 4.625, 3.375)
    return Row(f"digits-when-{digits}", f"the time to a limit to {digits:,} digits, torque on an axis",
               _time(lambda: when(case, spinning, component=("3", 10), digits=digits)))


def _time(call) -> float:
    """Processor time, s: the least of seven after one to warm up, or of two where it is long."""
    at = time.process_time()
    call()
    first = time.process_time() - at
    return min(first, *(_once(call) for _ in range(0 if first > 2 else 1 if first > 0.2 else 7)), first)


def _once(call) -> float:
    """Of as many calls as take some milliseconds, for a clock of ticks."""
    at, count = time.process_time(), 0
    while time.process_time() - at < 0.02:
        call()
        count += 1
    return (time.process_time() - at) / count
