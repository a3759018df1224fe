"""Percentiles of what a case does over its uncertain numbers: of the time to a limit, of the largest rate,
with their sampling error.

Each draw of the numbers is answered as a point of a sweep (`maps.plan`): seeded, in parallel, the same bytes
for any number of workers. Times are those of runs, as the sampling error is far larger than theirs.

Bounds of a quantile are order statistics. Of n draws the number below the quantile q of the fraction p is
binomial, whatever the distribution, so that with the least r where P(B(n, p) < r) exceeds 2.5 % and the least
s where P(B(n, p) < s) reaches 97.5 % the draws r and s in order of size enclose q with 95 % confidence
(David and Nagaraja, Order Statistics, 7.1). Bounds of a share are those of Clopper and Pearson. A draw that
never reaches the limit has the time infinity, and one that is not known counts at both ends."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ..answers.caveats import of_case
from ..answers.stuck.burn import TORQUE_STAYS
from ..answers.stuck.chain import Chain
from ..case.given import Amount, Given, Span, Start, written
from ..case.read import Burning, Case, fires_on_schedule, load_burning, read_text, text_of_case
from ..case.source import parsed
from ..case.uncertain import TOLERANCE
from ..case.write import text_of
from ..errors import Caveat, InputError, Kind, printable, without
from ..numbers.units import RATE, TIME, in_si
from ..orbit.result import OUTCOMES, Fate
from ..reasons import BROAD, Quantity, Sentence
from ..representation import Answer, Compared
from .plan import Plan, judged, place_and_text
from .run import run

if TYPE_CHECKING:
    from ..case.limit_options import StatedLimit

PERCENTS = (5, 50, 95)
CONFIDENCE = 0.95
AS_UNIFORM = Sentence("tolerance-drawn-as-uniform", "{keys}: a tolerance says nothing of how often each "
                      "value occurs; samples draw it as uniform")
LEFT_OUT = Sentence("draws-left-out",
                    "draws that make no case and are left out: {number} of {draws}; {fault}")
OPEN_DRAWS = Sentence("draws-not-known", "draws of which the {what} is not known: {number}; they count at "
                      "both ends of the bounds")
OF_NONE = Sentence("draws-of-none", "nothing is drawn of {thrusters}: no number of theirs is uncertain")
FROM_DRAWS = Sentence(
    "from-draws", "percentiles over the uncertain numbers by draws ({number}, seed {seed}), with bounds that "
    "hold with 95 % confidence; samples, no proof")


@dataclass(frozen=True)
class Fraction95:
    """Of `number` draws `count` do something; low, high: bounds of its probability with 95 % confidence,
    draws that are not known counted at either end."""

    count: int
    number: int
    low: float
    high: float

    @property
    def fraction(self) -> float:
        return self.count / self.number


@dataclass(frozen=True)
class Quantile:
    """The value below which a fraction of the draws lies, in SI units (of a scaled case in its variables).

    percent: that fraction; low, high: between which the draw of that rank lies, which are the two ends of its
    time, inf where it never comes to it; least, greatest: bounds of the quantile of all draws with 95 %
    confidence, None where there are too few draws for one.
    """

    percent: int
    low: float
    high: float
    least: float | None
    greatest: float | None


@dataclass(frozen=True, eq=False)
class Distribution(Compared):
    """What draws have: low, high: (n,) ends of each, in the order of the draws; unit: SI, "" in a scaled
    case; quantiles: of `PERCENTS`."""

    low: np.ndarray
    high: np.ndarray
    unit: str
    quantiles: tuple[Quantile, ...]

    def histogram(self, bins: int | None = None) -> tuple[np.ndarray, list[int], int]:
        """(edges (k + 1,), counts of the draws between them, how many are infinite or not known, those whose
        ends are far apart among them). bins: None for twice the cube root of the number of draws (Rice's
        rule), 60 at most."""
        finite = np.isfinite(self.high)
        finite[finite] = self.high[finite] - self.low[finite] <= BROAD * np.abs(self.high[finite])
        values = 0.5 * (self.low[finite] + self.high[finite])
        if not len(values):
            return np.array([0.0, 1.0]), [0], len(self.high)
        number = bins or max(1, min(60, math.ceil(2 * len(values) ** (1 / 3))))
        counts, edges = np.histogram(values, bins=number)
        return edges, counts.tolist(), len(self.high) - len(values)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Percentiles(Compared, Answer):
    """What draws of the uncertain numbers of a case do.

    name: of the case; number: of draws that make a case; draws: that were made; seed: of them; limit: that
    of the time, None without one; reached: name ("reached", "never", "unknown") -> share of the draws, of
    the limit; outcomes: word -> share, of the motion; time: to the limit, s; largest: |omega| at the most
    over all time, rad/s, inf where it grows without end; each None, or empty, where it was not asked. Of
    thrusters that fire on a schedule the outcome is that after the last closing; closing: the latest closing
    time that keeps |omega| below `below` (rad/s) for ever, s, inf where none is too late, 0 where all are.
    thruster: that alone is stuck, "" where those are that the case says. confidence: of all bounds; caveats:
    what limits them.
    """

    name: str
    number: int
    draws: int
    seed: int
    limit: StatedLimit | None = None
    reached: dict[str, Fraction95] = field(default_factory=dict)
    outcomes: dict[str, Fraction95] = field(default_factory=dict)
    time: Distribution | None = None
    largest: Distribution | None = None
    below: float | None = None
    closing: Distribution | None = None
    thruster: str = ""
    confidence: float = CONFIDENCE


def percentiles(case: Given | Burning, samples: int = 1000, seed: int = 1, *, rate: Amount | None = None,
                component: str | None = None, energy: Amount | None = None, tilt: str | None = None,
                until: Amount | None = None, below: Amount | None = None, nutation: str | None = None,
                nutation_below: str | None = None, largest: bool = True, workers: int | None = None,
                state: Start | None = None, span: Span | None = None, stop: Amount | None = None,
                closing_below: Amount | None = None, thruster: str | None = None) -> Percentiles:
    """Percentiles over the uncertain numbers of a case: of the time to a limit, of the largest rate, and the
    shares of outcomes.

    case: in any form, or a scene with `state` and `span`. samples, seed: as many draws. One limit as of
    `stabilab.when`; where none is given, that of [limits], if there is one. largest: whether outcomes and the
    largest rate are found too. workers: processes, None for one a core where that pays; the bytes are the
    same. stop, closing_below: of a case whose thrusters fire on a schedule (what `load_burning` gives, or
    its path), s and rad/s: all close then; also percentiles of the latest closing time that keeps |omega|
    below that for ever. thruster: the name of the one that is stuck, alone. Raises InputError for a case
    without uncertain numbers or without a motion.
    """
    as_text = lambda value: (" = ".join(map(str, value)) if isinstance(value, (tuple, list)) else str(value))
    options = {name: as_text(value) for name, value in (
        ("rate", rate), ("component", component), ("energy", energy), ("tilt", tilt), ("until", until),
        ("below", below), ("nutation", nutation), ("nutation_below", nutation_below)) if value is not None}
    raw = isinstance(case, (str, PathLike, Mapping)) and state is None and span is None
    if isinstance(case, Burning) or raw and fires_on_schedule(case):  # type: ignore[arg-type]
        burning = case if isinstance(case, Burning) else load_burning(case)
        last, for_ever = (None if value is None else as_text(value) for value in (stop, closing_below))
        return of_burn_drawn(burning, samples, seed, workers,
                             bool(options) or burning.craft.limits is not None, largest, last, for_ever,
                             **options)
    if stop is not None or closing_below is not None:
        raise InputError("percentiles: stop and closing_below are of thrusters that fire on a schedule: give "
                         "the path of such a case, or what stabilab.load_burning gives")
    source = written(case, state, span)
    path, text = place_and_text("percentiles", source)
    loaded = source if isinstance(source, Case) else None
    if loaded is not None and loaded.variant:
        text = text_of_case(loaded)
    text = text if thruster is None else alone_stuck(path, text, thruster)
    plan = Plan(path, text, (), samples, seed, (), quick=True)
    timed = bool(options) or plan.case.limits is not None
    if not timed and not largest:
        raise InputError('percentiles: nothing to find: give a limit such as rate="30 deg/s", or '
                         "largest=True")
    return replace(of_plan(plan, timed, largest, workers, options), thruster=thruster or "")


def alone_stuck(path: str, text: str, name: str) -> str:
    """The text of a case of which this thruster alone is stuck. Raises InputError where it has none of this
    name."""
    case, data = read_text(path, text), parsed(path, text)[0]
    names = [item.name for item in case.thrusters]
    if name not in names:
        raise InputError(f"thruster: the case has no thruster {printable(name)}; it has "
                         f"{', '.join(map(printable, names)) or 'none'}")
    data["thrusters"] = [{**table, "stuck": other == name} for table, other in zip(data["thrusters"], names)]
    return text_of(data)


def of_case_drawn(case: Case, samples: int, seed: int, workers: int | None, timed: bool, largest: bool,
                  **limit: str | None) -> Percentiles:
    """The same of a case that is loaded, its combination of [sweep] included. timed, largest: what is asked;
    limit: options of `when`."""
    text = text_of_case(case) if case.variant or not case.text else case.text
    result = of_plan(Plan(case.path, text, (), samples, seed, (), quick=True), timed, largest, workers,
                     {name: value for name, value in limit.items() if value is not None})
    return replace(result, name=case.name)


def of_each_thruster(case: Case, samples: int, seed: int, workers: int | None) -> tuple[Percentiles, ...]:
    """The same of each thruster of a loaded case alone, of which something is uncertain. Raises InputError
    where nothing is of any."""
    text = text_of_case(case)
    texts = {item.name: alone_stuck(case.path, text, item.name) for item in case.thrusters}
    loose = {name: own for name, own in texts.items() if read_text(case.path, own).uncertain} or texts
    certain = tuple(name for name in texts if name not in loose)
    more = (Caveat(Kind.SAMPLES, OF_NONE(thrusters=certain)),) if certain else ()
    result = []
    for name, own in loose.items():
        found = of_plan(Plan(case.path, own, (), samples, seed, (), quick=True), case.limits is not None,
                        True, workers, {})
        result.append(replace(found, name=f"{case.name}: {name}", thruster=name,
                              caveats=(*found.caveats, *more)))
    return tuple(result)


def of_burn_drawn(burning: Any, samples: int, seed: int, workers: int | None, timed: bool, largest: bool,
                  stop: str | None = None, below_for_ever: str | None = None,
                  **limit: str | None) -> Percentiles:
    """The same of thrusters that fire on a schedule, whose forces and other numbers are drawn. stop,
    below_for_ever: `stop` and `below` of `burn`, whose latest closing time is found where it is given."""
    case = burning.craft
    options = tuple((name, value) for name, value in (("stop", stop), ("below", below_for_ever))
                    if value is not None)
    chain = Chain(burning, None if stop is None else in_si(stop, TIME, "stop"))
    if below_for_ever is not None and not chain.quiet:
        raise InputError(TORQUE_STAYS)
    plan = Plan(case.path, case.text, (), samples, seed, (), quick=True, burn=options)
    result = of_plan(plan, timed, largest, workers,
                     {name: value for name, value in limit.items() if value is not None})
    return replace(result, name=case.name)


def of_plan(plan: Plan, timed: bool, largest: bool, workers: int | None,
            limit: dict[str, str]) -> Percentiles:
    """The percentiles of a plan of draws."""
    closing = dict(plan.burn or ()).get("below")
    wanted = ({"fate": largest, "when": timed, "largest": largest} if plan.burn is None
              else {"burn": largest, "burn_when": timed, "closing": closing})
    answers = [name for name, asked in wanted.items() if asked]
    plan = judged(replace(plan, answers=tuple(answers), limit=tuple(limit.items())))
    with run(plan, None, workers) as swept:
        records, fault = swept.records, swept.fault
    kept = records[records["valid"] == 1]
    case, scaled = plan.case, plan.case.variables == "scaled"
    own = without(of_case(case), Kind.UNCERTAIN, Kind.TOLERANCE, Kind.DISTRIBUTION)
    result = Percentiles(name=case.name, number=len(kept), draws=len(records), seed=plan.seed,
                         limit=plan.stated_limit,
                         caveats=(*own, *_of_draws(plan, len(kept), len(records), fault)))
    if timed:
        low, high = kept["when_low"], kept["when_high"]
        open_ = np.isnan(high)
        never = np.isinf(low)
        counts = {"reached": ~open_ & ~never, "never": never, "unknown": open_}
        ends = low, np.where(open_, math.inf, high)
        result = replace(result, time=distribution(*ends, "" if scaled else "s"),
                         reached=_shares(counts, open_), caveats=(*result.caveats, *_open(open_, "time")))
    if largest:
        fates = kept["fate"]
        undecided = fates == Fate.UNDECIDED
        words = {OUTCOMES[fate].word: fates == fate for fate in Fate}
        size = kept["largest"]
        unknown = np.isnan(size)
        result = replace(result, outcomes=_shares(words, undecided),
                         largest=distribution(np.where(unknown, kept["size"], size),
                                              np.where(unknown, math.inf, size), "" if scaled else "rad/s"),
                         caveats=(*result.caveats, *_open(unknown, "largest rate")))
    if closing is not None:
        low, high = kept["closing_low"], kept["closing_high"]
        open_ = np.isnan(high)
        result = replace(result, below=float(in_si(closing, RATE, "below")),
                         closing=distribution(low, np.where(open_, math.inf, high), "s"),
                         caveats=(*result.caveats, *_open(open_, "latest closing time")))
    return result


def _of_draws(plan: Plan, number: int, draws: int, fault: str) -> list[Caveat]:
    """That they are draws, what was drawn as uniform, and how many were left out."""
    rows = [Caveat(Kind.SAMPLES, FROM_DRAWS(number=number, seed=Quantity(plan.seed, digits=20)))]
    sampled: Any = plan.sampled
    loose = tuple(item.key for item in sampled.numbers if item.law == TOLERANCE)
    rows += [Caveat(Kind.DISTRIBUTION, AS_UNIFORM(keys=loose))] if loose else []
    rows += [Caveat(Kind.SAMPLES, LEFT_OUT(number=draws - number, draws=draws, fault=printable(fault)))
             ] if number < draws else []
    return rows


def _open(unknown: np.ndarray, what: str) -> list[Caveat]:
    number = int(unknown.sum())
    return [Caveat(Kind.SAMPLES, OPEN_DRAWS(number=number, what=what))] if number else []


def _shares(counts: dict[str, np.ndarray], unknown: np.ndarray) -> dict[str, Fraction95]:
    """The share of each kind that occurs; unknown: draws that may be of any kind."""
    number, open_ = len(unknown), int(unknown.sum())
    out = {}
    for name, of in counts.items():
        count = int(of.sum())
        if count:
            own = bool((of & unknown).any())
            out[name] = Fraction95(count, number, binomial(0 if own else count, number)[0],
                                   binomial(count if own else count + open_, number)[1])
    return out


def binomial(count: int, number: int) -> tuple[float, float]:
    """Bounds of a probability with 95 % confidence, of `count` of `number` (Clopper and Pearson 1934)."""
    from scipy.special import betaincinv
    rest = (1 - CONFIDENCE) / 2
    low = float(betaincinv(count, number - count + 1, rest)) if count else 0.0
    high = float(betaincinv(count + 1, number - count, 1 - rest)) if count < number else 1.0
    return low, high


def ranks(number: int, fraction: float) -> tuple[int, int]:
    """(r, s) from 1 on: the draws of these ranks enclose the quantile with 95 % confidence; 0 and number + 1
    where no draw does."""
    from scipy.special import bdtr
    rest = (1 - CONFIDENCE) / 2
    below = np.asarray(bdtr(np.arange(number + 1, dtype=float), number, fraction))  # P(B <= k), k = 0 ... n
    low = int(np.searchsorted(below, rest, side="right"))
    high = int(np.searchsorted(below, 1 - rest, side="left")) + 1
    return low, min(high, number + 1)


def distribution(low: np.ndarray, high: np.ndarray, unit: str) -> Distribution:
    """Of draws between two ends each."""
    number = len(low)
    lows, highs = np.sort(low), np.sort(high)
    rows = []
    for percent in PERCENTS:
        rank = max(1, math.ceil(number * percent / 100))
        first, last = ranks(number, percent / 100)
        rows.append(Quantile(percent, float(lows[rank - 1]), float(highs[rank - 1]),
                             float(lows[first - 1]) if first else None,
                             float(highs[last - 1]) if last <= number else None))
    return Distribution(low, high, unit, tuple(rows))
