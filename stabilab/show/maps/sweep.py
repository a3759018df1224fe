"""A sweep in words: the answer in a line, what is behind it, a table where it is short; CSV and JSON of every
point; a data set of xarray, and a NetCDF file with units, words and provenance."""
from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import of_case
from ...case.given import Given, Span, Start, written
from ...case.read import Case
from ...errors import Kind, printable, without
from ...files import whole_file
from ...maps.blocks import blocks, counted, given_back
from ...maps.columns import CAVEATS, ENDLESS, NO_CASE, NONE, OPEN, TIME, VALID, Column, columns_of
from ...maps.plan import Plan, planned
from ...maps.run import Swept, run
from ...orbit.result import OUTCOMES, Fate
from ...packages import demand
from ...version import __version__
from .. import endings, limiting, terminal
from ..axes import Axes, axes_of
from ..data import as_json, csv_lines, endless
from ..terminal import lettered
from ..text import headline
from ..units import Unit, as_bound, units_of, with_unit
from . import netcdf
from .shades import SAMPLE, dimensions, limits_of, names, of_every_point, said, unit

if TYPE_CHECKING:
    import xarray

SWEEP_SCHEMA = "stabilab.sweep/1"
ROWS = 40  # points of a table
TOGETHER = 8192  # lines of CSV that are made together
FEW = 100  # points that are counted; of more their share is given
# what points do, what one point does
DOES = {fate: (x.do, x.does) for fate, x in OUTCOMES.items()} | {NO_CASE: ("are no case", "is no case")}
SHORT = {"spin_axis": "axis", "greatest": "most"}  # names of columns in a table
# what numbers without end mean, the negative first: in a sentence, and in a cell where that is shorter
# of a column that is a bound: which of them
SIDES = {"when_low": -1, "when_high": 1}
INFINITE = {"margin": (("no barrier ahead", "no barrier"), ("no end to the barrier", "endless")),
            "distance": (("no separatrix",), ("no separatrix",)),
            "least": (("unbounded",), ("unbounded",)), "greatest": (("unbounded",), ("unbounded",)),
            "period": (("no period", "none"), ("no period", "none")),
            "when_low": (("never",), ("never",)), "when_high": (("never",), ("never",))}
CELLS = {ENDLESS: "curves", OPEN: "not known", NONE: "no case"}
COUNTS = {ENDLESS: "curves of equilibria", OPEN: "equilibria not all known", NONE: "no case"}


def text(result: Swept) -> str:
    """The answer first; then what else was asked, in ranges; a table of the points where there are few."""
    plan = result.plan
    lines = [f"{plan.case.name}: {_answer(result)}", *_details(result)]
    lines += limiting.lines(limits_of(_case_of(plan), result.records), units_of(plan.case))
    if result.broken:
        printed = (f"{result.broken:,} points are no case; the first" if result.broken > 1
                else "one point is no case")
        lines.append(f"  {printed}: {printable(result.fault)}")
    if result.records.size <= ROWS:
        lines += _table(result)
    return limiting.ahead(of_case(plan.case), "\n".join(lines))


def _answer(result: Swept) -> str:
    names = result.records.dtype.names
    if "fate" in names:
        return _shares(result.records["fate"], lambda value: DOES[value])
    if "equilibria" in names:
        return _shares(result.records["equilibria"],
                       lambda value: (f"have {_number(value)}", f"has {_number(value)}"))
    return f"{result.records.size:,} points"


def _number(value: int) -> str:
    return (COUNTS.get(value)
            or ("no equilibrium" if not value else f"{value} equilibri{'um' if value == 1 else 'a'}"))


def _shares(values: np.ndarray, phrase: Any) -> str:
    """"62 % of 10,201 points stay bounded, 38 % spin up"."""
    parts = [(_share(count, values.size), phrase(kind)[count == 1 and values.size <= FEW])
             for kind, count in _often_first(counted(blocks(values)))]
    if len(parts) == 1:
        return (f"all {values.size:,} points {parts[0][1]}" if values.size > 1
                else f"the one point {parts[0][1]}")
    head, *rest = parts
    return (f"{head[0]} of {values.size:,} points {head[1]}"
            + "".join(f", {fraction} {what}" for fraction, what in rest))


