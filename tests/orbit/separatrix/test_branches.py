"""Separatrix sheets: vertices on the surface to rounding, rows from the fold outward, and what lies on either
side."""
from __future__ import annotations

import math

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.errors import InputError
from stabilab.orbit.reduction import reduce
from stabilab.orbit.separatrix.distance import distance_of
from stabilab.orbit.separatrix.saddles import plain_separatrix
from tests.hunt.disagreements import off_surface
from tests.oracles import energy
from tests.oracles.pairs import PAPER_BODY, WORDS, axis_of, physical, scaled
from tests.shared import SCALED_MINOR

EPS = 2.0 ** -52
CUSP = 4 * 3 ** -0.75  # |c| below which the middle axis has no saddle: g^4 + c g + 1 > 0 for all g

SCENES = {
    "minor a=b": scaled(0.5, 0.5, (0, 0, 1)),
    "minor a<b": scaled(0.2, 0.4, (0, 0, 1)),
    "minor, c < 0": scaled(1.4, 0.2, (0, 0, 1)),
    "minor, other sign": scaled(0.2, 1.4, (0, 0, -1)),
    "minor physical": physical(PAPER_BODY, (100, 0, 0), (0, 0, 204.1)),
    "major physical": physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0.2, 0, 0)),
    "equilibria on lines": physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0, 0, 0.2)),
    "both components": physical((3.0, 2.0, 1.5), (0.4, -0.7, 0), (0, 0, 0.3)),
    "middle, c = 3": scaled(0.5, 3.5, (0, 1, 0)),
    "middle, c = -2.5": scaled(2.0, -0.5, (0, 1, 0)),
    "middle, c = 3, other sign": scaled(0.5, 3.5, (0, -1, 0)),
    "middle, c = 1.76": scaled(0.0, 1.76, (0, 1, 0)),
}
scenes = pytest.mark.parametrize("name", SCENES)


@pytest.fixture(scope="module")
def sheets():
    """Every scene's sheets, computed once."""
    return {name: stabilab.separatrix(scene).branches for name, (scene, _) in SCENES.items()}


def at_fold(problem, sheet, row):
    return (abs(rate_and_slope(problem, sheet.saddle[row], axis_of(problem))[1]) <= 1e-9
            * np.max(np.abs(sheet.saddle)))


@scenes
def test_rows_run_outward_and_columns_from_saddle_to_saddle(name, sheets):
    asked = stabilab.separatrix(SCENES[name][0], shape=(7, 21)).branches
    assert {sheet.points.shape[1:] for sheet in asked} == {(21, 3)}
    for sheet in sheets[name]:
        n, m = sheet.points.shape[:2]
        assert np.shape(sheet.residual) == (n, m)
        assert np.shape(sheet.saddle) == np.shape(sheet.centre) == (n, 3)
        close = dict(rtol=0, atol=1e-12 * np.max(np.abs(sheet.points)))
        np.testing.assert_allclose(sheet.points[:, 0], sheet.points[:, -1], **close)
        np.testing.assert_allclose(sheet.points[:, 0], sheet.saddle, **close)
        steps = np.diff(np.asarray(sheet.invariant, float))
        assert np.all(steps > 0) or np.all(steps < 0)
    names = [sheet.name for sheet in sheets[name]]
    numbers = [int("".join(c for c in word if c.isdigit())) for word in names]
    assert len(set(names)) == len(names) and sorted(set(numbers)) == list(range(1, max(numbers) + 1))


@scenes
def test_saddles_and_centres_of_the_rows_are_equilibria_of_their_kind(name, sheets):
    _, problem = SCENES[name]
    axis = axis_of(problem)
    for sheet in sheets[name]:
        for r in np.linspace(1, len(sheet.saddle) - 1, 6).astype(int):
            for point, steep in ((sheet.saddle[r], 1), (sheet.centre[r], -1)):
                rate, slope, size = rate_and_slope(problem, point, axis)
                assert point[axis] == 0
                assert abs(rate) <= 8 * EPS * size
                assert slope * steep > 0 or abs(slope) < 1e-6 * size, (sheet.name, r)


