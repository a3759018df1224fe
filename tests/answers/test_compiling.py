"""Everything that is compiled, compiled once: afterwards no process compiles."""
from __future__ import annotations

import os
import subprocess
import sys
from types import ModuleType

import numpy as np
import pytest

from stabilab.answers.motions import compiling
from stabilab.errors import InputError
from stabilab.numbers import numba_door
from stabilab.numbers.numba_door import installed

TASKS_ONCE_MORE = """
from stabilab.answers.motions.compiling import TASKS, compile_all, kernels
print(all(kernel.on_disk() for kernel in kernels()))
for task in TASKS:
    task()
stats = [function.stats for kernel in kernels() for function in kernel.functions(True).values()
         if hasattr(function, "stats")]
print(sum(sum(one.cache_misses.values()) for one in stats))
"""


@pytest.mark.slow
@pytest.mark.skipif(not installed(), reason="nothing is compiled without numba")
def test_what_is_compiled_once_is_on_disk_for_all_processes(tmp_path):
    """numba counts what it loads and what it misses, optimising little; without any it puts nothing on disk."""
    surroundings = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_OPT": "1"}
    surroundings.pop("STABILAB_QUIET", None)

    def run(program):
        return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True,
                              env=surroundings)
    first = run("from stabilab.answers.motions.compiling import compile_all\nprint(compile_all())")
    assert first.stdout.strip() == str(tmp_path) and first.stderr.count("compiling loops") == 1
    again = run(TASKS_ONCE_MORE)
    assert again.stdout.split() == ["True", "0"] and not again.stderr


def test_without_numba_or_a_folder_to_write_to_an_error_says_what_to_do(monkeypatch):
    monkeypatch.setattr(compiling, "TASKS", ())
    monkeypatch.setattr("stabilab.numbers.numba_door.Kernel.on_disk", lambda kernel: False)
    monkeypatch.setattr(compiling, "installed", lambda: True)
    with pytest.raises(InputError, match="NUMBA_CACHE_DIR"):
        compiling.compile_all()
    monkeypatch.setattr(compiling, "installed", lambda: False)
    with pytest.raises(InputError, match="pip install numba"):
        compiling.compile_all()


@pytest.mark.skipif(not installed(), reason="nothing is compiled without numba")
def test_no_function_is_compiled_by_two_tasks():
    """numba keeps an index on disk of each function, by file and name: two processes that write one at once may
    lose an entry, or name one file for two."""
    def called(kernel):
        """(file, name) of the functions of a kernel's own module, and of all that these call."""
        made = {name: item.py_func for name, item in kernel.functions(True).items() if hasattr(item, "py_func")}
        names, open_ = set(), [name for name, item in made.items()
                               if item.__code__.co_filename == kernel.module.__file__]
        while open_:
            names.add(name := open_.pop())
            open_ += [other for other in made[name].__code__.co_names if other in made and other not in names]
        return {(made[name].__code__.co_filename, made[name].__qualname__) for name in names}
    rows, others = (set().union(*(called(kernel) for kernel in compiling.kernels()
                                  if (".orbit." in kernel.module.__name__) == of_orbits))
                    for of_orbits in (True, False))
    assert rows and others and rows.isdisjoint(others)
    assert [task.__name__ for task in compiling.TASKS] == ["rows", "off_the_axes"]


def test_no_name_has_two_values_in_modules_that_are_compiled_together():
    """A function sees the names of all modules that are compiled with its own, and one that several kernels call is
    compiled once for all of them."""
    kernels = [kernel for kernel in compiling.kernels() if len(numba_door._below(kernel.module)) > 1]
    modules = {each for kernel in kernels for each in (*numba_door._below(kernel.module), kernel.module)}
    assert len(modules) == 5  # sums of twofold numbers, arcs, equilibria, rows, turns
    values = {}
    for module in modules:
        for name, value in vars(module).items():
            if not name.startswith("__") and name != "BELOW" and not isinstance(value, ModuleType):
                other = values.setdefault(name, value)
                assert other is value or np.array_equal(other, value), name
    assert len({(str(kernel.inlined), str(kernel.options), kernel.variant) for kernel in kernels}) == 1
