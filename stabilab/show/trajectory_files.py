"""Trajectories as files: NetCDF with units and provenance, or CSV. A file appears whole or not at all."""
from __future__ import annotations

from pathlib import Path

from ..errors import InputError
from .style import whole_file


def checked(path) -> Path:
    """The path, if it can be written by its ending; InputError otherwise."""
    path = Path(path)
    if path.suffix not in WRITERS:
        raise InputError(f"{path}: expected a name that ends in {' or '.join(WRITERS)}, got {path.suffix or 'no ending'}")
    if path.is_dir():
        raise InputError(f"{path}: expected a file, this is a folder")
    return path


def write(case, run, path) -> Path:
    """Write a Trajectory of a case to `path` (.nc or .csv), under a temporary name first, then renamed."""
    path = checked(path)
    with whole_file(path) as waiting:
        WRITERS[path.suffix](case, run, waiting)
    return path


def _csv(case, run, path):
    names = (case.scene.time_unit, *case.scene.components)
    with open(path, "w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(names) + "\n")
        for t, state in zip(run.t, run.states):
            stream.write(",".join(repr(float(v)) for v in (t, *state)) + "\n")


def _netcdf(case, run, path):
    try:
        import xarray
    except ImportError:
        raise InputError("files that end in .nc need xarray: pip install xarray; or write .csv") from None
    from .. import __version__
    unit = "rad/s" if case.variables == "physical" else "1"
    time, letter = ("t", "omega") if case.variables == "physical" else ("tau", "x")
    data = xarray.Dataset(
        {letter: ((time, "axis"), run.states, {"units": unit, "long_name": "angular velocity, body frame"})},
        {time: ((time,), run.t, {"units": "s" if case.variables == "physical" else "1"}), "axis": [1, 2, 3]},
        {"title": case.title, "source": case.source, "case": case.text, "program": f"stabilab {__version__}",
         "method": run.method, "rtol": run.rtol, "status": run.status,
         **{f"departure_from_{name}": value for name, value in run.invariant_drift.items()}})
    data.to_netcdf(path, engine="scipy")  # NetCDF 3: every reader knows it, and no HDF5 library is needed


WRITERS = {".nc": _netcdf, ".csv": _csv}