def rate_and_slope(problem, point, axis):
    """w', dw'/dalpha = kappa (p v'^2 + ...) written out, and the size of the terms of w'."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    u, v = float(point[j]), float(point[k])
    ka, ro, si, m = (float(row[axis]) for row in (problem.kappa, problem.rho, problem.sigma, problem.m))
    du = float(problem.kappa[j]) * v + float(problem.rho[j])
    dv = float(problem.kappa[k]) * u + float(problem.sigma[k])
    return (ka * u * v + ro * v + si * u + m, (ka * v + si) * du + (ka * u + ro) * dv,
            abs(ka * u * v) + abs(ro * v) + abs(si * u) + abs(m))


@scenes
def test_rows_start_at_a_fold(name, sheets):
    """There the saddle and the centre are one point, the loop around it has no size."""
    _, problem = SCENES[name]
    axis = axis_of(problem)
    for sheet in sheets[name]:
        size = np.max(np.abs(sheet.points))
        if np.abs(sheet.saddle[0] - sheet.centre[0]).max() > 1e-7 * size:
            continue  # the other loop of a figure eight: see below
        np.testing.assert_allclose(sheet.points[0], np.broadcast_to(sheet.saddle[0], sheet.points[0].shape),
                                   atol=1e-7 * size)
        rate, slope, scale = rate_and_slope(problem, sheet.saddle[0], axis)
        assert abs(rate) <= 1e-13 * scale
        # the slope in alpha vanishes at a fold; its unit is rate times the conic's wave number squared, of
        # order scale
        steep = max(abs(rate_and_slope(problem, p, axis)[1]) for p in sheet.saddle)
        assert abs(slope) <= 1e-6 * steep


@scenes
def test_no_membrane_spans_a_loop_at_the_fold(name, sheets):
    """Only the loop around the well that the saddle meets shrinks there. Of a figure eight the other loop
    keeps its size: rows next to each other lie next to each other, and one loop of each pair shrinks."""
    shrunk = 0
    for sheet in sheets[name]:
        extent = np.ptp(sheet.points[1], axis=0).max()
        assert np.abs(sheet.points[1] - sheet.points[0]).max() < 0.15 * np.abs(sheet.points).max()
        shrunk += np.ptp(sheet.points[0], axis=0).max() < 1e-6 * extent
    assert shrunk == (len(sheets[name]) // 2 if name.startswith("middle") else len(sheets[name]))


def test_loops_next_to_an_open_plane_close_to_rounding_as_reported():
    """Their energy is known to eps |x|^2/|C| only, but the surface is so steep there that the vertices lie on
    it."""
    scene, problem = scaled(0.0, 2.5, (0, 1, 0))
    right = [sheet for sheet in stabilab.separatrix(scene).branches if "right" in sheet.name]
    assert len(right) == 2
    for sheet in right:
        assert abs(sheet.invariant[-1]) < 1e-5 * np.sum(sheet.points[-1, 61] ** 2)
        for row, column in ((95, 61), (95, 64), (95, 11), (94, 30), (40, 64)):
            size, words = off_surface(problem, 1, sheet, row, column)
            assert size <= 1 and sheet.residual[row, column] < 4 * EPS, words


@pytest.mark.one_in(3)
@scenes
def test_points_inside_and_outside_a_sheet_have_the_fates_of_their_sides(name, sheets):
    scene, problem = SCENES[name]
    axis = axis_of(problem)
    elliptic = not name.startswith("middle")
    for sheet in sheets[name]:
        n, m = sheet.points.shape[:2]
        states, sides = [], []
        for r in np.linspace(n // 3, n - 1, 4).astype(int):
            if at_fold(problem, sheet, r):
                # the far end of a branch between two folds: rounding decides whether there is a saddle at all
                continue
            column = int(np.argmax(np.abs(sheet.points[r, :, axis])))
            for side in (-1, 1):
                state = np.array(sheet.points[r, column])
                state[axis] *= 1 + side * 1e-6
                states.append(state)
                sides.append(side)
        result = stabilab.fate(scene, np.array(states))
        np.testing.assert_array_equal(result.labels,
                                      [WORDS[energy.label(problem, tuple(s), digits=60)]
                                       for s in np.array(states).tolist()])
        if name in ("both components", "major physical", "equilibria on lines"):
            continue  # two saddles on one circle: bounded motion on both sides of the lower one's loop
        # around the figure-eight everything is bounded too
        outside = Fate.SPIN_UP if elliptic else Fate.BOUNDED
        np.testing.assert_array_equal(result.labels, [Fate.BOUNDED if s < 0 else outside for s in sides])
        np.testing.assert_array_equal(np.sign(result.margins), [-s for s in sides])


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("c", [0.0, 1.0, -1.75, 1.7547, 1.7549, -1.76, 2.5, -10.0])
def test_the_middle_axis_has_a_separatrix_beyond_the_cusp_alone(c, sign):
    """A figure eight: two lobes share each saddle, one around either centre."""
    found = stabilab.separatrix(scaled(0.0, c, (0, sign, 0))[0])
    assert len(found.branches) >= 2 if abs(c) > CUSP else found.branches == () and found.reason


FREE = {"no effect at all": ((3, 2, 1), (0, 0, 0)), "wheel on the major axis": ((3, 2, 1), (0.3, 0, 0)),
        "wheel on the middle axis": ((3, 2, 1), (0, 0.3, 0)),
        "wheel on the minor axis": ((3, 2, 1), (0, 0, 0.3)),
        "wheel across the major axis": ((3.0, 2.0, 1.5), (0, 0.1, 0.2)),
        "wheel across the minor axis": ((3.0, 2.0, 1.5), (0.3, 0.2, 0))}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", FREE)
def test_without_torque_no_surface_comes_twice(name):
    """Without torque the potential has period 2 pi: barriers of one height on a circle share one level set,
    in which a barrier's right loop is the left loop of the next barrier at its height (or its own, right
    round). So two vertices of different sheets coincide at saddles only. Were a sheet there twice, all its
    vertices would be met again."""
    inertia, momentum = FREE[name]
    scene, _ = physical(inertia, momentum, (0, 0, 0))
    found = stabilab.separatrix(scene, shape=(24, 33)).branches
    assert len(found) >= 2
    for one in found:
        row = len(one.points) // 2
        curve, level = one.points[row], one.invariant[row]
        size = np.abs(curve).max()
        for other in found:
            if other is one or not min(other.invariant) <= level <= max(other.invariant):
                continue
            near = _row_at(scene, other, level)
            gaps = np.min(np.linalg.norm(curve[:, None] - near[None], axis=2), axis=1)
            assert np.count_nonzero(gaps < 0.02 * size) < 0.5 * len(curve), (one.name, other.name)


def _row_at(scene, sheet, level):
    """(n, 3) dense polyline of a sheet's row at one value of the invariant: its grid, refined, at the nearest
    row."""
    fine = next(s for s in stabilab.separatrix(scene, shape=(400, 129)).branches if s.name == sheet.name)
    return fine.points[np.argmin(np.abs(fine.invariant - level))]


def test_sheets_of_the_free_body_are_its_two_planes_through_the_middle_axis():
    """Euler's top: |H|^2 = 2 T D2 gives D1(D1 - D2) w1^2 = D3(D2 - D3) w3^2, two planes, cut into two halves
    each by the middle axis; a sheet holds the two halves about one end of a centre's axis, so two sheets
    cover both planes once."""
    found = stabilab.separatrix(stabilab.Scene(stabilab.Body((3, 2, 1))), shape=(24, 33)).branches
    assert len(found) == 2
    for sheet in found:
        w1, _, w3 = np.moveaxis(sheet.points, -1, 0)
        np.testing.assert_allclose(3 * w1 * w1, w3 * w3, atol=1e-13 * np.max(w3 * w3))
    quarters = [set(map(tuple, np.sign(s.points[-1, 1:-1, [0, 2]]).T.astype(int).tolist())) for s in found]
    quarters = [{q for q in found if all(q)} for found in quarters]
    assert len(quarters[0] | quarters[1]) == 4 and not quarters[0] & quarters[1]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("rows", [100, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["minor a<b", "both components", "middle, c = 3"])
def test_no_vertex_is_nearer_than_the_distance_says(name, rows):
    """States off the saddles and on the plane of symmetry, W = 0, where the distance may be stationary
    without being least: a search that starts there on a ridge stays. Vertices are an upper bound that owes
    nothing to the search; those where the margin in energy is not zero part a well from a wider one that a
    higher barrier closes, and there no fate changes."""
    scene, problem = SCENES[name]
    sheets = stabilab.separatrix(scene, shape=(rows, rows + 101)).branches
    cloud = np.concatenate([sheet.points.reshape(-1, 3) for sheet in sheets])
    rng = np.random.default_rng(21)
    states = [sheet.saddle[int(share * rows)] + 0.05 * rng.normal(size=3) for sheet in sheets
              for share in (0.3, 0.67, 0.93)]
    states += list(rng.uniform(-3, 3, (rows // 50, 3)))
    states = np.array(states)
    states[:, axis_of(problem)] = sheets[0].saddle[0, axis_of(problem)]
    margins = stabilab.fate(scene, states).velocity_margins
    for state, margin in zip(states, margins):
        nearer = cloud[np.linalg.norm(cloud - state, axis=1) < margin * (1 - 1e-9)]
        assert name == "both components" or not len(nearer)
        assert np.all(stabilab.fate(scene, nearer[::97]).margins > 1e-9)


def test_distance_reaches_a_loop_that_a_second_barrier_is_about_to_open():
    """Two saddles on one circle: where the farther one sinks to the nearer one's height the loop jumps to
    another end, and the nearest point lies on the last loop before. A dense cloud of vertices gives 0.19613;
    a coarse grid's vertex 0.19652."""
    scene, _ = physical((3.0, 2.0, 1.5), (0.4, -0.7, 0), (0, 0, 0.3))
    state = np.array([-0.12794675, 1.19927972, 0.0])
    cloud = np.concatenate([sheet.points.reshape(-1, 3)
                            for sheet in stabilab.separatrix(scene, reach=5.6, shape=(700, 801)).branches])
    nearest = np.linalg.norm(cloud - state, axis=1).min()
    assert nearest * (1 - 1e-3) < stabilab.fate(scene, state).velocity_margins <= nearest


