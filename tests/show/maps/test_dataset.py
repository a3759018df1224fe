"""A sweep as a data set, a NetCDF file, text, CSV and JSON."""
from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

import stabilab
from stabilab.show.maps import shades as labels
from tests.shared import CASES

xarray = pytest.importorskip("xarray")
MINOR = CASES / "minor-axis-100.toml"
VARY = {"momentum[1]": "100, 200", "x[3]": "-3:3:4"}


def test_a_data_set_is_labelled_by_what_varies():
    found = stabilab.sweep(MINOR, VARY, answer="fate,margin,extremes")
    assert found.fate.dims == ("momentum_1", "x_3") and found.least.dims == ("momentum_1", "x_3", "axis")
    assert found.momentum_1.attrs == {"long_name": "effects.gyrostat.momentum[1]", "units": "N m s"}
    alone = stabilab.fate(stabilab.load(MINOR).scene, [2.5, 4.0, -3.0])
    assert found.fate.sel(momentum_1=100, x_3=-3.0) == alone.labels
    assert float(found.margin.sel(momentum_1=100, x_3=-3)) == pytest.approx(float(alone.margins))
    assert found.fate.attrs["flag_meanings"].split()[int(alone.labels)] == stabilab.Fate(
        int(alone.labels)).word


def test_a_file_reads_back_as_it_was_written_and_says_how_it_was_made(tmp_path):
    made = stabilab.sweep(MINOR, VARY, answer="fate,period,equilibria", out=tmp_path / "map.nc")
    with xarray.open_dataset(tmp_path / "map.nc") as read:
        xarray.testing.assert_identical(read.load(), made)
        assert read.attrs["case"] == MINOR.read_text(encoding="utf-8") and read.attrs[
            "Conventions"].startswith("CF-")
        assert read.attrs[
            "history"] == "stabilab sweep minor-axis-100.toml '--vary=momentum[1]=100, 200' '--vary=x[3]=-3:3:4' --answer=fate,period,equilibria"
    assert [path.name for path in tmp_path.iterdir()] == ["map.nc"]


def test_the_bytes_are_the_same_for_one_process_and_for_two(tmp_path):
    """Three chunks, each of which any process may compute."""
    for workers in (1, 2):
        stabilab.sweep(MINOR, {"x[3]": "-1:1:45"}, answer="fate,margin,when", rate="1e6",
                       out=tmp_path / f"{workers}.nc", workers=workers)
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()


def test_samples_are_a_dimension_with_their_numbers_as_coordinates():
    found = stabilab.sweep(CASES / "uncertain-minor-axis.toml", samples=6, seed=3)
    assert found.fate.dims == ("sample", ) and found.inertia_1.dims == ("sample", )
    assert ((found.inertia_1 - 2000) ** 2 <= 20**2).all()


def test_points_that_are_no_case_are_marked_in_the_file():
    found = stabilab.sweep(MINOR, {"inertia[1]": "2000, -9000"}, answer="fate,equilibria,margin")
    assert found.fate.values.tolist()[1] == 5 and np.isnan(found.margin[1]) and found.equilibria[
        1] == -3 and "positive" in found.attrs["no_case"]


def test_short_names_are_those_that_tell_the_keys_apart():
    assert labels.names(["wheels.W1.momentum", "wheels.W2.momentum",
                         "motion.x[1]"]) == ["W1_momentum", "W2_momentum", "motion_x_1"]
    assert labels.names(["motion.x[1]"]) == ["x_1"]


def test_csv_and_json_hold_every_point(stabilab):
    arguments = ("sweep", MINOR, "--vary", "x[1]=-4:4:3", "--vary", "momentum[1]=100,200", "--answer",
                 "fate,margin,extremes")
    rows = list(csv.DictReader(io.StringIO(stabilab(*arguments, "--csv")[1])))
    told = json.loads(stabilab(*arguments, "--json")[1])
    assert told["schema"] == "stabilab.sweep/1" and told["shape"] == [3, 2] and len(rows) == 6
    assert [float(row["margin"]) for row in rows] == told["columns"]["margin"]["values"]
    assert [row["fate"] for row in rows] == [told["columns"]["fate"]["flags"][n]
                                             for n in told["columns"]["fate"]["values"]]
    assert [float(row["greatest3"])
            for row in rows] == [float(value) for value in told["columns"]["greatest"]["values"][2::3]]
    assert [float(row["effects.gyrostat.momentum[1] (N m s)"])
            for row in rows[:2]] == told["axes"][1]["values"] == [100, 200]


@pytest.mark.parametrize("arguments, words", [
    (("--vary", "x[7]=0:1:3"), "did you mean motion.x["), (("--vary", "x[1]"), "--vary: expected KEY="),
    ((), "nothing varies"),
    (("--vary", "x[1]=0:1:3", "--out", "map.txt"), "ends in .nc"),
    (("--vary", "x[1]=0:1:3", "--workers", "0"), "workers: expected")])
def test_bad_input_ends_with_2_and_one_message(stabilab, arguments, words):
    code, out, err = stabilab("sweep", MINOR, *arguments)
    assert code == 2 and not out and words in err and err.count("\n") == 1
