"""How far a state is from the separatrix: the smallest change of the three rates that reaches it."""
from __future__ import annotations

import numpy as np

from .landscape import TURN, Landscape, landscape
from .separatrix import _branches, _polished, _sides, loop_end

ROWS, COLUMNS, STARTS, NEWTON = 36, 29, 3, 25
GRADING = 3  # s = t^3: rows uniform in t crowd at the fold, where a sheet narrows to a point


def separatrix_distance(scene, states) -> np.ndarray:
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the unit of the
    states; inf where the scene has none. A coarse grid over all sheets finds the neighbourhoods of the nearest points,
    Newton's method on the conditions of a nearest point refines them; the sheets' edges, the saddles, are searched too.
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
    # the nearest point lies no further out than the state plus its distance to a fold
    reach = 2 + 2 * size / max(max(folds), 1e-300)
    coarse = sorted((_Coarse(land, branch, side, state) for branch in _branches(land, reach) for side, _ in _sides(land)),
                    key=lambda grid: grid.least)
    best = np.inf
    for grid in coarse:
        best = min(best, grid.least, _nearest_saddle(land, grid.branch, state))
    for grid in coarse:
        best = _refined(land, grid, state, best)
    return best


class _Coarse:
    """A sheet on a coarse grid: (s in [0, 1] along the saddles, phi in [-1, 1] round the loop), and its distances."""

    def __init__(self, land, branch, side, state):
        self.branch, self.side = branch, side
        self.s, self.phi = np.linspace(0, 1, ROWS) ** GRADING, np.linspace(-1, 1, COLUMNS)
        self.points = _points(land, branch, side, self.s, self.phi)
        distance = np.sqrt(((self.points - state) ** 2).sum(axis=-1))
        self.distance = np.where(np.isfinite(distance), distance, np.inf)
        self.least = float(self.distance.min())

    def cell(self, row, column) -> float:
        """Size of the grid's cells about a vertex: no point of them is nearer than the vertex by more than that."""
        near = self.points[max(row - 1, 0):row + 2, max(column - 1, 0):column + 2].reshape(-1, 3)
        return 2 * float(np.nanmax(np.sqrt(((near - self.points[row, column]) ** 2).sum(axis=-1))))


def _refined(land, grid, state, best) -> float:
    """The least of `best` and the distances refined from the lowest separate basins of a coarse grid."""
    distance = grid.distance.copy()
    for _ in range(STARTS):
        row, column = np.unravel_index(np.argmin(distance), distance.shape)
        start = distance[row, column]
        if not start - grid.cell(row, column) < best:
            break
        piece = getattr(grid.branch, "piece", None)
        refined = _newton(land, piece, grid.side, state, grid.points[row, column]) if piece else None
        if refined is None or refined > start:
            refined = _descent(land, grid, state, row, column)
        best = min(best, refined)
        distance[max(row - 4, 0):row + 5, max(column - 4, 0):column + 5] = np.inf
    return best


def _nearest_saddle(land, branch, state) -> float:
    """Least distance to the branch of saddles, the edge of its sheet: a grid that shrinks about its nearest point."""
    low, high, least = 0.0, 1.0, np.inf
    for _ in range(30):
        t = np.linspace(low, high, 33)
        place = tuple(np.asarray(v, float) for v in branch(t))
        points = land.components(place, np.zeros(len(t)))
        distance = np.sqrt(((points - state) ** 2).sum(axis=-1))
        k = int(np.argmin(distance))
        least = min(least, float(distance[k]))
        low, high = t[max(k - 2, 0)], t[min(k + 2, 32)]
        if high - low < 1e-9:
            break
    return least


def _descent(land, grid, state, row, column) -> float:
    """The minimum near one vertex by damped Gauss-Newton steps in the sheet's own coordinates, for where Newton's method
    on the surface fails: next to a fold, where there is no saddle on one side, and on sheets along a line."""
    row = max(row, 1)  # at the fold itself all columns are one point
    at = np.array([grid.s[row] ** (1 / GRADING), grid.phi[column]])
    low, high = np.array([0.0, -1.0]), np.array([1.0, 1.0])
    least, damping = grid.distance[row, column], 1e-3
    width = 1e-4
    for _ in range(30):
        stencil = np.clip(at + np.array([-1.0, 0.0, 1.0])[:, None] * width, low, high)
        points = _points(land, grid.branch, grid.side, stencil[:, 0] ** GRADING, stencil[:, 1]) - state
        here = points[1, 1]
        with np.errstate(all="ignore"):
            slope = np.stack([(points[2, 1] - points[0, 1]) / (stencil[2, 0] - stencil[0, 0]),
                              (points[1, 2] - points[1, 0]) / (stencil[2, 1] - stencil[0, 1])], axis=1)
        if not (np.isfinite(here).all() and np.isfinite(slope).all()):
            break
        normal, force = slope.T @ slope, slope.T @ here
        for _ in range(12):
            step = np.linalg.lstsq(normal + damping * np.diag(np.diag(normal)), -force, rcond=None)[0]
            trial = np.clip(at + step, low, high)
            distance = np.linalg.norm(_points(land, grid.branch, grid.side, trial[:1] ** GRADING, trial[1:]) - state)
            if distance < least:
                break
            damping *= 8
        else:
            break
        gain, least, at, damping = least - distance, float(distance), trial, max(damping / 10, 1e-9)
        width = np.clip(0.1 * np.abs(step), 1e-7, 1e-4)
        if gain <= 1e-9 * least:
            break
    return float(least)


