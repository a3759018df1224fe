"""A sweep before it is run: what is asked, at which points, and how these fall into chunks.

Points are of a case over ranges, lists or random samples of its numbers.

Scenes run in the outer order and states of one scene in the inner one, so that a chunk is one call of a
kernel wherever one serves. The order in which the user named the axes is restored when the parts are put
together. Chunks depend on the sweep alone, never on who computes them."""
from __future__ import annotations

import base64
import hashlib
import json
import os
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from math import prod
from typing import Any, NamedTuple

import numpy as np

from ..answers.kinds import KINDS, kind_of
from ..case.correlations import factor
from ..case.limit_options import StatedLimit, stated_limit
from ..case.read import Case, load_burning, read_all, read_text
from ..case.source import parsed, source_text
from ..case.uncertain import NORMAL, Correlation, Uncertain
from ..errors import InputError, printable
from ..numbers.units import NONE, TIME, in_si
from ..physics.coefficients import effective
from ..version import __version__
from .axes import MAX_POINTS, Axis, Key, axis_of, each_once, key_of, keys_of, si_unit
from .columns import ALL, asked_answers
from .pointed import Pointed, pointed_from


# --- Some places of a grid as a short text, for another process and for the name of a sweep
def packed(keys: np.ndarray) -> str:
    """Whole numbers that rise, as letters: their differences, compressed."""
    steps = np.diff(keys, prepend=0).astype("<i8")
    return base64.b64encode(zlib.compress(steps.tobytes(), 6)).decode("ascii")


@lru_cache(maxsize=4)  # every chunk of a plan asks for the same
def unpacked(text: str) -> np.ndarray:
    """The numbers again."""
    return np.cumsum(np.frombuffer(zlib.decompress(base64.b64decode(text)), "<i8"))


# --- Random points of the uncertain numbers of a case, each by the distribution that the case states: the
# n-th is the same whoever asks for it, and for how many. A tolerance is drawn as uniform; correlated numbers
# have a Gaussian copula (`case.correlations`)
SMALLEST = 2.0**-54  # of a draw from 0 to 1: half a step of the generator, where a normal number ends


@dataclass(frozen=True)
class Samples:
    """count points. keys: the uncertain numbers; numbers: their middles, half-widths and distributions;
    correlations: of them."""

    keys: tuple[Key, ...]
    numbers: tuple[Uncertain, ...]
    count: int
    seed: int
    correlations: tuple[Correlation, ...] = ()

    def values(self, start: int, stop: int) -> np.ndarray:
        """(stop - start, keys): points start to stop in SI units; a draw of 64 bits for each number."""
        width = len(self.keys)
        bits = np.random.PCG64(self.seed)
        bits.advance(start * width)
        unit = np.random.Generator(bits).random((stop - start, width))
        middle, half = (np.array([float(getattr(number, name)) for number in self.numbers])
                        for name in ("middle", "half"))
        out = middle + half * (2.0 * unit - 1.0)
        for column, drawn in self._shaped(unit).items():
            number = self.numbers[column]
            out[:, column] = (float(number.middle) + float(number.sigma) * drawn if number.sigma
                              else middle[column] + half[column] * (2.0 * _uniform(drawn) - 1.0))
        return out

    def _shaped(self, unit: np.ndarray) -> dict[int, np.ndarray]:
        """Normal numbers of mean 0 and deviation 1 behind the normal and the correlated columns of draws."""
        lower = self._factor
        result: dict[int, np.ndarray] = {}
        for column, number in enumerate(self.numbers):
            parts = [(n, weight) for n, weight in enumerate(lower[column][:column + 1]) if weight]
            if number.law != NORMAL and len(parts) == 1 and parts[0] == (column, 1.0):
                continue
            # sums in one order, whatever library would multiply matrices
            drawn = np.zeros(len(unit))
            for n, weight in parts:
                drawn = drawn + weight * _normal(unit[:, n])
            result[column] = drawn
        return result

    @cached_property
    def _factor(self) -> list[list[float]]:
        result = factor(self.numbers, self.correlations)
        if result is None:  # the case was read, so that the matrix of all of its numbers is one
            raise InputError("correlations: no numbers have these together")
        return result

    def unit(self, number: int) -> str:
        """The SI unit of an uncertain number; "1" where it has none."""
        return si_unit(self.keys[number].paths[0]) or "1"


