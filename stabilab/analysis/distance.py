"""How far a state is from the separatrix: the smallest change of the three rates that reaches it.

Each sheet of the separatrix is a surface in two parameters: along its branch of saddles (from the fold outward) and round the
loop of each saddle. A coarse grid over all sheets finds the neighbourhoods of the nearest points, Newton's method on the
squared distance refines them. In plain floats: the question concerns one state at a time and needs no arrays.
"""
from __future__ import annotations

import math
from .conic import Conic
from .loop import loop_end, settled_on
from .potential import potential
from .reduction import reduce
from .saddle_branches import FOLD, PLANE, foot, on_line, saddle_branches, sides

ROWS, COLUMNS, STARTS, NEWTON = 28, 11, 3, 40
GRADING = 3  # s = t^3: rows uniform in t crowd at the fold, where a sheet narrows to a point
TO_PLANE = 24.0  # and near an invariant plane 1 - s falls to exp(-TO_PLANE), as loops grow there with the root of 1/(1 - s)
OFF = 0.25 / (COLUMNS - 1)  # starts keep off the saddle and the far end, where symmetry may hold a search on a ridge
STEP = 1e-4  # of the differences that give the surface's tangents and curvature


def separatrix_distance(scene, states):
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the unit of the
    states; inf where the scene has none."""
    import numpy as np
    array = np.asarray(states, float)
    reduction = reduce(scene)
    flat = [distance_of(reduction, state) for state in array.reshape(-1, 3).tolist()]
    return np.array(flat, float).reshape(array.shape[:-1])


def distance_of(reduction, state) -> float:
    """The distance of one state (three floats) of a scene with this reduction (None: it has none, so inf)."""
    if reduction is None or reduction.e == 0:
        return math.inf
    geometry = _Geometry(reduction, state)
    grids = sorted((_Grid(sheet) for sheet in geometry.sheets()), key=lambda grid: grid.least)
    best = min((grid.least for grid in grids), default=math.inf)
    for grid in grids:
        best = _refined(grid, best)
    return best


class _Geometry:
    """A reduction seen from one state: places in canonical variables, distances in the scene's own unit.

    The separatrix is symmetric in W, and so is the distance up to the sign of the state's: its nearest point has that sign.
    """

    def __init__(self, reduction, state):
        self.e, self.sense = reduction.e, reduction.sense
        self.pot, self.conic = potential(reduction), Conic(reduction)
        g = reduction.constants
        self.rx, self.rz, self.n = g["rx"], g["rz"], g["n"]
        self.x, self.z, self.w = map(float, reduction.canonical_exact(state))
        self.w = abs(self.w)

    def away(self, saddle, y, turned):
        """Vector from the state to the loop's point at offset y from a saddle, W of the sign of `turned`."""
        w = math.copysign(math.sqrt(2 * max(-self.pot.rise(y, saddle), 0.0)), turned)
        first, second = self.pot.move(saddle, y)
        x, z = (first, second) if self.e < 0 else (0.5 * (first + second), 0.5 * (first - second))
        return self.rx * (x - self.x), self.rz * (z - self.z), (w - self.w) / self.n

    def sheets(self):
        """The sheets that may hold the nearest point: it lies no further out than the state plus its distance to a fold (or,
        where the saddles are on lines, to the innermost of them)."""
        conic = self.conic
        ends = [conic.at(h) for h in conic.folds] + [on_line(line, foot(conic, line)) for line in conic.lines] or [(0.0, 0.0)]
        far = min(math.hypot(self.rx * (x - self.x), self.rz * (z - self.z), self.w / self.n) for x, z in ends)
        radius = math.hypot(self.x, self.z) + far / min(abs(self.rx), abs(self.rz))
        limit = max(4 * max(x * x + z * z for x, z in ends), 1.1 * radius * radius)
        for branch in saddle_branches(conic, self.pot, limit):
            for side, _ in sides(self.e, self.sense):
                yield _Sheet(self, branch, side)


class _Sheet:
    """Points over (t, phi): saddles from the fold (t = 0) outward, round each loop from its far end (phi = 0) to the saddle
    (phi = 1); phi < 0 is the other half of the loop."""

    def __init__(self, geometry, branch, side):
        self.geometry, self.branch, self.side = geometry, branch, side

    def loop(self, t):
        """(saddle, signed length of its loop), None where no loop closes."""
        g, s = self.geometry, t ** GRADING
        if self.branch.far == PLANE:
            s = 1 - (1 - s) * math.exp(-TO_PLANE * t ** 4)
        elif self.branch.far == FOLD:  # rows crowd there alike
            s = t * t * (3 - 2 * t)
        saddle = self.branch.place(s)
        if s == 0:
            return saddle, 0.0
        saddle = settled_on(g.pot, saddle)
        end = loop_end(g.pot, g.e, g.sense, saddle, self.side)
        return None if end is None else (saddle, self.side * end[0])

    def away(self, loop, phi):
        saddle, end = loop
        return self.geometry.away(saddle, end * math.cos(0.5 * math.pi * phi) ** 2, phi)


