"""Any result as it shows itself: in a line, in a notebook, and as numbers for xarray and pandas."""
from __future__ import annotations

from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError
from ...numbers.principal import oblique
from ...orbit.result import Motion
from ...packages import demand
from ...physics.scene import PARTS
from ..terminal import minus
from .kinds import KINDS
from .variables import FRAMES, IN_FILE, Variables, frame_attributes, in_file

if TYPE_CHECKING:
    import pandas
    import xarray

    from ...equilibrium.result import Equilibria

MAX_ROWS = 10  # rows of a page


def variables(result: Equilibria | Motion, frame: str = "file") -> Variables:
    """Those of a result, with what limits the whole answer, and of a full tensor the principal axes, among
    the attributes. frame: as of `Shown.to_xarray`."""
    if frame not in FRAMES:
        raise InputError(f'frame: expected "file" or "principal", got {frame!r:.40}')
    out = KINDS[type(result).__name__][1](result)
    caveats = "; ".join(item.words for item in getattr(result, "caveats", ()))
    attributes = {**out.attributes, **({"caveats": caveats} if caveats else {})}
    axes = oblique(getattr(getattr(result, "case", result), "frame", None))
    if axes is None:
        return replace(out, attributes=attributes)
    turning = frame == "file" and type(result).__name__ in IN_FILE
    return replace(in_file(out, axes) if turning else out,
                   attributes=attributes | frame_attributes(axes, turning))


def short(result: Equilibria | Motion) -> str:
    """The line of a result: its kind, what it answers in a few words, and all that limits the answer."""
    name = type(result).__name__
    limits = (item.words for item in getattr(result, "caveats", ()))
    return f"{name}({'; '.join([KINDS[name][0](result), *limits])})"


def dataset(result: Equilibria | Motion, frame: str = "file") -> xarray.Dataset:
    """The numbers of a result with their dimensions, units and words."""
    demand("xarray")
    import xarray
    out = variables(result, frame)
    return xarray.Dataset(dict(out.values),
                          {name: ((name,), *coordinate) for name, coordinate in out.coordinates.items()},
                          dict(out.attributes))


def table(result: Equilibria | Motion, frame: str = "file") -> pandas.DataFrame:
    """The numbers of a result as a table; a column a component, what belongs to the whole in `attrs`."""
    demand("pandas")
    import pandas
    out = variables(result, frame)
    built = pandas.DataFrame({name: values for name, values in columns(out)}, index=_index(out))
    built.attrs = dict(out.attributes)
    return built


def columns(result: Variables) -> list[tuple[str, np.ndarray]]:
    """(name, values in one row of cells) of every component: "omega1", "omega2", ..."""
    rows = []
    for name, (dims, values, _) in result.values.items():
        array, own = np.asarray(values), dims[len(result.index):]
        if not own:
            rows.append((name, array.reshape(-1)))
            continue
        flat = array.reshape(-1, array.shape[-1] if name != "matrix" else 9)
        resolved = PARTS[name].components if name in PARTS else ()
        axes = own == ("axis",) and "axis" in result.coordinates
        letters: Any = result.coordinates["axis"][0] if axes else ()
        if len(letters) and isinstance(letters[0], str):
            names = [f"{name}_{letter}" for letter in letters]
        else:
            names = (list(resolved) if len(resolved) == flat.shape[1]
                     else [f"{name}{n + 1}" for n in range(flat.shape[1])])
        rows += [(item, flat[:, n]) for n, item in enumerate(names)]
    return rows


def _index(result: Variables) -> Any:
    """Times or axes where they are known, else numbers; several dimensions as pandas counts them."""
    import pandas
    shape = next(iter(result.values.values()))[1].shape[:len(result.index)]
    if not result.index:
        return pandas.RangeIndex(1)
    if len(result.index) > 1:
        return pandas.MultiIndex.from_product([range(size) for size in shape], names=list(result.index))
    name, = result.index
    return pandas.Index(result.coordinates[name][0] if name in result.coordinates else range(shape[0]),
                        name=name)


def html(result: Equilibria | Motion) -> str:
    """The line of a result, and its first rows; what is in it is text and never a tag."""
    out = variables(result)
    rows = columns(out)
    index = out.index[0] if len(out.index) == 1 else ""
    labels = out.coordinates[index][0] if index in out.coordinates else range(len(rows[0][1]))
    head = "".join(f"<th>{escape(name)}</th>" for name in (index, *(name for name, _ in rows)))
    number = len(rows[0][1])
    body = "".join(
        f"<tr><th>{_cell(labels[n])}</th>{''.join(f'<td>{_cell(values[n])}</td>' for _, values in rows)}</tr>"
        for n in range(min(MAX_ROWS, number)))
    more = f"<p>and {number - MAX_ROWS} more</p>" if number > MAX_ROWS else ""
    return (f"<div><p><b>{_text(short(result))}</b></p><table><thead><tr>{head}</tr></thead>"
            f"<tbody>{body}</tbody></table>{more}</div>")


def _cell(value: Any) -> str:
    return (f"{float(value) + 0.0:.6g}".replace("-", "−") if isinstance(value, (float, np.floating))
            else _text(str(value)))


def _text(text: str) -> str:
    """Words as text; the minus of a number as print has it, the hyphens of words as they are."""
    return escape(minus(text))
