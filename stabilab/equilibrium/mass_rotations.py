"""All rotations of a free body with a damper's mass on a spring, at its angular momentum: those that leave
the mass where the spring is relaxed, and those that displace it.

With J(x) = D + x J1 + x^2 J2 of `effects.damper_mass`, no wheel, and the mass at rest in the body at x, what
moves with H has least the energy

    E(H, x) = H . J(x)^-1 H/2 + k x^2/2

of body, mass and spring; T >= E, and the dashpot takes energy. On |H| = h the rotations are its critical
points: H = h u, u a principal axis of J(x) with the moment theta, J u = theta u, and

    k x = omega . J'(x) omega/2 = h^2 u . J'(x) u/(2 theta^2),

so that x is stationary in the amended potential h^2/(2 theta(x)) + k x^2/2 of that axis. The moments are the
roots of p(theta, x) = det(J(x) - theta), rational in both. Of every irreducible factor f of p, theta' =
-f_x/f_theta, so that x is a root of the resultant, in theta, of f and

    2 k x theta^2 f_theta + h^2 f_x,

which vanishes nowhere identically for k > 0: theta would be 1/(C - k x^2/h^2), and no such function is
integral over the polynomials in x. All real roots of the resultants are isolated, and to each belongs a
moment, for a symmetric matrix has real ones. A factor of p that is there twice belongs to circles of
rotations.

Where two moments are equal at an x_c, every u in their plane is a principal axis, and those with u . J' u = 2
k x_c theta^2/h^2 between the two slopes are rotations, too, about axes between the branches. The x_c are the
real roots of the discriminant of the product of the factors.

The second variation on the sphere and in x, for eta_j h along the other axes v_j and y of x,

    sum (1/theta_j - 1/theta) h^2 eta_j^2 - 2 y sum h^2 (v_j . J' u) eta_j/(theta theta_j)
        + y^2 (k - h^2 u . J'' u/(2 theta^2) + h^2 sum (v_m . J' u)^2/(theta^2 theta_m)),

v_m all three axes, has the minima of E where it is positive definite: these attract. Where it has a negative
direction and no zero one the rotation is unstable with losses (Krasovskii)."""
from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from flint import Ordering, fmpq_mpoly_ctx

from ..numbers.algebraic import univariate
from ..numbers.balls import rational
from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import Exact3, Float3, dot
from .momentum_sphere import MAXIMUM, MINIMUM, SADDLE

DEGENERATE = "degenerate"
SAME = 1e-9  # relative: nearer, two numbers of doubles are taken as one
FLAT = 1e-10  # of the largest: a second variation that is none


@dataclass(frozen=True)
class MassRotation:
    """nature: of the energy at this |H|, "minimum", "maximum", "saddle" or "degenerate" (a term of higher
    order decides). momentum, omega: along the principal axes of the body; displacement: of the mass along its
    line, m; energy: J, with the spring's. downward: in how many directions the energy falls. axis: 1 to 3,
    about which a circle of them lies, else 0."""

    nature: str
    momentum: Float3
    omega: Float3
    displacement: float
    energy: float
    downward: int
    axis: int = 0


