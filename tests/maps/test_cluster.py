"""A sweep on the workers of a real Dask scheduler, and in processes that die: the same bytes, or one clear
error."""
from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import sysconfig
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from stabilab.errors import BAD_INPUT, InputError
from stabilab.maps import run as cluster
from stabilab.maps import run as workers
from stabilab.maps.parts import place_of
from stabilab.maps.plan import planned
from stabilab.maps.run import run
from tests.shared import CASES

MINOR = CASES / "minor-axis-100.toml"
# eight chunks of a second or two
ASKED = ("sweep", MINOR, "--vary", "x[1]=-4:4:60", "--vary", "x[3]=-3:3:4", "--answer",
         "fate,margin,distance")
posix = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


def started(*words, **options):
    return subprocess.Popen([sys.executable, "-m", "stabilab", *map(str, words)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **options)


def made(out, *more, asked=ASKED):
    """The bytes of the sweep's file, made by a process of its own."""
    command = started(*asked, "--out", out, *more)
    words = command.communicate(timeout=300)
    assert command.returncode == 0, words
    return out.read_bytes()


def until(number, out, command, pause=0.05):
    """Wait until so many parts of a sweep are finished."""
    while command.poll() is None and len(list(place_of(out).glob("part-*"))) < number:
        time.sleep(pause)
    assert command.poll() is None


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The bytes of the sweep by one worker of this machine."""
    return made(tmp_path_factory.mktemp("alone") / "here.nc", "--workers", 1)


@contextmanager
def a_cluster(folder, workers, environment=None, program=("-m", "distributed.cli.dask_worker")):
    """(address, processes of the workers) of a Dask scheduler on this machine."""
    told, quiet = folder / "scheduler.json", {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL,
                                              "cwd": folder}
    processes = [subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_scheduler", "--host",
                                   "127.0.0.1", "--port", "0", "--no-dashboard",
                                   "--scheduler-file", str(told)], **quiet)]
    try:
        while not told.exists() or not told.read_text():
            time.sleep(0.05)
        address = json.loads(told.read_text())["address"]
        words = [address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(folder)]
        processes += [subprocess.Popen([sys.executable, *program, *words], **quiet, env=environment)
                      for _ in range(workers)]
        if workers:  # a busy machine may take longer to start them than the program waits for the first
            from distributed import Client
            with Client(address, timeout=100, set_as_default=False) as client:
                client.wait_for_workers(workers, timeout=100)
        yield address, processes[1:]
    finally:
        for process in processes:
            process.kill()
            process.wait()


@pytest.mark.slow
def test_a_cluster_gives_the_bytes_of_this_machine_though_a_worker_is_killed_in_the_middle(tmp_path, alone):
    pytest.importorskip("distributed")
    with a_cluster(tmp_path, 3) as (address, workers):
        out = tmp_path / "cluster.nc"
        command = started(*ASKED, "--out", out, "--scheduler", address)
        until(2, out, command)
        workers[0].kill()
        words = command.communicate(timeout=300)
        assert command.returncode == 0, words
    assert out.read_bytes() == alone


@pytest.mark.slow
def test_a_worker_without_the_package_is_named(tmp_path):
    """In an environment that has everything but stabilab."""
    pytest.importorskip("distributed")
    site = tmp_path / "site"
    site.mkdir()
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if "stabilab" not in entry.name:
            (site / entry.name).symlink_to(entry)
    program = ("-S", "-c", "from distributed.cli.dask_worker import main; main()")
    with a_cluster(tmp_path, 1, {**os.environ, "PYTHONPATH": str(site)}, program) as (address, _):
        command = started(*ASKED, "--out", tmp_path / "map.nc", "--scheduler", address)
        out, err = command.communicate(timeout=100)
    assert command.returncode == BAD_INPUT and not out and "lacks the package stabilab" in err and err.count(
        "\n") == 1, err
    assert not (tmp_path / "map.nc").exists() and not place_of(tmp_path / "map.nc").exists()


@pytest.mark.slow
@pytest.mark.parametrize("workers, words", [(None, "does not answer"), (0, "has no workers")])
def test_a_scheduler_that_is_not_there_or_has_no_workers_is_one_error(tmp_path, workers, words):
    pytest.importorskip("distributed")
    address = "tcp://127.0.0.1:9"
    with a_cluster(tmp_path, 0) if workers is not None else pytest.MonkeyPatch.context() as found:
        command = started(*ASKED, "--out", tmp_path / "map.nc", "--scheduler",
                          found[0] if workers is not None else address)
        out, err = command.communicate(timeout=100)
    assert command.returncode == BAD_INPUT and not out and words in err and err.count("\n") == 1, err
    assert not (tmp_path / "map.nc").exists() and not place_of(tmp_path / "map.nc").exists()


def test_an_address_that_is_none_is_refused_before_any_work():
    pytest.importorskip("distributed")
    with pytest.raises(InputError,
                       match="expected an address"), run(planned(MINOR, {"x[1]": "0:1:3"}),
                                                         scheduler="localhost"):
        pass


def test_a_worker_makes_the_records_of_this_process():
    plan = planned(CASES / "wheel-and-thruster.toml", {"angular_velocity[1]": "0:1:2"}, answer="fate")
    kind, rows = cluster.computed(plan.as_json(), 0)
    with run(plan, workers=1) as found:
        assert kind == "records" and rows == found.records.tobytes()


ENDLESS = """
import sys, time
from pathlib import Path
from stabilab.maps import run as workers
def answered(plan, number):
    workers.parts.write(plan, Path(sys.argv[1]), number, b"begun")
    time.sleep(600)
workers.answered = answered
workers.main(Path(sys.argv[1]))
"""
PARENT = """
import signal, sys
from pathlib import Path
from stabilab.processes import helpers
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # which a run under nohup ignores, and hands on
with helpers("endless", Path(sys.argv[1]), 2) as found:
    for number, one in enumerate(found):
        one.stdin.write(b"%d\\n" % number)
        one.stdin.flush()
    signal.pause()
"""


@posix
@pytest.mark.parametrize("how",
                         [signal.SIGKILL,
                          *(pytest.param(one, marks=pytest.mark.slow)
                            for one in (signal.SIGTERM, signal.SIGHUP))])
def test_workers_end_in_the_middle_of_a_chunk_with_the_process_that_started_them(tmp_path, how):
    (tmp_path / "endless.py").write_text(ENDLESS)
    plan = planned(MINOR, {"x[1]": "0:1:2"})
    (tmp_path / workers.WORK).write_text(plan.as_json())
    around = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(CASES.parent)])}
    parent = subprocess.Popen([sys.executable, "-c", PARENT, tmp_path], stdout=subprocess.PIPE, env=around)
    begin = time.monotonic()
    while len(list(tmp_path.glob("part-*"))) < 2:
        assert parent.poll() is None and time.monotonic() < begin + 300
        time.sleep(0.02)
    parent.send_signal(how)
    # its stdout is that of its workers: it is closed when all of them have ended, whose chunks last ten
    # minutes
    parent.communicate(timeout=300)
    assert parent.returncode == -how


@posix
@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGTERM, pytest.param(signal.SIGHUP, marks=pytest.mark.long),
                                 pytest.param(signal.SIGKILL, marks=pytest.mark.long)])
def test_a_sweep_ended_by_a_signal_goes_on_from_its_parts_to_the_same_bytes(tmp_path, how, alone):
    out = tmp_path / "killed.nc"
    command = started(*ASKED, "--out", out, "--workers", "2")
    until(1, out, command)
    command.send_signal(how)
    command.communicate(timeout=300)
    finished = {path.name: path.stat().st_mtime_ns for path in place_of(out).glob("part-*")}
    time.sleep(2)
    assert finished == {path.name: path.stat().st_mtime_ns
                        for path in place_of(out).glob("part-*")} != {} and command.returncode == -how
    assert made(out, "--workers", "2") == alone
    assert [path.name for path in tmp_path.iterdir() if path.suffix != ".nc"] == []


@posix
@pytest.mark.slow
def test_a_worker_that_is_killed_is_one_error_and_keeps_what_is_finished(tmp_path):
    out = tmp_path / "map.nc"
    command = started(*ASKED, "--out", out, "--workers", "2")
    until(1, out, command)
    children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(command.pid)], capture_output=True,
                              text=True, check=True).stdout.split()
    os.kill(int(children[0]), signal.SIGKILL)
    words, err = command.communicate(timeout=100)
    assert command.returncode == BAD_INPUT and not words and "signal 9 (SIGKILL)" in err and err.count(
        "\n") == 1
    assert list(place_of(out).glob("part-*")) and made(out, "--workers", "2")


@posix
@pytest.mark.slow
def test_a_disk_that_is_full_is_one_error(tmp_path):
    def limit():
        import resource
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))
    command = started("sweep", MINOR, "--vary", "x[1]=-4:4:900", "--out", tmp_path / "map.nc", "--workers", 1,
                      preexec_fn=limit, env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})  # none is cut off
    words, err = command.communicate(timeout=100)
    assert command.returncode == BAD_INPUT and not words and "cannot be written: File too large" in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