def _share(count: int, of: int) -> str:
    """A share in per cent; of few points their number."""
    if of <= FEW:
        return str(count)
    return per_cent(count / of)


def per_cent(fraction: float) -> str:
    """A share that is not given as 100 % where it is less."""
    percent = 100 * fraction
    if percent > 99 and fraction < 1 - 1e-12:
        return f"{min(percent, 99.99):.2f} %"
    return f"{percent:.0f} %" if percent >= 1 else f"{percent:.2g} %"


def _details(result: Swept) -> list[str]:
    lines, names = [], result.records.dtype.names
    valid = lambda column: (block[column][block["valid"] == 1] for block in blocks(result.records))
    about = counted(block["spin_axis"][block["fate"] == Fate.SPIN_UP]
                    for block in blocks(result.records)) if "spin_axis" in names else {}
    if about:
        signed = axes_of(result.plan.case).signed
        lines.append("  spin-up about " + _listed(about, lambda axis: signed(abs(axis), axis) if axis
                                                  else "an axis between equal moments"))
    if "level" in names:
        flags = next(c.flags for c in columns_of(result.plan.answers) if c.name == "level")
        lines.append("  the fate is known as " + _listed(counted(valid("level")), lambda level: flags[level]))
    for column in columns_of(result.plan.answers):
        if column.kind == "f8":
            lines.append(_range(valid(column.name), column, *_unit(result.plan, column)))
        elif column.kind == "i4":
            lines.append(f"  {column.description}: " + _listed(
                counted(valid(column.name)), lambda value: COUNTS.get(value, str(value))))
    return lines


def _listed(counts: Mapping[int, int], phrase: Any) -> str:
    return ", ".join(f"{phrase(kind)} ({count:,})" for kind, count in _often_first(counts))


def _often_first(counts: Mapping[int, int]) -> list[tuple[int, int]]:
    return sorted(counts.items(), key=lambda pair: -pair[1])


def _unit(plan: Plan, column: Column) -> Unit:
    """The unit in which people read the numbers of a column: rates in the units of the case."""
    of = unit(plan, column)
    if of == "1":
        return ("τ" if column.unit == TIME else "", 1.0)
    return units_of(plan.case).of(of)


def _range(pieces: Iterable[np.ndarray], column: Column, of: str, item: float) -> str:
    name = column.name.replace("_", " ")
    least, most, negative, positive, unknown = np.inf, -np.inf, 0, 0, 0
    for values in pieces:
        finite = np.isfinite(values)
        least, most = (min(least, float(values.min(where=finite, initial=np.inf))),
                       max(most, float(values.max(where=finite, initial=-np.inf))))
        negative, positive, unknown = (total + int(of_kind(values).sum()) for total, of_kind in (
            (negative, np.isneginf), (positive, np.isposinf), (unknown, np.isnan)))
    (below, *_), (above, *_) = INFINITE.get(column.name, (("-∞",), ("∞",)))
    rest = [f"{phrase} at {count:,}" for phrase, count in (
        (below, negative), (above, positive), ("not known", unknown)) if count]
    ends = (list(dict.fromkeys(_in_unit(end, item, column.name) for end in (least, most)))
            if least <= most else [])
    printed = " to ".join(ends) + (f" {of}" if of else "") if ends else "no finite value"
    return f"  {name}: {printed}" + (f" ({', '.join(rest)})" if rest else "")


def undecided(result: Swept) -> bool:
    """Whether the fate of a point is."""
    return "fate" in result.plan.answers and any((block == Fate.UNDECIDED).any()
                                                 for block in blocks(result.records["fate"]))


