"""Homoclinic loops of many saddles, NumPy: where the motion that leaves a saddle turns back, and the
points of the loop in between.

Along a loop W = +-sqrt(2 (V_saddle - V(theta))), the difference formed without cancellation, so points lie on
the separatrix to rounding.

Loops whose orbits are centred far away, those of nearly equal moments, start from their saddles in the
components themselves.

Canonical places are measured from the centre, and would have no digit of a loop that is a million times
smaller than its distance from there. With t = p q alpha^2 and S = sum t^k alpha^(2k+1)/(2k+1)!, C its
integral, L that of C (sin, 1 - cos, alpha - sin of an orbit, or hyperbolic ones), a loop is

    omega_j = u + a S + p b C,   omega_k = v + b S + q a C,   a = p v + p0, b = q u + q0,   (omega_i + s)^2 =
    2 alpha^2 R(alpha),
    R = F' c + (F1 l + kappa a b (S c/alpha - l)) alpha + kappa (q a^2 + p b^2)/2 c^2 alpha^2,   c =
    C/alpha^2, l = L/alpha^3,

F' and F1 = F'' - 2 kappa a b at the saddle (u, v). Nothing here is a difference of large numbers, and R is
nearly a parabola, whose roots begin the search.

Seams of a branch are where the loop of a saddle reaches a second saddle as high, behind which it opens a
second well.

At the seam the far end of the loop jumps: on one side the loop turns back before the second saddle, on the
other it passes over it. The branch is smooth on both sides, W^2 = 2 (V_saddle - V) being a saddle surface
itself next to the second saddle, but rows of a grid are level curves of it: they must crowd towards the seam
like squares, and columns towards the second saddle, where loops are pinched. So a strip is cut there, and
each part graded by itself."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..potential import Circle, Parabola
from .homoclinic import loop_end, others, settled

if TYPE_CHECKING:
    from ..landscape import ConicLandscape
    from ..reduction import Reduction
    from .saddles import Branch

# --- Loops whose orbits are centred far away
FAR_LOOP = 100.0   # times the size of a loop: from there canonical places lose two digits and more
TURNED = 0.1  # of a radian, in which series of five terms end below rounding
NEWTON_STEPS = 10    # of Newton's method with the slope of the parabola, which is off by a tenth of t at most
TINY = np.finfo(float).tiny


class Orbits:
    """Orbits through saddles, in alpha from them. u, v: (r,) the ways there from the asymptotes of the
    hyperbola of equilibria, omega_j = -rho/kappa and omega_k = -sigma/kappa, whose digits the slopes need;
    side: (r,) the sign of alpha on the loop."""

    def __init__(self, reduction: Reduction, u: np.ndarray, v: np.ndarray, side: np.ndarray):
        self.r, self.side = r, _ = Parabola(reduction), side
        self.product = u * v
        self.u, self.v = u - r.rho / r.kappa, v - r.sigma / r.kappa
        a, b = self.a, self.b = r.p * self.v + r.p0, r.q * self.u + r.q0
        self.steep, self.bent = r.kappa * (a * v + b * u), r.kappa * (r.p * b * v + r.q * a * u)
        self.both, self.curl = r.kappa * a * b, 0.5 * r.kappa * (r.q * a * a + r.p * b * b)

    def moved(self, alpha: np.ndarray):
        """(omega_j, omega_k) at alpha (r, ...)."""
        S, C, _ = (v * alpha**n for n, v in enumerate(self._series(alpha), 1))
        a, b, u, v = (item.reshape(item.shape + (1,) * (alpha.ndim - 1))
                      for item in (self.a, self.b, self.u, self.v))
        return u + (a * S + self.r.p * b * C), v + (b * S + self.r.q * a * C)

    def fall(self, alpha: np.ndarray):
        """R(alpha): how far the potential lies below the saddle's height, over alpha^2."""
        s, c, third = self._series(alpha)
        steep, bent, both, curl = (v.reshape(v.shape + (1,) * (alpha.ndim - 1))
                                   for v in (self.steep, self.bent, self.both, self.curl))
        return steep * c + (bent * third + both * (s * c - third)) * alpha + curl * c * c * alpha * alpha

    def ends(self):
        """(r,) alpha of the far ends; nan where none is near."""
        return self._root(self.steep / 2, self.bent / 6 + self.both / 3, self.curl / 4, self.fall)

    def centres(self):
        """(r,) alpha of the wells."""
        def force(alpha: np.ndarray):  # over alpha
            s, c, _ = self._series(alpha)
            du, dv = self.a * s + self.r.p * self.b * c * alpha, self.b * s + self.r.q * self.a * c * alpha
            return self.steep * s + self.bent * c * alpha + self.r.kappa * du * dv * alpha
        return self._root(self.steep, self.bent / 2 + self.both, self.curl, force)

    def wells(self, alpha: np.ndarray):
        """(omega_j, omega_k) of the wells at alpha (r,), which lie on the hyperbola of equilibria too: it
        tells the component that is nearer to its asymptote, of which the way there from the saddle may keep
        no digit."""
        r, (u, v) = self.r, self.moved(alpha)
        first, second = u + r.rho / r.kappa, v + r.sigma / r.kappa
        long = np.abs(second) > np.abs(first)
        with np.errstate(all="ignore"):
            return np.where(long, self.product / second - r.rho / r.kappa,
                            u), np.where(long, v, self.product / first - r.sigma / r.kappa)

    def sharpness(self, end: np.ndarray):
        """(r,) the way to the far end times the bend of the potential over its slope there."""
        far = self.moved(end)
        with np.errstate(all="ignore"):
            return np.abs(end) * self.r.slope(far) / np.abs(self.r.force(far))

    def _series(self, alpha: np.ndarray):
        t = self.r.p * self.r.q * alpha * alpha
        return (1 + t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72))),
                0.5 * (1 + t / 12 * (1 + t / 30 * (1 + t / 56 * (1 + t / 90)))),
                (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110)))) / 6)

    def _root(self, first: np.ndarray, second: np.ndarray, third: np.ndarray,
              function: Callable[[np.ndarray], np.ndarray]):
        """The root on the loop's side of what is nearly first + second x + third x^2, with first > 0 > third.
        """
        with np.errstate(all="ignore"):
            half = -0.5 * (second + np.copysign(np.sqrt(second * second - 4 * first * third), second))
            item, other = half / third, first / half
            x = np.where(item * self.side > 0, item, other)
            for _ in range(NEWTON_STEPS):
                step = function(x) / (second + 2 * third * x)
                x = x - np.where(np.isfinite(step) & (np.abs(step) < 0.5 * np.abs(x)), step, 0.0)
            return np.where((first > 0) & (third < 0) & (x * self.side > 0), x, np.nan)


