"""The JSON of `stuck` for case files drawn at random, field by field, against a run by brute force in the
frame of the file."""
import json
import math

import numpy as np
import pytest

from tests.answers.stuck import energy
from tests.answers.stuck.brute import Craft
from tests.answers.stuck.random_crafts import anywhere, on_an_axis
from tests.shared import later

FATES, LEVELS = ("spin-up", "bounded", "equilibrium", "separatrix",
                 "undecided"), ("proved", "certified", "exact", "run")


@pytest.fixture
def asked(stabilab, case_file):
    def ask(text):
        path = case_file(text, "own")
        code, out, err = stabilab("stuck", path, "--json")
        assert code == 0, err
        return json.loads(out), Craft(text)
    return ask


@pytest.mark.one_in(3)
@pytest.mark.parametrize("n", [3, 4, 9, 11, *later(range(12, 44))])
def test_every_field_off_the_axes_is_that_of_a_run(asked, n):
    found, craft = asked(anywhere(np.random.default_rng([13, n]), n))
    moments, axes = (np.array(found["principal"][name]) for name in ("moments", "axes"))
    assert found["schema"] == "stabilab.stuck/2"
    assert np.cross(axes[0], axes[1]) == pytest.approx(axes[2], abs=1e-14)
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-14)
    assert axes @ craft.J @ axes.T == pytest.approx(np.diag(moments), abs=1e-12 * moments.max())
    alone = [[name] for name in craft.stuck] if len(craft.stuck) > 1 else []
    assert [row["thrusters"] for row in found["rows"]] == [craft.stuck, *alone]
    for row in found["rows"]:
        M = craft.torque(row["thrusters"])
        size = np.linalg.norm(M)
        assert row["torque"] == pytest.approx(M, abs=1e-12 * size)
        assert row["torque_principal"] == pytest.approx(axes @ M, abs=1e-11 * size)
        assert row["fate"] in FATES and row["level"] in LEVELS and np.ravel(row["limit"]) == pytest.approx(
            np.ravel(craft.limit), rel=1e-14)
        assert set(row["margin"]) == {"rate", "wheel",
                                      "torque"} and len(row["wheel_intervals"]) == craft.wheels
        assert (row["axis"] in (1, 2, 3) and row["sense"] in (1, -1)) or (row["axis"] is row["sense"] is None)
        if row["axis"]:
            assert row["fate"] == "spin-up" and row["direction"] == pytest.approx(
                row["sense"] * axes[row["axis"] - 1], abs=1e-12)
        if row["time_to_limit"]:
            low, high = row["time_to_limit"]
            t, _, largest = craft.run(high * 1.001, M)
            assert low <= high <= low * (1 + 1e-9) and low * (1 - 1e-8) < t < high * (1 + 1e-8)
            assert largest <= row["largest_rate"] * (1 + 1e-9)
        else:
            assert craft.run(30 * math.sqrt(moments[0] / size), M, rtol=1e-9)[0] is None


def moments_differ(found):
    return len(set(found["principal"]["moments"])) == 3