def heads(result: Swept) -> list[str]:
    """What the cells of `rows` are: keys with their units, then columns with theirs."""
    plan = result.plan
    keys = [with_unit(axis.key.name, axis.shown_unit) for axis in plan.axes]
    keys += ([SAMPLE, *(with_unit(key.name, plan.sampled.unit(n)) for n, key in enumerate(plan.sampled.keys))]
             if plan.sampled else [])
    for column in columns_of(plan.answers)[1:]:
        keys += [with_unit(f"{column.name}{n}", unit(plan, column))
                 for n in (("1", "2", "3") if column.shape else ("",))]
    return keys


def rows(result: Swept) -> Iterator[list[Any]]:
    """A row for every point, the last dimension fastest: what varies, then the answers, words for flags."""
    plan = result.plan
    columns, begin, sampled = columns_of(plan.answers)[1:], -1, []
    for number, index in enumerate(np.ndindex(*plan.shape)):
        if number % TOGETHER == 0:
            given_back(result.records)
        row: list[Any] = [axis.values[n] for axis, n in zip(plan.axes, index)]
        if plan.sampled:
            if index[-1] // TOGETHER != begin:
                begin = index[-1] // TOGETHER
                sampled = plan.sampled.values(begin * TOGETHER, min((begin + 1) * TOGETHER,
                                                                    plan.sampled.count)).tolist()
            row += [index[-1], *sampled[index[-1] % TOGETHER]]
        for column in columns:
            value = result.records[column.name][index].tolist()
            row += (value if column.shape else [column.flags[value] if column.flags and value >= 0
                                                else "" if column.flags else value])
        yield row


def _case_of(plan: Plan) -> Any:
    """The case, without the caveat that an answer is of the middles of its uncertain numbers where the points
    go through all of these."""
    varied = {path for axis in plan.axes for path in axis.key.paths}
    if plan.sampled is None and not all(item.path in varied for item in plan.case.uncertain):
        return plan.case
    return replace(plan.case, caveats=without(plan.case.caveats, Kind.UNCERTAIN, Kind.TOLERANCE))


def csv(result: Swept) -> str:
    """Every point as a line, with what limits the answers of all points beside what limits its own."""
    return "".join(csv_pieces(result))


def csv_pieces(result: Swept) -> Iterator[str]:
    """The same, so many lines at a time that a large sweep needs no memory for its text."""
    case, records = _case_of(result.plan), result.records
    if CAVEATS not in columns_of(result.plan.answers):
        full = limiting.cell(case, limits_of(case, records))
        lines = chain([[*heads(result), CAVEATS.name]], ([*row, full] for row in rows(result)))
    else:
        every = limiting.cell(case, of_every_point(case, records))
        lines = chain([heads(result)], ([*row, "; ".join(filter(None, (every, own)))]
                                        for *row, own in rows(result)))
    while some := list(islice(lines, TOGETHER)):
        yield csv_lines(some)


def json(result: Swept) -> str:
    """Every point: axes with their values, then each column in one list, the last axis fastest."""
    plan = result.plan
    axes = [{"key": axis.key.name, "unit": axis.shown_unit, "values": list(axis.values)}
            for axis in plan.axes]
    columns = {column.name: {"unit": unit(plan, column), "long_name": column.description}
               | ({"flags": list(column.flags)} if column.flags else {})
               | {"values": endless(result.records[column.name].ravel().tolist())}
               for column in columns_of(plan.answers)[1:]}
    told: dict[str, Any] = {"schema": SWEEP_SCHEMA, "case": plan.case.name, "variables": plan.case.variables,
                            "command": plan.command,
                            "shape": list(plan.shape), "axes": axes}
    if plan.sampled:
        told["samples"] = {"count": plan.sampled.count, "seed": plan.sampled.seed,
                           "keys": [key.name for key in plan.sampled.keys],
                           "values": plan.sampled.values(0, plan.sampled.count).tolist()}
    told |= limiting.key(plan.case, limits_of(_case_of(plan), result.records))
    told |= headline.key(headline.of_case(plan.case))
    return as_json(told | {"no_case": {"points": result.broken, "because": result.fault}, "columns": columns})


