"""Data sets written in blocks have the bytes that xarray and SciPy write, which share no code with it."""
from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
import xarray

import stabilab
from stabilab.show.maps import netcdf, sweep
from tests.shared import CASES


def bare(built):
    for variable in built.variables.values():
        variable.encoding["_FillValue"] = None
    return built


def by_xarray(built):
    return bytes(bare(built).to_netcdf(engine="scipy"))


@pytest.mark.parametrize("vary, answer", [
    ({"x[1]": "-3:3:7"}, None), ({"x[1]": "-3:3:3", "x[2]": "-3:3:5"}, "fate,extremes,period"),
    ({"x[1]": "-3:3:3", "x[2]": "-3:3:5", "x[3]": "0,1"}, "fate,level,margin")])
@pytest.mark.parametrize("block", [1 << 17, 4])
def test_sweeps_have_the_bytes_of_xarray(tmp_path, monkeypatch, vary, answer, block):
    monkeypatch.setattr(netcdf, "BLOCK", block)
    built = bare(stabilab.sweep(CASES / "minor-axis-100.toml", vary, answer=answer))
    assert netcdf.fits(built)
    assert sweep.write(built, tmp_path / "map.nc").read_bytes() == by_xarray(built)


@pytest.mark.parametrize("built", [
    xarray.Dataset(), xarray.Dataset(attrs={"empty": "", "letters": "λ₁", "numbers": np.array([1.5, 2]), "one": 3}),
    xarray.Dataset({"few": ("n", np.array([1, 2, 3], np.int8)), "wide": ("n", np.array([1, -2, 3])),
                    "short": ("n", np.array([1, 2, 3], np.int16)), "single": ("n", np.float32([1, 2, 3])),
                    "point": ((), 2.5), "plane": (("n", "m"), np.arange(6.0).reshape(3, 2))},
                   {"m": ("m", np.array([0.5, 1.5]), {"units": "s"})})], ids=["nothing", "attributes", "kinds"])
def test_all_kinds_of_numbers_have_the_bytes_of_xarray(tmp_path, built):
    netcdf.write(bare(built), tmp_path / "some.nc")
    assert netcdf.fits(built) and (tmp_path / "some.nc").read_bytes() == by_xarray(built)


def test_what_does_not_fit_is_left_to_xarray():
    for values, coordinates in (({"name": ("n", np.array(["a", "b"]))}, {}),
                                ({"far": ("n", np.array([1, 2**40]))}, {}),
                                ({"v": ("n", np.zeros(2))}, {"other": ("n", np.ones(2))})):
        assert not netcdf.fits(xarray.Dataset(values, coordinates))


def test_a_column_is_written_without_another_of_its_size(tmp_path):
    """Counted by Python's allocator: 24 MB written with less than a quarter of that."""
    records = np.zeros(2_000_000, [("a", "f8"), ("b", "i1"), ("c", "f8")])
    built = bare(xarray.Dataset({name: ("n", records[name]) for name in "ac"}))
    tracemalloc.start()
    try:
        netcdf.write(built, tmp_path / "large.nc")
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert (tmp_path / "large.nc").stat().st_size > 32e6 and peak < 9e6
