"""A sweep as a data set of xarray, and as a NetCDF file with units, words and provenance."""
from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...case.read import Case
from ...errors import printable
from ...files import whole_file
from ...maps.columns import VALID, columns_of
from ...maps.plan import Plan, planned
from ...maps.run import Swept, run
from ...packages import demand
from ...version import __version__
from ..axes import axes_of
from ..files import endings
from ..limiting import cell
from .shades import SAMPLE, dimensions, limiting, meanings, names, unit

if TYPE_CHECKING:
    import xarray

ENDING = (".nc",)


def sweep(case: Case | str | os.PathLike[str], vary: Mapping[str, Any] | None = None,
          samples: int | None = None, seed: int = 1, answer: Any = None,
          out: str | os.PathLike[str] | None = None, workers: int | None = 1, scheduler: str | None = None,
          follow: str | None = None,
          **limit: str | None) -> xarray.Dataset:
    """Answers over ranges of a case's numbers, labelled by what varies.

    case: a Case, or the path of a case file. vary: name of a number -> the values it takes, "0:30:31 deg/s",
    "0.1:10:21:log", or numbers in SI units; names such as "motion.angular_velocity[1]", "wheels.pitch.speed",
    or their ends where these are unique. samples, seed: as many random points of the box of the case's
    uncertain numbers, one more dimension. answer: names of `maps.columns.ANSWERS`; None: fate, level and
    margin. limit: rate, component, energy, tilt or until, as the options of `stabilab when`, for the answer
    "when". out: a .nc file, written in chunks that outlive a killed run; follow: how long motions are
    followed that only a run decides, "200 s"; workers: processes, None for one a core; scheduler: address of
    a Dask scheduler. The bytes are the same whoever computes them. Raises InputError for what cannot be
    varied or asked.
    """
    demand("xarray")
    plan, path = planned(case, vary or {}, samples, seed, answer, follow,
                         **limit), None if out is None else checked(out)
    with run(plan, path, workers, scheduler) as found:
        made = dataset(found)
        if path is not None:
            write(made, path)
        return made


def checked(path: str | os.PathLike[str]) -> Path:
    """The path, if a data set can be written to it; InputError otherwise."""
    demand("xarray", "scipy")
    return endings.file(path, ENDING)


def write(made: xarray.Dataset, path: Path) -> Path:
    """Write a data set as NetCDF 3: every reader knows it, and it holds neither time nor machine. Whole or
    not at all."""
    # in memory first: a full disk then says so in plain words
    content = bytes(made.to_netcdf(engine="scipy"))
    with whole_file(path) as waiting:
        waiting.write_bytes(content)
    return path


def dataset(found: Swept) -> xarray.Dataset:
    """The records with their dimensions, units and words."""
    import xarray
    plan, dims = found.plan, dimensions(found.plan)
    values = {column.name: _variable(found, column, dims) for column in columns_of(plan.answers)
              if column is not VALID or found.broken}
    coordinates = {name: ((name,), np.array(axis.values),
                          {"long_name": axis.key.name, "units": axis.shown_unit}) for name,
                   axis in zip(dims, plan.axes)}
    if plan.sampled:
        coordinates |= _sampled(plan, dims)
    if any("axis" in one[0] for one in values.values()):
        told = "; ".join(map(axes_of(plan.case).name, (1, 2, 3)))
        coordinates["axis"] = (("axis",), np.array([1, 2, 3], np.int8),
                               {"long_name": "principal axis", "names": told})
    made = xarray.Dataset(values, coordinates, _attributes(found))
    for name in made.variables:
        made.variables[name].encoding["_FillValue"] = None
    return made


def _variable(found: Swept, column: Any, dims: list[str]) -> tuple[Any, ...]:
    words = {"long_name": column.words} | ({"units": unit(found.plan, column)} if column.kind == "f8" else {})
    if column.flags:
        words |= {"flag_values": np.arange(len(column.flags), dtype=np.int8),
                  "flag_meanings": meanings(column)}
    if column.note:
        words |= {"comment": column.note}
    return (*dims,
            *(["axis"] if column.shape
              else [])), np.ascontiguousarray(found.records[column.name]).astype(column.kind), words


def _sampled(plan: Plan, dims: list[str]) -> dict[str, Any]:
    of = plan.sampled
    rows, keys = of.values(0, of.count), [key.name for key in of.keys]
    labels = names([*(axis.key.name for axis in plan.axes), *keys])[len(plan.axes):]
    columns = {label: ((SAMPLE,), rows[:, n], {"long_name": keys[n], "units": of.unit(n)}) for n,
               label in enumerate(labels)}
    return {SAMPLE: ((SAMPLE,), np.arange(of.count, dtype=np.int32),
                     {"long_name": "number of a random point"}), **columns}


def _attributes(found: Swept) -> dict[str, Any]:
    plan, case = found.plan, found.plan.case
    broken = {"no_case": f"{found.broken} points: {printable(found.why)}"} if found.broken else {}
    return {"Conventions": "CF-1.11", "title": case.title or case.name, "source": f"stabilab {__version__}",
            "references": case.source,
            "history": plan.command, "case_variables": case.variables, "case": plan.text,
            "sweep": plan.as_json(brief=True),
            "caveats": cell(case, limiting(case, found.records)), **broken}