class _Sheet:
    """Phi = W^2/2 + V - V_saddle(Q) and its gradient near a sheet, in coordinates with the scene's own metric."""

    def __init__(self, land, piece, side):
        self.land, self.piece, self.side = land, piece, side
        g = land.reduction.constants
        self.g, self.unit = g, np.array([g["rx"], g["rz"], 1 / g["n"]])
        self.offset = np.array([g["sj"], g["sk"], float(land.reduction.s)])

    def coordinates(self, point):
        """Scene state -> p = (rx X, rz Z, W/n), at the same distances from one another."""
        r, flip = self.land.reduction, self.g["flip"]
        p = np.array([point[r.j], point[r.k], point[r.axis]]) + self.offset
        return p * np.array([flip, 1.0, flip])

    def value_and_gradient(self, p):
        """(Phi (n,), gradient (n, 3), on the sheet's loop (n,)) at p (n, 3)."""
        land, g, e = self.land, self.g, self.land.e
        x, z, w = (p / self.unit).T
        Q = (z - x) * (z + x) if e > 0 else z * z + x * x
        xs, zs, exists = land.conic._meet_piece(self.piece, Q)
        spot = land._polish((xs, zs) if e < 0 else (xs + zs, xs - zs))
        with np.errstate(all="ignore"):
            if e < 0:
                xs, zs = spot
                y = np.arctan2(x * zs - z * xs, x * xs + z * zs)
                y = np.where(y * self.side > 0, y, y + self.side * TURN)
            else:
                xs, zs = 0.5 * (spot[0] + spot[1]), 0.5 * (spot[0] - spot[1])
                y = np.log((x + z) / spot[0])
            value = 0.5 * w * w + land.potential.rise(y, spot)
            rate = (-(g["G"] * xs + g["c"]) * xs - e * g["d"] * zs) / (2 * Q)  # dV_saddle/dQ
            slope_x = -g["G"] * x - g["c"] - g["mu"] * z / Q + 2 * e * rate * x
            slope_z = -e * g["d"] + g["mu"] * x / Q - 2 * rate * z
        gradient = np.stack([slope_x, slope_z, w], axis=1) / self.unit
        return value, gradient, exists & np.isfinite(value) & (y * self.side >= 0)

    def on_loop(self, p) -> bool:
        """Whether p (3,) lies on the loop itself, not in a further well at the same energy."""
        land = self.land
        x, z, _ = p / self.unit
        Q = np.array([(z - x) * (z + x) if land.e > 0 else z * z + x * x])
        xs, zs, _ = land.conic._meet_piece(self.piece, Q)
        spot = land._polish((xs, zs) if land.e < 0 else (xs + zs, xs - zs))
        end, _, found, _ = loop_end(land, spot, self.side)
        if land.e < 0:
            y = np.arctan2(x * spot[1] - z * spot[0], x * spot[0] + z * spot[1])
            y = np.where(y * self.side > 0, y, y + self.side * TURN)
        else:
            y = np.log((x + z) / spot[0])
        return bool(found[0] and abs(y[0]) <= abs(end[0]) * (1 + 1e-9))


def _newton(land, piece, side, state, start):
    """Distance to the stationary point of the distance that Newton's method finds from `start`; None if it finds none."""
    sheet = _Sheet(land, piece, side)
    target, p = sheet.coordinates(state), sheet.coordinates(start)
    size = np.linalg.norm(p - target) + 1e-9 * np.abs(p).max()
    steps = 1e-5 * np.abs(p).max() * np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])
    multiplier, step = None, np.inf
    for _ in range(NEWTON):
        values, gradients, ok = sheet.value_and_gradient(p + steps)
        if not ok.all():
            return None
        value, gradient = values[0], gradients[0]
        hessian = (gradients[1:4] - gradients[4:7]) / (2 * steps[1, 0])
        hessian = 0.5 * (hessian + hessian.T)
        if multiplier is None:
            multiplier = -(p - target) @ gradient / (gradient @ gradient)
        matrix = np.zeros((4, 4))
        matrix[:3, :3], matrix[:3, 3], matrix[3, :3] = np.eye(3) + multiplier * hessian, gradient, gradient
        try:
            change = np.linalg.solve(matrix, -np.append(p - target + multiplier * gradient, value))
        except np.linalg.LinAlgError:
            return None
        step = np.linalg.norm(change[:3])
        factor = min(1.0, 0.5 * size / step) if step else 1.0
        p, multiplier = p + factor * change[:3], multiplier + factor * change[3]
        if step <= 1e-11 * (size + np.abs(p).max()):
            return float(np.linalg.norm(p - target)) if sheet.on_loop(p) else None
    return None


def _points(land, branch, side, s, phi):
    """(rows, columns, 3) points of a sheet; nan where a row has no loop."""
    saddle = _polished(land, tuple(np.asarray(v, float) for v in branch(s)), s)
    end, _, found, _ = loop_end(land, saddle, side)
    end = np.where(found | (s == 0), end, np.nan)
    y = end[:, None] * np.cos(0.5 * np.pi * phi) ** 2
    spot = tuple(v[:, None] for v in saddle)
    with np.errstate(all="ignore"):
        w = np.sign(phi) * np.sqrt(2 * np.maximum(-land.potential.rise(y, spot), 0))
        return land.components(land.potential.move(spot, y), w)