@pytest.mark.one_in(2)
@pytest.mark.parametrize("axis, n", [(0, 5), (2, 2), *later((n % 3, n) for n in range(6, 30))])
def test_fate_margins_and_wheel_intervals_on_an_axis_are_those_of_runs(asked, axis, n):
    """A start, a wheel or a torque changed by 0.99 or 1.01 of a margin; a wheel's momentum on both sides of
    every end: by what runs prove (`Craft.fate`), and a millionth to either side by the balance of energy
    (`energy.fate`)."""
    found, craft = asked(on_an_axis(np.random.default_rng([14, n]), axis))
    # of a diagonal tensor the axes are in the order of the file
    index = np.argsort(found["principal"]["moments"])[::-1][axis]
    (row,), across = found["rows"], np.array(found["principal"]["axes"])[index]
    assert np.linalg.norm(row["torque_principal"]) == pytest.approx(np.linalg.norm(craft.torque()), rel=1e-14)
    assert [abs(v) > 0
            for v in row["torque_principal"]] == [i == index for i in range(3)] or not moments_differ(found)
    assert craft.l @ craft.torque() == pytest.approx(0, abs=1e-14) and row["fate"] == craft.fate()
    _margins_are_where_the_fate_changes(craft, row, across)
    (wheel,) = row["wheel_intervals"]
    along, kept = np.array(wheel["axis"]), wheel["keeps_bounded"]
    unit = np.linalg.norm(craft.J @ craft.start)
    ends = [end for pair in kept for end in pair if math.isfinite(end)]
    for s in [*np.linspace(-3 * unit, 3 * unit, 200),
              *(end + side * 1e-6 * unit for end in ends for side in (-1, 1))]:
        assert energy.fate(craft.J, craft.torque(), s * along,
                           craft.start)[0] == ("bounded" if any(low <= s <= high for low, high in kept)
                                               else "spin-up"), s
    step = 1e-3 * min([unit, *(abs(a - b) for a in ends for b in ends if a != b)])
    for s in (end + side * step for end in ends for side in (-1, 1)):
        assert craft.fate(l=s * along) == ("bounded" if any(low <= s <= high for low, high in kept)
                                           else "spin-up")


def _margins_are_where_the_fate_changes(craft, row, across):
    torque = craft.torque()
    changes = {"rate": ("start", craft.start), "wheel": ("l", craft.l), "torque": ("torque", torque)}
    for name, (what, now) in changes.items():
        size, until, told = (row[key][name] for key in ("margin", "margin_until", "margin_because"))
        if size is None or "no torque at all" in told:
            continue
        change = np.array(row["margin_direction"][name])
        assert name != "wheel" or change @ across == pytest.approx(0, abs=1e-12)
        by_energy = lambda s: energy.fate(craft.J,
                                          *(given + s * change if given is now else given
                                            for given in (torque, craft.l, craft.start)))[0]
        beyond = until is None or until > size
        assert by_energy(size * (1 - 1e-6)) == row["fate"]
        assert (by_energy(size * (1 + 1e-6)) != row["fate"]) == beyond
        assert craft.fate(**{what: now + 0.99 * size * change}) == row["fate"]
        back = until is not None and until < 1.01 * size  # told: the fate is soon again what it was
        assert (craft.fate(**{what: now + 1.01 * size * change}) == row["fate"]) == back == (
            back and " again" in told)
        if until is not None and size < until and (until < math.inf or name == "rate"):
            last = until * (1 - 1e-9) if until < math.inf else 20 * size
            assert all(by_energy(s) != row["fate"] for s in np.linspace(size * (1 + 1e-6), last, 12))
            assert (" again" in told) == (until < math.inf)
            assert until == math.inf or by_energy(until * (1 + 1e-9)) == row["fate"]


@pytest.mark.parametrize("axis, n", [(1, 4), *later((n % 3, n) for n in range(30, 39))])
def test_a_wheel_that_is_not_across_the_torque_keeps_nothing_bounded_but_without_momentum(asked, axis, n):
    """By the law of growth, measured along a run: a growth of |H|^2/2 - D T that never ends. Without the
    momentum by what a run proves (`Craft.fate`)."""
    found, craft = asked(on_an_axis(np.random.default_rng([14, n]), axis, across=False))
    (row,), (wheel,) = found["rows"], found["rows"][0]["wheel_intervals"]
    for momentum in (1.0, -0.01):
        l = momentum * np.array(wheel["axis"])
        assert craft.law(l, 20.0) == pytest.approx(l @ craft.torque(),
                                                   rel=1e-6) and abs(l @ craft.torque()) > 1e-6
    assert row["fate"] == "spin-up" and all(size is None for size in row["margin"].values())
    assert wheel["keeps_bounded"] == ([[0.0, 0.0]] if craft.fate(l=np.zeros(3)) == "bounded" else [])
