"""A run in time: as text (how far it went, times and states in columns with units, departures from the laws),
as JSON, and as a file, which appears whole or not at all."""
from __future__ import annotations

import math
from dataclasses import replace
from decimal import ROUND_CEILING, Decimal, localcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...files import whole_file, write_text
from ...integrate.trajectory import ALL_REACHED
from ...numbers.principal import oblique
from ...packages import demand
from ...physics.scene import ATTITUDES, PARTS
from ...representation import values_of
from ...version import __version__
from .. import endings, frame
from ..data import csv_lines
from ..results.variables import (
    BODILY,
    Variables,
    frame_attributes,
    in_file,
    matrix_of,
    of_parts,
    turned_to_file,
)
from ..terminal import lettered, written
from ..units import DIGITS, SHORT, Units, with_unit
from .aem import message

if TYPE_CHECKING:
    from ...answers.simulate import Simulation
    from ...case.read import Case

ALL = 16  # digits of a double
GAP = 2


def text(case: Case, run: Simulation, units: Units, resolved: int | None = None,
         width: int | None = None) -> str:
    """The lines for one run. resolved: digits that a check vouches for, where more than a table's were asked
    for; width: of a terminal, where the columns are printed part by part if they do not fit."""
    digits = DIGITS if resolved is None else min(ALL, resolved)
    names, rows = columns(run)
    measures = [units.of(unit) for unit in _units(run)]
    head = [f"t ({written(case.scene.time_unit)})",
            *(lettered(with_unit(name, unit)) for name, (unit, _) in zip(names, measures))]
    scale, off = [1.0, *(item for _, item in measures)], [0.0, *errors(run)]
    cells = [[zero_within(error * item) if lost(t, value, error) else f"{value * item + 0.0:.{digits}g}"
              for value, item, error in zip((t, *row), scale, off)] for t, row in zip(run.t, rows)]
    laws = [f"# {lettered(name)}: largest relative departure {value:.3g}"
            for name, value in run.invariant_drift.items()]
    how = f"# {run.method}, rtol {run.rtol:.3g}" if run.rtol else f"# {run.model}: {lettered(run.method)}"
    notes = [] if run.reason == ALL_REACHED else [f"# {units.said(run.reason)}"]
    notes += [f"# {', '.join(PARTS[name].components)}: {PARTS[name].description}" for name in run.state
              if name in ATTITUDES]
    notes += [f"# nutation: angle of {run.nutation_axis} to the angular momentum"] * bool(run.nutation_axis)
    return "\n".join([f"{case.name}: {headline(case, run, units)}",
                      *_columns(head, cells, width, 13 if resolved is None else ALL + 7), how, *laws, *notes,
                      *(f"# {line.strip()}" for line in frame.note(case))])


def theory_lines(rows, units: Units) -> list[str]:
    """What a theory says, a line a row."""
    return [lettered(f"{row['about']}: {units.said(row['reason'])}") for row in rows]


def zero_within(error: float) -> str:
    """What stands for a number that is no more than its error, which is given by one digit, rounded up."""
    with localcontext() as context:
        context.prec, context.rounding = 1, ROUND_CEILING
        return f"0 within {float(+Decimal(error)):.0e}"


def headline(case: Case, run: Simulation, units: Units) -> str:
    """How far the motion was followed, its size at both ends, and by how much first integrals vary."""
    if not len(run.t):
        return f"NOT FOLLOWED: {units.said(run.reason)}"
    reached = "followed to" if run.status == "reached" else "STOPPED at"
    rest = f"; first integrals vary by {max(run.invariant_drift.values()):.2g}" if run.invariant_drift else ""
    return f"{reached} {units.time(float(run.t[-1]), SHORT)}{_sizes(run, units)}{rest}"


def _sizes(run: Simulation, units: Units):
    part = _rates(run)
    if not part:
        return ""
    error = max((float(v) for v in np.ravel(run.error.get(part, 0.0))), default=0.0)
    unit, item = units.rates
    sizes = [(float(run.t[n]), size(run.state[part][n])) for n in (0, -1)]
    first, last = (f"{zero_within(error * item)} {unit}".rstrip() if lost(t, size, error)
                   else units.rate(size, SHORT) for t, size in sizes)
    name = "|x|" if units.scaled else "|ω|"
    return f"; {name} = {last} there" if len(run.t) == 1 else f"; {name} = {first} first, {last} last"


def _rates(run: Simulation) -> str:
    """The name of the part of the state that is its three rates; empty where it has none."""
    return next((name for name in ("omega", "x") if name in run.state), "")


def size(vector) -> float:
    """Of a vector: its length."""
    return math.hypot(*map(float, vector))