class _Grid:
    """A sheet on a coarse grid: vectors from the state and their lengths, None where there is no loop."""

    def __init__(self, sheet):
        self.sheet = sheet
        self.t = [row / (ROWS - 1) for row in range(ROWS)]
        self.phi = [column / (COLUMNS - 1) for column in range(COLUMNS)]
        self.away = []
        for t in self.t:
            loop = sheet.loop(t)
            self.away.append(loop and [sheet.away(loop, phi) for phi in self.phi])
        self.distance = {(r, c): math.hypot(*v) for r, row in enumerate(self.away) if row for c, v in enumerate(row)}
        self.least = min(self.distance.values(), default=math.inf)

    def cell(self, row, column) -> float:
        """Size of the grid's cells about a vertex: no point of them is nearer than the vertex by more than that."""
        here = self.away[row][column]
        return 2 * max((math.dist(here, self.away[r][c]) for r in range(row - 1, row + 2) for c in range(column - 1, column + 2)
                        if (r, c) in self.distance), default=0.0)


def _refined(grid, best) -> float:
    """The least of `best` and the distances refined from the lowest separate basins of a coarse grid."""
    left = dict(grid.distance)
    for _ in range(STARTS):
        if not left:
            break
        row, column = min(left, key=left.get)
        if left[row, column] - grid.cell(row, column) < best:
            phi = min(max(grid.phi[column], OFF), 1 - OFF)
            best = min(best, _descent(grid.sheet, grid.t[row], phi, left[row, column]))
        left = {at: d for at, d in left.items() if abs(at[0] - row) > 4 or abs(at[1] - column) > 2}
    return best


def _descent(sheet, t, phi, least) -> float:
    """The minimum of the distance near one vertex, by Newton's method with the surface's tangents and curvature from
    differences; damped where the squared distance is not convex. Vectors, not distances, are differenced: the gradient is
    then as accurate against the distance itself, however near the surface is."""
    damping = 0.0
    for _ in range(NEWTON):
        t = min(max(t, 2 * STEP), 1 - 2 * STEP)
        loops = [sheet.loop(t + k * STEP) for k in (-1, 0, 1)]
        if None in loops:
            return least
        v = [[sheet.away(loop, phi + k * STEP) for k in (-1, 0, 1)] for loop in loops]
        here = v[1][1]
        along, round_ = _slope(v[0][1], v[2][1]), _slope(v[1][0], v[1][2])
        bend = _bend(v[0][1], here, v[2][1]), _bend(v[1][0], here, v[1][2])
        twist = tuple((a - b - c + d) / (4 * STEP * STEP) for a, b, c, d in zip(v[2][2], v[2][0], v[0][2], v[0][0]))
        now = math.hypot(*here)
        least = min(least, now)
        gradient = _dot(along, here), _dot(round_, here)
        squares = _dot(along, along), _dot(round_, round_)
        aa, bb, ab = squares[0] + _dot(bend[0], here), squares[1] + _dot(bend[1], here), _dot(along, round_) + _dot(twist, here)
        while True:
            da, db = aa + damping * squares[0] + 1e-300, bb + damping * squares[1] + 1e-300
            det = da * db - ab * ab
            if da > 0 and db > 0 and det > 1e-6 * da * db:
                move_t, move_phi = (ab * gradient[1] - db * gradient[0]) / det, (ab * gradient[0] - da * gradient[1]) / det
                move_t, move_phi = max(-0.2, min(0.2, move_t)), max(-0.2, min(0.2, move_phi))
                trial = sheet.loop(min(max(t + move_t, 2 * STEP), 1 - 2 * STEP))
                if trial and math.hypot(*sheet.away(trial, phi + move_phi)) <= now * (1 + 1e-12):
                    break
            damping = max(4 * damping, 0.01)
            if damping > 1e9:
                return least
        t, phi = t + move_t, phi + move_phi
        damping = damping / 8 if damping > 0.02 else 0.0
        if abs(move_t) + abs(move_phi) < 1e-9 or -_dot(gradient, (move_t, move_phi)) < 1e-15 * now * now:
            return min(least, math.hypot(*sheet.away(trial, phi)))
    return least


def _slope(before, after):
    return tuple((b - a) / (2 * STEP) for a, b in zip(before, after))


def _bend(before, here, after):
    return tuple((a - 2 * h + b) / (STEP * STEP) for a, h, b in zip(before, here, after))


def _dot(a, b) -> float:
    return sum(u * v for u, v in zip(a, b))
