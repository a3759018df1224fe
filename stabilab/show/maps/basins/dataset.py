"""Basins as a data set of xarray and as a NetCDF file: the states asked, the cells, the boundary; and the
public question."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ....case.read import Case
from ....maps.basins.ask import DEPTH, Basins, Mesh, basins, dimension, label_of
from ....maps.columns import ANSWERS, CAVEATS, LEVELS, record
from ....maps.plan import from_json
from ....version import __version__
from ...limiting import cell
from ..dataset import checked, write
from ..shades import limiting, meanings
from .words import cells_of, command

if TYPE_CHECKING:
    import xarray


def basin(case: Case | str | os.PathLike[str], vary: Mapping[str, str], depth: int = DEPTH,
          out: str | os.PathLike[str] | None = None,
          workers: int | None = 1, scheduler: str | None = None, follow: str | None = None) -> Basins:
    """The basins of a plane of initial states: what becomes of the motions from there, with cells that get
    smaller towards the boundary.

    case: a Case, or the path of a case file. vary: two rates of the initial state with their ranges,
    {"angular_velocity[1]": "-60:60 deg/s", ...}, the others as in the case; "-60:60:33 deg/s" for 33 places
    along the coarse grid. depth: how often a cell is halved whose corners have different fates. out: a .nc
    file, whose parts outlive a killed run; workers, scheduler: as of `stabilab.sweep`; the bytes are the same
    whoever computes them. follow: how long motions are followed that only a run decides, "200 s": those in
    bounded islands are undecided however long. The answer has shares, boundary, dimension and, where the
    scene reduces, `separatrix()`: the exact boundary. `stabilab.plot.basin` draws it. Raises InputError for
    what is no plane of states.
    """
    path = None if out is None else checked(out)
    with basins(case, vary, depth, path, workers, scheduler, follow) as found:
        if path is not None:
            write(dataset(found), path)
        return found


def dataset(found: Basins) -> xarray.Dataset:
    """The states asked with their fates, the cells that are not split, and how many cells of each depth the
    boundary has."""
    import xarray
    mesh, rough, cells = found.mesh, found.dimension, cells_of(found)
    places = mesh.places(mesh.keys)
    words = {"fate": ANSWERS["fate"][0], "spin_axis": ANSWERS["fate"][1], "level": ANSWERS["level"][0],
             "caveats": CAVEATS}
    values: dict[str, Any] = {f"coordinate{n + 1}": (("state",), np.array(axis.values)[places[n]],
                                                     {"long_name": axis.key.name, "units": axis.shown_unit})
                              for n, axis in enumerate(found.plan.axes)}
    for name, column in words.items():
        flags = ({"flag_values": np.arange(len(column.flags), dtype=np.int8),
                  "flag_meanings": meanings(column)} if column.flags else {})
        values[name] = (("state",), np.ascontiguousarray(found.records[name]),
                        {"long_name": column.words, **flags})
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
    case = found.plan.case
    made = xarray.Dataset(values,
                          {"depth": (("depth",), np.array(rough.depths, np.int8),
                                     {"long_name": "depth of refinement"})}, {
        "Conventions": "CF-1.11", "title": case.title or case.name, "source": f"stabilab {__version__}",
        "references": case.source,
        "history": command(found), "case_variables": case.variables, "case": found.plan.text,
        "basin": found.plan.as_json(brief=True),
        "caveats": cell(case, limiting(case, found.records)),
        "coarse_cells": np.array(mesh.cells, np.int32), "depth_asked": np.int32(found.asked),
        "depth_reached": np.int32(mesh.depth),
        "complete": np.int8(not mesh.full), "box_dimension": rough.value,
        "box_dimension_uncertainty": rough.uncertainty,
        "box_dimension_because": rough.reason})
    for variable in made.variables.values():
        variable.encoding["_FillValue"] = None
    return made


def opened(data: xarray.Dataset) -> Basins:
    """The basins that a data set holds. Raises KeyError or ValueError for one that was changed."""
    plan = from_json(data.attrs["basin"])
    cells, depth = tuple(int(n) for n in data.attrs["coarse_cells"]), int(data.attrs["depth_reached"])
    records = np.zeros(data.sizes["state"], record(plan.answers))
    for name in ("fate", "spin_axis", "level", "caveats"):
        records[name] = data[name].values
    records["valid"] = 1
    mesh = Mesh(cells, depth, full=not int(data.attrs["complete"]))  # type: ignore[arg-type]  # two of them
    place, lower = data["place"].values.astype(np.int64), data["cell"].values.astype(np.int64)
    mesh.keys, mesh.labels = place[:, 0] * mesh.width + place[:, 1], label_of(records)
    own = data["cell_depth"].values.astype(np.int64)
    for n in range(depth + 1):
        here = lower[own == n] >> depth - n
        mesh.leaves.append(np.sort(mesh.number(n, here[:, 0], here[:, 1])))
    found = Basins(plan, mesh, records, int(data.attrs["depth_asked"]))
    counts = tuple(int(n) for n in data["boundary_cells"].values)
    if plan.shape != tuple((n << depth) + 1
                           for n in cells) or dimension(counts).counts != found.dimension.counts or len(
                               LEVELS) <= records["level"].max():
        raise ValueError("changed")
    return found
