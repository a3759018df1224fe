"""A point of a sweep has the answer of the case that has its numbers."""
from __future__ import annotations

import itertools
import os
import subprocess
import sys
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.case.read import read_text
from stabilab.errors import InputError
from stabilab.maps import blocks, columns, parts
from stabilab.maps.parts import answered
from stabilab.maps.plan import from_json, planned
from stabilab.maps.run import Swept, run
from stabilab.orbit.result import Fate
from stabilab.show.maps import netcdf
from stabilab.show.maps import sweep as words
from tests.shared import CASES


def swept(name, vary, **options):
    with run(planned(CASES / f"{name}.toml", vary, **options), workers=1) as found:
        return found


def written(case_file, name, **replaced):
    """The same case as a file of its own, with other lines: the oracle never meets the code that puts numbers
    in."""
    lines = (CASES / f"{name}.toml").read_text(encoding="utf-8").splitlines()
    path = case_file("\n".join(next((f"{key} = {value}" for key, value in replaced.items()
                                     if line.startswith(f"{key} =")), line) for line in lines), "point")
    return stabilab.load(path)


def test_points_have_the_answers_of_cases_written_by_hand(case_file):
    found = swept("minor-axis-100", {"momentum[1]": "-100, 250", "x[3]": "-3:3:5"},
                  answer="fate,margin,distance,extremes,period")
    for (i, wheel), (j, rate) in itertools.product(enumerate((-100, 250)), enumerate((-3, -1.5, 0, 1.5, 3))):
        one = written(case_file, "minor-axis-100", momentum=[wheel, 0, 0], x=[2.5, 4.0, rate])
        expected, row = motion(one.scene, one.start, one.span), found.records[i, j]
        assert (row["fate"], row["spin_axis"]) == (expected.fate, expected.axis * expected.sense)
        assert row["margin"] == pytest.approx(-np.inf if expected.margin_energy is None
                                              else expected.margin_energy, rel=1e-9, abs=1e-9)
        assert row["distance"] == pytest.approx(np.inf if expected.margin_velocity is None
                                                else expected.margin_velocity, rel=1e-8)
        assert np.stack([row["least"], row["greatest"]],
                        axis=1) == pytest.approx(np.array(expected.extremes), rel=1e-9, abs=1e-9)
        assert row["period"] == pytest.approx(expected.period or np.inf, rel=1e-9)


def test_the_order_of_the_axes_is_the_users():
    one = swept("minor-axis-100", [("momentum[1]", "100:300:3"), ("x[3]", "0:3:4")])
    other = swept("minor-axis-100", [("x[3]", "0:3:4"), ("momentum[1]", "100:300:3")])
    assert one.records.shape == (3, 4) and (one.records == other.records.T).all()


def test_a_state_in_the_frame_of_a_full_tensor_is_turned(case_file):
    found = swept("upper-stage", {"angular_velocity[2]": "-1:1:3 deg/s"}, answer="extremes")
    for n, rate in enumerate(("-1 deg/s", "0 deg/s", "1 deg/s")):
        one = written(case_file, "upper-stage", angular_velocity=f'["1.5 deg/s", "{rate}", "-0.05 deg/s"]')
        start = np.array(one.state)
        assert (found.records["least"][n] <= start
                + 1e-12).all() and (start <= found.records["greatest"][n] + 1e-12).all()
        assert found.records["least"][n] == pytest.approx(stabilab.extremes(one.scene, start, one.span)[:, 0],
                                                          abs=1e-9)


def test_equilibria_are_counted_with_their_verdicts(case_file):
    found = swept("off-axis-two", {"torque[3]": "-0.1, 0.1"}, answer="equilibria,verdict")
    # by hand, in the case's own comment: two of them iff M1 M2 M3 > 0
    for n, torque in enumerate((-0.1, 0.1)):
        one = written(case_file, "off-axis-two", torque=[0.1, 0.2, torque])
        assert found.records["equilibria"][n] == len(equilibria(one.scene).points) == (2 if torque > 0 else 0)
        assert found.records["unstable"][n] == (2 if torque > 0 else 0) and found.records["stable"][n] == 0