# --- the distance's proved lower bound and its witness


def test_a_sheet_that_nears_an_invariant_plane_is_found_however_near_it_is():
    """omega1 = -4 + 1e-62 and -4 + 1e-63 have margins of either sign, so a sheet passes within 1e-62 of the
    plane
    2 (omega1 + 4)^2 = omega2^2, whose distance is that of a line from a point in its plane: 0.1 sqrt(2/3)."""
    found = distance_of(reduce(physical((4, 2, 3), (4, 0, 0), (0, 0, -1.5))[0]), (-3.9, 0.0, 20.0))
    assert found.settled and found.upper == pytest.approx(0.1 * math.sqrt(2 / 3), rel=1e-9)


def random_scene(rng):
    """A body of one of the geometries with wheel and torque along it, and a state near or far."""
    moments = rng.uniform(1, 2, 3)
    if rng.random() < 0.25:
        moments[1] = moments[0]
    wheel, torque, axis = rng.normal(size=3), np.zeros(3), rng.integers(3)
    wheel[axis] = 0
    wheel *= rng.random(3) < 0.7
    torque[axis] = rng.normal() * (rng.random() < 0.8)
    return moments, wheel, torque, rng.normal(size=3) * 10.0 ** rng.uniform(-2, 1.5)


def inside(found, state, scene, rng, rays=12, steps=60):
    """Least distance within the lower bound at which the margin in energy passes through zero along random
    rays, or None."""
    ways = rng.normal(size=(rays, 3)) + 2 * (np.array(found.witness) - state) / found.upper
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    at = np.linspace(0, found.lower * (1 - 1e-9), steps)
    margins = stabilab.fate(scene, state + ways[:, None] * at[:, None]).margins
    scale = np.abs(margins[np.isfinite(margins)]).max(initial=0.0)
    for ray, row in zip(ways, margins):
        for low, high, a, b in zip(at, at[1:], row, row[1:]):
            if np.isfinite(a + b) and a * b < 0:
                for _ in range(50):
                    middle = 0.5 * (low + high)
                    value = float(stabilab.fate(scene, state + ray * middle).margins)
                    low, high = (middle, high) if value * a > 0 else (low, middle)
                if abs(value) < 1e-7 * scale:
                    return middle
    return None


