"""Trajectories as files: NetCDF with units and provenance, or CSV. A file appears whole or not at all."""
from __future__ import annotations

import os
from pathlib import Path

from ..errors import InputError


def checked(path) -> Path:
    """The path, if its ending is one that can be written; InputError otherwise."""
    path = Path(path)
    if path.suffix not in WRITERS:
        raise InputError(f"{path}: expected a name that ends in {' or '.join(WRITERS)}, got {path.suffix or 'no ending'}")
    return path


def write(case, run, path) -> Path:
    """Write a Trajectory of a case to `path` (.nc or .csv), under a temporary name first, then renamed."""
    path = checked(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}{path.suffix}")
    try:
        WRITERS[path.suffix](case, run, temporary)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
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
        import h5netcdf  # noqa: F401  (the engine below)
    except ImportError as error:
        raise InputError(f"{path.suffix} files need xarray and h5netcdf: pip install {error.name}; or write .csv") from None
    from .. import __version__
    unit = "rad/s" if case.variables == "physical" else "1"
    time, letter = ("t", "omega") if case.variables == "physical" else ("tau", "x")
    data = xarray.Dataset(
        {letter: ((time, "axis"), run.states, {"units": unit, "long_name": "angular velocity, body frame"})},
        {time: ((time,), run.t, {"units": "s" if case.variables == "physical" else "1"}), "axis": [1, 2, 3]},
        {"title": case.title, "source": case.source, "case": case.text, "program": f"stabilab {__version__}",
         "method": run.method, "rtol": run.rtol, "status": run.status,
         **{f"departure from {name}": value for name, value in run.invariant_drift.items()}})
    data.to_netcdf(path, engine="h5netcdf")


WRITERS = {".nc": _netcdf, ".csv": _csv}
