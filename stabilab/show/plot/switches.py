"""The rates of a burn over time: across the switches of its thrusters, and after the last closing."""
from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.stuck.burn import Burned, with_latest
from ...answers.stuck.chain import Chain, links_of
from ...errors import InputError
from .. import limiting, style
from ..text.stuck import burn_headline
from ..units import SHORT, Units, number, units_of, with_unit
from . import canvas
from .over_time import IN_FILE, LIMIT, components, file_axes, limit_marks
from .path import path
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FIRES: dict[str, Any] = {"facecolor": style.PALE, "alpha": 0.55, "linewidth": 0}
CLOSING: dict[str, Any] = {"color": style.BLACK, "linestyle": "-", "linewidth": 1.6}
SWITCH: dict[str, Any] = {"color": style.GREY, "linestyle": "-", "linewidth": 0.8}
CLOSE_BY: dict[str, Any] = {"color": style.VERMILION, "linestyle": "-.", "linewidth": 1.6}
FOR_EVER: dict[str, Any] = {"color": style.BLACK, "linestyle": (0, (1, 2)), "linewidth": 1.3}
AFTER = 0.4  # of the time up to the last closing: how long what follows is shown at least
PERIODS = 3  # of what follows: as many are shown where they take no longer than the burn
MARKED = 60  # switches at most that are ruled; of more the thrusters fire too often to be told apart


def rates(item: Subject, ax: Axes | None = None, units: str | None = None,
          size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the rates of a burn (a Subject with `burning`) along the principal axes, and return the axes.

    Grey areas: while a thruster fires; black: the last closing; dotted: the largest |omega| for ever after
    it. Where the case states limits, these too, and of |omega| the latest closing time that keeps it; limits
    about other axes of a file have the rates along those. Raises InputError as `stabilab.burn` does, and for
    a span that does not begin at 0.
    """
    if item.burning is None or item.burned is None:
        raise InputError("plot: expected a burn: a case whose thrusters fire on a schedule")
    chain, limits, answer = Chain(item.burning), item.burning.craft.limits, item.burned
    if limits is not None and limits.rate is not None and chain.quiet:
        answer = with_latest(answer, item.burning, Fraction(limits.rate))
    scale, end = measures(item, units), _end(item, answer)
    t, omega = _run(chain, answer, end)
    turned = file_axes(item)
    omega = omega if turned is None else omega @ turned.T
    unit, per_time = scale.time(end)
    with canvas.on(ax, size) as target:
        names = scale.names if turned is None else IN_FILE
        rows, _ = components(target, t, omega, names, scale, (unit, per_time))
        rows += _switches(target, answer, end, per_time, unit)
        system = scale.system or units_of(item.burning.craft)
        rows += _levels(target, answer, end, system, per_time)
        if limits is not None and answer.latest is None:
            rows += limit_marks(target, limits.rates if limits.rate is None else limits.rate, None, t, omega,
                                (unit, per_time), scale.rate)
        if turned is not None:
            target.set_ylabel(with_unit("rate, axes of the file", scale.rate[0]))
        line = burn_headline(answer, system)
        return canvas.explained(target, list(dict(rows).items()) if legend else [], ax is None,
                                item.burning.craft.heading, line,
                                notes=limiting.notes(answer.caveats, line, system))


def _end(item: Subject, answer: Burned) -> float:
    """s: the end that was asked for; else some time after the last closing, and past the end of the span."""
    if item.asked:
        if item.asked[0] != 0:
            raise InputError("plot time: a burn is followed from 0 on: give the end alone")
        return item.asked[-1]
    closed, craft = answer.closed, item.burning.craft  # type: ignore[union-attr]
    period = closed.motion.period or 0.0
    few = min(PERIODS * period, closed.time) if np.isfinite(period) else 0.0
    end = closed.time + max(AFTER * closed.time, few)
    return max(end or 1.0, craft.span[-1] if craft.span else 0.0)


def whole(item: Subject) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and rates (n, 3) along the principal axes of a burn, from its start past its last closing.
    Raises InputError as `rates` does."""
    burning: Any = item.burning
    answer: Any = item.burned
    return _run(Chain(burning), answer, _end(item, answer))


def _run(chain: Chain, answer: Burned, end: float) -> tuple[np.ndarray, np.ndarray]:
    t, omega = zip(*_followed(chain, answer, end))
    return np.concatenate(t), np.concatenate(omega)


def _followed(chain: Chain, answer: Burned, end: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """(times (n,), rates (n, 3)) of each motion in turn, up to the end."""
    for link in links_of(chain):
        begin, length = float(link.begin), min(float(link.length), end - float(link.begin))
        if length > 0:
            t, states = path(subject(link.scene, link.start.tolist()), 0.0, length)
            yield begin + t, states
    if end > answer.closed.time:
        t, states = path(subject(chain.base, answer.closed.rates), 0.0, end - answer.closed.time)
        yield answer.closed.time + t, states


def _switches(ax: Axes, answer: Burned, end: float, per_time: float, unit: str) -> list[tuple[str, Any]]:
    """When thrusters fire, and the last closing; rows of the legend."""
    closed, rows = answer.closed.time, []
    ends = [*(switch.time for switch in answer.switches[1:]), closed]
    for switch, after in zip(answer.switches, ends):
        if switch.firing:
            ax.axvspan(per_time * switch.time, per_time * min(after, end), zorder=0, **FIRES)
            rows.append((f"firing: {', '.join(dict.fromkeys(_names(answer)))}", FIRES))
    for switch in answer.switches[1:] if len(answer.switches) <= MARKED else ():
        ax.axvline(per_time * switch.time, zorder=1, **SWITCH)
        rows.append(("switch", SWITCH))
    if closed <= end:
        ax.axvline(per_time * closed, zorder=1.5, **CLOSING)
        rows.append((f"last closing, {number(per_time * closed, SHORT)} {unit}", CLOSING))
    return rows


def _names(answer: Burned) -> list[str]:
    return [name for switch in answer.switches for name in switch.firing]


def _levels(ax: Axes, answer: Burned, end: float, units: Units, per_time: float) -> list[tuple[str, Any]]:
    """The largest rate for ever after, the limit and by when to close; rows of the legend."""
    per_rate = units.rates[1]
    rows: list[tuple[str, Any]] = []
    if (largest := answer.closed.largest_rate) is not None:
        low = per_time * min(answer.closed.time, end)
        ax.plot([low, per_time * end], [per_rate * largest] * 2, **FOR_EVER)
        rows.append((f"then never above {units.rate(largest, side=1)}", FOR_EVER))
    needed = answer.latest
    if needed is None:
        return rows
    ax.axhline(per_rate * needed.limit, **LIMIT)
    rows.append((f"limit of |ω|, {units.rate(needed.limit, SHORT)}", LIMIT))
    if 0 < needed.low <= end:
        ax.axvline(per_time * needed.low, zorder=1.5, **CLOSE_BY)
        rows.append((f"close by {units.time(needed.low, SHORT, side=-1)} to stay below it", CLOSE_BY))
    return rows