@lru_cache(maxsize=64)
def asymptotes(land: ConicLandscape):
    """(omega_j, omega_k) of the hyperbola of equilibria far out, and the product of the ways from them; None
    without one, or with an asymptote that is far."""
    r, conic, g = land.reduction, land.conic, land.reduction.constants
    if not conic.pieces or r.parabolic_shift_size == 0:
        return None
    return float(-r.rho / r.kappa), float(-r.sigma / r.kappa), g["flip"] * g["rx"] * conic.K / conic.G


def saddles_of(land: ConicLandscape, branch: Branch, s: np.ndarray):
    """((u, v) of the saddles of a branch at s (n,) as of `Orbits`, (n,) whether they are much nearer than the
    centre)."""
    result = asymptotes(land)
    if result is None or branch.line is not None:
        return (np.zeros(len(s)), np.zeros(len(s))), np.zeros(len(s), bool)
    (first, second, product), rz = result, land.reduction.constants["rz"]
    h = branch.start + (branch.end - branch.start) * s
    u, v = product / h, rz * h
    size = np.abs(u) + np.abs(v) + 2 * (abs(first) + abs(second))
    return (u, v), FAR_LOOP * size < land.reduction.parabolic_shift_size


def shrinks_far(land: ConicLandscape, branch: Branch, side: int) -> bool | None:
    """`branches.shrinks` of a fold whose orbit's centre is far; None of others."""
    (u, v), far = saddles_of(land, branch, np.zeros(1))
    if not far[0]:
        return None
    item = Orbits(land.reduction, u, v, np.ones(1))
    return bool((item.bent / 6 + item.both / 3)[0] * side * land.unit <= 0)


