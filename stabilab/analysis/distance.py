"""How far a state is from the separatrix: the smallest change of the three rates that reaches it."""
from __future__ import annotations

import numpy as np

from .landscape import TURN, Landscape, landscape
from .separatrix import _branches, _polished, _sides, loop_end

ROWS, COLUMNS, ZOOMS, SHRINK = 48, 41, 30, 0.4


def separatrix_distance(scene, states) -> np.ndarray:
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the unit of the
    states; inf where the scene has none. Of all sheets: a coarse grid finds the neighbourhood, then a grid that shrinks
    about its nearest point finds the minimum to about 1e-8 of the distance.
    """
    array = np.asarray(states, float)
    flat = array.reshape(-1, 3)
    land = landscape(scene)
    if land is None or land.e == 0:
        return np.full(array.shape[:-1], np.inf)
    return np.array([_one(land, state) for state in flat]).reshape(array.shape[:-1])


def _one(land: Landscape, state) -> float:
    place, _, _ = land.start(state[None])
    size = np.sqrt(place[0] ** 2 + place[1] ** 2)[0]
    folds = [np.sqrt(abs(q)) for q in land.conic.fold_invariants] or [1.0]
    best = np.inf
    # the nearest point lies no further out than the state plus its distance to a fold: reach far enough, then check
    reach = 2 + 2 * size / max(max(folds), 1e-300)
    for branch in _branches(land, reach):
        for side, _ in _sides(land):
            best = min(best, _nearest_on_sheet(land, branch, side, state, best))
    return best


def _nearest_on_sheet(land, place_at, side, state, best):
    """Least distance to one sheet, parametrised by (s in [0, 1] along the saddles, phi in [-1, 1] round the loop)."""
    s = np.linspace(0, 1, ROWS) ** 1.5
    phi = np.linspace(-1, 1, COLUMNS)
    distance = _distances(land, place_at, side, state, s, phi)
    found = np.inf
    for _ in range(3):  # the three lowest separate basins of the coarse grid
        row, column = np.unravel_index(np.argmin(distance), distance.shape)
        if not np.isfinite(distance[row, column]):
            break
        found = min(found, _zoom(land, place_at, side, state, s, phi, row, column, distance[row, column]))
        distance[max(row - 4, 0):row + 5, max(column - 4, 0):column + 5] = np.inf
    return found


def _zoom(land, place_at, side, state, s, phi, row, column, start):
    ds = s[min(row + 1, len(s) - 1)] - s[max(row - 1, 0)]
    dphi = phi[1] - phi[0]
    centre, least = [s[row], phi[column]], start
    for _ in range(ZOOMS):
        near_s = np.clip(centre[0] + ds * np.linspace(-1, 1, 7), 0, 1)
        near_phi = np.clip(centre[1] + dphi * np.linspace(-1, 1, 7), -1, 1)
        distance = _distances(land, place_at, side, state, near_s, near_phi)
        r, c = np.unravel_index(np.argmin(distance), distance.shape)
        if distance[r, c] <= least:
            centre, least = [near_s[r], near_phi[c]], distance[r, c]
        at_edge = r in (0, 6) or c in (0, 6)
        if not at_edge:
            ds, dphi = ds * SHRINK, dphi * SHRINK
        if ds < 1e-9 and dphi < 1e-9:
            break
    return float(least)


def _distances(land, place_at, side, state, s, phi):
    """(rows, columns) distances from the state to the sheet's points; inf where a row has no loop."""
    saddle = _polished(land, tuple(np.asarray(v, float) for v in place_at(s)), s)
    end, _, found = loop_end(land, saddle, side)
    end = np.where(found, end, 0.0)
    y = end[:, None] * np.cos(0.5 * np.pi * phi) ** 2
    spot = tuple(v[:, None] for v in saddle)
    with np.errstate(all="ignore"):
        w = np.sign(phi) * np.sqrt(2 * np.maximum(-land.potential.rise(y, spot), 0))
    points = land.components(land.potential.move(spot, y), w)
    distance = np.sqrt(((points - state) ** 2).sum(axis=-1))
    return np.where(found[:, None] | (s == 0)[:, None], distance, np.inf)
