"""What is kept on disk between runs is an answer only where it is what was derived: same content, same
versions, whole, and of known classes."""
from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass, replace
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, LiquidCavity, Scene
from stabilab.cache import MOST, cache_folder, kept
from stabilab.physics import equations, to_numpy


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("STABILAB_CACHE", str(tmp_path / "kept"))
    return tmp_path / "kept"


@dataclass(frozen=True)
class Made:
    """What is kept in these tests."""

    value: Any


def made(content, value, versions=("1",), sources=None):
    """(what `kept` gives, whether it was made anew)."""
    asked = []
    found = kept("kind", content, sources or Path(__file__).parent, versions,
                 lambda: asked.append(1) or Made(value), {"Made": Made})
    return found.value, bool(asked)


def test_the_same_content_is_made_once_and_other_content_or_versions_anew(folder, tmp_path):
    assert made("a", Fraction(1, 3)) == (Fraction(1, 3), True) and made("a", None) == (Fraction(1, 3), False)
    assert made("b", Fraction(1))[1] and made("a", Fraction(2), versions=("2",))[1]
    source = tmp_path / "code" / "law.py"
    source.parent.mkdir()
    source.write_text("one")
    assert made("a", Fraction(3), sources=source.parent)[1] and not made("a", None, sources=source.parent)[1]
    source.write_text("another")  # code of the same version that was changed
    assert made("a", Fraction(4), sources=source.parent) == (Fraction(4), True)


def whole(data):
    return sha256(data).hexdigest().encode() + b"\n" + data


STRANGE = [["+", "__import__('os').mkdir('made')"], ["+", "x", ["q", 1, 2]], ["q", "1", 2], ["/", 1.5, 2],
           ["x", 3, {}],
           ["record", "Path", {}], ["^", ["q", 1, 2]], ["eval", "1"], [], {"a": 1}]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("data", [b"", b"x" * 100, whole(b"no JSON"),
                                  b"\n" + json.dumps(["record", "Made", {"value": 3}]).encode(), whole(b"3"),
                                  *(whole(json.dumps(wrapped).encode()) for one in STRANGE
                                    for wrapped in (one, ["record", "Made", {"value": one}]))])
def test_a_broken_or_a_strange_file_is_no_answer_and_is_written_anew(folder, data):
    made("a", Fraction(1, 3))
    file, = folder.rglob("*.json")
    file.write_bytes(data)
    assert made("a", Fraction(1, 7)) == (Fraction(1, 7), True) and made("a", None) == (Fraction(1, 7), False)


def test_where_nothing_can_be_written_or_is_to_be_kept_it_is_derived_each_time(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    for place in (str(tmp_path / "file" / "below"), "off"):
        monkeypatch.setenv("STABILAB_CACHE", place)
        assert made("a", Fraction(1)) == (Fraction(1), True) and made("a", Fraction(2)) == (Fraction(2), True)
    assert cache_folder() is None and [file.name for file in tmp_path.iterdir()] == ["file"]


@pytest.mark.slow
def test_the_folder_never_holds_many_files(folder):
    for n in range(MOST + 1):
        made(str(n), Fraction(n))
    assert len(list(folder.rglob("*.json"))) <= MOST and not list(folder.rglob(".*"))


def test_equations_from_disk_are_those_derived(folder):
    """Symbols, numbers and rates of a body with wheel, torque and liquid, derived and then read; the rates
    without the liquid by Euler's equations."""
    rigid = Body((2000, 1500, 1000)), Gyrostat((100, 0, 0)), ConstantTorque((0, 0, 20))
    for scene, files in ((Scene(*rigid), 1), (Scene(*rigid, LiquidCavity(1000, 1e-4, 1e-9)), 2)):
        seen = []
        for _ in range(2):
            equations._physical.cache_clear()
            to_numpy._system.cache_clear()
            system = to_numpy.to_numpy(stabilab.derive(scene))
            seen.append((system.equations.rhs, system.equations.parameters, system.equations.symbols,
                         system.equations.balances, system.rhs,
                         system.entries, system.quantities, system.rates, system([0.1, 0.2, 0.3]).tolist()))
        assert seen[0] == seen[1] and len(list(folder.rglob("*.json"))) == files
        if files == 1:
            euler = [500 * 0.06 / 2000, (-1000 * 0.03 - 100 * 0.3) / 1500,
                     (500 * 0.02 + 100 * 0.2 + 20) / 1000]
            np.testing.assert_allclose(seen[0][-1], euler, rtol=1e-14)


def test_compiled_rates_load_none_of_numpys_tools():
    """A star import of NumPy loads its tests and its reader of Fortran, a fifth of a small command's time."""
    code = ("import sys, stabilab; from stabilab.physics.to_numpy import to_numpy; "
            "to_numpy(stabilab.derive(stabilab.Scene(stabilab.Body((3, 2, 1.5)))))([1, 2, 3]); "
            "print(*{'numpy.f2py', 'numpy.testing'} & set(sys.modules))")
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True,
                          text=True).stdout == "\n"


def test_numbers_that_are_equal_as_doubles_alone_have_equations_of_their_own(folder):
    """0.1 in decimals is 1/10; the double next to it is 3602879701896397/2^55 (IEEE 754)."""
    double = Fraction(3602879701896397, 2**55)
    for _ in range(2):
        for given, moment in (("0.1", Fraction(1, 10)), (0.1, double)):
            equations._physical.cache_clear()
            scene = Scene(Body((given, "0.12", "0.15")), ConstantTorque((given, 0, 0)),
                          LiquidCavity(1000, 1e-4, 1e-9))
            parameters = stabilab.derive(scene).parameters
            assert parameters["D1"] == parameters["M1"] == moment


class Own(ConstantTorque):
    """An effect of a user's own."""


def test_a_users_own_effects_and_changed_copies_are_never_kept(folder):
    to_numpy.to_numpy(stabilab.derive(Scene(Body((2000, 1500, 1001)), Own((0, 0, 20)))))
    derived = stabilab.derive(Scene(Body((2000, 1500, 1002)), ConstantTorque((0, 0, 20))))
    assert derived.content and not replace(derived, energy=derived.energy * 2).content
    assert len(list(folder.rglob("*.json"))) == 1