def _columns(head, cells, width, wide):
    """Lines of right-aligned columns, the time first; in several tables where they do not fit a terminal."""
    sizes = [max(wide, len(name) + GAP, 1 + max((len(row[i]) for row in cells), default=0))
             for i, name in enumerate(head)]
    fit = len(head) - 1 if width is None else max(1, (width - sizes[0]) // max(sizes[1:], default=1))
    lines = []
    for start in range(1, len(head), fit):
        chosen = [0, *range(start, min(start + fit, len(head)))]
        lines += [""] * (start > 1)
        lines += ["".join(f"{row[i]:>{sizes[i]}}" for i in chosen) for row in (head, *cells)]
    return lines


# --- As JSON
def as_dict(case: Case, run: Simulation) -> dict:
    """The object of `stabilab simulate --json`."""
    rates = _rates(run)
    return {"schema": "stabilab.simulate/1", "case": case.name, "model": run.model,
            "time": case.scene.time_unit,
            "size": [size(row) for row in run.state[rates]] if rates else None,
            **values_of(run, "t state error invariant_drift counters method rtol status"),
            "reason": run.because, "why": run.reason.as_dict(),
            **({"nutation_axis": run.nutation_axis} if run.nutation_axis else {}),
            **{name: PARTS[name].description for name in ATTITUDES if name in run.state}
            } | frame.rows(case, run)


def columns(run: Simulation) -> tuple[list[str], list[list[float]]]:
    """Names and rows of everything a run has, time left out."""
    names: list[str] = []
    parts: list[np.ndarray] = []
    for name, values in run.state.items():
        values = np.asarray(values, float)
        names += PARTS[name].components
        parts.append(values.reshape(len(run.t), int(np.prod(values.shape[1:]))))
    return names, np.hstack(parts).tolist()


def _units(run: Simulation) -> list[str]:
    """The SI unit of each of the columns."""
    return [PARTS[name].unit for name in run.state for _ in PARTS[name].components]


def errors(run: Simulation) -> list[float]:
    """The error of each of the columns, 0 where none is known."""
    return [float(v) for name, values in run.state.items()
            for v in np.broadcast_to(run.error.get(name, 0.0), np.shape(values)[1:]).ravel()]


def lost(t: float, value: float, error: float) -> bool:
    """Whether a number is no more than its error: rounding. What a start gives is known."""
    return t != 0 and 0 < abs(value) <= error


def lost_columns(run: Simulation) -> list[tuple[str, float]]:
    """(name, error) of the columns that hold numbers which are no more than their error."""
    names, rows = columns(run)
    return [(name, error) for name, error, values in zip(names, errors(run), zip(*rows))
            if any(lost(t, value, error) for t, value in zip(run.t, values))]


# --- As files: NetCDF with units and provenance, or CSV
def _in_file(case: Case, run: Simulation) -> tuple[list[str], list[str], list]:
    """Names, units and rows of the vectors of the body in the frame of the file; none where a tensor is
    diagonal."""
    axes = oblique(case.frame)
    resolved = [name for name in run.state if name in BODILY and np.shape(run.state[name])[1:] == (3,)]
    if axes is None or not resolved:
        return [], [], []
    turned = [turned_to_file(name, np.asarray(run.state[name], float), matrix_of(axes)) for name in resolved]
    return ([f"{name}_{letter}" for name in resolved for letter in "xyz"],
            [PARTS[name].unit for name in resolved for _ in "xyz"], np.hstack(turned).tolist())


def checked(path: Path) -> Path:
    """The path, if it can be written by its ending; InputError otherwise."""
    path = endings.file(path, (".nc", ".csv", ".aem"))
    if endings.ending(path) == ".nc":
        demand("xarray", "scipy")
    return path


def write(case: Case, run: Simulation, path: Path, epoch: Any = None) -> Path:
    """Write a run of a case to `path` (.nc, .csv or .aem), whole or not at all. epoch: as of
    `aem.epoch_of`. Of a full tensor NetCDF has the vectors of the body in the frame of the file, named x, y,
    z, the principal axes as an attribute, and those along them as omega_principal and so on; CSV has both
    beside each other."""
    path = checked(path)
    if endings.ending(path) == ".aem":
        return write_text(path, message(case, run, epoch))
    if endings.ending(path) == ".csv":
        names, rows = columns(run)
        more, units, turned = _in_file(case, run)
        rows = [[*row, *other] for row, other in zip(rows, turned)] if more else rows
        head = ("tau" if case.variables == "scaled" else "t (s)",
                *map(with_unit, [*names, *more], [*_units(run), *units]))
        return write_text(path, csv_lines([head, *((float(t), *row) for t, row in zip(run.t, rows))]))
    import xarray
    time = "t" if case.variables == "physical" else "tau"
    result, axes = Variables((time,), of_parts(run.state, time, run.error)), oblique(case.frame)
    if axes is not None:
        beside = {f"{name}_principal": ((time, "principal_axis"), values, phrase)
                  for name, (dims, values, phrase) in result.values.items()
                  if name in BODILY and dims == (time, "axis")}
        result = in_file(result, axes)
        result = replace(result, values={**result.values, **beside},
                        coordinates={**result.coordinates, "principal_axis": ([1, 2, 3], {})})
    data = xarray.Dataset(
        dict(result.values),
        {time: ((time,), run.t, {"units": "s" if case.variables == "physical" else "1"}), "axis": [1, 2, 3],
         **{name: ((name,), *coordinate) for name, coordinate in result.coordinates.items()}},
        {**({} if axes is None else frame_attributes(axes, True)),
         "title": case.title, "source": case.source, "case": case.text, "program": f"stabilab {__version__}",
         "model": run.model, "method": run.method, **({"rtol": run.rtol} if run.rtol else {}),
         "status": run.status,
         **{f"departure_from_{name}": value for name, value in run.invariant_drift.items()}})
    with whole_file(path) as waiting:  # NetCDF 3: every reader knows it, and no HDF5 library is needed
        data.to_netcdf(waiting, engine="scipy")
    return path
