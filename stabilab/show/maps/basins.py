"""Basins in words, as CSV, JSON and a data set of xarray; and the public question.

It says what share of the plane each has, how far its boundary was followed and how rough it is. The data
set has the states asked, the cells and the boundary."""
from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import of_case
from ...case.given import Given, Span, Start, written
from ...errors import printable
from ...maps.basins import (
    BOUNDED,
    DEPTH,
    NO_AXIS,
    UNDECIDED,
    Basins,
    Mesh,
    basins,
    dimension,
    label_of,
    leaves,
)
from ...maps.columns import ANSWERS, CAVEATS, LEVELS, record
from ...maps.plan import from_json
from .. import limiting
from ..axes import axes_of
from ..data import as_json, csv_lines
from ..text import headline
from ..units import number, units_of, with_unit
from .shades import limits_of
from .sweep import checked, column_in, finished, origin, write

if TYPE_CHECKING:
    import xarray

BASIN_SCHEMA = "stabilab.basin/1"
SMOOTH = 0.1  # of the dimension: less than this above 1 is called smooth where the uncertainty allows


def basin_name(result: Basins, label: int) -> str:
    """What motions of a basin do."""
    named = {BOUNDED: "bounded", UNDECIDED: "undecided",
             NO_AXIS: "spin-up about an axis between equal moments"}
    return named.get(label) or f"spin-up about {axes_of(result.plan.case).signed(abs(label), label)}"


def text(result: Basins) -> str:
    """The answer first, then the boundary, its dimension, and what was asked."""
    mesh = result.mesh
    lines = [f"{printable(result.plan.case.name)}: {_answer(result)}"]
    lines += [f"  {line}" for line in (*_boundary(result), _known(result))]
    full = _grid(mesh)
    lines.append(
        f"  {len(mesh.keys):,} states computed, of {full[0] * full[1]:,} of the grid of finest cells "
        f"({full[0]:,} x {full[1]:,})")
    lines += limiting.lines(limits_of(result.plan.case, result.records), units_of(result.plan.case))
    if mesh.full:
        lines.append(
            "  refinement ended before the depth asked for: more than the largest number of states would be "
            "needed; take a smaller depth or plane")
    return limiting.ahead(of_case(result.plan.case), "\n".join(lines))


def _grid(mesh: Mesh) -> tuple[int, int]:
    """How many states along each axis a grid of finest cells has."""
    return (mesh.cells[0] << mesh.depth) + 1, (mesh.cells[1] << mesh.depth) + 1


def _answer(result: Basins) -> str:
    parts = [f"{_percent(fraction, result.blur)} {basin_name(result, label)}"
             for label, fraction in result.shares.items()]
    if len(parts) == 1:
        return f"one basin in this plane: all of it {basin_name(result, next(iter(result.shares)))}"
    return (
        f"{len(parts)} kinds of motion in this plane: {'; '.join(parts)}; ± {_digits(100 * result.blur)} %, "
        f"the cells on the boundaries")


def _percent(fraction: float, blur: float) -> str:
    places = max(0, min(6, math.ceil(-math.log10(max(100 * blur, 1e-7))) + 1))
    return f"{100 * fraction:.{places}f} %"


def _digits(value: float) -> str:
    return number(value, 2)


def _boundary(result: Basins) -> list[str]:
    if not len(result.boundary):
        visited = ("" if not result.unclear
                else f": {result.unclear:,} finest cells lie between what is decided and what is undecided")
        return [
            f"no boundary between decided basins is "
            f"seen{visited or ' from cell to cell: a smaller basin inside a coarse cell would not be'}"]
    steps, units = result.steps, [axis.shown_unit for axis in result.plan.axes]
    size = " x ".join(f"{_digits(abs(step))}{'' if unit == '1' else f' {unit}'}"
                      for step, unit in zip(steps, units))
    through = "; the exact separatrix passes through each" if result.exact else ""
    rough = result.dimension
    lines = [f"boundary: {len(result.boundary):,} cells of depth {result.mesh.depth}, {size} each{through}"]
    if result.unclear:
        lines.append(f"besides {result.unclear:,} cells between what is decided and what is undecided")
    if math.isnan(rough.value):
        return [*lines, f"its box dimension is not known: {rough.because}"]
    lines.append(f"its box dimension: {rough.value:.4f} ± {rough.uncertainty:.4f}, {_roughness(rough)} "
                 f"({rough.reason.alone})")
    return lines


def _roughness(rough: Any) -> str:
    if abs(rough.value - 1) <= rough.uncertainty:
        return "that of a smooth line" if rough.uncertainty < SMOOTH else "which a smooth line may have"
    return ("more than a smooth line has at these sizes" if rough.value > 1
            else "less than a line has: pieces smaller than the cells")