@dataclass(frozen=True)
class BodyWithMass:
    """D: principal moments of the whole where the spring is relaxed; mu, k: of the mass and its spring; r:
    its place; line: its direction, of any length, in units of which it moves by y; square: |H|^2, all
    exact."""

    D: Exact3
    mu: Fraction
    k: Fraction
    r: Exact3
    line: Exact3
    square: Fraction

    @classmethod
    def of(cls, D: Exact3, mover: Any, square: Fraction) -> BodyWithMass:
        """mover: the damper with its mass."""
        mu, k, _, *vectors = mover.exact
        return cls(D, mu, k, tuple(vectors[:3]), tuple(mover.supplied[2]), square)

    @cached_property
    def unit(self) -> float:
        """m, by which it moves where y is one."""
        return float(sqrt_fraction(dot(self.line, self.line)))

    def inertia(self, y: Any) -> list[list[Any]]:
        """J at a displacement of so many units of the line, of a variable of flint."""
        r, n, along, square = self.r, self.line, dot(self.r, self.line), dot(self.line, self.line)

        def entry(i: int, j: int) -> Any:
            same = int(i == j)
            first = self.mu * (2 * along * same - r[i] * n[j] - n[i] * r[j])
            second = self.mu * (square * same - n[i] * n[j])
            return y * y * rational(second) + y * rational(first) + rational(self.D[i] * same)
        return [[entry(i, j) for j in range(3)] for i in range(3)]

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """D, J1, J2 in doubles, of x in m."""
        r, n, mu = np.array(self.r, float), np.array(self.line, float) / self.unit, float(self.mu)
        first = mu * (2 * (r @ n) * np.eye(3) - np.outer(r, n) - np.outer(n, r))
        return np.diag(np.array(self.D, float)), first, mu * (np.eye(3) - np.outer(n, n))

    def energy(self, momentum: np.ndarray, x: float) -> float:
        """E(H, x)."""
        D, J1, J2 = self.matrices
        turn = momentum @ np.linalg.solve(D + x * J1 + x * x * J2, momentum)
        return float(turn + float(self.k) * x * x) / 2

    @cached_property
    def rotations(self) -> tuple[MassRotation, ...]:
        """All of them, the least energy first."""
        found: list[MassRotation] = []
        for item in (*self._on_branches(), *self._between_branches()):
            if not any(_alike(item, other) for other in found):
                found.append(item)
        return tuple(sorted(found, key=lambda item: item.energy))

    @property
    def minima(self) -> tuple[int, ...]:
        """Which of them attract."""
        return tuple(n for n, item in enumerate(self.rotations) if item.nature == MINIMUM)

    @property
    def lowest_pass(self) -> float:
        """The energy below which every piece of the sphere times the line has one rotation, a minimum, J."""
        return min((item.energy for item in self.rotations if item.nature != MINIMUM), default=math.inf)

    @property
    def counted(self) -> bool:
        """Whether none is degenerate and minima, saddles and maxima add up to the Euler number of what they
        are on, that of the sphere (Morse)."""
        points = [item for item in self.rotations if not item.axis]
        return (all(item.nature != DEGENERATE for item in self.rotations)
                and (len(points) < len(self.rotations) or sum((-1) ** item.downward for item in points) == 2))

    # --- The critical points
    @cached_property
    def _factors(self) -> list[tuple[Any, int]]:
        """(irreducible factor of det(J - theta), how often) in (theta, y)."""
        theta, y = fmpq_mpoly_ctx.get(("theta", "y"), Ordering.lex).gens()
        J = self.inertia(y)
        for i in range(3):
            J[i][i] = J[i][i] - theta
        a, b, c = J
        p = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
             + a[2] * (b[0] * c[1] - b[1] * c[0]))
        return [(f, int(many)) for f, many in p.factor()[1]]

    def _on_branches(self) -> Iterator[MassRotation]:
        k = rational(self.k * dot(self.line, self.line))
        for f, many in self._factors:
            theta, y = f.context().gens()
            q = 2 * k * y * theta**2 * f.derivative("theta") + rational(self.square) * f.derivative("y")
            for at in real_roots(Poly.of(univariate(f.resultant(q, "theta"), 1))):
                yield from self._at(float(at) * self.unit, many)

    def _at(self, x: float, many: int) -> Iterator[MassRotation]:
        """The rotations at one displacement at which the pull balances along a principal axis."""
        theta, axes, slopes = self._principal(x)
        k, h2 = float(self.k), float(self.square)
        off = np.abs(2 * k * x * theta**2 - h2 * slopes)
        scale = (h2 * np.abs(self.matrices[1]).max() + h2 * abs(x) * np.abs(self.matrices[2]).max()
                 + 2 * k * abs(x) * theta**2)
        off = off / np.maximum(scale, 1e-300)
        for i in range(3):
            if off[i] == off.min() or off[i] < SAME:
                twin = [j for j in range(3) if j != i and abs(theta[j] - theta[i]) < SAME * theta[i]]
                yield from self._both(x, axes[:, i], float(theta[i]), axes, theta,
                                      _axis_of(axes, i, twin) if many > 1 and twin else 0)

    def _between_branches(self) -> Iterator[MassRotation]:
        product = None
        for f, _ in self._factors:
            product = f if product is None else product * f
        if product is None or product.degrees()[0] < 2:
            return
        level = Poly.of(univariate(product.discriminant("theta"), 1))
        for at in real_roots(level) if level.degree > 0 else ():
            x = float(at) * self.unit
            theta, axes, _ = self._principal(x)
            for i, j in ((0, 1), (1, 2)):
                if abs(theta[i] - theta[j]) < 1e-7 * theta[j]:
                    yield from self._oblique(x, axes[:, [i, j]], float(theta[i] + theta[j]) / 2, axes, theta)

    def _oblique(self, x: float, plane: np.ndarray, moment: float, axes: np.ndarray, theta: np.ndarray
                 ) -> Iterator[MassRotation]:
        """In a plane of equal moments, between the slopes of both branches."""
        _, J1, J2 = self.matrices
        slopes, turned = np.linalg.eigh(plane.T @ (J1 + 2 * x * J2) @ plane)
        wanted = 2 * float(self.k) * x * moment**2 / float(self.square)
        width = slopes[1] - slopes[0]
        if not SAME * np.abs(slopes).max() < min(wanted - slopes[0], slopes[1] - wanted):
            return
        part = math.sqrt((wanted - slopes[0]) / width)
        for sign in (-1, 1):
            u = plane @ turned @ np.array([math.sqrt(1 - part * part), sign * part])
            other = np.cross(plane[:, 0], plane[:, 1])
            own = np.stack([u, np.cross(other, u), other], axis=1)
            J = self.matrices[0] + x * J1 + x * x * J2
            yield from self._both(x, u, moment, own, np.einsum("ij,ij->j", own, J @ own), 0)

    def _principal(self, x: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(moments, axes as columns, slopes of the moments) at x; in a plane of equal moments those of J'."""
        D, J1, J2 = self.matrices
        theta, axes = np.linalg.eigh(D + x * J1 + x * x * J2)
        slope = J1 + 2 * x * J2
        for i in range(2):
            if abs(theta[i + 1] - theta[i]) < SAME * theta[i + 1]:
                plane = axes[:, [i, i + 1]]
                axes[:, [i, i + 1]] = plane @ np.linalg.eigh(plane.T @ slope @ plane)[1]
        return theta, axes, np.einsum("ij,ij->j", axes, slope @ axes)

    def _both(self, x: float, u: np.ndarray, moment: float, axes: np.ndarray, theta: np.ndarray, circle: int
              ) -> Iterator[MassRotation]:
        """The rotations about u in both directions; of a circle one of its points."""
        h2, size = float(self.square), float(sqrt_fraction(self.square))
        values = self._second(x, u, moment, axes, theta)
        largest = np.abs(values).max()
        flat = np.abs(values) < FLAT * largest
        downward = int(((values < 0) & ~flat).sum())
        if flat.sum() > (circle > 0):
            nature = DEGENERATE
        else:
            nature = MINIMUM if not downward else MAXIMUM if downward == 3 - flat.sum() else SADDLE
        u = np.where(np.abs(u) < 1e-12, 0.0, u)
        energy = h2 / (2 * moment) + float(self.k) * x * x / 2
        for sign in (1.0,) if circle else (1.0, -1.0):
            H, w = (tuple((sign * size / d * u + 0.0).tolist()) for d in (1.0, moment))
            yield MassRotation(nature, H, w, x, energy, downward, circle)

    def _second(self, x: float, u: np.ndarray, moment: float, axes: np.ndarray, theta: np.ndarray
                ) -> np.ndarray:
        """Eigenvalues of the second variation, in units of the energy."""
        _, J1, J2 = self.matrices
        k, h2, pull = float(self.k), float(self.square), axes.T @ (J1 + 2 * x * J2) @ u
        i = int(np.argmax(np.abs(axes.T @ u)))
        others = [j for j in range(3) if j != i]
        form = np.zeros((3, 3))
        for row, j in enumerate(others):
            form[row, row] = h2 * (moment - theta[j]) / (theta[j] * moment)
            form[row, 2] = form[2, row] = -h2 * pull[j] / (moment * theta[j])
        form[2, 2] = k - h2 * (u @ J2 @ u) / moment**2 + h2 * float((pull**2 / theta).sum()) / moment**2
        length = math.sqrt(h2 / (moment * k))  # in which the spring holds the energy of the turn
        scale = np.array([1.0, 1.0, length])
        return np.linalg.eigvalsh(form * np.outer(scale, scale))


def _axis_of(axes: np.ndarray, i: int, twin: list[int]) -> int:
    """The principal axis, 1 to 3, about which a circle lies; 0 where it is none."""
    normal = np.abs(np.cross(axes[:, i], axes[:, twin[0]]))
    return int(normal.argmax()) + 1 if normal.max() > 1 - SAME else 0


def _alike(one: MassRotation, other: MassRotation) -> bool:
    size = math.hypot(*one.momentum)
    x, y = one.displacement, other.displacement
    if abs(x - y) > 1e-7 * (abs(x) + abs(y)) or one.axis != other.axis:
        return False
    if one.axis:
        i = one.axis - 1
        return abs(one.momentum[i] - other.momentum[i]) < 1e-6 * size
    return math.dist(one.momentum, other.momentum) < 1e-6 * size
