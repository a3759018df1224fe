"""Basins in words, JSON, CSV, NetCDF and as a picture."""
from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.colors import to_rgb

import stabilab
from stabilab.errors import InputError
from stabilab.show.maps import basins, sweep_file, to_file
from stabilab.show.maps import picture as pictures
from stabilab.show.plot import basins as picture
from tests.shared import CASES

MINOR, PLANE = CASES / "minor-axis-100.toml", {"x[1]": "-4:4:12", "x[3]": "-3:3.1:11"}


@pytest.fixture(scope="module")
def minor():
    return stabilab.basin(MINOR, PLANE, depth=4)


def test_json_has_what_the_words_say_and_a_command_that_asks_the_same(minor):
    told = json.loads(basins.json(minor))
    assert told["schema"] == "stabilab.basin/1" and told["complete"] and told["states_asked"] == len(
        minor.records)
    assert {row["basin"]: row["share"]
            for row in told["basins"]} == {basins.basin_name(minor, k): v for k, v in minor.shares.items()}
    assert len(told["boundary"]["corners"]) == told["boundary"]["cells"] == len(
        told["boundary"]["separatrix"])
    assert told["box_dimension"]["value"] == minor.dimension.value and told["axes"][0]["cells"] == 11
    vary = dict(word.removeprefix("--vary=").split("=")
                for word in told["command"].replace("'", "").split()[3:5])
    again = stabilab.basin(MINOR, vary, depth=int(told["command"].rpartition("=")[2]))
    assert basins.json(again) == basins.json(minor)


def test_csv_has_a_line_for_each_cell_and_its_cells_cover_the_plane(minor):
    rows = list(csv.reader(io.StringIO(basins.csv(minor))))
    assert rows[0] == ["motion.x[1] from", "motion.x[1] to", "motion.x[3] from", "motion.x[3] to", "depth",
                       "basin", "caveats"]
    areas = [(float(b) - float(a)) * (float(d) - float(c)) for a, b, c, d, *_ in rows[1:]]
    assert sum(areas) == pytest.approx(8 * 6.1)
    assert {row[-2] for row in rows[1:]} == {"bounded", "spin-up about +x3", "boundary"}
    assert sum(row[-2] == "boundary" for row in rows[1:]) == len(minor.boundary)


def test_a_file_holds_the_basins_and_plot_draws_it(minor, tmp_path):
    path = tmp_path / "basin.nc"
    to_file.write_basins(minor, to_file.data_of(to_file.checked([path])))
    again = basins.opened(sweep_file.loaded(path))
    assert basins.text(again) == basins.text(minor) and np.array_equal(again.separatrix(), minor.separatrix())
    one, two = pictures.write(path, tmp_path / "one.png"), picture.write(minor, tmp_path / "two.png")
    assert one.read_bytes() == two.read_bytes() and one.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(InputError, match="one picture"):
        pictures.write(path, tmp_path / "three.png", kind="margin")


def test_a_file_that_was_changed_is_refused(minor, tmp_path):
    made = basins.dataset(minor)
    for name, value in (("fate", made.fate * 0), ("cell", made.cell * 0 + 10**6),
                        ("cell_depth", made.cell_depth * 0)):
        made.assign({name: value}).to_netcdf(tmp_path / f"{name}.nc", engine="scipy")
        with pytest.raises(InputError, match="changed"):
            pictures.write(tmp_path / f"{name}.nc", tmp_path / "a.png")
    assert not (tmp_path / "a.png").exists()


def test_the_picture_shows_each_basin_where_its_states_are(minor):
    """Colours of the cells that are drawn, beside the fates of states in their middles."""
    ax = stabilab.plot.basin(minor)
    corners = np.array([path.vertices[:4] for path in ax.collections[0].get_paths()])
    middle, sides = corners.mean(axis=1), np.ptp(corners, axis=1)
    states = np.insert(middle, 1, 4.0, axis=1)
    spun = stabilab.fate(stabilab.load(MINOR).scene, states).labels == stabilab.Fate.SPIN_UP
    wrong = (ax.collections[0].get_facecolor()[:, :3] != np.where(spun[:, None], to_rgb(picture.AREAS[3]),
                                                                  to_rgb(picture.AREAS[0]))).any(axis=1)
    assert sides.prod(axis=1).sum() == pytest.approx(8 * 6.1)
    assert sides[wrong].prod(axis=1).sum() < minor.blur * 8 * 6.1
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x_1$",
                                                  "$x_3$") and len(ax.collections[-1].get_segments()) == len(
                                                      minor.boundary)
    legend = ax.figure.legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["spin-up about +x3", "bounded",
                                                                "separatrix (exact)", "the case itself"]
    plt.close("all")


def test_files_are_judged_before_the_work():
    for paths, told in (((MINOR.with_suffix(".txt"),), "ends in"),
                        ((MINOR.with_name("a.nc"), MINOR.with_name("b.nc")), "one data set")):
        with pytest.raises(InputError, match=told):
            to_file.data_of(to_file.checked(paths))


def test_a_case_has_no_basins_of_its_own_and_the_plot_says_what_it_takes():
    with pytest.raises(InputError, match=r"plot.basin: expected the basins of a plane, got Case.*: "
                                         r"found = stabilab.basin\(case, "):
        stabilab.plot.basin(stabilab.load(MINOR))
