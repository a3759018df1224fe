"""A histogram of draws of the uncertain numbers: of the time to the limit, else of the largest rate."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...case.given import Given
from ...errors import InputError
from ...maps.percentiles import AS_UNIFORM, LEFT_OUT, of_burn_drawn, of_case_drawn
from .. import style
from ..text.percentiles import drawn
from ..units import SHORT, number
from . import canvas
from . import subject as subjects
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...maps.percentiles import Percentiles

DRAWS, SEED = 500, 1
NOTED = (LEFT_OUT.code, AS_UNIFORM.code)  # caveats that stand below the picture
BAR: dict[str, Any] = {"color": style.VIOLET, "alpha": 0.55}
MEDIAN: dict[str, Any] = {"color": style.BLACK, "linewidth": 1.4}
ENDS: dict[str, Any] = {"color": style.BLACK, "linewidth": 1.0, "linestyle": "--"}
BOUNDS: dict[str, Any] = {"facecolor": style.GREY, "alpha": 0.3, "linewidth": 0}


def _spread(result: Percentiles) -> Any:
    """The distribution that is drawn."""
    return result.largest if result.time is None else result.time


def draws_of(item: Subject, samples: int, seed: int, workers: int | None, largest: bool) -> Percentiles:
    """What draws of its uncertain numbers do: the time to its limit, where it has one, and the largest rate
    where that is asked for."""
    timed = item.case.limits is not None  # type: ignore[union-attr]
    if item.burning is not None:
        return of_burn_drawn(item.burning, samples, seed, workers, timed, largest)
    return of_case_drawn(item.case, samples, seed, workers, timed, largest)  # type: ignore[arg-type]


def is_known(result: Percentiles) -> bool:
    """Whether some draw has a value to be drawn."""
    return _spread(result).histogram()[2] < result.number


def histogram(case: Given | Subject, ax: Axes | None = None, units: str | None = None,
              size: tuple[float, float] | None = None, legend: bool = True, samples: int = DRAWS,
              seed: int = SEED) -> Axes:
    """Draw how often draws of the uncertain numbers reach the limit of the case after which time, and return
    the axes; without a limit how large their largest rates are, of a burn during it and after it.

    samples, seed: of the draws. Lines: 5 %, median and 95 % of all draws, with their 95 % bounds shaded;
    draws that never come there, or whose rate grows without end, stand in the title. Raises InputError where
    the case has no uncertain number or no motion, or no draw has a value.
    """
    item = subject(case)
    subjects.check("histogram", item)
    scale = measures(item, units)
    timed = item.case.limits is not None
    result = item.draws or draws_of(item, samples, seed, None, not timed)
    spread: Any = _spread(result)
    edges, counts, beyond = spread.histogram()
    if not is_known(result):
        what = "time" if timed else "largest rate"
        raise InputError(f"{item.path}: histogram: no draw has a {what} that is known and finite"
                         + ("" if timed else "; a limit in [limits] has a time to it"))
    unit, per = scale.time(float(edges[-1])) if timed else scale.rate
    with canvas.on(ax, size) as target:
        target.bar(per * edges[:-1], counts, width=per * (edges[1:] - edges[:-1]), align="edge", **BAR)
        ends = [f"{quantile.percent} %" for quantile in spread.quantiles
                if quantile.percent != 50 and quantile.high < float("inf")]
        for quantile in spread.quantiles:
            look = MEDIAN if quantile.percent == 50 else ENDS
            if quantile.high < float("inf"):
                for end in {quantile.low, quantile.high}:  # one, or both where they are apart
                    target.axvline(per * end, **look)
                low, high = quantile.least, quantile.greatest
                if low is not None and high is not None and high < float("inf"):
                    target.axvspan(per * low, per * high, **BOUNDS)
        name = "time to the limit" if timed else "largest rate |ω|"
        target.set_xlabel(f"{name} ({unit})" if unit else name)
        target.set_ylabel("draws")
        rows = [("median", MEDIAN), (" and ".join(ends), ENDS), ("95 % bounds of each", BOUNDS)]
        rows = [(name, look) for name, look in rows if name]
        other = "never reach it, or are not known" if timed else "grow without end, or are not known"
        text = (f"{drawn(result.number)} of the uncertain numbers, seed {result.seed}; samples, no proof"
                + f"; {beyond:,} {other} ({number(100 * beyond / result.number, SHORT)} %)" * bool(beyond))
        heading = item.heading if item.burning is None else item.burning.craft.heading
        return canvas.explained(target, rows if legend else [], ax is None, heading, text,
                                *(caveat.words for caveat in result.caveats if caveat.reason.code in NOTED))
