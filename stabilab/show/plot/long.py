"""The turns of a motion of many, followed where a picture needs them: some in each stretch of its time, and
whole ones at its start, at a moment that matters, and at its end."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..space.drawing import near_part
from ..turns.band import (
    APIECE,
    BAND,
    FEW,
    MANY,
    SPARE,
    Grid,
    Long,
    band_of,
    bold_turns,
    name_of,
    often,
    one_turn,
    outside,
    rows_of,
)
from ..turns.moment import moment
from .path import along, path
from .subject import Subject

TURNS, FINE = 8, 48  # in a stretch of time that are looked at, at most; places on each
BOLD = 96  # places on a turn that is drawn as a line
MOST = 4000  # of a part of the motion that does not go round
TRIED, CUT = 6, 8  # how often, and by how much, places get denser until they show each turn
PROBES, PROBED, SPAN = 9, 120, 0.002  # where turns are measured, by how many places, over which part of all
# of what a band fills: exact extremes so near those of its samples are of the same time
EXACT, ROUNDING = 0.02, 1e-12

Clock = Callable[[float], tuple[str, float]]


def long(item: Subject, t: np.ndarray, omega: np.ndarray, clock: Clock) -> tuple[Long, np.ndarray] | None:
    """(what is drawn of a motion of many turns, the places (n, 3) from which that is made); None of one of
    few. t (n,), omega (n, 3): the motion, as densely as a picture shows it."""
    if not often(omega.tolist()) > MANY:
        return None
    low, high = float(t[0]), float(t[-1])
    turn = _turn_lengths(item, t, omega)
    length = np.diff(t) / np.array([turn(at) for at in (t[1:] + t[:-1]) / 2])
    number = int(round(float(length.sum())))
    edges = _edges(t, omega, rows_of(number))
    windows = [(a, min(high, a + min(max(b - a, APIECE * turn(a)), TURNS * turn(a))))
               for a, b in zip(edges[:-1], edges[1:])]
    matters = moment(item.motion, item.assumed_time)
    bold = bold_turns(low, high, turn, clock(max(abs(low), abs(high))), matters)
    places = []
    times = [np.linspace(a, b, 1 + max(FINE, round(FINE * (b - a) / turn(a)))) for a, b in windows]
    times += [np.linspace(a, b, round(BOLD * SPARE)) for a, b, *_ in bold]
    followed, states = along(item, np.unique(np.concatenate(times)), t[::10])
    for row in times:
        at = states[(followed >= row[0]) & (followed <= row[-1])]
        places.append(at if len(at) > 2 else np.empty((0, 3)))
    whole = [n for n, row in enumerate(places[:len(windows)]) if len(row)]
    sampled = min(number, int(round(sum((b - a) / turn(a) for a, b in windows))))
    skins, goes = band_of([places[n].tolist() for n in whole], name_of(number, sampled))
    band = exactly(skins, item, low, high, number)
    lines = [(one_turn(row.tolist(), backwards), text)
             for row, (*_, backwards, text) in zip(places[len(windows):], bold) if len(row)]
    for first, end in outside(goes) if len(t) >= FEW * number else ():
        part = omega[(t >= edges[whole[first]]) & (t <= edges[whole[end - 1] + 1])]
        lines.append((part[::max(1, len(part) // MOST)].tolist(), ""))
    return Long(band, tuple(lines), number, sampled), np.concatenate(places)


def exactly(band: tuple[Grid, ...], item: Subject, low: float, high: float,
            number: int) -> tuple[Grid, ...]:
    """The band with its outermost places where the motion's exact extremes are, of each rate of which these
    are known over the time of the picture; where that is all three, nothing of it is of samples."""
    pairs, over = item.motion.extremes, item.span
    covered = item.motion.for_all_time or (over is not None and over[0] <= low
                                           and abs(over[-1] - high) <= EXACT * abs(high - low))
    if not band or pairs is None or not covered or item.motion.extremes_side:
        return band
    points = [np.array(grid.points) for grid in band]
    every, resolved = np.concatenate(points), 0
    for n, (least, greatest) in enumerate(pairs):
        first, last = float(every[:, n].min()), float(every[:, n].max())
        room = EXACT * (last - first) + ROUNDING * max(abs(first), abs(last))
        if abs(least - first) <= room and abs(greatest - last) <= room:
            resolved += 1
            for rows in points:
                share = (rows[:, n] - first) / (last - first) if last > first else np.zeros(len(rows))
                rows[:, n] = least + share * (greatest - least)
    name = f"{BAND} of {number} turns" if resolved == 3 else band[0].name
    return tuple(replace(grid, name=name, points=rows.tolist()) for grid, rows in zip(band, points))


def until(item: Subject, end: float, clock: Clock) -> tuple[Long, list[list[float]]] | None:
    """The same of a motion from time 0 to an end, as far as it is drawn, where it has a band."""
    t, omega = path(item, 0.0, end)
    near = len(near_part(t.tolist(), omega.tolist(), item.motion, item.assumed_time))
    result = long(item, t[:near], omega[:near], clock)
    return None if result is None or not result[0].skins else (result[0], result[1].tolist())


def _edges(t: np.ndarray, omega: np.ndarray, rows: int) -> np.ndarray:
    """(rows + 1,) times between stretches: even ones, but denser where least and greatest change."""
    first = np.linspace(0, len(t) - 1, 4 * rows + 1).astype(int)
    ends = np.concatenate([np.minimum.reduceat(omega, first[:-1]), np.maximum.reduceat(omega, first[:-1])],
                          axis=1)
    swing = np.maximum(np.ptp(omega, axis=0), np.finfo(float).tiny)
    moved = np.linalg.norm(np.diff(ends, axis=0) / np.tile(swing, 2), axis=1)
    steps = np.concatenate([[0.0], moved])
    smooth = np.convolve(np.pad(steps, 4, mode="edge"), np.full(9, 1 / 9), mode="valid")
    share = smooth / (smooth.sum() or 1.0) + 1 / len(smooth)
    along_it = np.concatenate([[0.0], np.cumsum(share)]) / share.sum()
    return np.interp(np.linspace(0, 1, rows + 1), along_it, t[first])


def _turn_lengths(item: Subject, t: np.ndarray, omega: np.ndarray) -> Callable[[float], float]:
    """How long a turn is at a time; measured by ever denser places until these show each turn."""
    low, high = float(t[0]), float(t[-1])
    length = SPAN * (high - low)
    counts = len(t) / max(1, often(omega.tolist()))
    starts = np.linspace(low, high - length, PROBES)
    lengths = np.full(PROBES, (high - low) / max(1, often(omega.tolist())))
    if counts >= FEW:  # the motion itself is dense enough
        edges = np.linspace(0, len(t) - 1, PROBES + 1).astype(int)
        for n, (a, b) in enumerate(zip(edges[:-1], edges[1:])):
            if (turns := often(omega[a:b + 1].tolist())) > 1:
                lengths[n] = (t[b] - t[a]) / turns
            starts[n] = (t[a] + t[b]) / 2
        return lambda at: float(np.interp(at, starts, lengths))
    sizes = [length / CUT**n for n in range(TRIED)]
    rows = [[np.linspace(a, a + size, PROBED) for a in starts] for size in sizes]
    every = np.unique(np.concatenate([row for tried in rows for row in tried]))
    followed, states = along(item, every, t[::10])  # in one run, which takes far longer than its places do
    others = ~np.isin(followed, every)  # where each time costs many digits
    for size, tried in zip(sizes, rows):
        parts = [states[(followed >= row[0]) & (followed <= row[-1]) & (others | np.isin(followed, row))]
                 for row in tried]
        counted = [often(part.tolist()) if len(part) > 2 else 0 for part in parts]
        for n, count in enumerate(counted):
            if 1 < count <= PROBED / FEW:
                lengths[n] = size / count
        if max(counted) <= PROBED / FEW:
            break
    return lambda at: float(np.interp(at, starts, lengths))
