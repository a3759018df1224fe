"""Enclosures of a motion by Taylor series in integers, against Taylor series in 60 digits of another code
(`tests.oracles.taylor`)."""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import pytest

from stabilab.integrate.integer_flow import IntegerFlow
from tests.oracles import taylor
from tests.oracles.pairs import physical, scaled

SCENES = {"gyrostat": (physical((12, 9, 5), (0.75, -0.5, 0.25), (0.25, 0.125, 0.5)), (12, 9, 5),
                       Fraction(1, 2)),
          "no wheel": (physical((2, 3, 4), (0, 0, 0), (1, 0.5, -0.25)), (2, 3, 4), Fraction(2)),
          "scaled": (scaled(0.5, 0.75, (0.25, 0, 1)), (1, 2, 1), Fraction(1))}


def _pieces(flow, end):
    while flow.now < end:
        yield flow.step()


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("bits", [96, 160])
def test_the_true_motion_is_within_the_radius_of_every_piece(name, bits):
    (scene, model), weights, unit = SCENES[name]
    start = (0.5, -0.25, 1.0)
    flow = IntegerFlow(scene.quadratic(), [Fraction(w) for w in weights], [Fraction(v) for v in start], bits,
                       unit)
    pieces = list(_pieces(flow, 6))[::5]
    exactly = lambda value: mp.mpf(value.numerator) / value.denominator
    with mp.workdps(80):
        times = [exactly((p.start + p.length / 2) / unit) for p in pieces]
        for piece, row in zip(pieces, taylor.integrate(model, start, times, digits=60)):
            for i in range(3):
                half = sum(exactly(Fraction(c, 2**n)) for n, c in enumerate(piece.rows[i]))
                true = row[i] / exactly(unit) * mp.mpf(2)**bits
                assert abs(half - true) <= piece.radii[i] and abs(true) <= piece.sizes[i] + piece.radii[i]


def test_an_error_of_the_start_is_within_the_radius_for_ever():
    """The bound of growth alone: two exact starts a little apart, the distance of their motions against the
    energy norm's growth."""
    (scene, _), weights, unit = SCENES["no wheel"]
    form, weights = scene.quadratic(), [Fraction(w) for w in weights]
    near, far = (IntegerFlow(form, weights, [Fraction(1, 2), Fraction(-1, 4) + gap, Fraction(1)], 200, unit)
                 for gap in (0, Fraction(1, 2**40)))
    near.error = far.error = 1 << 161  # more than their distance in the norm: 2^-40 / unit of 2^200
    for _ in range(60):
        one = near.step()
        far.h = near.h
        far_piece = far.step()
        if far_piece.start + far_piece.length == one.start + one.length:
            assert all(abs(a - b) <= r for a, b, r in zip(near.x, far.x, one.radii))


def test_weights_that_leave_cubic_terms_are_refused():
    (scene, _), _, unit = SCENES["no wheel"]
    with pytest.raises(ValueError, match="weights"):
        IntegerFlow(scene.quadratic(), [Fraction(1)] * 3, [Fraction(1)] * 3, 96, unit)


def test_a_direction_at_rest_in_space_keeps_its_length():
    (scene, _), weights, unit = SCENES["gyrostat"]
    flow = IntegerFlow(scene.quadratic(), [Fraction(w) for w in weights], [Fraction(1, 2)] * 3, 128, unit,
                       (Fraction(0), Fraction(1), Fraction(0)))
    for piece in _pieces(flow, 8):
        n = [Fraction(row[0], 1 << 128) for row in piece.rows[3:]]
        off = max(piece.radii[3:])
        assert abs(sum(v * v for v in n) - 1) <= Fraction(2 * 2 * off + 1, 1 << 128)
