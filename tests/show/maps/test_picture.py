"""The picture of a sweep: where its boundary is, and what it cannot draw."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab import sweep
from stabilab.errors import InputError
from stabilab.maps.parts import case_of
from stabilab.maps.plan import planned
from stabilab.maps.run import changes
from stabilab.orbit.result import Fate
from stabilab.show import style
from stabilab.show.maps import picture, sweep_file
from stabilab.show.units import units_of
from tests.shared import CASES, MOVING

xarray = pytest.importorskip("xarray")
MINOR = CASES / "minor-axis-100.toml"


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweeps") / "map.nc"
    stabilab.sweep(MINOR, {"x[1]": "-4:4:9", "x[3]": "-3:3:7", "momentum[1]": "100, 200"}, out=path)
    return path


@pytest.mark.slow
def test_the_boundary_of_states_lies_where_the_margin_of_the_energy_is_zero():
    """The boundary asks for labels alone; the margin in balls is another way to the same place."""
    plan = planned(MINOR, {"momentum[1]": "100, 200", "x[1]": "1:4:4", "x[3]": "-3:3:7"})
    rows = np.array([[1, 0, 3], [1, 1, 5]])  # places of (2, 4, 0) with the second wheel, and of (2, 4, 2)
    for row in rows:
        spun = stabilab.fate(*_of(plan, row)).labels == stabilab.Fate.SPIN_UP
        share, = changes(plan, tuple(row), 1, row[None], np.array([spun]))
        scene, state = _of(plan, row)
        state[0] += share * 1.0
        assert abs(stabilab.motion(scene, state).margin_energy) < 1e-9


def _of(plan, row):
    case = case_of(plan, int(row[0]))
    state = list(case.state)
    state[0], state[2] = plan.axes[1].si[row[1]], plan.axes[2].si[row[2]]
    return case.scene, state


def test_pieces_of_the_boundary_close_a_circle():
    x, y = np.linspace(-2, 2, 31), np.linspace(-2, 2, 27)
    inside = x[:, None] ** 2 + y**2 < 1.2

    def way(at, along):  # the circle's own place on the line, by Pythagoras
        low, other = (x[at[:, 0]], y[at[:, 1]]) if along == 0 else (y[at[:, 1]], x[at[:, 0]])
        step = (x[1] - x[0], y[1] - y[0])[along]
        target = np.sqrt(1.2 - other**2) * np.where(low + step / 2 > 0, 1, -1)
        return (target - low) / step
    pieces = picture.segments_of(inside.astype(np.int8), x, y, way)
    assert np.abs((pieces**2).sum(axis=-1) - 1.2).max() < 1e-12
    assert np.linalg.norm(pieces[:, 1] - pieces[:, 0],
                          axis=1).sum() == pytest.approx(2 * np.pi * np.sqrt(1.2), rel=0.01)


def test_a_file_is_drawn_with_its_columns_by_name(swept, tmp_path, stabilab):
    assert stabilab("plot", swept, "--out", tmp_path / "a.png") == (0, f"{tmp_path / 'a.png'}\n", "")
    code, _, err = stabilab("plot", swept, "--kind", "period")
    assert code == 2 and "this file has fate, margin, level" in err
    picture.write(swept, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_what_is_no_sweep_is_refused(tmp_path, stabilab):
    other = tmp_path / "other.nc"
    assert "no such file" in stabilab("plot", other)[2]
    other.write_bytes(b"CDF nothing")
    code, _, err = stabilab("plot", other)
    assert code == 2 and "expected a file of stabilab sweep" in err
    sweep(MINOR, {"x[1]": "1"}, out=tmp_path / "one.nc")
    with pytest.raises(InputError, match="one point"):
        picture.write(tmp_path / "one.nc", tmp_path / "x.png")
    assert "got a folder" in _refused(tmp_path)


def _refused(path):
    path = path / "folder.nc"
    path.mkdir()
    with pytest.raises(InputError) as error:
        sweep_file.opened(path)
    return str(error.value)


def test_a_file_that_is_cut_off_or_changed_is_one_error(swept, tmp_path):
    whole, other = swept.read_bytes(), tmp_path / "other.nc"
    for content in (whole[:40], whole[:500], whole[:-40], whole.replace(b'"vary"', b'"vbry"'),
                    whole.replace(b"x_1", b"x_9"),
                    whole.replace(b"long_name", b"lung_name"), whole.replace(b"margin", b"morgin")):
        assert content != whole
        other.write_bytes(content)
        with pytest.raises(InputError, match="expected a file of stabilab sweep"):
            picture.write(other, tmp_path / "x.png")
    assert not (tmp_path / "x.png").exists()


def test_a_part_of_a_sweep_is_refused_since_its_boundary_would_be_that_of_another(swept, tmp_path):
    xarray.load_dataset(swept,
                        engine="scipy").isel(x_1=slice(2,
                                                       None)).to_netcdf(tmp_path / "part.nc", engine="scipy")
    with pytest.raises(InputError, match="its axis x_1 is not that of the sweep"):
        picture.write(tmp_path / "part.nc", tmp_path / "x.png")


def test_a_column_without_a_finite_number_is_refused_and_not_drawn_empty(tmp_path):
    # far above every barrier: a spin-up has no period
    sweep(MINOR, {"x[3]": "100:101:3"}, answer="period", out=tmp_path / "up.nc")
    with pytest.raises(InputError, match="no point has a finite value of period"):
        picture.write(tmp_path / "up.nc", tmp_path / "x.png")


def test_a_column_named_is_drawn_alone_along_one_axis(tmp_path):
    data = sweep(MINOR, {"x[1]": "1:2:3"}, answer="fate,margin,period", out=tmp_path / "line.nc")
    plan = sweep_file.opened(tmp_path / "line.nc")[1]
    with style.drawing() as plt:
        assert [ax.get_ylabel()
                for ax in picture.curves(data, plan, "period", "x_1", None, plt).axes] == ["period"]
        assert len(picture.curves(data, plan, "fate", "x_1", None, plt).axes) == 2


@pytest.mark.slow
@pytest.mark.parametrize("case, vary, options", [
    ("uncertain-separatrix", {}, {"samples": 50}),
    ("uncertain-separatrix", {"angular_velocity[1]": "0:1:3"}, {"samples": 20}),
    ("uncertain-separatrix", {"angular_velocity[1]": "0:1:3", "torque[3]": "1:100:4:log"}, {"samples": 10}),
    ("off-axis-two", {"torque[1]": "-0.2:0.2:5", "torque[2]": "-0.2:0.2:5"},
     {"answer": "equilibria,verdict"}),
    ("minor-axis-100", {"momentum[1]": "-300:300:21"}, {"answer": "fate,margin,extremes,period,verdict"}),
    ("minor-axis-100", {"momentum[1]": "-300:300:5", "x[1]": "0:4:5", "x[2]": "0:4:4", "x[3]": "0:1:5"}, {})])
def test_every_kind_of_sweep_has_its_picture(tmp_path, case, vary, options):
    stabilab.sweep(CASES / f"{case}.toml", vary, out=tmp_path / "map.nc", **options)
    assert picture.write(tmp_path / "map.nc", tmp_path / "map.png").stat().st_size > 5000


def test_a_size_of_which_no_picture_can_be_made_is_refused_for_maps_too(tmp_path):
    with pytest.raises(InputError, match="1 to 60 inches, got 100 x 100"):
        picture.write(tmp_path / "none.nc", tmp_path / "a.png", size=(100.0, 100.0))


def test_rates_and_times_of_a_map_have_the_units_of_the_case_or_those_asked_for(tmp_path):
    """Oracle: the file itself, in SI units; a turn is 2 pi, an hour 3600 s."""
    (tmp_path / "my.toml").write_text(f"{MOVING}span = [0, 300]\n")
    data = sweep(tmp_path / "my.toml", {"angular_velocity[1]": "1:3:3 deg/s"},
                 answer="fate,extremes,period,when", rate="10 deg/s", out=tmp_path / "a.nc")
    plan = sweep_file.opened(tmp_path / "a.nc")[1]
    told = sweep_file.in_units(data, units_of(plan.case, None))
    assert (told.least.attrs["units"], told.period.attrs["units"],
            data.least.attrs["units"]) == ("deg/s", "s", "rad/s")
    assert told.least.values == pytest.approx(
        np.degrees(data.least.values)) and told.period.values == pytest.approx(data.period.values)
    slow = sweep_file.in_units(data.assign(period=(data.period * 1000).assign_attrs(data.period.attrs)),
                               units_of(plan.case, "deg"))
    assert slow.period.attrs["units"] == "h" and slow.period.values == pytest.approx(data.period.values / 3.6)
    si = sweep_file.in_units(data, units_of(plan.case, "si"))
    assert si.least.attrs["units"] == "rad/s" and (si.least.values == data.least.values).all()
    with style.drawing() as plt:
        assert picture.curves(told, plan, "least", data.least.dims[0], None,
                             plt).axes[0].get_ylabel() == "extremes (deg/s)"


def test_a_map_says_what_its_white_cells_mean_and_is_refused_where_all_are(tmp_path):
    data = sweep(MINOR, {"x[1]": "0:4:3", "x[3]": "0:100:3"}, answer="fate,period,extremes",
                 out=tmp_path / "two.nc")
    plan = sweep_file.opened(tmp_path / "two.nc")[1]
    assert {0, 1} == set(data.fate.values.ravel().tolist())  # some stay, some spin up and have no period
    with style.drawing() as plt:
        figure = picture.drawn(data, plan, "period", None, plt)
        assert "white: never repeats" in [text.get_text() for text in figure.legends[0].get_texts()]
    sweep(MINOR, {"x[1]": "1, 2", "x[3]": "100, 101"}, answer="fate,extremes", out=tmp_path / "up.nc")
    # axes 1 and 2 have one, of three the greatest is without end
    with pytest.raises(InputError, match="no point has a finite value of greatest"):
        picture.write(tmp_path / "up.nc", tmp_path / "x.png", "greatest")


def test_the_line_of_margin_zero_goes_on_where_no_barrier_is_ahead():
    """By hand: margin = y - x^2 is zero on a parabola; beyond it there is none. Half a step would be 0.05."""
    x = y = np.linspace(0, 1, 11)
    margin = np.where((inside := y[None, :] - x[:, None]**2) > 0, inside, np.nan)
    fates = np.where(inside > 0, Fate.BOUNDED, Fate.SPIN_UP)
    lines = picture.segments_of(fates, x, y, lambda at, along: picture.zero_between(margin, at, along))
    ends = lines.reshape(-1, 2)
    assert len(lines) > 8 and np.abs(ends[:, 1] - ends[:, 0]**2).max() < 0.02