def test_a_limit_is_reached_when_the_case_alone_reaches_it():
    found = swept("cubesat-3u", {"wheels.pitch.speed": "3000 rpm"}, answer="fate,level,when")
    case = stabilab.load(CASES / "cubesat-3u.toml")
    alone = stabilab.time_to(case.scene, case.state, rate="1.0471975511965977")  # 60 deg/s
    assert found.records["when_low"][0] == pytest.approx(alone.low, rel=1e-9)
    assert found.records["fate"][0] == Fate.SPIN_UP


def test_scenes_without_arrays_are_answered_one_by_one():
    found = swept("liquid-base", {"angular_velocity[1]": "0, 0.5"}, answer="fate,extremes,verdict")
    for n, rate in enumerate(("0", "0.5")):
        text = (CASES / "liquid-base.toml").read_text(encoding="utf-8")
        case = stabilab.load(CASES / "liquid-base.toml")
        first = next(line for line in text.splitlines() if line.startswith("angular_velocity"))
        one = read_text("x.toml",
                        text.replace(first,
                                     f"angular_velocity = [{rate}, {case.state[1]!r}, {case.state[2]!r}]"))
        expected = motion(one.scene, one.start, one.span)
        assert found.records["fate"][n] == expected.fate and found.records["greatest"][n] == pytest.approx(
            [b for _, b in expected.extremes])


def test_a_period_that_nobody_knows_is_none_and_the_words_say_so():
    """+inf is of motions that never repeat. The one command says of this top: no period is known of this
    motion (bounded)."""
    found = swept("top-fast", {"angular_velocity[1]": "0, 1"}, answer="fate,period")
    assert found.records["fate"].tolist() == [Fate.BOUNDED] * 2 and np.isnan(found.records["period"]).all()
    told = words.text(found)
    assert told.count("not known") == 3 and "nan" not in told and "inf" not in told


@pytest.mark.slow
def test_what_has_no_end_and_what_has_no_number_are_told_in_words():
    """The torque of the case spins this body up: its rates have no end; beside a wheel and a torque on an
    axis equilibria fill curves."""
    told = words.text(swept("wheel-and-thruster", {"torque[3]": "0, 204.1, 2000"},
                            answer="fate,margin,extremes,period,when,equilibria", rate="5000 deg/s"))
    table = told.split("torque[3]")[1]
    assert "inf" not in told and "unbounded at 2" in told and "no barrier ahead at 1" in told
    assert "no barrier" in table and "never at 1" in told
    assert "curves" in table and "-1" not in table.split()


def test_a_limit_is_asked_of_scenes_without_arrays_too():
    found = swept("top-fast", {"lambda": "0.5, 1"}, answer="when", component="1 = 100")
    for n, share in enumerate(("0.5", "1")):
        text = (CASES / "top-fast.toml").read_text(encoding="utf-8")
        first = next(line for line in text.splitlines() if line.startswith("lambda"))
        one = read_text("x.toml", text.replace(first, f"lambda = {share}"))
        alone = stabilab.time_to(one.scene, one.start, component=(1, 100.0))
        told = [found.records["when_low"][n], found.records["when_high"][n]]
        assert np.array_equal(told, np.array([alone.low, alone.high], float), equal_nan=True)


def test_numbers_that_make_no_case_are_told_and_nothing_else_is_lost():
    found = swept("minor-axis-100", {"inertia[1]": "2000, -9000"})
    assert found.records["valid"].tolist() == [1, 0] and found.broken == 1 and "positive" in found.fault
    with pytest.raises(InputError, match="none of the 1 points makes a case: .*positive"):
        swept("minor-axis-100", {"inertia[1]": "-9000"})


def test_samples_lie_in_the_box_and_the_nth_is_the_same_for_any_number():
    few, many = (swept("uncertain-minor-axis", {}, samples=n, seed=7) for n in (5, 40))
    rows = many.plan.sampled.values(0, 40)
    assert (rows[3:5] == few.plan.sampled.values(3, 5)).all()
    for column, one in zip(rows.T, many.plan.sampled.numbers):
        assert (np.abs(column
                       - float(one.middle)) <= float(one.half)).all() and np.ptp(column) > float(one.half)
    assert (few.records["margin"] == many.records["margin"][:5]).all()
    assert not (swept("uncertain-minor-axis", {}, samples=5,
                      seed=8).records["margin"] == few.records["margin"]).any()