def replaced(land: ConicLandscape, strips: Sequence[Part | tuple[Branch, int]], s: np.ndarray, u: np.ndarray,
             built: Loops, shares_of: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]):
    """The fields of `Loops` of strips at rows s (k, n) and columns u (k, m), those of rows with a far centre
    in the components; shares_of(sharpness (r,), u (r, m), numbers of strips (r,)): where columns stand."""
    r, g = land.reduction, land.reduction.constants
    printed = [saddles_of(land, strip[0], row) for strip, row in zip(strips, s)]
    far = np.array([item[1] for item in printed])
    if not far.any():
        return built
    strip, row = np.nonzero(far)
    side = np.array([np.sign(item[1] * land.unit) for item in strips])[strip]
    ways = np.moveaxis(np.array([item[0] for item in printed]), 1, -1)[far]
    orbits = Orbits(r, *ways.T, side)
    fold = s[far] == 0
    end, deep = (np.where(fold, 0.0, v) for v in (orbits.ends(), orbits.centres()))
    good = np.isfinite(end) & np.isfinite(deep) & (g["n"] * np.abs(end) < TURNED)
    size = np.abs(orbits.moved(np.nan_to_num(end))).max(axis=0)
    good &= FAR_LOOP * size < r.parabolic_shift_size
    end, deep = np.where(good, end, 0.0), np.where(good, deep, 0.0)
    alpha = end[:, None] * shares_of(np.where(fold, 0.0, orbits.sharpness(end)), u[strip], strip)
    w = np.abs(alpha) * np.sqrt(2 * np.maximum(orbits.fall(alpha), 0.0))
    w[:, 0] = w[:, -1] = 0.0
    points = _states(r, *orbits.moved(alpha), side[:, None] * w)
    still = np.zeros(len(end))
    new = {"end": end * g["n"] * g["flip"], "offset": alpha * g["n"] * g["flip"], "w": w * g["n"],
           "points": points, "found": good | fold,
           "shared": np.zeros(len(end), bool), "ways": ways,
           "saddle_state": _states(r, orbits.u, orbits.v, still),
           "centre_state": _states(r, *orbits.wells(deep), still)}
    out = dict(vars(built))
    for name, values in new.items():
        out[name] = np.array(out[name])
        out[name][strip[good], row[good]] = values[good]
    return type(built)(**out)


def _states(r: Reduction, u: np.ndarray, v: np.ndarray, w: np.ndarray):
    out = np.empty(np.shape(w) + (3,))
    out[..., r.j], out[..., r.k], out[..., r.axis] = u, v, w - float(r.s)
    return out


def residual_far(land: ConicLandscape, loops: Loops):
    """(r, m) residuals of the rows of loops that are `far`, from their points: energy above the saddle's over
    the size of its terms at the nearest place of the orbit, or how far that is from the point, relative to
    its size."""
    r, far = land.reduction, loops.far
    points, alpha = loops.points[far], loops.offset[far] * land.unit
    orbits = Orbits(r, *loops.ways[far].T, np.sign(alpha[:, -1]))
    u, v = orbits.moved(alpha)
    speed = np.array([orbits.r.p * v + orbits.r.p0, orbits.r.q * u + orbits.r.q0])
    off = np.array([points[..., r.j] - u, points[..., r.k] - v])
    square = np.maximum((speed * speed).sum(axis=0), TINY)
    along = (off * speed).sum(axis=0) / square
    w, size = points[..., r.axis] + float(r.s), np.abs(points[..., r.j]) + np.abs(points[..., r.k])
    beside = np.abs(off[0] * speed[1] - off[1] * speed[0]) / np.sqrt(square) / np.maximum(size, TINY)
    alpha = alpha + along
    departure = np.abs(0.5 * w * w - alpha * alpha * orbits.fall(alpha))
    terms = 0.5 * w * w + orbits.r.terms((points[..., r.j], points[..., r.k])) * np.abs(alpha)
    return np.fmax(np.where(departure > 0, departure / np.maximum(terms, TINY), 0.0), beside)


# --- Seams of a branch
# of its length, by which a loop grows at least where a seam is; so near to it a smooth far end moves by less
# than a millionth
JUMP = 1e-3
# halvings, after which a smooth far end, which begins like a root of s, moves by a quarter of JUMP at most
# between the ends
LOOK = 24
BEGIN = 1e-9   # s next to the fold
# of s: so far from the seam the second saddle's height is known beside the first one's, and the parts' edges
# lie within a millionth of the loop
TWIN_WIDTH = 1e-12
PINCH = 0.02      # of a lobe's length: no bend at the second saddle is resolved below


