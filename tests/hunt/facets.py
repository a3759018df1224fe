"""Surfaces within an accuracy: how far their facets, rims, folds and creases lie from the separatrix of
Euler's equations, and whether a part is missing."""
from __future__ import annotations

import math

import numpy as np

import stabilab
from stabilab.show.surface.mesh import triangulate
from tests.hunt.disagreements import NO_QUESTION, worst
from tests.oracles import homoclinic
from tests.oracles.model import CYCLE
from tests.oracles.pairs import physical
from tests.orbit.separatrix.test_random_scenes import beside_a_plane, distance_to_facets

# of the accuracy: it is held by second differences, and the third ones of neighbours are up to a tenth of
# these
ESTIMATED = 1.1
# saddles and columns of a lobe, and of finer scans about its nearest few places
FIRST, ROUND, SCAN, BASINS = 401, 201, 21, 4
# places that look worst are asked for; and so many at random, on each rim, fold and crease
WORST, OTHERS = 3, 1
LOOKS = 6  # places of each lobe that a facet must be near to


def problem_of(knobs):
    """(scene, oracle's model, (share of the size that is the accuracy, reach, seed)) of a point in [0, 1]^14:
    scenes over a few decades, as the oracle works in doubles where it looks for the nearest place."""
    pick = [min(max(float(v), 0.0), 1.0) for v in knobs]
    axis = min(int(3 * pick[0]), 2)
    j, k = CYCLE[axis]
    shape = [10.0 ** (-2 * v) for v in pick[1:4]]
    if pick[4] > 0.7:  # nearly equal moments
        shape[(axis, j,
               k)[min(int(3 * pick[5]), 2)]] = shape[(j, k,
                                                      axis)[min(int(3 * pick[5]),
                                                                2)]] * (
                                                                    1 + 10.0 ** (-4 * (pick[4] - 0.7) / 0.3))
    inertia = [sum(shape) - part for part in shape]
    momentum, torque = [0.0] * 3, [0.0] * 3
    for i, size, side in ((j, pick[6], pick[7]), (k, pick[8], pick[9])):
        momentum[i] = 0.0 if abs(side - 0.5) < 0.1 else math.copysign(10.0 ** (3 * size - 2), side - 0.5)
    torque[axis] = math.copysign(10.0 ** (4 * pick[10] - 3), pick[11] - 0.5)
    scene, problem = physical(inertia, momentum, torque)
    return scene, problem, (10.0 ** (-2 - 2 * pick[12]), 1.2 * 10.0 ** pick[13], pick[13])


def facets(scene, problem, state):
    share, reach, _ = state
    rough = stabilab.separatrix(scene, reach=reach, shape=(24, 33)).branches
    if not rough or not any(scene.vector("gyrostat")):
        return NO_QUESTION
    accuracy = share * max(np.abs(branch.points - branch.points.mean(axis=(0, 1))).max() for branch in rough)
    body = homoclinic.Gyrostat(*(tuple(map(float, v))
                                 for v in (scene.body.inertia, scene.vector("gyrostat"),
                                           scene.vector("constant_torque"))))
    branches = stabilab.separatrix(scene, reach=reach, accuracy=accuracy).branches
    return worst(NO_QUESTION,
                 *_judged(body, branches, accuracy, np.random.default_rng(list(np.array(state).tobytes())),
                          f"accuracy {accuracy!r}"))


def _judged(body, branches, accuracy, rng, words):
    limit = max(np.abs(body.invariant(branch.saddle)).max() for branch in branches)
    lobes = homoclinic.lobes(body, 2 * limit)
    for branch in branches:
        allowed = ESTIMATED * max(accuracy, branch.error)
        for place, where in _places(body, branch, rng):
            yield _off(body, lobes, place,
                       allowed) / allowed, f"{branch.name}, {where}, {place.tolist()}: {words}, told {branch.error:.3g}"
    corner = np.concatenate([mesh.points[mesh.triangles] for mesh in map(triangulate, branches)])
    allowed, least = ESTIMATED * max(accuracy,
                                     *(branch.error for branch in branches)), 0.0 if body.closed else 1e-3 * limit
    for lobe in homoclinic.lobes(body, 0.5 * limit):  # farther out the rim where `reach` cuts strays more
        t = rng.uniform(lobe.stretch.low, lobe.stretch.high, LOOKS)
        # nearer to a plane the oracle's doubles lose the invariant
        t = t[np.abs(body.invariant(lobe.stretch.saddle(t))) >= least]
        places = lobe.places(t, rng.uniform(0, 1, len(t)))
        for place in places[np.isfinite(places).all(axis=1)]:
            yield distance_to_facets(place, corner) / allowed, f"no facet near {place.tolist()}: {words}"


