"""Rest, spins about one axis and states of one plane: resultants of such starts have double zeros, and some
lie where no wall holds a motion.

Expected values are by the balance of energy in mpmath (`symmetric.least`) and by runs of Euler's equations
(`oracles.brute`); neither shares code with the package.
"""
import math
import random
from fractions import Fraction

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, load, stuck
from stabilab.answers.stuck.fate import intervals
from stabilab.show.text.stuck import merged
from tests.answers.stuck.symmetric import least, scene
from tests.oracles import brute
from tests.oracles.model import physical

INF = math.inf
CASE = """[body]
inertia = [12, 9, 5]
[[wheels]]
name = "W"
axis = [1, 0, 0]
momentum = {}
[effects.constant_torque]
torque = {}
[motion]
angular_velocity = {}
"""
# s^2 = min M x/q(x), q = T(x) of s = 1 from rest: by mpmath at 30 digits, from Euler's equations by hand
THRESHOLD = 0.426671927192811570753
ENOUGH = 0.3  # of the scenes: have a run that decides, and an end


def asked(case_file, momentum, torque, start):
    path = case_file(CASE.format(momentum, torque, start), "own")
    return stuck(load(path)).rows[0]


def at(given, s):
    """The momentum of all wheels with s on the one that is asked about."""
    _, _, _, l, _, axis = given
    return [a + Fraction(s) * b for a, b in zip(l, axis)]


def bounded(given, s):
    D, i, M, _, w, _ = given
    return least(D, i, M, at(given, s), w) < 0


def kept(given):
    D, i, M, l, w, axis = given
    torque = [M if n == i else 0 for n in range(3)]
    return intervals(Scene(Body(D), Gyrostat(l), ConstantTorque(torque)), w, axis)[0]


@pytest.mark.parametrize("torque, threshold", [("0.02", THRESHOLD), ("0.2", THRESHOLD * math.sqrt(10))])
def test_every_greater_momentum_keeps_a_body_at_rest_bounded(case_file, torque, threshold):
    """The square of the threshold is as the torque, by dimension."""
    row = asked(case_file, 0.8, [0, 0, float(torque)], [0, 0, 0])
    ((low, most), (some, high)) = row.wheels[0].keeps_bounded
    assert (low, high) == (-INF, INF) and -most == some == pytest.approx(threshold, rel=1e-14)
    assert (row.fate == "bounded") == (threshold < 0.8)
    given = (12, 9, 5), 2, Fraction(torque), (0, 0, 0), (0, 0, 0), (1, 0, 0)
    assert bounded(given, threshold * (1 + 1e-9)) and not bounded(given, threshold * (1 - 1e-9))


def agree(seed):
    """(momenta of one scene at which the intervals are right, if a run decides one, if there is an end)."""
    rng = random.Random(seed)
    D, i, M, _, w, _ = given = scene(rng)
    found = kept(given)
    size = float(max(D)) * max(map(abs, map(float, w))) + math.sqrt(float(abs(M) * max(D)))
    momenta = [0.0, *(rng.uniform(-1, 1) * size * 10 ** rng.uniform(-2, 1) for _ in range(3))]
    ends = [end for pair in found for end in pair if math.isfinite(end)]
    for end in ends:
        step = 1e-7 * max(abs(end), 1e-3 * size)
        momenta += [end - step, end + step]
    for s in momenta:
        assert bounded(given, s) == any(low <= s <= high for low, high in found), (seed, s, found)
    model = physical(D, list(map(float, at(given, momenta[1]))), [M if n == i else 0 for n in range(3)])
    try:
        ran = brute.label(model, list(map(float, w)), patience=500)
    except brute.Undecided:
        ran = None
    assert ran in (None, "bounded" if bounded(given, momenta[1]) else "spin-up"), seed
    return len(momenta), ran is not None, bool(ends)


SLOW = [pytest.param(n, 100, marks=[pytest.mark.slow, *[pytest.mark.long] * (n >= 400)])
        for n in range(0, 2000, 100)]


@pytest.mark.parametrize("first, many", [(0, 20), *SLOW])
def test_no_momentum_contradicts_energy_or_a_run(first, many):
    momenta, ran, ends = map(sum, zip(*map(agree, range(first, first + many))))
    assert momenta > 4 * many and ran > ENOUGH * many and ends > ENOUGH * many


@pytest.mark.parametrize("inertia, torque, where", [
    ((12, 9, 5), (0, "0.02", 0), "intermediate axis"), ((9, 9, 5), ("0.02", 0, 0), "between two equal moments"),
    ((9, 9, 9), (0, "0.02", 0), "three equal moments")])