def _known(result: Basins) -> str:
    values, counts = np.unique(result.records["level"], return_counts=True)
    return ("the fate is known as " + ", ".join(f"{LEVELS[value]} ({count:,})"
                                                for value, count in zip(values.tolist(), counts.tolist())))


def cells_of(result: Basins) -> dict[str, np.ndarray]:
    """The cells that are not split, coarse ones first: places of their ends on the finest grid, depth,
    whether their corners differ, and the label at the first corner."""
    mesh, rows = result.mesh, []
    for depth, cells in leaves(mesh):
        row, column = mesh.at(depth, cells)
        step = 1 << mesh.depth - depth
        rows.append(np.stack([row * step, column * step, np.full(len(cells), step),
                              np.full(len(cells), depth), mesh.mixed(depth, cells),
                              mesh.labels_of(mesh.corners(depth, cells)[:, 0])]))
    names = ("first", "second", "width", "depth", "mixed", "label")
    return dict(zip(names, np.concatenate(rows, axis=1)))


def csv(result: Basins) -> str:
    """A line for each cell: its ends along both axes, its depth, and what its states do, or that it is on a
    boundary."""
    cells = cells_of(result)
    heads = [with_unit(f"{axis.key.name} {end}", axis.shown_unit)
             for axis in result.plan.axes for end in ("from", "to")]
    values = [np.array(axis.values) for axis in result.plan.axes]
    columns = [values[n][cells[name] + more].tolist()
               for n, name in enumerate(("first", "second")) for more in (0, cells["width"])]
    phrases = ["boundary" if mixed else basin_name(result, label)
             for mixed, label in zip(cells["mixed"].tolist(), cells["label"].tolist())]
    printed = [limiting.cell(result.plan.case, limits_of(result.plan.case, result.records))] * len(phrases)
    return csv_lines([[*heads, "depth", "basin", "caveats"],
                        *zip(*columns, cells["depth"].tolist(), phrases, printed)])


def json(result: Basins) -> str:
    """The answer, the boundary's cells and the exact pieces of it."""
    mesh, rough = result.mesh, result.dimension
    row, column = mesh.at(mesh.depth, result.boundary)
    lower = [np.array(axis.values)[location] for axis, location in zip(result.plan.axes, (row, column))]
    axes = [{"key": axis.key.name, "unit": axis.shown_unit, "from": axis.values[0], "to": axis.values[-1],
             "cells": cells, "finest_cell": step}
            for axis, cells, step in zip(result.plan.axes, mesh.cells, result.steps)]
    case = result.plan.case
    limits = limiting.key(case, limits_of(case, result.records)) | headline.key(headline.of_case(case))
    return as_json(limits | {
        "schema": BASIN_SCHEMA, "case": result.plan.case.name, "variables": result.plan.case.variables,
        "command": command(result), "axes": axes,
        "depth": mesh.depth, "complete": not mesh.full, "states_asked": len(mesh.keys),
        "finest_grid": list(_grid(mesh)),
        "basins": [{"basin": basin_name(result, label), "share": fraction}
                   for label, fraction in result.shares.items()], "share_uncertainty": result.blur,
        "boundary": {"cells": len(result.boundary), "unclear_cells": result.unclear, "exact": result.exact,
                     "corners": np.stack(lower, axis=1),
                     "separatrix": result.separatrix()},
        "box_dimension": {"value": rough.value, "uncertainty": rough.uncertainty,
                          "depths": list(rough.depths), "cells": list(rough.counts),
                          "fitted_depths": list(rough.used), "because": rough.because,
                          "reason": rough.reason.as_dict()}})


def command(result: Basins) -> str:
    """A command that asks the same."""
    import shlex
    rows = [f"--vary={axis.key.name}={axis.values[0]!r}:{axis.values[-1]!r}:{cells + 1}"
            f"{':log' if text.count(':') == 3 else ''} {axis.unit}".strip()
            for axis, cells, (_, text) in zip(result.plan.axes, result.mesh.cells, result.plan.vary)]
    rows += [f"--depth={result.asked}", *([f"--follow={result.plan.follow}"] if result.plan.follow else [])]
    return shlex.join(["stabilab", "basin", os.path.basename(result.plan.path), *rows])


def undecided(result: Basins) -> bool:
    """Whether the fate of a state that was asked is."""
    return UNDECIDED in result.shares


# --- As a data set