def test_a_number_that_varies_is_not_sampled_as_well():
    found = swept("uncertain-minor-axis", {"momentum[1]": "200, 400"}, samples=3)
    assert found.records.shape == (2, 3)
    assert "effects.gyrostat.momentum[1]" not in [key.name for key in found.plan.sampled.keys]


def test_chunks_hold_every_point_once_and_are_the_same_from_json():
    plan = planned(CASES / "minor-axis-100.toml",
                   {"momentum[1]": "1:9:9", "x[1]": "0:4:200", "x[3]": "-3:3:300"})
    assert sum(chunk.points for chunk in plan.chunks) == plan.points and len(plan.chunks) > 3
    assert from_json(plan.as_json()).chunks == plan.chunks and from_json(plan.as_json()).digest == plan.digest


def test_a_killed_run_goes_on_from_its_parts(tmp_path, monkeypatch):
    plan = planned(CASES / "minor-axis-100.toml", {"momentum[1]": "1:3:3", "x[1]": "0:4:70"}, answer="fate")
    monkeypatch.setattr("stabilab.maps.plan.LARGEST", 30)
    folder, made = tmp_path / "f.nc.parts", []
    with run(plan, workers=1) as found:
        whole = found.records
    with parts.kept(plan, folder):
        for number in range(4):
            parts.write(plan, folder, number, answered(plan, number).tobytes())
    cut = folder / "part-0000002"
    cut.write_bytes(cut.read_bytes()[:-1])  # as a power cut leaves it
    monkeypatch.setattr("stabilab.maps.run.answered", lambda plan,
                        number: made.append(number) or answered(plan, number))
    with run(plan, tmp_path / "f.nc", workers=1) as found:
        assert (found.records == whole).all() and folder.is_dir()
    assert made == [2, *range(4, 9)] and not folder.exists()


def test_parts_of_another_sweep_are_left_alone(tmp_path):
    one, other = (planned(CASES / "minor-axis-100.toml", {"x[1]": text}) for text in ("0:1:3", "0:1:4"))
    with parts.kept(one, tmp_path / "f.nc.parts") as folder:
        parts.write(one, folder, 0, answered(one, 0).tobytes())
    goes_on = (
        "finished parts .1. of another command, which goes on from them: stabilab sweep minor-axis-100.toml ")
    with pytest.raises(InputError, match=goes_on) as error, run(other, tmp_path / "f.nc", workers=1):
        pass
    assert str(error.value).endswith(
        f"; to replace them: rm -r {folder}; or give another --out") and "0:1:3" in str(error.value)
    edited = replace(one, text=one.text + "# changed")
    with pytest.raises(InputError,
                       match="of this command, before the case file or the program changed; to replace "
                             "them: "), run(edited, tmp_path / "f.nc"):
        pass


@pytest.mark.parametrize("line, other", [
    (("atlas", "off-axis-two", "--level", "1", "--refine", "1", "--no-time"), ("--level", "0")),
    (("basin", "minor-axis-100", "--vary", "x[1]=-4:4:5", "--vary", "x[3]=-3:3:5", "--depth", "2"),
     ("--depth", "1"))], ids=["atlas", "basin"])
def test_a_map_killed_after_a_refinement_goes_on_by_its_command_or_says_how_it_is_replaced(
    tmp_path, stabilab, monkeypatch, line, other):
    monkeypatch.chdir(tmp_path)
    line = (line[0], CASES / f"{line[1]}.toml", *line[2:], "--out", "map.nc", "--workers", "1")
    assert stabilab(*line)[0] == 0
    whole = Path("map.nc").read_bytes()
    with monkeypatch.context() as killed:  # before its file is written
        killed.setattr("stabilab.show.maps.sweep.write", lambda *_: 1 / 0)
        assert stabilab(*line)[0] == 1
    left = sorted(path.name for path in Path().glob("*.parts"))
    assert {"map.nc.1.parts", "map.nc.parts"} <= set(left)
    next(Path("map.nc.1.parts").glob("part-*")).unlink()
    code, _, err = stabilab(*line, *other)
    assert code == 2 and f"stabilab {line[0]} {line[1].name} " in err
    assert f"--out map.nc; to replace them: rm -r {' '.join(left)}; or " in err
    made = []
    monkeypatch.setattr("stabilab.maps.run.answered", lambda plan,
                        number: made.append(number) or answered(plan, number))
    code, out, err = stabilab(*line)
    assert code == 0 and Path("map.nc").read_bytes() == whole and len(made) == 1 and not list(
        Path().glob("*.parts"))