def _normal(unit: np.ndarray) -> np.ndarray:
    """Normal numbers of uniform draws from 0 to 1, by the inverse of their distribution."""
    from scipy.special import ndtri
    return np.asarray(ndtri(np.clip(unit + SMALLEST, SMALLEST, 1.0 - 2 * SMALLEST)))


def _uniform(normal: np.ndarray) -> np.ndarray:
    from scipy.special import ndtr
    return np.asarray(ndtr(normal))


def samples_of(case: Case, resolved: dict[str, Key], taken: set[tuple[Any, ...]], count: int | None,
               seed: int) -> Samples | None:
    """The samples asked for over the numbers that the case gives with an uncertainty, those left out that
    vary by themselves."""
    if count is None:
        return None
    if isinstance(count, bool) or not isinstance(count, int) or not 0 < count <= MAX_POINTS:
        raise InputError(f"samples: expected at least one point and at most {MAX_POINTS:,}, "
                         f"got {count!r:.40}")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError(f"seed: expected a whole number that is not negative, got {seed!r:.40}")
    by_path = {path: key for key in resolved.values() for path in key.paths}
    numbers = tuple(item for item in case.uncertain if item.path not in taken)
    if not numbers:
        raise InputError(
            f'samples: {case.place} gives no number with an uncertainty: write one as "2000 +- 20"')
    return Samples(tuple(by_path[number.path] for number in numbers), numbers, count, seed,
                   case.correlations)


AXES = 4
RATES = ("angular_velocity", "x")  # keys of [motion] whose numbers leave the scene as it is
# of one processor that a chunk takes, roughly, so that a killed run keeps something; its most points
CHUNK_SECONDS, LARGEST = 1.0, 1 << 17
SCENE_COST = (3e-3, 3e-2)
POINTED_COST = 5e-2  # of a direction of an atlas, all answers together


class Chunk(NamedTuple):
    """Scenes [first, last) with their states [low, high), scenes outside."""

    first: int
    last: int
    low: int
    high: int

    @property
    def points(self) -> int:
        return (self.last - self.first) * (self.high - self.low)