class Part(NamedTuple):
    """The rows low <= s <= high of a branch's loops on one side; seam: -1 where `low` is one, +1 where `high`
    is, 0 without; over: whether the loops pass over a second saddle. number: of the part among those of its
    strip, 0 for a whole one."""

    branch: Any
    side: int
    low: float = 0.0
    high: float = 1.0
    seam: int = 0
    over: bool = False
    number: int = 0

    def rows(self, t: np.ndarray):
        """s at parameters t in [0, 1], of which the distance from the seam is the square; without a seam they
        are s itself."""
        if not self.seam:
            return t
        return (self.low + (self.high - self.low) * t * t if self.seam < 0
                else self.high - (self.high - self.low) * (1 - t) ** 2)

    def parameters(self, s: np.ndarray):
        """t at rows s: the inverse of `rows`."""
        if not self.seam:
            return s
        fraction = np.clip((np.asarray(s) - self.low) / (self.high - self.low), 0.0, 1.0)
        return np.sqrt(fraction) if self.seam < 0 else 1 - np.sqrt(1 - fraction)


def parted(land: ConicLandscape, strips: Sequence[tuple[Branch, int]], first: np.ndarray) -> list[Part]:
    """The parts of strips, pairs (branch, side), whose rows begin at first (k,)."""
    rows = []
    for (branch, side), start in zip(strips, first):
        seam = seam_of(land, branch, side)
        if seam is None or not start < seam[0]:
            rows.append(Part(branch, side))
            continue
        before, behind, over = seam
        rows += [Part(branch, side, float(start), before, 1, over < 0, 1),
                  Part(branch, side, behind, 1.0, -1, over > 0, 2)]
    return rows


def seam_of(land: ConicLandscape, branch: Branch, side: int) -> tuple[float, float, int] | None:
    """(s just before the seam of a strip, s just behind it, +1 where loops pass over the second saddle behind
    it, -1 where before), or None.

    Circles with a torque alone have seams. Where the second saddle appears below the first one's height, no
    far end jumps, and there is none.
    """
    if len(land.conic.sides(land.sense)) > 1:
        return None
    low, high, pot = BEGIN, 1.0, land.potential
    before, behind = (_passes(pot, branch, side, s) for s in (low, high))
    if before == behind:
        return None
    halvings = 0
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if _passes(pot, branch, side, middle) == before else (low, middle)
        halvings += 1
        if halvings == LOOK and not _jumps(land, branch, side, low, high):
            return None  # as of most strips: the second half of the halvings is for seams alone
    low, high = low * (1 - TWIN_WIDTH), high * (1 + TWIN_WIDTH)
    return (low, high, 1 if behind else -1) if high < 1 and _jumps(land, branch, side, low, high) else None


def _jumps(land: ConicLandscape, branch: Branch, side: int, low: float, high: float) -> bool:
    """Whether the far end of the loop jumps between two rows."""
    ends = [_far_end(land, branch, side, s) for s in (low, high)]
    return abs(ends[1] - ends[0]) > JUMP * max(ends)


def _far_end(land: ConicLandscape, branch: Branch, side: int, s: float) -> float:
    saddle = settled(land.potential, tuple(map(float, branch.place(s))))
    result = loop_end(land.potential, land.sense, saddle, side)
    return result[0] if result else 0.0


def _passes(pot: Circle, branch: Branch, side: int, s: float) -> bool:
    """Whether a loop passes over a second saddle: the first one ahead is below its own."""
    saddle = settled(pot, tuple(map(float, branch.place(s))))
    ahead = _barrier(pot, saddle, side)
    return ahead is not None and pot.rise(side * ahead, saddle) < 0


def pinched_shares(pot: Circle, saddle: np.ndarray, end: np.ndarray, side: int, u: np.ndarray):
    """(n, m) shares of the way to the far ends (n,) at which columns u (m,), 0 to 1, stand: half of them
    before the second saddle and half behind it, crowded towards it as hyperbolas W^2 = K (e^2 + t^2) at
    distance t bend, with e the half width of the pinch; towards the far end as a parabola bends.

    saddle: (2, n).
    """
    rows = [_second(pot, location, side, abs(far)) for location,
            far in zip(zip(*(v.tolist() for v in saddle)), end.tolist())]
    at, width = np.array(rows).T[:, :, None]
    full, v = np.abs(end)[:, None], np.clip(2 * u, 0, 1)
    behind, v2 = full - at, np.clip(2 * u - 1, 0, 1)
    first = _crowded(1 - v, np.maximum(width / at, PINCH))
    second = _crowded(1 - (1 - v2) ** 2, np.maximum(width / behind, PINCH))
    shares = np.where(u <= 0.5, at * (1 - first), at + behind * second) / full
    shares[:, 0], shares[:, -1] = 0.0, 1.0  # exactly, as the ends are
    return shares


