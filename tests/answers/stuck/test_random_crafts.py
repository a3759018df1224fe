"""The JSON of `stuck` for case files drawn at random, field by field, against a run by brute force in the frame of the file."""
import json
import math

import numpy as np
import pytest

from tests.answers.stuck.brute import Craft
from tests.answers.stuck.random_crafts import anywhere, on_an_axis

FATES, LEVELS = ("spin-up", "bounded", "equilibrium", "separatrix", "undecided"), ("proved", "certified", "exact", "run")


@pytest.fixture
def asked(stabilab, tmp_path):
    def ask(text):
        path = tmp_path / "own.toml"
        path.write_text(text)
        code, out, err = stabilab("stuck", path, "--json")
        assert code == 0, err
        return json.loads(out), Craft(text)
    return ask


def fate_of(craft, torque=None, l=None, start=None):
    """By a run: the largest rate of its second half is greater than that of its first if it spins up, and is not if it is bounded."""
    M, l = craft.torque() if torque is None else torque, craft.l if l is None else l
    most, before = np.linalg.eigvalsh(craft.J)[-1], craft.start
    craft.start = before if start is None else start
    t = 25 * math.sqrt(most / np.linalg.norm(M)) + 4 * (most * np.linalg.norm(craft.start) + np.linalg.norm(l)) / np.linalg.norm(M)
    _, half, first = craft.run(t, M, l, limit=False, rtol=1e-9)
    craft.start = half
    _, _, second = craft.run(t, M, l, limit=False, rtol=1e-9)
    craft.start = before
    return "spin-up" if second > 1.25 * first else "bounded"


@pytest.mark.parametrize("n", [3, 4, 9, 11, *(pytest.param(n, marks=pytest.mark.slow) for n in range(12, 44))])
def test_every_field_off_the_axes_is_that_of_a_run(asked, n):
    found, craft = asked(anywhere(np.random.default_rng([13, n]), n))
    moments, axes = (np.array(found["principal"][name]) for name in ("moments", "axes"))
    assert found["schema"] == "stabilab.stuck/1" and moments[0] >= moments[1] >= moments[2]
    assert np.cross(axes[0], axes[1]) == pytest.approx(axes[2], abs=1e-14) and axes @ axes.T == pytest.approx(np.eye(3), abs=1e-14)
    assert axes @ craft.J @ axes.T == pytest.approx(np.diag(moments), abs=1e-12 * moments[0])
    alone = [[name] for name in craft.stuck] if len(craft.stuck) > 1 else []
    assert [row["thrusters"] for row in found["rows"]] == [craft.stuck, *alone]
    for row in found["rows"]:
        M = craft.torque(row["thrusters"])
        size = np.linalg.norm(M)
        assert row["torque"] == pytest.approx(M, abs=1e-12 * size) and row["torque_principal"] == pytest.approx(axes @ M, abs=1e-11 * size)
        assert row["fate"] in FATES and row["level"] in LEVELS and np.ravel(row["limit"]) == pytest.approx(np.ravel(craft.limit), rel=1e-14)
        assert set(row["margin"]) == {"rate", "wheel", "torque"} and len(row["wheel_intervals"]) == craft.wheels
        assert (row["axis"] in (1, 2, 3) and row["sense"] in (1, -1)) or (row["axis"] is row["sense"] is None)
        if row["axis"]:
            assert row["fate"] == "spin-up" and row["direction"] == pytest.approx(row["sense"] * axes[row["axis"] - 1], abs=1e-12)
        if row["time_to_limit"]:
            low, high = row["time_to_limit"]
            t, _, largest = craft.run(high * 1.001, M)
            assert low <= high <= low * (1 + 1e-9) and low * (1 - 1e-8) < t < high * (1 + 1e-8) and largest <= row["largest_rate"] * (1 + 1e-9)
        else:
            assert craft.run(30 * math.sqrt(moments[0] / size), M, rtol=1e-9)[0] is None


@pytest.mark.parametrize("axis, n", [(0, 5), (2, 2), *(pytest.param(n % 3, n, marks=pytest.mark.slow) for n in range(6, 30))])
def test_fate_margins_and_wheel_intervals_on_an_axis_are_those_of_runs(asked, axis, n):
    """A start, a wheel or a torque changed by 0.99 or 1.01 of a margin; a wheel's momentum on both sides of every end."""
    found, craft = asked(on_an_axis(np.random.default_rng([14, n]), axis))
    (row,), across = found["rows"], np.array(found["principal"]["axes"])[axis]
    assert [abs(v) > 0 for v in row["torque_principal"]] == [i == axis for i in range(3)] and row["fate"] == fate_of(craft)
    told = row["margin_because"]
    changes = {"rate": lambda v: {"start": craft.start + v}, "wheel": lambda v: {"l": craft.l + v}, "torque": lambda v: {"torque": craft.torque() + v}}
    for name, changed in changes.items():
        if row["margin"][name] is None or "no torque at all" in told[name]:
            continue
        change = row["margin"][name] * np.array(row["margin_direction"][name])
        assert name != "wheel" or change @ across == pytest.approx(0, abs=1e-12)
        assert fate_of(craft, **changed(0.99 * change)) == row["fate"]
        assert (fate_of(craft, **changed(1.01 * change)) == row["fate"]) == ("bounded again" in told[name])
    (wheel,) = row["wheel_intervals"]
    ends = [(float(end), sign) for low, high in wheel["keeps_bounded"] for end, sign in ((low, -1), (high, 1)) if end is not None and math.isfinite(float(end))]
    step = 1e-3 * min([np.linalg.norm(craft.J @ craft.start), *(abs(a - b) for a, _ in ends for b, _ in ends if a != b)])
    for end, outwards in ends:
        for beyond in (-1, 1):
            l = (end + beyond * outwards * step) * np.array(wheel["axis"])
            assert fate_of(craft, l=l) == ("spin-up" if beyond > 0 else "bounded")
