"""How fates and axes of a sweep look: colours by meaning, labels with units, straight or logarithmic scales."""
from __future__ import annotations

from typing import Any

import numpy as np

from ...case.lines import KeyLines
from ...case.table import Faults, Table
from ...case.units import unit_of
from ...maps.keys import value_at
from ...maps.plan import Plan
from ...orbit.result import Fate
from .. import style

# fate -> (its name in a legend, its colour)
FATES = {Fate.BOUNDED: ("bounded", style.BLUE), Fate.SPIN_UP: ("spins up", style.VERMILION), Fate.SEPARATRIX: ("on the separatrix", style.BLACK),
         Fate.EQUILIBRIUM: ("at rest", style.GREEN), Fate.UNDECIDED: ("undecided", style.YELLOW), 5: ("no case", style.GREY)}
LIGHT = 0.45  # of a colour that fills an area
LONG = 28  # letters of a key beside an axis


def light(colour: str, share: float = LIGHT) -> tuple[float, float, float]:
    """The colour on white."""
    red, green, blue = (1 - share * (1 - int(colour[i:i + 2], 16) / 255) for i in (1, 3, 5))
    return red, green, blue


def label(data: Any, name: str) -> str:
    """The name of a dimension or column with its unit."""
    attrs = data[name].attrs
    words, unit = str(attrs.get("long_name", name)), attrs.get("units", "1")
    words = words if len(words) <= LONG or name not in data.dims else ".".join(words.split(".")[-2:])
    return words if unit == "1" else f"{words} ({unit})"


def short_label(data: Any, name: str) -> str:
    """The same for a narrow place: a column by its own name."""
    unit = data[name].attrs.get("units", "1")
    return name.replace("_", " ") + ("" if unit == "1" else f" ({unit})")


def is_log(values: np.ndarray) -> bool:
    """Whether values are spread in equal ratios rather than in equal steps."""
    if len(values) < 3 or not ((values > 0).all() or (values < 0).all()):
        return False
    ratios, steps = values[1:] / values[:-1], np.diff(values)
    return bool(np.ptp(ratios) < 1e-6 * abs(ratios[0]) and np.ptp(steps) > 1e-6 * abs(steps).max())


def scale_axes(ax: Any, x: np.ndarray, y: np.ndarray | None = None) -> None:
    """Logarithmic scales where the values are."""
    for setter, values in ((ax.set_xscale, x), (ax.set_yscale, y)):
        if values is not None and is_log(values) and (values > 0).all():
            setter("log")


def own_value(plan: Plan, dimension: int) -> float | None:
    """The value that the case itself has along a dimension, in the unit of the axis."""
    axis = plan.axes[dimension]
    path = axis.key.paths[0]
    value = value_at(plan.data, path)
    table = Table(path[:-1], {path[-1]: value}, Faults(KeyLines()))
    exact = table.number(path[-1])
    return None if exact is None else float(exact / unit_of(axis.unit).size) if axis.unit else float(exact)


def fate_legend(data: Any) -> list[tuple[Any, str]]:
    """(patch, words) of every fate that occurs."""
    from matplotlib.patches import Patch
    present = [value for value in FATES if (np.asarray(data["fate"]) == value).any()]
    return [(Patch(facecolor=light(FATES[value][1]), edgecolor=FATES[value][1]), FATES[value][0]) for value in present]