@dataclass(frozen=True)
class Plan:
    """path, text: of the case; vary: (name, what was asked) in the user's order; samples, seed: of random
    points, None without; answers: names of `columns.ANSWERS`; limit: options of `when`, by name; listed: of a
    plane of states those places alone (`listed.packed`), in one row; follow: how long motions are followed
    that only a run decides, as it was written; pointed: of an atlas, its directions, the only dimension
    then; quick: times to a limit by runs, without a proof; burn: of thrusters that fire on a schedule, what
    is asked of `burn`, by name, as it was written; None of a torque that stays."""

    path: str
    text: str = field(repr=False)
    vary: tuple[tuple[str, Any], ...]
    samples: int | None
    seed: int
    answers: tuple[str, ...]
    limit: tuple[tuple[str, str], ...] = ()
    listed: str = field(default="", repr=False)
    follow: str | None = None
    pointed: Pointed | None = field(default=None, repr=False)
    quick: bool = False
    burn: tuple[tuple[str, str], ...] | None = None

    @cached_property
    def data(self) -> dict[str, Any]:
        """The case's TOML data, without what belongs to the file's own combinations."""
        result, _ = parsed(self.path, self.text)
        return {key: value for key, value in result.items() if key not in ("sweep", "expect")}

    @cached_property
    def case(self) -> Case:
        """The case with the numbers of the file; of a burn the craft."""
        if self.burn is not None:
            return replace(load_burning(self.text).craft, path=self.path)
        return read_text(self.path, self.text)

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """The numbers that vary, in the user's order."""
        return tuple(axis_of(key_of(self.data, name), request) for name, request in self.vary)

    @cached_property
    def sampled(self) -> Samples | None:
        """The random points, the last dimension."""
        taken = {path for axis in self.axes for path in axis.key.paths}
        return samples_of(self.case, keys_of(self.data), taken, self.samples, self.seed)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Points along every dimension, in the user's order, samples last."""
        if self.pointed is not None:
            return (len(self.pointed.points),)
        return (*(len(axis.values) for axis in self.axes), *([self.sampled.count] if self.sampled else []))

    @cached_property
    def inner(self) -> tuple[int, ...]:
        """The dimensions along which only the state varies; of a burn none, which is answered whole."""
        if self.burn is not None:
            return ()
        keys = [(axis.key,) for axis in self.axes] + ([self.sampled.keys] if self.sampled else [])
        return tuple(n for n, of in enumerate(keys)
                     if all(key.paths[0][0] == "motion" and key.paths[0][1] in RATES for key in of))

    @property
    def outer(self) -> tuple[int, ...]:
        """The dimensions along which the scene varies."""
        return tuple(n for n in range(len(self.shape)) if n not in self.inner)

    @property
    def scenes(self) -> int:
        return prod(self.shape[n] for n in self.outer)

    @property
    def states(self) -> int:
        """States of each scene."""
        return len(unpacked(self.listed)) if self.listed else prod(self.shape[n] for n in self.inner)

    @property
    def points(self) -> int:
        return self.scenes * self.states

    def places(self, low: int, high: int) -> np.ndarray:
        """Which places of the grid along the inner dimensions the states [low, high) are."""
        return unpacked(self.listed)[low:high] if self.listed else np.arange(low, high)

    @cached_property
    def stated_limit(self) -> StatedLimit | None:
        """The limit that `when` asks about."""
        return self.limit_of(self.case)

    def limit_of(self, case: Case) -> StatedLimit | None:
        """The same for a point, whose own [limits] may vary."""
        return stated_limit(case, **dict(self.limit)) if {"when", "burn_when"} & set(self.answers) else None

    @cached_property
    def longest(self) -> float | None:
        """How long motions are followed, in the time of the case; None for as long as an answer takes
        unasked."""
        if self.follow is None:
            return None
        result = float(in_si(self.follow, NONE if self.case.variables == "scaled" else TIME, "follow"))
        if not result > 0:
            raise InputError(f"follow: expected a time above zero, got {printable(self.follow)[:40]}")
        return result

    @cached_property
    def chunks(self) -> tuple[Chunk, ...]:
        """All points, in order."""
        largest = max(1, min(LARGEST, int(CHUNK_SECONDS / self.cost)))
        if self.states >= largest:
            return tuple(Chunk(n, n + 1, low, min(low + largest, self.states)) for n in range(self.scenes)
                         for low in range(0, self.states, largest))
        together = max(1, largest // self.states)
        return tuple(Chunk(n, min(n + together, self.scenes), 0, self.states)
                     for n in range(0, self.scenes, together))

    @cached_property
    def cost(self) -> float:
        """Seconds of a processor for a point, roughly."""
        if self.pointed is not None:
            return POINTED_COST
        scene = effective(self.case.scene)
        slow = not scene.plain or KINDS[kind_of(scene)].follows
        return sum(ALL[name].cost[slow] for name in self.answers) + SCENE_COST[slow] / self.states

    def as_json(self, brief: bool = False) -> str:
        """All of the plan, for another process. brief: without the folder of the case, for a file that is to
        be the same wherever it is made."""
        pointed = {} if self.pointed is None else {"pointed": self.pointed.told()}
        return json.dumps({"version": __version__,
                           "path": os.path.basename(self.path) if brief else self.path, "text": self.text,
                           "vary": self.vary, "samples": self.samples, "seed": self.seed,
                           "answers": self.answers, "limit": self.limit}
                          | pointed | {name: text for name,
                                       text in (("listed", self.listed), ("follow", self.follow),
                                                     ("quick", self.quick)) if text}
                          | ({} if self.burn is None else {"burn": self.burn}))

    @cached_property
    def digest(self) -> str:
        """A name for what is asked: parts of another question are not taken for those of this one."""
        printed = json.loads(self.as_json(brief=True)) | {"chunks": self.chunks}
        return hashlib.sha256(json.dumps(printed).encode()).hexdigest()

    @property
    def command(self) -> str:
        """A command that asks the same, without what does not change the answer."""
        import shlex
        phrases = ["stabilab", "sweep", os.path.basename(self.path)]
        phrases += [f"--vary={name}={_as_text(request)}" for name, request in self.vary]
        phrases += [f"--samples={self.samples}", f"--seed={self.seed}"] if self.samples else []
        phrases += [f"--answer={','.join(self.answers)}", *(f"--{name}={text}" for name, text in self.limit)]
        phrases += [f"--follow={self.follow}"] if self.follow else []
        return shlex.join(phrases)


def _as_text(request: str) -> str:
    return request if isinstance(request, str) else ",".join(map(repr, request))


def from_json(text: str) -> Plan:
    """The plan that another process wrote down."""
    shown = json.loads(text)
    rows = lambda name: tuple((key, value) for key, value in shown[name])
    pointed = pointed_from(shown["pointed"]) if "pointed" in shown else None
    return Plan(shown["path"], shown["text"], rows("vary"), shown["samples"], shown["seed"],
                tuple(shown["answers"]), rows("limit"), shown.get("listed", ""), shown.get("follow"), pointed,
                shown.get("quick", False), rows("burn") if "burn" in shown else None)


def split_keys(text: Sequence[str],
               expected: str = "KEY=START:STOP:COUNT or KEY=A,B,C") -> list[tuple[str, str]]:
    """(key, values) of every KEY=VALUES of a command line. expected: the form that the command takes, for
    whom it misses."""
    for word in text:
        if "=" not in word:
            raise InputError(f'--vary: expected {expected}, got "{printable(word)[:60]}"')
    # values have none, a wheel's name may
    return [(key.strip(), values.strip()) for key, _, values in (word.rpartition("=") for word in text)]


def place_and_text(question: str, case: Any) -> tuple[str, str]:
    """(path, text) of a case, or of a case file by its path. Raises InputError, in the name of what was
    asked, for anything else, and for a file with a fault, those of its [sweep] among them, though its values
    are left aside."""
    if not isinstance(case, (Case, str, os.PathLike)):
        raise InputError(
            f"{question}: expected a case, as of load(...), or the path of a case file, got {case!r:.80}")
    path, text = (case.path, case.text) if isinstance(case, Case) else (os.fspath(case), source_text(case))
    read_all(path, text)
    return path, text


def planned(case: Case | str | os.PathLike[str], vary: Mapping[str, Any] | Sequence[tuple[str, Any]],
            samples: int | None = None, seed: int = 1,
            answer: Any = None, follow: str | None = None, **limit: str | None) -> Plan:
    """A sweep whose every part is checked. Raises InputError with what is wrong."""
    path, text = place_and_text("sweep", case)
    rows = [(name, request if isinstance(request, str) else _plain(name, request)) for name,
            request in (vary.items() if isinstance(vary, Mapping) else vary)]
    plan = Plan(path, text, tuple(rows), samples, seed, asked_answers(answer),
                tuple((k, v) for k, v in limit.items() if v is not None), follow=follow)
    _judge(plan)
    return plan


def judged(plan: Plan) -> Plan:
    """The plan, once every part of it is checked. Raises InputError with what is wrong."""
    _judge(plan)
    return plan


def _plain(name: str, request: str) -> list[float]:
    try:
        return [float(value) for value in request]
    except (TypeError, ValueError):
        raise InputError(f'vary {printable(name)}: expected a text such as "0:30:31 deg/s" or numbers in a '
                         f'row, got {request!r:.60}') from None


def _judge(plan: Plan) -> None:
    case = plan.case
    if not plan.vary and plan.samples is None:
        answered = (f"; stabilab fate and the other questions answer every case of the [sweep] in {case.path}"
                    if "sweep" in parsed(plan.path, plan.text)[0] else "")
        raise InputError('nothing varies: give --vary KEY=START:STOP:COUNT, such as --vary '
                         f'"motion.angular_velocity[1]=0:30:31 deg/s", or --samples N{answered}')
    each_once(axis.key for axis in plan.axes)
    if len(plan.shape) > AXES:
        raise InputError(f"expected at most {AXES} axes, got {len(plan.shape)}")
    if plan.points > MAX_POINTS:
        raise InputError(
            f"{' x '.join(map(str, plan.shape))} are {plan.points:,} points; at most {MAX_POINTS:,} are run")
    if plan.limit and "when" not in plan.answers:
        raise InputError(f"{plan.limit[0][0]}: belongs to the answer when, which is not asked for: add it, "
                         "as in --answer fate,when")
    moving = [name for name in plan.answers if name not in ("equilibria", "verdict")]
    if moving and case.state is None:
        raise InputError(f"{case.place}: motion: expected x or angular_velocity in [motion]; "
                         f"{', '.join(moving)} need a state")
    plan.limit_of(case), plan.longest  # say what is wrong with them
