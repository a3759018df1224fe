"""Loops as written or compiled: what is counted, when compiled code is loaded, and what is on disk."""
from __future__ import annotations

import gc
import importlib.util
import math
import sys

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.numbers import numba_door
from stabilab.numbers.numba_door import (
    BEGIN,
    IMPORT,
    LOAD,
    Account,
    Kernel,
    by_the_c_library,
    compiled,
    stored,
)

with_numba = pytest.mark.skipif(not numba_door.installed(), reason="nothing is compiled without numba")
ROW = 3e-4
START = 0.2  # s of a processor: what a process takes before its first call, at least


def test_where_no_folder_is_writable_a_module_compiles_without_a_cache(monkeypatch):
    asked = []

    def compiled(module, inlined, cache, *names):
        asked.append(cache)
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return {"orbits": "kernel"}
    monkeypatch.setattr(numba_door, "_compiled", compiled)
    assert numba_door.compiled(numba_door, ()) == {"orbits": "kernel"} and asked == [True, False]


class Process:
    """A process of its own, counted: what its calls cost by the prices of the module."""

    def __init__(self, monkeypatch, on_disk):
        self.kernel, self.time, self.loads = Kernel(math, "rows", 9.0, account=Account()), 0.0, 0
        self.on_disk, self.begun = on_disk, False
        monkeypatch.setattr(numba_door, "installed", lambda: True)
        monkeypatch.setattr(numba_door, "compiled", self.load)
        monkeypatch.setattr(numba_door, "_begun", lambda: self.begun)
        monkeypatch.setattr(numba_door, "stored", lambda function: on_disk)
        monkeypatch.setattr(numba_door, "_announced", [])
        monkeypatch.delenv("STABILAB_QUIET", raising=False)
        monkeypatch.delitem(sys.modules, "numba", raising=False)

    def load(self, *module):
        self.loads += 1
        self.time += IMPORT
        return {"rows": None}

    def begin(self):
        self.begun = True
        self.time += BEGIN

    def call(self, rows):
        before = self.kernel.ready
        fast = self.kernel.pays(ROW * rows)
        if fast and self.on_disk and not self.begun:
            self.begin()
        self.time += 0.0 if fast else ROW * rows
        self.time += self.kernel.seconds if fast and not before and not self.on_disk else 0.0
        return fast