def check_distances(number, seed):
    """How many of the brackets are settled; each is a bracket, and no margin changes its sign nearer than its
    lower bound."""
    rng, settled, known = np.random.default_rng(seed), 0, 0
    while known < number:
        moments, wheel, torque, state = random_scene(rng)
        scene = physical(moments, wheel, torque)[0]
        if (reduction := reduce(scene)) is None:
            continue
        found = distance_of(reduction, state.tolist())
        assert 0 <= found.lower <= found.upper
        if found.witness is None:
            continue
        known += 1
        settled += found.settled
        # where rounding keeps the bracket open, its upper end allows for it
        apart = np.linalg.norm(np.array(found.witness) - state)
        assert found.lower * (1 - 1e-9) <= apart <= found.upper * (1 + 1e-9)
        if torque.any():  # without torque the margin is the highest barrier's alone
            assert inside(found, state, scene, rng) is None, (moments, wheel, torque, state)
    return settled


@pytest.mark.parametrize("number", [12, pytest.param(2000, marks=[pytest.mark.slow, pytest.mark.long])])
def test_no_margin_of_random_scenes_changes_its_sign_nearer_than_the_lower_bound(number):
    assert check_distances(number, 5) >= 0.9 * number


def test_the_loops_of_a_free_hyperbola_keep_the_energy_and_the_momentum_of_their_saddle():
    D, wheel = np.array([9.0, 5.0, 4.0]), np.array([4.0, 0.0, 1.0])
    scene = Scene(Body((9, 5, 4)), Gyrostat((4, 0, 1)))
    sheets = stabilab.separatrix(scene, shape=(7, 17)).branches
    assert sheets
    for sheet in sheets:
        for row in sheet.points.reshape(-1, *sheet.points.shape[-2:]):
            row = row[np.isfinite(row).all(axis=1)]
            for law in ((D * row**2).sum(axis=1), ((D * row + wheel) ** 2).sum(axis=1)):
                assert not len(law) or np.ptp(law) < 1e-11 * np.abs(law).max()


