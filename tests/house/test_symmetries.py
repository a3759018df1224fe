"""Symmetries of D w' = (D w + lambda) x w + M: what must not depend on names and senses."""
from __future__ import annotations

from functools import lru_cache
from itertools import permutations, product

import numpy as np
import pytest

import stabilab
from stabilab import Fate
from stabilab.answers.digits import ask
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from tests.oracles.pairs import physical

BODY, SPAN = (3.0, 2.0, 1.5), 2.0
# (gyrostatic moment, torque): on the minor, middle and major axis, both perpendicular components of the
# moment present
CASES = {"minor": ((0.4, -0.7, 0.0), (0.0, 0.0, 0.3)), "middle": ((0.4, 0.0, -1.9), (0.0, 0.2, 0.0)),
         "major": ((0.0, 0.8, 0.6), (-0.2, 0.0, 0.0))}
cases = pytest.mark.parametrize("name", CASES)
MANY = np.random.default_rng(17).normal(size=(60, 3)) * SPAN
STATES = MANY[:18]  # of the default suite; all of them are slow
how_many = pytest.mark.parametrize("states", [STATES, pytest.param(MANY, marks=pytest.mark.slow)],
                                   ids=["some", "many"])
LOOSE = 1e-11  # two evaluations of the same quantity on differently rounded numbers, each good to 1e-12


@lru_cache(maxsize=16)
def answers(scene, states):
    """(fates, periods, extremes) of states (the bytes of (n, 3) doubles): what every image of them is
    compared with."""
    rows = np.frombuffer(states).reshape(-1, 3)
    return stabilab.fate(scene, rows), stabilab.period(scene, rows), stabilab.extremes(scene, rows)


def compare(scene, states, other, images, box):
    """Same labels, margins and periods; extremes through `box` ((n, 3, 2) -> (n, 3, 2))."""
    (first, times, boxes), second = answers(scene, states.tobytes()), stabilab.fate(other, images)
    np.testing.assert_array_equal(first.labels, second.labels)
    np.testing.assert_allclose(second.margins, first.margins, rtol=LOOSE, atol=LOOSE)
    np.testing.assert_allclose(stabilab.period(other, images), times, rtol=1e-9)
    expected, got = box(boxes), stabilab.extremes(other, images)
    finite = np.isfinite(expected)
    np.testing.assert_array_equal(np.isfinite(got), finite)
    np.testing.assert_array_equal(got[~finite], expected[~finite])
    size = np.max(np.abs(expected[finite]))
    assert np.max(np.abs(got[finite] - expected[finite])) < 1e-10 * size


def signed(boxes, signs):
    """Extremes of a state whose components change sign: minimum and maximum trade places."""
    out = boxes * np.asarray(signs)[:, None]
    return np.sort(out, axis=-1)


def signed_permutations():
    """All 48 as (order, signs, determinant): component n of an image is signs[n] times component order[n]."""
    for order in permutations(range(3)):
        for signs in product((1, -1), repeat=3):
            yield list(order), np.array(signs), float(np.linalg.det(np.eye(3)[list(order)]).round()
                                                      * np.prod(signs))