def _table(result: Swept) -> list[str]:
    """A row a point under short names and units, rates in the units of the case."""
    plan, columns = result.plan, columns_of(result.plan.answers)[1:]
    told = list(rows(result))
    if columns[-1:] == (CAVEATS,):  # in words above the table
        columns, told = columns[:-1], [row[:-1] for row in told]
    keys = [(axis.key.name, axis.shown_unit) for axis in plan.axes]
    sampled = ([(key.name, plan.sampled.unit(n)) for n, key in enumerate(plan.sampled.keys)] if plan.sampled
               else [])
    names = said([key for key, _ in keys + sampled])
    titles = names[:len(keys)] + ([SAMPLE, *names[len(keys):]] if sampled else [])
    units = [of for _, of in keys] + (["1", *(of for _, of in sampled)] if sampled else [])
    units = ["" if of == "1" else lettered(of) for of in units]
    factors, kinds = [1.0] * len(units), [""] * len(units)
    for column in columns:
        (of, item), name = _unit(plan, column), SHORT.get(column.name, column.name.replace("_", " "))
        titles += ([f"{lettered(component)} {name}" for component in plan.case.scene.components]
                   if column.shape else [name])
        places = math.prod(column.shape)
        units, factors = units + [of] * places, factors + [item] * places
        kinds += [column.name] * places
    axes = axes_of(plan.case)
    cells = [[_cell(value, x, kind, axes) for value, x, kind in zip(row, factors, kinds)] for row in told]
    said_of = [n for n in range(len(titles)) if any(row[n] for row in cells)]
    return terminal.table([[row[n] for n in said_of] for row in (titles, units, *cells)], len(keys + sampled),
                      terminal.width())


def _cell(value: Any, item: float, kind: str, axes: Axes) -> str:
    if kind == "spin_axis":
        return axes.signed(abs(value), value)
    if isinstance(value, int) and kind in ("equilibria", "stable", "unstable", "open"):
        return CELLS.get(value, str(value))
    if not isinstance(value, float):
        return str(value)
    if math.isinf(value) and kind in INFINITE:
        return INFINITE[kind][value > 0][-1]
    return "not known" if math.isnan(value) else _in_unit(value, item, kind)


def _in_unit(value: float, item: float, kind: str) -> str:
    """A number of a column in its unit, a bound rounded outward."""
    return f"{as_bound(value, item, 6, SIDES.get(kind, 0)) + 0.0:.6g}"


# --- As a data set
ENDING = (".nc",)


def sweep(case: Given, vary: Mapping[str, Any] | None = None,
          samples: int | None = None, seed: int = 1, answer: Any = None,
          out: str | os.PathLike[str] | None = None, workers: int | None = 1, scheduler: str | None = None,
          follow: str | None = None,
          *, state: Start | None = None, span: Span | None = None,
          **limit: str | None) -> xarray.Dataset:
    """Answers over ranges of a case's numbers, with_unit by what varies.

    case: in any form, or a scene with `state` and `span`. vary: name of a number -> the values it takes,
    "0:30:31 deg/s", "0.1:10:21:log", or numbers in SI units; names such as "motion.angular_velocity[1]",
    "wheels.pitch.speed", or their ends where these are unique. samples, seed: as many random points of the
    box of the case's uncertain numbers, one more dimension. answer: names of `maps.columns.ANSWERS`; None:
    fate, level and margin. limit: rate, component, energy, tilt, below or until, as the options of
    `stabilab when`, for the answer "when". out: a .nc file, written in chunks that outlive a killed run;
    follow: how long motions are followed that only a run decides, "200 s"; workers: processes, None for one a
    core; scheduler: address of a Dask scheduler. The bytes are the same whoever computes them. Raises
    InputError for what cannot be varied or asked.
    """
    case = written(case, state, span)
    demand("xarray")
    plan = planned(case, vary or {}, samples, seed, answer, follow, **limit)
    path = None if out is None else checked(out)
    with run(plan, path, workers, scheduler) as result:
        built = dataset(result)
        if path is not None:
            write(built, path)
        return built


