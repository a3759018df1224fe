"""An atlas as a data set of xarray and as a NetCDF file, from which it can be drawn again."""
from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ....case.read import Case, read_text
from ....errors import InputError, printable
from ....maps.atlas.pointed import Leaves, corners, directions
from ....maps.atlas.run import LEVEL, REFINE, Asked, Atlas, asked, drawn
from ....maps.columns import columns_of, record
from ....packages import demand
from ....version import __version__
from ...limiting import cell
from ..dataset import checked, write
from ..shades import limiting, meanings, unit
from .words import point_name

if TYPE_CHECKING:
    import xarray


def atlas(case: Case | str | os.PathLike[str], torque: Any = None, wheel: str | None = None,
          level: int = LEVEL, refine: int = REFINE,
          certify: bool = False, follow: str | None = None, out: str | os.PathLike[str] | None = None,
          workers: int | None = 1, scheduler: str | None = None,
          timed: bool = True, **limit: str | None) -> xarray.Dataset:
    """What becomes of a case's motion under a torque of every direction: cells of equal area on the sphere,
    smaller ones along the boundaries.

    case: a Case, or the path of a case file. torque: its size, "1 N m"; None: that of the case. wheel:
    momenta beside each of which all directions are asked, "0:2:5" along the wheel of the case, or "z=0:2:5";
    None: the case's own. level: 8 4^level cells at first; refine: how often those along a boundary are cut in
    four. limit: rate, component, energy, tilt or until, as the options of `stabilab when`; without any, that
    of [limits] of the case, if it has one; timed: whether that time is asked. certify: prove what can be.
    follow: how long motions are followed that only a run decides. out: a .nc file; workers and scheduler: as
    of `stabilab.sweep`; the numbers are the same whoever computes them. Raises InputError for what cannot be
    asked.
    """
    demand("xarray")
    plan, path = asked(case, torque, wheel, level, refine, certify, follow, timed,
                       **limit), None if out is None else checked(out)
    with drawn(plan, path, workers, scheduler) as found:
        made = dataset(found)
        if path is not None:
            write(made, path)
        return made


def dataset(found: Atlas) -> xarray.Dataset:
    """The cells with directions, corners, shares and answers; directions with a name beside them."""
    import xarray
    whole = lambda column, words: ("cell", column.astype(np.int32), {"long_name": words})
    leaves = found.leaves
    values: dict[str, Any] = {"wheel": whole(leaves.wheel, "number of the wheel momentum"),
                              "number": whole(leaves.number, "number of the cell at its depth"),
                              "depth": whole(leaves.level,
                                             "depth of the cell: 8 4^depth of them make the sphere")}
    values["share"] = ("cell", found.share, {"long_name": "share of the sphere", "units": "1"})
    values["direction"] = (("cell", "axis"), found.directions,
                           {"long_name": "middle of the cell along the principal axes", "units": "1"})
    values["direction_in_file"] = (("cell", "axis"), found.in_file(found.directions),
                                   {"long_name": "the same in the frame of the file", "units": "1"})
    values["corners"] = (("cell", "corner", "axis"), _corners(found.leaves),
                         {"long_name": "corners of the cell along the principal axes", "units": "1"})
    values |= {column.name: _variable(found, column, "cell", found.records)
               for column in columns_of(found.asked.answers)[1:]}
    values["point_direction"] = (("point", "axis"), found.named_directions,
                                 {"long_name": "direction with a name, along the principal axes",
                                  "units": "1"})
    values["point_wheel"] = ("point", np.array([point.wheel for point in found.named], np.int32),
                             {"long_name": "number of the wheel momentum"})
    values |= {f"point_{column.name}": _variable(found, column, "point", found.named_records)
               for column in columns_of(found.asked.answers)[1:]}
    coordinates: dict[str,
                      Any] = {"axis": ("axis", np.array([1, 2, 3], np.int8), {"long_name": "principal axis"}),
                                   "point": ("point", [point_name(found, point) for point in found.named],
                                             {"long_name": "name of the direction"})}
    vectors = np.array([[float(v) for v in wheel] for wheel in found.asked.wheels])
    values["wheel_momentum"] = (("wheels", "axis"), vectors,
                                {"long_name": "momentum of the wheel along the principal axes",
                                 "units": "N m s"})
    made = xarray.Dataset(values, coordinates, _attributes(found))
    for name in made.variables:
        made.variables[name].encoding["_FillValue"] = None
    return made


def _corners(leaves: Leaves) -> np.ndarray:
    out = np.empty((len(leaves.level), 3, 3))
    for level in np.unique(leaves.level):
        rows = leaves.level == level
        out[rows] = directions(corners(int(level),
                                       leaves.number[rows]).reshape(-1, 3) / 2.0**level).reshape(-1, 3, 3)
    return out


def _variable(found: Atlas, column: Any, dimension: str, records: np.ndarray) -> tuple[Any, ...]:
    words = ({"long_name": column.words}
             | ({"units": unit(found.asked.plan(()), column)} if column.kind == "f8" else {}))
    if column.flags:
        words |= {"flag_values": np.arange(len(column.flags), dtype=np.int8),
                  "flag_meanings": meanings(column)}
    if column.note:
        words |= {"comment": column.note}
    return dimension, np.ascontiguousarray(records[column.name]).astype(column.kind), words


def _attributes(found: Atlas) -> dict[str, Any]:
    of = found.asked
    told = {"path": os.path.basename(of.path), "options": dict(of.options), "level": of.level,
            "refine": of.refine, "certify": of.certify,
            "limit": dict(of.limit), "timed": of.timed, "computed": found.asked_points}
    return {"Conventions": "CF-1.11", "title": of.case.title or of.case.name,
            "source": f"stabilab {__version__}", "references": of.case.source,
            "history": of.command, "torque": float(of.torque), "case": of.text, "atlas": json.dumps(told),
            "caveats": cell(of.case, limiting(of.case, found.records))}


def atlas_of(data: xarray.Dataset, path: Path) -> Atlas:
    """The atlas that a data set of `dataset` holds. Raises InputError for one that was changed."""
    try:
        told = json.loads(data.attrs["atlas"])
        of = asked(read_text(told["path"], data.attrs["case"]), **told["options"], level=told["level"],
                   refine=told["refine"], certify=told["certify"],
                   timed=told.get("timed", True), **told["limit"])
        leaves = Leaves(*(data[name].values.astype(np.int64) for name in ("wheel", "depth", "number")))
        found = Atlas(of, leaves, _records(data, of, "cell"), of.named, _records(data, of, "point"),
                      told["computed"], 0)
        complete = (len(found.named_records) == len(found.named)
                    and abs(found.share.sum() - len(of.wheels)) < 1e-9)
    except Exception:  # of any kind: what stands there is none, or of another version
        complete = False
    if not complete:
        raise InputError(
            f"{printable(str(path))}: what it says of its atlas cannot be read: was it changed, or made by "
            f"another version?")
    return found


def _records(data: xarray.Dataset, of: Asked, dimension: str) -> np.ndarray:
    out = np.zeros(data.sizes[dimension], record(of.answers))
    out["valid"] = 1
    for column in columns_of(of.answers)[1:]:
        name = f"point_{column.name}" if dimension == "point" else column.name
        out[column.name] = data[name].values
    return out