def basin(case: Given, vary: Mapping[str, str], depth: int = DEPTH,
          out: str | os.PathLike[str] | None = None,
          workers: int | None = 1, scheduler: str | None = None, follow: str | None = None, *,
          state: Start | None = None, span: Span | None = None) -> Basins:
    """The basins of a plane of initial states: what becomes of the motions from there, with cells that get
    smaller towards the boundary.

    case: in any form, or a scene with `state` and `span`. vary: two rates of the initial state with their
    ranges, {"angular_velocity[1]": "-60:60 deg/s", ...}, the others as in the case; "-60:60:33 deg/s" for 33
    places along the coarse grid. depth: how often a cell is halved whose corners have different fates. out: a
    .nc file, whose parts outlive a killed run; workers, scheduler: as of `stabilab.sweep`; the bytes are the
    same whoever computes them. follow: how long motions are followed that only a run decides, "200 s": those
    in bounded islands are undecided however long. The answer has shares, boundary, dimension and, where the
    scene reduces, `separatrix()`: the exact boundary. `stabilab.plot.basin` draws it. Raises InputError for
    what is no plane of states.
    """
    case = written(case, state, span)
    path = None if out is None else checked(out)
    with basins(case, vary, depth, path, workers, scheduler, follow) as result:
        if path is not None:
            write(dataset(result), path)
        return result


def dataset(result: Basins) -> xarray.Dataset:
    """The states asked with their fates, the cells that are not split, and how many cells of each depth the
    boundary has."""
    mesh, rough, cells = result.mesh, result.dimension, cells_of(result)
    places = mesh.places(mesh.keys)
    columns = (*ANSWERS["fate"].columns, *ANSWERS["level"].columns, CAVEATS)
    phrase = {column.name: column for column in columns}
    values: dict[str, Any] = {f"coordinate{n + 1}": (("state",), np.array(axis.values)[places[n]],
                                                     {"long_name": axis.key.name, "units": axis.shown_unit})
                              for n, axis in enumerate(result.plan.axes)}
    values |= {name: column_in(("state",), column, result.records, "1") for name, column in phrase.items()}
    values["place"] = (("state", "axis"), np.stack(places, axis=1).astype(np.int32),
                       {"long_name": "place of a state on the grid of finest cells, from 0"})
    values["cell"] = (("cell", "axis"), np.stack([cells["first"], cells["second"]], axis=1).astype(np.int32),
                      {"long_name": "place of a cell's lower corner on the grid of finest cells"})
    values["cell_depth"] = (("cell",), cells["depth"].astype(np.int8),
                            {"long_name": "how often its coarse cell was halved"})
    values["on_boundary"] = (("cell",), cells["mixed"].astype(np.int8),
                             {"long_name": "whether the corners of a cell have different fates"})
    values["boundary_cells"] = (("depth",), np.array(rough.counts, np.int32),
                                {"long_name": "cells of a depth that hold a piece of the boundary"})
    case = result.plan.case
    depths = {"depth": (("depth",), np.array(rough.depths, np.int8), {"long_name": "depth of refinement"})}
    return finished(values, depths, {
        **origin(case, command(result)), "case_variables": case.variables, "case": result.plan.text,
        "basin": result.plan.as_json(brief=True),
        "caveats": limiting.cell(case, limits_of(case, result.records)),
        "coarse_cells": np.array(mesh.cells, np.int32), "depth_asked": np.int32(result.asked),
        "depth_reached": np.int32(mesh.depth), "complete": np.int8(not mesh.full),
        "box_dimension": rough.value, "box_dimension_uncertainty": rough.uncertainty,
        "box_dimension_because": rough.because})


def opened(data: xarray.Dataset) -> Basins:
    """The basins that a data set holds. Raises KeyError or ValueError for one that was changed."""
    plan = from_json(data.attrs["basin"])
    cells, depth = tuple(int(n) for n in data.attrs["coarse_cells"]), int(data.attrs["depth_reached"])
    records = np.zeros(data.sizes["state"], record(plan.answers))
    for name in ("fate", "spin_axis", "level", "caveats"):
        records[name] = data[name].values
    records["valid"] = 1
    mesh = Mesh(cells, depth, full=not int(data.attrs["complete"]))  # type: ignore[arg-type]  # two of them
    location, lower = data["place"].values.astype(np.int64), data["cell"].values.astype(np.int64)
    mesh.keys, mesh.labels = location[:, 0] * mesh.width + location[:, 1], label_of(records)
    own = data["cell_depth"].values.astype(np.int64)
    for n in range(depth + 1):
        here = lower[own == n] >> depth - n
        mesh.leaves.append(np.sort(mesh.number(n, here[:, 0], here[:, 1])))
    result = Basins(plan, mesh, records, int(data.attrs["depth_asked"]))
    counts = tuple(int(n) for n in data["boundary_cells"].values)
    if (plan.shape != tuple((n << depth) + 1 for n in cells) or len(LEVELS) <= records["level"].max()
            or dimension(counts).counts != result.dimension.counts):
        raise ValueError("changed")
    return result