def _places(body, branch, rng):
    """Mid-points of edges and centres of facets, with words: those that look worst, some at random, some of
    the first and the last row, of the saddles and of the far ends."""
    p = branch.points
    kept = np.flatnonzero(~beside_a_plane(body, branch))
    p, half = p[kept[0]:kept[-1] + 1] if len(kept) else p[:0], p.shape[1] // 2
    if len(p) < 3:
        return
    down, across = 0.5 * (p[1:] + p[:-1]), 0.5 * (p[:, 1:] + p[:, :-1])
    first = p[:-1, :half], p[1:, 1:half + 1]
    other = p[1:, :half], p[:-1, 1:half + 1]
    one, two = (first, other) if branch.cut > 0 else (other, first)
    centres = (one[0] + one[1] + two[0]) / 3
    within = np.concatenate([v.reshape(-1, 3)
                             for v in (down[:, :half + 1], across[:, :half], 0.5 * (one[0] + one[1]),
                                       centres)])
    looks = _roughly(body, within)
    for n in (*np.argsort(looks)[-WORST:], *rng.integers(0, len(within), OTHERS)):
        yield within[n], "within"
    for places, where in ((across[0], "first row"), (across[-1], "last row"), (down[:, 0], "saddles"),
                          (down[:, half], "far ends")):
        for n in rng.integers(0, len(places), OTHERS):
            yield places[n], where


def _roughly(body, places):
    """(n,) about how far places lie from the nearest of the saddles' manifolds on their curves, hidden ones
    too; 0 where they have none."""
    alpha = homoclinic.Curves(body, places).equilibria()
    turn = homoclinic.Curves(body, places[:1]).turn
    alpha = np.concatenate([alpha + n * turn for n in (-1, 0, 1)], axis=1) if body.closed else alpha
    step, Di = 1e-6 * np.abs(places).max(), body.numbers()[0]

    def gap(moved):
        curves = homoclinic.Curves(body, moved)
        return curves.rise(alpha) - 0.5 * Di * curves.w[:, None] ** 2
    with np.errstate(all="ignore"):
        slope = np.linalg.norm([(gap(places + d) - gap(places - d)) / (2 * step) for d in step * np.eye(3)],
                               axis=0)
        saddle = homoclinic.Curves(body, places).slope(alpha) > 0
        apart = np.where(saddle & (slope > 0), np.abs(gap(places)) / slope, np.inf).min(axis=1)
    return np.where(np.isfinite(apart), apart, 0.0)


def _off(body, lobes, place, allowed):
    """How far a place lies from the surface: to first order on its own curve, or, where that is more than
    allowed, by the nearest place of a lobe, the less of both."""
    first = float(homoclinic.in_digits(body, place.tolist()))
    return first if first <= allowed else min([first, *(_from_lobe(lobe, place) for lobe in lobes)])


def _from_lobe(lobe, place):
    """An upper bound on the distance of a place from a lobe: the best of a scan that is closer towards the
    stretch's ends, where folds may be, and of finer ones about its best places."""
    low, high, best = np.array([lobe.stretch.low, 0.0]), np.array([lobe.stretch.high, 1.0]), math.inf
    t = low[0] + (high[0] - low[0]) * (0.5 - 0.5 * np.cos(np.linspace(0, np.pi, FIRST)))
    turned = np.linspace(0, 1, ROUND)
    first = _apart(lobe, place, t, turned)
    if not np.isfinite(first).any():
        return best
    for n in np.argsort(np.fmin.reduce(first, axis=1))[:BASINS]:  # rows that are no numbers come last
        centre, width = np.array([t[n],
                                  turned[np.nanargmin(first[n])]]), np.array(
                                      [t[min(n + 2, FIRST - 1)] - t[max(n - 2, 0)], 5 / ROUND])
        while width.max() > 1e-7:
            near = [np.clip(c + w * np.linspace(-1, 1, SCAN), a, b) for c, w, a,
                    b in zip(centre, width, low, high)]
            apart = _apart(lobe, place, *near)
            i, j = np.unravel_index(np.nanargmin(apart), apart.shape)
            best, centre, width = min(best,
                                      float(apart[i, j])), np.array([near[0][i], near[1][j]]), width * 0.3
    return best


def _apart(lobe, place, t, turned):
    """(len(t), len(turned)) distances of a place from those of a lobe; nan where no loop closes."""
    saddle = lobe.stretch.saddle(t)
    ends = homoclinic.far_ends(lobe.stretch.body, saddle, lobe.side)
    grid = np.repeat(saddle, len(turned),
                     axis=0), np.repeat(ends, len(turned)), np.tile(np.sin(0.5 * np.pi * turned) ** 2, len(t))
    return np.linalg.norm(homoclinic.loop_places(lobe.stretch.body, *grid, lobe.way) - place,
                          axis=1).reshape(len(t), len(turned))