def test_a_mesh_that_cannot_be_made_is_refused_and_a_parabola_has_none():
    for wrong in ({"shape": (2, 9)}, {"shape": (9, 4)}, {"reach": 1.0}, {"reach": -2},
                  {"shape": (9, 9), "accuracy": 1e-3}, {"accuracy": 0.0}, {"accuracy": -1e-3},
                  {"accuracy": float("nan")}):
        with pytest.raises(InputError):
            stabilab.separatrix(SCALED_MINOR, **wrong)
    found = stabilab.separatrix(Scene(Body((2, 2, 1)), ConstantTorque((1, 0, 0))))
    assert not found.branches and "parabolic" in found.because


@pytest.mark.parametrize("scene, words", [  # what there is none of, by hand
    # the axis and a plane of equilibria: not "there is no equilibrium"
    (Scene(Body((2, 2, 3))), "no force acts along any orbit"),
    (Scene(Body((3, 2, 2)), ConstantTorque((1, 0, 0))), "there is no equilibrium"),  # D1 p' = 1
    # D omega' = M: not "all motions are bounded"
    (Scene(Body((2, 2, 2)), ConstantTorque((1, 0, 0))), "every motion spins up"),
    # omega turns about the wheel, shifted
    (Scene(Body((2, 2, 2)), Gyrostat((0, 1, 0)), ConstantTorque((1, 0, 0))), "all motions are bounded"),
    # nor is there a "pure spin about the torque"
    (Scene(Body((2, 2, 2)), Gyrostat((0, 1, 0))), "no torque acts"),
    (Scene(Body((3, 2, "1.5")), Gyrostat(("0.3", 0, 0)), ConstantTorque(("0.1", "0.2", 0))), "")])
@pytest.mark.parametrize("sheets_of", [stabilab.separatrix, plain_separatrix])
def test_a_scene_without_sheets_is_told_what_is_true_of_it(scene, words, sheets_of):
    found = sheets_of(scene)
    sheets, reason = found if isinstance(found, tuple) else (found.branches, found.because)
    assert words in str(reason) and reason and not len(sheets)
