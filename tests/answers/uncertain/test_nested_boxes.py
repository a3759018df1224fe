"""A wider box is never called safer than a box inside it, and its witnesses are there: by DOP853 from Euler's
equations."""
import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.fate import look_at, uncertain
from stabilab.answers.uncertain.result import CORNERS, corners, worst
from stabilab.case.read import load
from tests.answers.uncertain.test_verdicts import numbers_at, walls_ahead
from tests.oracles.rigid import euler
from tests.shared import later

TEXT = """[body]
inertia = [{}]
[effects.gyrostat]
momentum = [{}]
[effects.constant_torque]
torque = [{}]
[motion]
angular_velocity = [{}]
"""


def written(rows, half):
    """A case whose numbers have these middles and half-widths, four rows of three each."""
    one = lambda middle, width: f'"{middle!r} +- {width!r}"' if width else repr(middle)
    return TEXT.format(*(", ".join(one(float(m), float(d)) for m, d in zip(*row)) for row in zip(rows, half)))


def spins_up(values, times=24):
    """Whether the rate about the torque's axis comes to so many times the size of the start, by DOP853 over
    twenty times as long as a free M t/D would take: beside a separatrix it lingers."""
    D, h, M, w = (np.array([float(v) for v in values[name]])
                  for name in ("inertia", "momentum", "torque", "state"))
    k = int(np.argmax(np.abs(M)))
    far = times * (np.linalg.norm(w) + np.linalg.norm(h) / D.min())

    def reached(t, x):
        return abs(x[k]) - far
    reached.terminal = True
    run = solve_ivp(euler(D, h, M), (0, 20 * far * D[k] / abs(M[k])), w, method="DOP853", rtol=1e-11, atol=1e-13,
                    events=reached)
    return run.status == 1


TWENTY = [[12.0, 9.0, 5.0], [0.8, 0.1, 0.0], [0.0, 0.0, 0.02], [0.1, 0.05, 0.02]]


def widths(share):
    return [[share * v for v in TWENTY[0]], [0.24, 0.2, 0.0], [0.0, 0.0, 0.01], [0.1, 0.1, 0.1]]


def test_a_box_of_nine_numbers_whose_moments_may_change_places_has_its_witness(case_file, stabilab):
    """12 of the corners spin up, and none of 64 points drawn from the box does."""
    inner = uncertain(load(case_file(written(TWENTY, widths(0.1)))), ("fate",)).fate
    path = case_file(written(TWENTY, widths(0.2)))
    outer, box = uncertain(load(path), ("fate",)).fate, box_of(load(path))
    assert inner.answer == outer.answer == "depends" and outer.changes_at <= inner.changes_at
    assert outer.samples.counts == {"bounded": outer.samples.number}
    assert [spins_up(w.values, 6) for w in outer.witnesses] == [False, True]
    at_corners = corners(9)[box.rigid(corners(9))]
    # 384 of the 512 obey D1 <= D2 + D3: 14.4 <= 10.8 + 4 does, 14.4 <= 7.2 + 6 does not (by hand)
    assert len(at_corners) == 384
    turned = [look_at(box, p)[0] != "bounded" for p in at_corners]
    # by the potential on a grid of the angle; a circle, as the torque's axis has the least moment at all
    D = numbers_at(box, at_corners)[0]
    circle = (D[:, 0] > D[:, 2]) & (D[:, 1] > D[:, 2])
    assert circle.all() and sum(turned) == 12
    assert (walls_ahead(box, at_corners, 2) < 0).tolist() == turned
    code, out, _ = stabilab("fate", path, "--strict")
    assert code == 3 and out.splitlines()[0].endswith(", BUT not over all uncertainties")
    assert "\n  BUT within the uncertainties also spin-up about the z axis" in out
    told = json.loads(stabilab("fate", path, "--json")[1])[0]
    assert told["uncertain"]["fate"]["answer"] == "depends"
    assert any("within the uncertainties also spin-up" in one["words"] for one in told["caveats"])


def nested(seed):
    """(middles, half-widths of a box, and of one around it): a rigid body, a wheel across the torque."""
    rng = np.random.default_rng(seed)
    of = lambda low, high: np.round(rng.uniform(low, high, 3), 3)
    some = lambda: rng.integers(0, 2, 3)
    masses, k = of(1, 4), int(rng.integers(3))
    D, across = np.roll(masses, 1) + np.roll(masses, 2), np.arange(3) != k
    torque = np.round(rng.choice((-1, 1)) * 10**rng.uniform(-1.3, -0.5), 4)
    rows = [D, of(-1, 1) * some() * across, torque * ~across, of(-0.4, 0.4)]
    inner = [D * of(0, 0.2) * some(), of(0, 0.3) * some() * across, np.abs(rows[2]) * of(0.1, 0.8),
             of(0, 0.3) * some()]
    outer = [half * (1 + of(0, 1) * some()) for half in inner]
    outer[0], outer[3] = np.minimum(outer[0] + D * of(0, 0.2) * some(), 0.7 * D), outer[3] + of(0, 0.1) * some()
    outer[2] = np.minimum(outer[2], 0.9 * np.abs(rows[2]))
    return rows, inner, outer


@pytest.mark.parametrize("seed", [0, *later(range(1, 48))])
def test_a_box_around_another_is_never_the_safer_one(case_file, seed):
    rows, *boxes = nested(seed)
    inner, outer = (uncertain(load(case_file(written(rows, half))), ("fate",)).fate for half in boxes)
    if inner.answer == "depends":
        assert outer.answer == "depends" and outer.changes_at <= 1.02 * inner.changes_at
    for over in (inner, outer):
        if over.answer == "depends":
            assert [spins_up(w.values) for w in over.witnesses] == [w.verdict.startswith("spin-up")
                                                                   for w in over.witnesses]


def test_of_more_corners_than_are_all_tried_the_search_finds_the_worst():
    """Against all 2^11 corners."""
    rng, n = np.random.default_rng(3), 11
    assert 2**n > CORNERS
    for _ in range(5):
        slope, bend = rng.normal(size=n), 0.1 * rng.normal(size=(n, n))
        margins = lambda x, slope=slope, bend=bend: x @ slope + np.einsum("ni,ij,nj->n", x, bend, x)
        every = corners(n, 2**n)
        assert margins(worst(margins, n)).min() == pytest.approx(margins(every).min())
