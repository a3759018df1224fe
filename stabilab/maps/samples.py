"""Random points of the box that a case's uncertain numbers span: the n-th is the same whoever asks for it, and for how many."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..case.read import Case
from ..case.table import Uncertain
from ..errors import InputError
from .axes import MOST, si_unit
from .keys import Key


@dataclass(frozen=True)
class Samples:
    """count points, uniform in the box. keys: the uncertain numbers; numbers: their middles and half-widths."""

    keys: tuple[Key, ...]
    numbers: tuple[Uncertain, ...]
    count: int
    seed: int

    def values(self, start: int, stop: int) -> np.ndarray:
        """(stop - start, keys): points start to stop in SI units; a draw of 64 bits for each number."""
        width = len(self.keys)
        bits = np.random.PCG64(self.seed)
        bits.advance(start * width)
        unit = np.random.Generator(bits).random((stop - start, width))
        middle, half = (np.array([float(getattr(one, name)) for one in self.numbers]) for name in ("middle", "half"))
        return middle + half * (2.0 * unit - 1.0)

    def unit(self, number: int) -> str:
        """The SI unit of an uncertain number; "1" where it has none."""
        return si_unit(self.keys[number].paths[0]) or "1"


def samples_of(case: Case, known: dict[str, Key], taken: set[tuple[Any, ...]], count: int | None, seed: int) -> Samples | None:
    """The samples asked for over the numbers that the case gives with an uncertainty, those left out that vary by themselves."""
    if count is None:
        return None
    if isinstance(count, bool) or not isinstance(count, int) or not 0 < count <= MOST:
        raise InputError(f"samples: expected at least one point and at most {MOST:,}, got {count!r:.40}")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError(f"seed: expected a whole number that is not negative, got {seed!r:.40}")
    by_path = {path: key for key in known.values() for path in key.paths}
    numbers = tuple(one for one in case.uncertain if one.path not in taken)
    if not numbers:
        raise InputError(f'samples: {case.place} gives no number with an uncertainty: write one as "2000 +- 20"')
    return Samples(tuple(by_path[one.path] for one in numbers), numbers, count, seed)