@pytest.mark.parametrize("on_disk", [True, False])
@pytest.mark.parametrize("rows", [1, 10, 100, 900, 1000, 40_000])
def test_no_process_costs_over_twice_the_better_choice_and_no_call_doubles_what_was_spent(
        monkeypatch, capsys, rows, on_disk):
    """The better choice is plain Python for all that was asked, or loading (compiling) at once."""
    process, price = Process(monkeypatch, on_disk), IMPORT + (BEGIN if on_disk else 9.0)
    calls, times = min(20_000, 40 + int(3 * price / (ROW * rows))), [0.0]
    for n in range(1, calls + 1):
        before = process.time
        process.call(rows)
        better = min(n * rows * ROW, price)
        assert process.time <= (2 * better + ROW * rows + IMPORT if not on_disk else 2 * better) + 1e-9
        assert n == 1 or process.time <= 2 * (before + ROW * rows) + 1e-9
        if n == 1 and rows * ROW < IMPORT:
            assert process.time == rows * ROW
        times.append(process.time)
        # loading once falls between n/2 calls and n; compiling, dearer than the start of a process, may double it
        assert START + times[n] <= (2 if on_disk else 4) * (START + times[n // 2] + ROW * rows) + 1e-9
    assert process.loads == (calls * rows * ROW >= IMPORT)
    assert capsys.readouterr().err.count("compiling loops") == (not on_disk and process.kernel.ready)


def test_a_second_kernel_costs_no_second_import(monkeypatch):
    monkeypatch.setattr(numba_door, "installed", lambda: True)
    monkeypatch.setitem(sys.modules, "numba", math)
    kernel = Kernel(math, "rows", 9.0, account=Account())
    assert kernel.left() == LOAD and not kernel.pays(LOAD / 2) and kernel.left() == LOAD / 2


def test_kernels_rent_together_for_numba_and_each_for_its_own_code(monkeypatch):
    process = Process(monkeypatch, on_disk=True)
    one, other = process.kernel, Kernel(math, "rows", 9.0, account=process.kernel.account)
    assert not one.pays(0.75 * IMPORT) and other.left() == pytest.approx(0.25 * IMPORT)
    assert not other.pays(0.26 * IMPORT) and process.loads == 1  # numba is imported, and has not begun
    monkeypatch.setitem(sys.modules, "numba", math)
    assert not one.pays(0.0) and process.loads == 2 and one.left() == other.left() <= BEGIN
    assert other.pays(BEGIN) and not one.ready
    process.begin()
    assert one.left() == 0 and one.pays(0.0)  # it has rented for its own long since
    third = Kernel(math, "rows", 9.0, account=one.account)
    assert third.left() == LOAD and not third.pays(LOAD / 2)


def test_what_kernels_share_is_paid_for_once(monkeypatch):
    process = Process(monkeypatch, on_disk=False)
    one, other, third = (Kernel(math, "rows", own, below=("shared", 5.0), account=process.kernel.account)
                         for own in (4.0, 3.0, 2.0))
    monkeypatch.setattr(numba_door, "compiled", lambda *module: {"rows": None, "shared": "shared"})
    for kernel in (one, other):
        assert not kernel.pays(IMPORT) and kernel.left() == pytest.approx(kernel.seconds + 5.0 - IMPORT)
    assert one.pays(9.1) and other.left() == pytest.approx(3.0 - IMPORT)
    monkeypatch.setattr(numba_door, "stored", lambda function: function == "shared")
    third.account = Account()  # of a process that begins when these are on disk
    assert not third.pays(IMPORT) and third.left() == pytest.approx(2.0 - IMPORT)


@pytest.mark.parametrize("enabled", [True, False])
def test_a_load_that_fails_leaves_collecting_as_it_was(enabled, monkeypatch):
    monkeypatch.setattr(numba_door, "compiled", lambda *module: 1 / 0)
    before = gc.isenabled()
    try:
        (gc.enable if enabled else gc.disable)()
        with pytest.raises(ZeroDivisionError):
            Kernel(math, "rows", 9.0, account=Account()).functions(True)
        assert gc.isenabled() == enabled
    finally:
        (gc.enable if before else gc.disable)()


def test_what_the_user_chose_is_not_counted(monkeypatch):
    kernel = Kernel(math, "rows", 9.0, account=Account())
    assert not kernel.pays(100.0, fast=False) and kernel.spent == kernel.account.spent == 0
    monkeypatch.setattr(numba_door, "installed", lambda: False)
    assert not kernel.pays(100.0) and kernel.left() == math.inf
    with pytest.raises(InputError, match="pip install numba"):
        kernel.pays(100.0, fast=True)


@with_numba
def test_code_on_disk_is_seen_until_its_source_changes(tmp_path, monkeypatch):
    from numba import config
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path / "cache"))
    source = tmp_path / "few_lines.py"
    source.write_text("def double(x):\n    return 2 * x\n")
    spec = importlib.util.spec_from_file_location("few_lines", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    first = compiled(module)["double"]
    assert not stored(first) and first(3.0) == 6.0
    assert stored(first) and stored(compiled(module)["double"])
    source.write_text("def double(x):\n    return 2 * x  # another version\n")
    assert not stored(compiled(module)["double"])
    assert not stored(math.sin)  # nothing that numba made


def test_plain_code_has_the_functions_of_the_c_library_and_infinities_as_numpy():
    """`math` is the C library's; where it refuses, C has these values (C11, annex F)."""
    library, x = by_the_c_library(), np.random.default_rng(1).normal(size=200) * 3
    for name, function in numba_door.FROM_C.items():
        inside = np.tanh(x) if name in ("arcsin", "arccos", "arctanh") else np.abs(x) + 1
        got = [getattr(library, name)(*(v,) * (1 + (name == "arctan2"))) for v in inside]
        assert got == [function(*(v,) * (1 + (name == "arctan2"))) for v in inside.tolist()]
        assert isinstance(got[0], np.float64)
    with np.errstate(all="ignore"):
        assert library.exp(1e4) == math.inf and library.log(0.0) == -math.inf
        assert math.isnan(library.log(-1.0)) and library.sqrt(4.0) == 2.0
