"""Trajectories as files: NetCDF with units and provenance, or CSV. A file appears whole or not at all."""
from __future__ import annotations

from pathlib import Path

from ...files import whole_file
from ...packages import demand
from ...physics.scene import PARTS
from ...version import __version__
from ..results import of_parts
from ..text.answers import columns
from . import comma, endings


def checked(path) -> Path:
    """The path, if it can be written by its ending; InputError otherwise."""
    path = endings.file(path, tuple(WRITERS))
    if endings.ending(path) == ".nc":
        demand("xarray", "scipy")
    return path


def write(case, run, path) -> Path:
    """Write a Trajectory of a case to `path` (.nc or .csv), under a temporary name first, then renamed."""
    path = checked(path)
    with whole_file(path) as waiting:
        WRITERS[endings.ending(path)](case, run, waiting)
    return path


def _csv(case, run, path):
    names, rows = columns(run)
    units = [unit for name in run.state for unit in [PARTS[name].unit] * len(PARTS[name].components)]
    time = "tau" if case.variables == "scaled" else "t (s)"
    named = [f"{name} ({unit})" if unit else name for name, unit in zip(names, units, strict=True)]
    path.write_text(comma.lines([(time, *named),
                                 *((float(t), *row) for t, row in zip(run.t, rows))]), encoding="utf-8",
                    newline="")


def _netcdf(case, run, path):
    import xarray
    time = "t" if case.variables == "physical" else "tau"
    data = xarray.Dataset(
        of_parts(run.state, time, run.error),
        {time: ((time,), run.t, {"units": "s" if case.variables == "physical" else "1"}), "axis": [1, 2, 3]},
        {"title": case.title, "source": case.source, "case": case.text, "program": f"stabilab {__version__}",
         "model": run.model, "method": run.method, **({"rtol": run.rtol} if run.rtol else {}),
         "status": run.status,
         **{f"departure_from_{name}": value for name, value in run.invariant_drift.items()}})
    data.to_netcdf(path, engine="scipy")  # NetCDF 3: every reader knows it, and no HDF5 library is needed


WRITERS = {".nc": _netcdf, ".csv": _csv}