def checked(path: str | os.PathLike[str]) -> Path:
    """The path, if a data set can be written to it; InputError otherwise."""
    demand("xarray", "scipy")
    return endings.file(path, ENDING)


def write(built: xarray.Dataset, path: Path) -> Path:
    """Write a data set as NetCDF 3: every reader knows it, and it holds neither time nor machine. Whole or
    not at all."""
    with whole_file(path) as waiting:
        if netcdf.fits(built):
            netcdf.write(built, waiting)
        else:
            built.to_netcdf(waiting, engine="scipy")
    return path


def dataset(result: Swept) -> xarray.Dataset:
    """The records with their dimensions, units and words."""
    plan, dims = result.plan, dimensions(result.plan)
    values = {column.name: column_in((*dims, *["axis"] * len(column.shape)), column, result.records,
                                     unit(plan, column))
              for column in columns_of(plan.answers) if column is not VALID or result.broken}
    coordinates = {name: ((name,), np.array(axis.values),
                          {"long_name": axis.key.name, "units": axis.shown_unit})
                   for name, axis in zip(dims, plan.axes)}
    if plan.sampled:
        coordinates |= _sampled(plan)
    if any("axis" in value[0] for value in values.values()):
        printed = "; ".join(map(axes_of(plan.case).name, (1, 2, 3)))
        coordinates["axis"] = (("axis",), np.array([1, 2, 3], np.int8),
                               {"long_name": "principal axis", "names": printed})
    return finished(values, coordinates, _attributes(result))


def finished(values: dict[str, Any], coordinates: dict[str, Any],
             attributes: dict[str, Any]) -> xarray.Dataset:
    """The data set, in which no value stands for one that is missing."""
    import xarray
    built = xarray.Dataset(values, coordinates, attributes)
    for variable in built.variables.values():
        variable.encoding["_FillValue"] = None
    return built


def column_in(dims: str | Sequence[str], column: Column, records: np.ndarray,
              of: str) -> tuple[Any, np.ndarray, dict]:
    """A column of answers with its dimensions, its words, unit (`of`) and flags."""
    label: dict[str, Any] = {"long_name": column.description} | ({"units": of} if column.kind == "f8" else {})
    if column.flags:
        label |= {"flag_values": np.arange(len(column.flags), dtype=np.int8),
                  "flag_meanings": " ".join(flag.replace(" ", "_") or "none" for flag in column.flags)}
    if column.note:
        label |= {"comment": column.note}
    return dims, records[column.name].astype(column.kind, copy=False), label  # no copy of a large sweep


def _sampled(plan: Plan) -> dict[str, Any]:
    of = plan.sampled
    rows, keys = of.values(0, of.count), [key.name for key in of.keys]
    labels = names([*(axis.key.name for axis in plan.axes), *keys])[len(plan.axes):]
    columns = {label: ((SAMPLE,), rows[:, n], {"long_name": keys[n], "units": of.unit(n)})
               for n, label in enumerate(labels)}
    return {SAMPLE: ((SAMPLE,), np.arange(of.count, dtype=np.int32),
                     {"long_name": "number of a random point"}), **columns}


def _attributes(result: Swept) -> dict[str, Any]:
    plan, case = result.plan, result.plan.case
    broken = {"no_case": f"{result.broken} points: {printable(result.fault)}"} if result.broken else {}
    return {**origin(case, plan.command), "case_variables": case.variables, "case": plan.text,
            "sweep": plan.as_json(brief=True),
            "caveats": limiting.cell(case, limits_of(_case_of(result.plan), result.records)), **broken}


def origin(case: Case, command: str) -> dict[str, Any]:
    """Where a data set comes from: its attributes by the conventions CF."""
    return {"Conventions": "CF-1.11", "title": case.title or case.name, "source": f"stabilab {__version__}",
            "references": case.source, "history": command}