def test_a_run_that_ended_before_its_first_part_stands_in_nobodys_way(tmp_path):
    one, other = (planned(CASES / "minor-axis-100.toml", {"x[1]": text}) for text in ("0:1:3", "0:1:4"))
    with parts.kept(one, tmp_path / "f.nc.parts"):
        claim = (tmp_path / "f.nc.parts" / parts.PLAN).read_bytes()
    assert not (tmp_path / "f.nc.parts").exists()
    (tmp_path / "f.nc.parts").mkdir()
    (tmp_path / "f.nc.parts" / parts.PLAN).write_bytes(claim)  # as a kill leaves it
    with run(other, tmp_path / "f.nc", workers=1) as found:
        assert found.records.shape == (4,)
    assert not (tmp_path / "f.nc.parts").exists()


def test_files_that_are_no_parts_are_not_removed_with_them(tmp_path):
    own = tmp_path / "f.nc.parts" / "thesis.txt"
    own.parent.mkdir()
    own.write_text("my own", encoding="utf-8")
    with pytest.raises(InputError,
                       match="no sweep's"), run(planned(CASES / "minor-axis-100.toml", {"x[1]": "0:1:3"}),
                                                tmp_path / "f.nc", workers=1):
        pass
    assert own.read_text(encoding="utf-8") == "my own"


@pytest.mark.skipif(os.name != "posix", reason="a signal that a process sends to itself")
def test_an_interrupt_takes_an_empty_folder_of_parts_along(tmp_path):
    program = ("import os, pathlib, signal, sys\n"
               "from stabilab import interrupt\nfrom stabilab.maps import parts, plan\n"
               # a test run in the background may hand down an ignored one
               "signal.signal(signal.SIGINT, signal.SIG_DFL)\ninterrupt.arm()\n"
               "with parts.kept(plan.planned(sys.argv[1], {'x[1]': '0:1:3'}), pathlib.Path(sys.argv[2])) as "
               "folder:\n"
               "    assert folder.is_dir()\n    os.kill(os.getpid(), signal.SIGINT)\n    signal.pause()\n")
    code = subprocess.run([sys.executable, "-c", program, CASES / "minor-axis-100.toml",
                           tmp_path / "f.nc.parts"], timeout=60).returncode
    assert code == 130 and not (tmp_path / "f.nc.parts").exists()


def test_without_ranges_it_names_what_answers_the_cases_of_the_file():
    with pytest.raises(InputError, match=r"stabilab fate and the other questions answer every case of the .sweep."):
        planned(CASES / "charged-sweep.toml", {})


@pytest.mark.parametrize("options, words", [
    ({"vary": {}}, "nothing varies"),
    ({"vary": {"x[1]": "0:1:3", "motion.x[1]": "2:3:2"}}, "varies already"),
    ({"vary": {}, "samples": 3}, "no number with an"),
    ({"vary": {f"{key}[{n}]": "1:2:2" for key,
               n in (("x", 1), ("x", 2), ("x", 3), ("momentum", 1), ("momentum", 2))}}, "at most 4 axes"),
    ({"vary": {"x[1]": "0:1:3"}, "answer": "fats"}, "did you mean fate"),
    ({"vary": {"x[1]": "0:1:3"}, "answer": "when"}, "no limit"),
    ({"vary": {"x[1]": "0:1:30000", "x[2]": "0:1:30000"}}, "at most 100,000,000"),
    ({"vary": {"x[1]": 3}}, "numbers in a row"),
    ({"vary": {"x[1]": "0:1:3"}, "rate": "5"}, "rate: belongs to the answer when")])
def test_what_cannot_be_swept_is_told(options, words):
    with pytest.raises(InputError) as error:
        planned(CASES / "minor-axis-100.toml", **options)
    assert words in str(error.value)


def test_a_column_that_nobody_fills_is_an_error_and_no_zeros(monkeypatch):
    more = columns.Column("hue", "f8", "", "in the table of no answer", lambda found: 0.0, lambda found: 0.0)
    of, plan = columns.columns_of, planned(CASES / "minor-axis-100.toml", {"x[3]": "0:3:2"})
    for module in (columns, parts):
        monkeypatch.setattr(module, "columns_of", lambda answers: (*of(answers), more))
    with pytest.raises(NotImplementedError, match="nobody fills the columns hue"):
        answered(plan, 0)