def _crowded(x: np.ndarray, width: np.ndarray):
    """Shares x in [0, 1] moved towards 0, as sinh(q x)/sinh(q) with width sinh(q) = 1."""
    q = np.arcsinh(1 / width)
    return np.sinh(q * x) * width


def _second(pot: Circle, saddle: Sequence[float], side: int, end: float):
    """(distance of the second saddle, half width of the pinch there); without one the middle of the loop, and
    no pinch."""
    t = _barrier(pot, saddle, side)
    if t is None or not t < end:
        return 0.5 * end, end
    return t, max(-2 * float(pot.rise(side * t, saddle)) / pot.slope(pot.move(saddle, side * t)), 0.0) ** 0.5


def _barrier(pot: Circle, saddle: Sequence[float], side: int):
    """The distance to the first barrier on one side of a saddle; None where there is none within a turn."""
    return next((t for t in others(pot, saddle, side) if pot.slope(pot.move(saddle, side * t)) > 0), None)


# --- Loops of many saddles
SHARPEST = 1e3  # bends tighter than the loop's length over this are not resolved


def polished(land: ConicLandscape, saddle: Sequence[np.ndarray], s: np.ndarray):
    """Return the points of the conic after each was moved along its orbit to where the force vanishes. The
    fold itself stays where it is."""
    moved = land.polished(saddle)
    return tuple(np.where(s > 0, m, v) for m, v in zip(moved, saddle))


def loop_ends(land: ConicLandscape, saddle: Sequence[np.ndarray], side: np.ndarray):
    """(offset of the far end of the loop (n,), centre place (2, n), found (n,), shared (n,)) for saddles (2,
    n), each on its side (n,); shared: it ends at a saddle there, for which this is the loop on the other
    side."""
    pot = land.potential
    ends, centres = np.zeros((2, len(side)))
    there, shared = np.zeros((2, len(side)), bool)
    for row, (x, z, toward) in enumerate(zip(*(v.tolist() for v in (*saddle, side)))):
        result = loop_end(pot, land.sense, (x, z), toward)
        if result:
            there[row] = True
            ends[row], centres[row], shared[row] = result
    return side * ends, np.array(land.polished(pot.move(saddle, side * centres))), there, shared


@dataclass(frozen=True)
class Loops:
    """First halves of loops, from the saddle to the far end, in k strips of n rows and m columns.

    saddle, centre: places (2, k, n); end: (k, n) offsets of the far ends; found: (k, n) whether there is a
    loop; shared: (k, n) whether the far end is a saddle too; offset, w: (k, n, m) offsets and W; points: (k,
    n, m, 3). saddle_state, centre_state: (k, n, 3) the same as states; ways: (k, n, 2) those of
    `Orbits` where states and points are measured from them, and not from places; else nan.
    """

    saddle: np.ndarray
    centre: np.ndarray
    end: np.ndarray
    found: np.ndarray
    shared: np.ndarray
    offset: np.ndarray
    w: np.ndarray
    points: np.ndarray
    saddle_state: np.ndarray
    centre_state: np.ndarray
    ways: np.ndarray

    @property
    def far(self) -> np.ndarray:
        """(k, n) True where the loop comes from `Orbits`."""
        return np.isfinite(self.ways[..., 0])

    def at_rows(self, rows: np.ndarray) -> Loops:
        """The loops of some rows only."""
        return Loops(*(v[:, :, rows] if name in ("saddle", "centre") else v[:, rows] for name,
                       v in vars(self).items()))

    def of(self, strip: int) -> Loops:
        """The loops of one strip only."""
        return Loops(*(v[:, strip:strip + 1] if name in ("saddle", "centre") else v[strip:strip + 1] for name,
                       v in vars(self).items()))