def some_scenes(seed, count):
    """(moments, wheel, torque, states): a torque about one axis or none, a wheel across it along none, one or
    two axes (without a torque along three as well), moments sometimes equal, rates and torques over eight
    decades; floats."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        D, axis, pace = rng.uniform(1, 2, 3), int(rng.integers(3)), 10.0 ** rng.uniform(-4, 4)
        if n % 6 == 5:
            D[0] = D[1] * (1 + rng.choice([0, 1e-12]))
        momentum, torque = rng.normal(size=3) * pace * (rng.random(3) < 0.6), np.zeros(3)
        if n % 3:
            torque[axis], momentum[axis] = rng.normal() * pace * pace, 0.0
        states = rng.normal(size=(4, 3)) * pace * 10.0 ** rng.uniform(-2, 2, (4, 1))
        states[3, rng.integers(3)] = 0.0
        yield D, momentum, torque, states


def same_motion(one, two, order, signs, energy, scene):
    """Whether two answers for one state (`motion`) tell the same of a motion and of its image."""
    assert (one.fate, one.because.replace(f"axis {one.axis}", "axis"), one.axis) == (
        two.fate, two.because.replace(f"axis {two.axis}", "axis"),
        two.axis and order[two.axis - 1] + 1), scene
    assert not one.axis or two.sense == signs[two.axis - 1] * one.sense, scene
    assert (one.margin_energy is None) == (two.margin_energy is None), scene
    assert one.margin_energy is None or abs(two.margin_energy
                                            - one.margin_energy) <= 1e-11 * (
                                                energy + abs(one.margin_energy + energy)), scene
    if one.extremes is not None and two.extremes is not None:
        box, image = signed(np.array(one.extremes)[order], signs), np.array(two.extremes)
        np.testing.assert_allclose(image, box, rtol=0, atol=1e-9 * np.abs(box[np.isfinite(box)]).max(),
                                   err_msg=repr(scene))


@pytest.mark.parametrize("seed", [1, *(pytest.param(n, marks=[pytest.mark.slow, pytest.mark.long]) for n in (2, 3))])
def test_nothing_depends_on_how_the_axes_are_numbered_or_pointed(seed):
    """P a signed permutation: (P a) x (P b) = det P P (a x b), so w, lambda, M become det P times their
    images. All 48 for fates of arrays, four of them in turn for periods and for one state."""
    images = list(signed_permutations())
    for n, (D, momentum, torque, states) in enumerate(some_scenes(seed, 6 if seed == 1 else 200)):
        scene, _ = physical(D, momentum, torque)
        answer, times = stabilab.fate(scene, states), stabilab.period(scene, states)
        energies = 0.5 * (D * states**2).sum(axis=1)
        single = motion_of(scene, states[n % 4], needs=Needs.QUICK)
        for m, (order, signs, sign) in enumerate(images):
            turn = lambda v: sign * signs * np.asarray(v)[..., order]
            other, _ = physical(D[order], turn(momentum), turn(torque))
            image = stabilab.fate(other, turn(states))
            np.testing.assert_array_equal(image.labels, answer.labels, err_msg=repr((scene, order)))
            np.testing.assert_array_equal(image.reasons, answer.reasons, err_msg=repr((scene, order)))
            np.testing.assert_array_equal(np.isfinite(image.margins), np.isfinite(answer.margins),
                                          err_msg=repr((scene, order)))
            here = np.isfinite(answer.margins)
            off = np.abs(image.margins[here] - answer.margins[here])
            assert (off <= 2e-12
                    * (energies + np.abs(answer.margins + energies))[here]).all(), (scene, order, off)
            if m % 12 == n % 12:
                np.testing.assert_allclose(stabilab.period(other, turn(states)), times, rtol=1e-9,
                                           err_msg=repr((scene, order)))
                same_motion(single, motion_of(other, turn(states[n % 4]), needs=Needs.QUICK), order,
                            sign * signs, energies[n % 4], other)


@pytest.mark.parametrize("seed", [4])
def test_reversed_and_mirrored_free_motions_have_the_same_margins(seed):
    """Without a torque t -> -t with w, lambda -> -w, -lambda, and with them any mirror, keeps momentum and
    energy."""
    for D, momentum, torque, states in some_scenes(seed, 20):
        if torque.any():
            continue
        scene, _ = physical(D, momentum, torque)
        answer = stabilab.fate(scene, states)
        for order, signs, _ in signed_permutations():
            other, _ = physical(D[order], signs * momentum[order], torque)
            image = stabilab.fate(other, signs * states[:, order])
            np.testing.assert_array_equal(image.labels, answer.labels)
            np.testing.assert_allclose(image.margins, answer.margins, rtol=0,
                                       atol=1e-12 * (D * states**2).sum())


@pytest.mark.parametrize("step",
                         # of the 48: each order and each choice of signs comes up
                         [5, pytest.param(1, marks=pytest.mark.slow)])
def test_the_digits_of_a_free_margin_do_not_depend_on_the_numbering_either(step):
    D, momentum, state = np.array([2.097342044612408, 1.6171673443598118,
                                   1.7957359267338395]), np.array([0.03125, 0.0,
                                                                   -0.0625]), np.array([-2.0, 1.0, 0.0])
    asked = {}
    for order, signs, sign in list(signed_permutations())[::step]:
        for wheel in (0.0, 1.0):
            scene, _ = physical(D[order], sign * wheel * (signs * momentum[order]), np.zeros(3))
            told = ask("fate", scene, tuple(sign * signs * state[order]), 30)
            assert told.digits >= 30
            asked.setdefault(wheel, set()).add(told.decimals)
    assert [len(texts) for texts in asked.values()] == [1, 1], asked


@cases
@how_many
@pytest.mark.parametrize("axis",
                         # a mirror and a half turn are another mirror
                         [0, *(pytest.param(axis, marks=pytest.mark.slow) for axis in (1, 2))])
def test_time_reversal_with_a_mirror_keeps_bounded_motions(name, axis, states):
    """R = mirror of one axis, t -> -t: D w' = H x w + M becomes the same equation with R lambda and -R M. A
    bounded motion is periodic, so its past and its future have one label, margin, period and range."""
    momentum, torque = map(np.array, CASES[name])
    mirror = np.where(np.arange(3) == axis, -1.0, 1.0)
    scene, _ = physical(BODY, momentum, torque)
    other, _ = physical(BODY, mirror * momentum, -mirror * torque)
    labels = stabilab.fate(scene, states).labels
    bounded = states[labels == Fate.BOUNDED]
    assert len(bounded) > 5
    np.testing.assert_array_equal(stabilab.fate(other, states * mirror).labels, labels)
    compare(scene, bounded, other, bounded * mirror, lambda b: signed(b, mirror))