@pytest.mark.parametrize("spin", [0, "0.3"])
def test_a_pure_spin_that_no_wall_holds_is_bounded_with_any_momentum_but_none(inertia, torque, where, spin):
    """Without a wheel D_i w_i' = M for ever, by hand; with one, however small, the energy sets a bound."""
    i = next(n for n in range(3) if torque[n])
    start, axis = ([Fraction(v) if n == m % 3 else Fraction(0) for n in range(3)]
                   for v, m in ((spin, i), (1, i + 1)))
    scene = Scene(Body(inertia), Gyrostat((0, 0, 0)), ConstantTorque(torque))
    ((_, below), (above, _)), because = intervals(scene, start, axis)
    assert where in str(because) and (-below, above) == (5e-324, 5e-324)
    if len(set(inertia)) > 1:
        given = inertia, i, Fraction("0.02"), (0, 0, 0), start, axis
        assert [bounded(given, s) for s in (-1e-12, 0, 1e-12)] == [True, False, True]


def test_the_one_momentum_that_puts_the_start_on_the_decaying_plane_is_left_out():
    """Moments (6, 5, 3), torque on axis 2, momentum s on axis 1: with x the angle about axis 2,
    w3' = (w1 + s)/3 and (w1 + s)' = w3/3, by hand. From (1, 0, -2) both decay at s = 1 alone, and T, 9 at the
    start, stays below it; at s = -3 both grow."""
    start, axis = [Fraction(1), Fraction(0), Fraction(-2)], [Fraction(1), Fraction(0), Fraction(0)]
    given = [Fraction(6), Fraction(5), Fraction(3)], 1, Fraction("0.02"), (0, 0, 0), start, axis
    ((_, below), (above, _)) = kept(given)
    assert below < 1 < above and above - below < 1e-15
    assert [bounded(given, s) for s in (-3, 1 - 1e-12, 1, 1 + 1e-12)] == [True, True, False, True]


def test_words_name_the_single_momentum_that_is_left_out(case_file):
    row = asked(case_file, 0, [0, 0.02, 0], [0, 0, 0])
    assert row.fate == "spin-up" and merged(row.wheels[0].keeps_bounded) == [(-INF, INF, (0.0,))]
    assert merged([(-INF, 1.0), (2.0, INF)]) == [(-INF, 1.0, ()), (2.0, INF, ())]


def test_a_motion_that_no_wall_holds_is_made_bounded_by_any_change(case_file):
    margins = asked(case_file, 0, [0, 0.02, 0], [0, 0, 0]).margins
    assert margins["rate"].size == margins["wheel"].size == 0
    assert margins["torque"].size == 0.02 == margins["torque"].until  # beyond none it spins up against it


def numbers(values):
    return "[" + ", ".join(f'"{v}"' for v in values) + "]"


@pytest.mark.parametrize("first, many", [(400, 4), pytest.param(404, 60, marks=pytest.mark.slow)])
def test_the_fate_changes_at_every_margin_and_not_before(tmp_path, first, many):
    """By energy, a millionth of the change before and beyond, where it ends, and at smaller changes all
    round."""
    compared = 0
    for seed in range(first, first + many):
        rng = random.Random(seed)
        D, i, M, l, w, _ = scene(rng)
        if len(set(D)) == 1:
            continue
        torque = [M if n == i else 0 for n in range(3)]
        path = tmp_path / "own.toml"
        text = (
            "[body]\ninertia = {}\n[effects.constant_torque]\ntorque = {}\n[effects.gyrostat]\nmomentum "
            "= {}\n")
        path.write_text((text + "[motion]\nangular_velocity = {}\n").format(*map(numbers, (D, torque, l, w))))
        row = stuck(load(path)).rows[0]

        def changed(name, change, D=D, i=i, M=M, l=l, w=w):
            parts = {"rate": [Fraction(0)] * 3, "wheel": [Fraction(0)] * 3, "torque": [Fraction(0)] * 3,
                     name: change}
            l = [a + b * (n != i) for n, (a, b) in enumerate(zip(l, parts["wheel"]))]
            torque, w = M + parts["torque"][i], [a + b for a, b in zip(w, parts["rate"])]
            return torque == 0 or least(D, i, torque, l, w) < 0
        now = changed("rate", [Fraction(0)] * 3)
        assert row.fate == ("equilibrium" if row.fate == "equilibrium" else "bounded" if now else "spin-up")
        for name, margin in row.margins.items():
            if not margin.size:
                continue
            way = list(map(Fraction, margin.direction))
            along = lambda s, name=name, way=way: changed(name, [Fraction(s) * v for v in way])
            assert along(margin.size * (1 - 1e-6)) == now, (seed, name, margin)
            if margin.until is None or margin.until > margin.size * (1 + 1e-5):
                assert along(margin.size * (1 + 1e-6)) != now, (seed, name, margin)
            if margin.until is not None and margin.until < 1e6 * margin.size:
                assert along(margin.until * (1 + 1e-6)) == now, (seed, name, margin)
            for _ in range(6):
                way = [rng.gauss(0, 1) * (name == "rate" or (n == i) == (name == "torque")) for n in range(3)]
                size = margin.size * rng.uniform(0.5, 0.9999) / math.hypot(*way)
                assert changed(name, [Fraction(size * v) for v in way]) == now, (seed, name, margin, way)
            compared += 1
    assert compared >= many / 2