def loops(land, strips, s, u) -> Loops:
    """The loops of strips (`Part`, or pairs of branch and side) at parameters s (k, n) along them and u
    (k, m) round them.

    A loop shared with the saddle at its far end is found from the left one only; at s = 0, the fold, it is a
    point.
    """
    k, n = s.shape
    index = np.array([np.broadcast_arrays(*strip[0].place(row)) for strip, row in zip(strips, s)], float)
    saddle = np.array(polished(land, (index[:, 0].ravel(), index[:, 1].ravel()), s.ravel())).reshape(2, k, n)
    sides = np.array([strip[1] for strip in strips])
    end, centre, result, shared = loop_ends(land, tuple(saddle.reshape(2, -1)), np.repeat(sides, n))
    end, result, shared = end.reshape(k, n), result.reshape(k, n), shared.reshape(k, n)
    centre = centre.reshape(2, k, n)
    result &= ~(shared & (sides[:, None] > 0))
    fold = s == 0
    result |= fold
    end = np.where(fold | ~result, 0.0, end)
    centre = np.where(fold, saddle, centre)
    cut = [len(strip) > 2 and strip.seam != 0 for strip in strips]
    sharpest = np.where(cut, 1 / PINCH, SHARPEST)
    shares = _shares(land, saddle, end, shared, u[:, None, :], sharpest)
    for strip in (n for n, part in enumerate(strips) if cut[n] and part.over):
        shares[strip] = pinched_shares(land.potential, saddle[:, strip], end[strip], sides[strip], u[strip])
    offset = end[:, :, None] * shares
    point = saddle[0][:, :, None], saddle[1][:, :, None]
    with np.errstate(all="ignore"):
        w = np.sqrt(2 * np.maximum(-land.potential.rise(offset, point), 0))
    w[:, :, 0] = w[:, :, -1] = 0.0
    points = land.components(land.potential.move(point, offset), sides[:, None, None] * w)
    states = (land.components(item, np.zeros((k, n))) for item in (saddle, centre))
    built = Loops(saddle, centre, end, result, shared, offset, w, points, *states, np.full((k, n, 2), np.nan))
    return replaced(land, strips, s, u, built, lambda sharp, at, rows: _by_turning(sharp, at, sharpest[rows]))


def _shares(land: ConicLandscape, saddle: np.ndarray, end: np.ndarray, shared: np.ndarray, u: np.ndarray,
            sharpest: np.ndarray):
    """(k, n, m) shares of the way to the far end at which columns u (k, 1, m), 0 to 1, stand.

    At the far end, distance t away, W^2 = 2 F t + K t^2 + ...: F the force there, K its slope. That is a
    hyperbola with t = (F/K)(cosh q - 1), and equal steps of q turn the loop's direction evenly, however sharp
    the bend; columns then run along the bend from row to row. No bend tighter than the way over
    sharpest (k,) is followed. Where the far end is a saddle itself, columns crowd at both ends alike.
    """
    if shared.any():
        return np.broadcast_to(np.sin(0.5 * np.pi * u) ** 2, end.shape + u.shape[-1:])
    far = land.potential.move(saddle, end)
    with np.errstate(all="ignore"):
        sharp = np.abs(end) * land.potential.slope(far) / np.abs(land.potential.force(far))
    return _by_turning(sharp, u, sharpest[:, None])


def _by_turning(sharp: np.ndarray, u: np.ndarray, sharpest: np.ndarray):
    """(..., m) shares at columns u, from K/F times the way to the far end, (...,)."""
    sharp = np.clip(np.nan_to_num(sharp), 1e-8, sharpest)
    half = 0.5 * np.log1p(sharp + np.sqrt(sharp * (sharp + 2)))[..., None]  # arccosh(1 + sharp)
    return 1 - (np.sinh(half * (1 - u)) / np.sinh(half)) ** 2


def residual(land: ConicLandscape, loops: Loops):
    """(k, n, m) energy of the rounded points above their saddle's, relative to the size of the energy's
    terms; their offsets from the saddle tell the turn that the angle of a rounded point belongs to. On a
    hyperbola the larger of xi, eta tells the place: next to an open plane the smaller one is all rounding.
    How far the other lies from the saddle's hyperbola, relative to the size of the point, is the residual
    where that is more.
    """
    location, w, size = land.start(loops.points)
    point = tuple(v[:, :, None] for v in loops.saddle)
    pot = land.potential
    with np.errstate(all="ignore"):
        departure = np.abs(0.5 * w * w + pot.rise(land.way(point, location, loops.offset), point))
        shaken, beside = land.blurred(point, location, size)
        scale = (0.5 * w * w + np.abs(pot.G) * (size[0] ** 2 + size[1] ** 2)
                 + pot.slopes * (size[0] + size[1]) + pot.mu + shaken)
        result = np.fmax(np.where(departure > 0, departure / scale, 0.0), beside)
    if loops.far.any():
        result[loops.far] = residual_far(land, loops)
    return result
