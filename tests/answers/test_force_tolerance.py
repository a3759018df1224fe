"""A thruster's force that is known within a tolerance: every answer that depends on its torque says so.

Oracle: SciPy's DOP853 on Euler's equations written out here, which shares no code with the program."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.answers.uncertain.boxes import box_of
from tests.oracles.rigid import tensor
from tests.shared import craft_file, in_one_line

DEGREE = math.pi / 180
ON_AXIS = craft_file([412.0, 297.5, 351.2], ([0.5, 0, 0], [0, 0, -1], "2.2 N +- 30 %"), [([1, 0, 0], 14)],
                     ["0.02 deg/s", "-0.061 deg/s", "0.004 deg/s"])
FEEBLE = ON_AXIS.replace("2.2 N", "0.2 N")
TORQUE = """[body]
inertia = [412.0, 297.5, 351.2]
[effects.gyrostat]
momentum = [14, 0, 0]
[effects.constant_torque]
torque = [0, "1.1 +- 30 %", 0]
[motion]
angular_velocity = ["0.02 deg/s", "-0.061 deg/s", "0.004 deg/s"]
"""
INERTIA = [[412.0, -6.3, 11.8], [-6.3, 297.5, 4.4], [11.8, 4.4, 351.2]]
CENTRE, PLACE, ALONG = [0.92, 0.013, -0.008], [0.05, 0.55, -0.48], [0.94, 0.0, -0.34]
WHEEL, START = [0.0, -1.0, 0.02], [0.02, -0.061, 0.004]
OFF_AXIS = craft_file(INERTIA, (PLACE, ALONG, "1 N +- 6 %"), [(WHEEL, 14)], [f"{v} deg/s" for v in START],
                      CENTRE, misalignment="0.5 deg") + 'span = [0, "20 min"]\n[limits]\nrate = "6 deg/s"\n'


class Body:
    """A rigid body with a wheel, in the frame of the file."""

    def __init__(self, inertia, wheel, start):
        self.I, self.h, self.start = np.array(inertia, float), np.array(wheel, float), np.array(start) * DEGREE

    def run(self, torque, until, start=None, events=None, **options):
        return solve_ivp(tensor(self.I, self.h, torque), (0, until), self.start if start is None else start, "DOP853", rtol=1e-11,
                         atol=1e-14, events=events, **options)

    def first(self, torque, limit, until=5000.0):
        """s, at which |omega| reaches a limit; inf where it does not."""
        over = lambda t, w: np.linalg.norm(w) - limit
        over.terminal = True
        run = self.run(torque, until, events=over)
        return run.t_events[0][0] if len(run.t_events[0]) else math.inf


SMALL = Body(np.diag([412.0, 297.5, 351.2]), [14, 0, 0], START)
LARGE = Body(INERTIA, 14 * np.array(WHEEL) / np.linalg.norm(WHEEL), START)


def torques(sizes, azimuths, angle=0.5 * DEGREE):
    """Of a force of 1 N at its place, of other sizes and directions round the edge of its cone."""
    arm, u = np.array(PLACE) - CENTRE, np.array(ALONG) / np.linalg.norm(ALONG)
    first = np.cross([0, 1.0, 0], u)
    second = np.cross(u, first)
    for size in sizes:
        yield size * np.cross(arm, u)
        for phi in np.arange(azimuths) * 2 * math.pi / max(azimuths, 1):
            yield size * np.cross(arm, math.cos(angle) * u + math.sin(angle) * (
                math.cos(phi) * first + math.sin(phi) * second))


@pytest.mark.slow
def test_a_force_and_the_same_torque_have_one_verdict(stabilab, case_file):
    """The proved and the flipping share of the box are those of the torque written itself; at +30 % the body
    reaches 1631 deg/s by DOP853 (above)."""
    rows = []
    for text in (ON_AXIS, TORQUE):
        code, out, _ = stabilab("fate", case_file(text), "--json", "--strict")
        assert code == 3  # not the same all over the box
        rows.append(json.loads(out)[0]["uncertain"]["fate"])
    force, torque = rows
    assert force["answer"] == torque["answer"] == "depends"
    assert [force[name] for name in ("proved_up_to", "changes_at")] == pytest.approx(
        [torque[name] for name in ("proved_up_to", "changes_at")], rel=1e-9)
    for row, spins in zip(force["witnesses"], (False, True)):
        size = float(row["force"][0])
        assert float(row["torque"][1]) == pytest.approx(size / 2, rel=1e-12)
        largest = np.linalg.norm(SMALL.run(np.array([0, size / 2, 0]), 6000).y, axis=0).max() / DEGREE
        assert (largest > 100) == spins
    assert "BUT within the uncertainties also spin-up" in stabilab("fate", case_file(ON_AXIS))[1]


def test_a_tolerance_of_its_own_key_is_the_same(stabilab, case_file):
    texts = [ON_AXIS, ON_AXIS.replace(" +- 30 %", "") .replace("stuck", 'force_tolerance = "30 %"\nstuck'),
             ON_AXIS.replace(" +- 30 %", "").replace("stuck", 'force_tolerance = "0.66 N"\nstuck')]
    first, *others = [stabilab("fate", case_file(text, "one"), "--json")[1] for text in texts]
    assert others == [first, first]


def test_a_limit_that_only_a_larger_force_reaches_is_said(stabilab, case_file):
    true = [SMALL.first(np.array([0, size, 0]), DEGREE) for size in (0.07, 0.1, 0.13)]
    assert true[0] == true[1] == math.inf
    code, out, _ = stabilab("when", case_file(FEEBLE), "--rate", "1 deg/s", "--strict")
    line = in_one_line(out)
    assert code == 3 and "NEVER reaches |ω| = 1 deg/s with the force as stated" in line
    told = line.split("BUT with the force of A within 30 % it reaches 1 deg/s after ")[1]
    assert float(told.split()[0]) == pytest.approx(true[2], rel=2e-4)
    found = package.load(case_file(FEEBLE)).when(rate="1 deg/s")
    assert math.isinf(found.low) and found.tilt.varies and found.tilt.forces.latest is None
    low, high = found.tilt.forces.earliest
    assert low <= true[2] * (1 + 1e-9) and high >= true[2] * (1 - 1e-9)


def test_no_force_and_no_tilt_reaches_the_limit_before_what_is_proved_of_a_steady_motion(case_file):
    case = package.load(case_file(FEEBLE))
    found = case.when(rate="1 deg/s").tilt
    assert 0 < found.not_before <= found.low
    for size in (0.07, 0.085, 0.1, 0.115, 0.13):
        for phi in np.arange(6) * math.pi / 3:
            across = size * math.sin(DEGREE) * np.array([math.cos(phi), 0, math.sin(phi)])
            torque = across + np.array([0, size * math.cos(DEGREE), 0])
            assert SMALL.first(torque, DEGREE, until=2 * found.low) >= min(found.low * (1 - 1e-4),
                                                                           2 * found.low)


@pytest.mark.slow  # 75 runs of DOP853
def test_the_range_over_tolerance_and_misalignment_is_that_of_brute_force(stabilab, case_file):
    true = [LARGE.first(torque, 6 * DEGREE) for torque in torques((0.94, 1, 1.06), 24)]
    path = case_file(OFF_AXIS)
    for command in ("fate", "when", "stuck"):
        found = json.loads(stabilab(command, path, "--json")[1])
        tilt = (found["rows"] if command == "stuck" else found)[0]["tilt"]
        assert tilt["earliest"][0] == pytest.approx(min(true), rel=1e-4) and tilt["level"] == "proved"
        assert tilt["latest"][1] == pytest.approx(max(true), rel=1e-4)
        assert tilt["earliest"][0] <= min(true) * (1 + 1e-9) and tilt["latest"][1] >= max(true) * (1 - 1e-9)


@pytest.mark.slow
def test_the_latest_closing_time_holds_for_every_force(stabilab, case_file):
    """Closed then, no force of the tolerance and of the cone leaves more than the limit, and a little later
    one does."""
    told = json.loads(stabilab("burn", case_file(OFF_AXIS), "--below", "6 deg/s", "--json")[1])
    (low, _), stated = told["latest"]["time"], told["latest"]["stated"]["time"][0]

    inverse, wheel = np.linalg.inv(LARGE.I), LARGE.h[:, None]

    def run(torque, until, start, **options):
        """Of all torques (3, n) at once, each from its start, which one step size for all follows."""
        def rates(t, w):
            w = w.reshape(3, -1)
            (x, y, z), (a, b, c) = w, LARGE.I @ w + wheel
            return (inverse @ (torque - np.stack([y * c - z * b, z * a - x * c, x * b - y * a]))).ravel()
        found = solve_ivp(rates, (0, until), start.ravel(), "DOP853", rtol=1e-11, atol=1e-14, **options).y
        return found.reshape(3, torque.shape[1], -1)

    def largest(torques, close):
        torque = np.transpose(torques)
        left = run(torque, close, np.repeat(LARGE.start[:, None], len(torques), axis=1))[..., -1]
        return np.linalg.norm(run(0 * torque, 600, left, max_step=0.5), axis=0).max() / DEGREE
    every = list(torques((0.94, 1, 1.06), 24))
    assert largest(every, low) == pytest.approx(6, abs=2e-4)
    assert largest(every, low * (1 + 1e-6)) < 6 + 2e-4
    assert largest(every, low * 1.002) > 6.005
    assert largest(list(torques([1], 0)), stated) == pytest.approx(6, abs=2e-4) and stated > low * 1.05


def test_the_torques_of_uncertain_forces_are_on_their_lines(case_file):
    """Two thrusters, one oblique, beside a constant torque and a full tensor: scene and principal axes of a
    point against those of a file with these forces."""
    rng = np.random.default_rng(8)
    second = ('[[thrusters]]\nname = "B"\nposition = [0.3, -0.2, 0.1]\ndirection = [1, 2, 2]\nforce = "{}"\n'
              'stuck = true\n')
    rest = '[effects.constant_torque]\ntorque = [0.01, 0, "-1/3"]\n'
    text = OFF_AXIS.replace('"1 N +- 6 %"', '"{}"') + rest
    box = box_of(package.load(case_file(text.format("1 N +- 6 %") + second.format("0.3 N +- 0.1 N"))))
    assert box.places == (("force", 0), ("force", 1)) and box.frame is None
    for point in rng.uniform(-1, 1, (20, 2)):
        values = box.values(point)
        scene, state = box.at(point)
        forces = [f"{float(v)!r} N" for v in values["force"]]
        case = package.load(case_file(text.format(forces[0]) + second.format(forces[1]), "point"))
        assert np.allclose([float(v) for v in scene.vector("constant_torque")],
                           [float(v) for v in case.scene.vector("constant_torque")], rtol=1e-15, atol=1e-17)
        assert np.allclose(state, case.state, rtol=1e-14, atol=0)
        numbers = box.numbers(point[None], np.zeros((1, 2)))["torque"]
        assert np.allclose([float(n.c[0]) for n in numbers], [float(v) for v in values["torque"]], rtol=1e-12)


def test_samples_of_a_sweep_draw_the_force(stabilab, case_file):
    for text in (ON_AXIS, ON_AXIS.replace(" +- 30 %", "").replace("stuck", 'force_tolerance = "90 %"\nstuck')):
        code, out, err = stabilab("sweep", case_file(text), "--samples", "60", "--csv")
        assert code == 0, err
        head, *rows = [line.split(",") for line in out.splitlines()]
        assert head[1] == "thrusters.A.force (N)" and {row[2] for row in rows} == {"bounded", "spin-up"}
        # spin-up beyond 2.54 N: the box's own flip of 0.5185 x 30 %, checked by DOP853 above
        assert all((float(row[1]) > 2.5423) == (row[2] == "spin-up") for row in rows)
        assert "not looked at" not in out


@pytest.mark.parametrize("command", ["extremes", "period"])
def test_where_it_is_not_looked_at_that_is_said(stabilab, case_file, command):
    words = "the tolerance of the force of A is not looked at here"
    path = case_file(ON_AXIS)
    assert f"caveat: {words}" in stabilab(command, path)[1]
    (row,) = json.loads(stabilab(command, path, "--json")[1])
    assert any(one["words"].startswith(words) for one in row["caveats"])
    assert any(one.words.startswith(words) for one in package.load(path).motion().caveats)


def test_a_force_without_tolerance_has_no_such_words(stabilab, case_file):
    path = case_file(ON_AXIS.replace(" +- 30 %", ""))
    for command in ("fate", "extremes", "period", "stuck"):
        out = stabilab(command, path)[1]
        assert "tolerance" not in out and "uncertain" not in out and "within" not in out