@pytest.mark.parametrize("name, key", [("minor-axis-100", "x[3]"), ("liquid-base", "angular_velocity[3]")])
def test_a_new_column_is_one_row_of_the_table(monkeypatch, name, key):
    """Of a scene with arrays, and of one whose states are answered one by one."""
    row = columns.Column("turns", "i1", "", "whether it turns about axis 3",
                         lambda rows: rows.states[:, 2] > 0, lambda motion: motion.at[2] > 0)
    for table in (columns.ANSWERS, columns.ALL):  # of burns too
        monkeypatch.setitem(table, "turns", columns.Answer("motions", (0, 0), (row,)))
    found = swept(name, {key: "0:3:2"}, answer="turns,fate")
    assert found.records["turns"].tolist() == [0, 1]  # as the axis is written above
    assert "turns" in words.heads(found) and '"turns"' in words.json(found)


def test_records_are_put_together_in_one_copy(tmp_path, monkeypatch):
    """Counted by Python's allocator: the records of all parts, beside one part."""
    plan = planned(CASES / "minor-axis-100.toml", {"x[1]": "-3:3:1500", "x[2]": "-3:3:1000"})
    for number in range(len(plan.chunks)):
        rows = np.zeros(plan.chunks[number].points, parts.record(plan.answers))
        parts.write(plan, tmp_path, number, rows.tobytes())
    size = plan.points * parts.record(plan.answers).itemsize
    tracemalloc.start()
    try:
        whole = parts.whole(plan, tmp_path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    largest = max(chunk.points for chunk in plan.chunks) / plan.points
    assert whole.nbytes == size and peak < size * (1.05 + 3 * largest)


@pytest.mark.parametrize("vary", [
    {"x[1]": "-3:3:60", "x[2]": "-3:3:50"}, {"x[1]": "-3:3:60", "mu[3]": "0.5:1:20"}], ids=["states", "turned"])
def test_records_in_a_file_make_the_same_answers_and_take_the_memory_of_a_block(
        vary, tmp_path, monkeypatch):
    """Blocks and chunks of a few points; Python's allocator counts what is held beside the file."""
    def answers_of(large, block):
        monkeypatch.setattr(blocks, "LARGE", large)
        monkeypatch.setattr(blocks, "BLOCK", block)
        monkeypatch.setattr(words, "TOGETHER", block)
        out = tmp_path / f"{large}-{block}.nc"
        with run(planned(CASES / "minor-axis-100.toml", vary), out, 1, in_file=True) as result:
            assert isinstance(result.records, np.memmap) == (large == 0)
            words.write(words.dataset(result), out)
            return out.read_bytes(), words.text(result), "".join(words.csv_pieces(result))
    assert answers_of(0, 7) == answers_of(0, 64) == answers_of(10**9, 1 << 18)


def test_records_in_a_file_are_counted_and_written_in_memory_that_does_not_grow(tmp_path, monkeypatch):
    """Counted by Python's allocator, four times as many points beside each other."""
    monkeypatch.setattr(blocks, "LARGE", 0)
    monkeypatch.setattr(blocks, "BLOCK", 1 << 12)
    monkeypatch.setattr(netcdf, "BLOCK", 1 << 12)
    peaks = []
    for count in (100, 400):
        plan = planned(CASES / "minor-axis-100.toml", {"x[1]": f"-3:3:{count}", "x[2]": "-3:3:1000"})
        folder = tmp_path / str(count)
        folder.mkdir()
        for number, chunk in enumerate(plan.chunks):
            rows = np.zeros(chunk.points, parts.record(plan.answers))
            rows["valid"] = 1
            parts.write(plan, folder, number, rows.tobytes())
        records = parts.whole(plan, folder, in_file=True)
        tracemalloc.start()
        try:
            result = Swept(plan, records)
            words.text(result)
            words.write(words.dataset(result), tmp_path / "all.nc")
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    assert peaks[1] < peaks[0] + 100_000 < 400_000 * parts.record(plan.answers).itemsize / 2, peaks
