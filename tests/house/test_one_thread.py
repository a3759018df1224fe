"""One thread in each process: of a command, unless the user says otherwise, and of each worker."""
from __future__ import annotations

import os
import subprocess
import sys

import pytest

from stabilab import threads
from stabilab.processes import helpers

# threads that NumPy starts for a product of matrices of a size for which BLAS would
COUNT = """
import os
before = len(os.listdir("/proc/self/task"))
import numpy as np
a = np.ones((600, 600))
a @ a
print(len(os.listdir("/proc/self/task")) - before)
"""
with_proc = pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="threads are counted in /proc")


@with_proc
def test_workers_have_one_thread_even_where_their_parent_has_more(tmp_path, monkeypatch):
    (tmp_path / "counting.py").write_text(COUNT)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    for name in threads.VARIABLES:
        monkeypatch.setenv(name, "4")
    with helpers("counting", tmp_path, 2, stdout=subprocess.PIPE, text=True) as workers:
        assert [worker.stdout.read().split() for worker in workers] == [["0"], ["0"]]
    assert os.environ[threads.VARIABLES[0]] == "4"


@with_proc
def test_a_command_has_one_thread_for_linear_algebra_unless_the_user_says_otherwise(tmp_path):
    program = ("import os\nimport stabilab.__main__ as program\nprogram._commands = lambda: lambda silence: None\n"
               "program.main()\nprint(os.environ['OPENBLAS_NUM_THREADS'])\n")
    bare = {name: value for name, value in os.environ.items() if name not in threads.VARIABLES}
    for chosen, expected in (({}, "1"), ({"OPENBLAS_NUM_THREADS": "3"}, "3")):
        run = subprocess.run([sys.executable, "-c", program + COUNT], env=bare | chosen, capture_output=True,
                             text=True, check=True)
        assert run.stdout.split()[0] == expected
        assert run.stdout.split()[1] == "0" or chosen


def test_a_library_in_a_program_of_others_changes_nothing_of_its_environment():
    bare = {name: value for name, value in os.environ.items() if name not in threads.VARIABLES}
    program = "import os, stabilab, stabilab.processes\nprint('OPENBLAS_NUM_THREADS' in os.environ)"
    run = subprocess.run([sys.executable, "-c", program], env=bare, capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False"]
