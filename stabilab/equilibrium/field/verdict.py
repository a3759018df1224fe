"""The verdict on one permanent rotation, from signs of certified balls."""
from __future__ import annotations

from fractions import Fraction

from ...numbers.balls import rational
from ...numbers.vectors import cross
from ..result import EquilibriumPoint
from .spectrum import Field, coefficients, second_variation

MINIMUM = ("stable", "energy-Casimir: at constant area integral the energy has a strict minimum on |gamma| = 1 (K positive definite), and it "
                     "persists as the area changes")
SADDLE = ("unstable", "det K < 0: b < 0 in z^4 + a z^2 + b, a positive eigenvalue")
SPIRAL = ("unstable", "a^2 < 4 b in z^4 + a z^2 + b: four eigenvalues off the imaginary axis")
REAL = ("unstable", "a < 0 < b, a^2 > 4 b in z^4 + a z^2 + b: two positive eigenvalues")
GYROSCOPIC = ("undecided", "K is negative definite and all eigenvalues are imaginary: the gyroscopic terms stabilise the linear motion, and the "
                           "energy, a saddle here, does not decide for the full one")
SLEEPING = ("stable", "sleeping top: the spin about the axis of symmetry is a third integral; with distinct frequencies a combination of the "
                      "three integrals is definite (Chetaev)")
CIRCLE = ("unstable", "one of a circle of rotations about the axis of symmetry: with any small change of the spin about it gamma drifts round the "
                      "circle, so neighbours leave this point")
OPEN = ("undecided", "a coefficient of the spectrum vanishes here: the next order decides")
SHELL = ("undecided", "a continuum of rotations at one Omega: its second variation vanishes along it, and a term of higher order decides")


def judged(field: Field, Omega: Fraction, rotation) -> EquilibriumPoint:
    """Spectrum and verdict of a `rotation_balance.Rotation` at Omega; at = (omega, gamma)."""
    from flint import fmpq
    O = rational(Omega)
    gamma, one = rotation.gamma, fmpq(1)
    a, b = coefficients(field, O, rotation.mu, gamma, one)
    determinant, trace = second_variation(field, O, rotation.mu, gamma, one)
    at = tuple(float(v.mid()) for v in (*(O * g for g in gamma), *gamma))
    if rotation.circle:
        axis = 3 - sum(rotation.circle)
        reason = CIRCLE if len(rotation.circle) == 2 and _symmetric(field, axis) else SHELL
        return EquilibriumPoint(at, spectrum(a, 0 * b), "degenerate", *reason)
    linear, reason = _verdict(field, gamma, a, b, determinant, trace)
    return EquilibriumPoint(at, spectrum(a, b), linear, *reason)


def _symmetric(field: Field, k: int) -> bool:
    """Whether axis k is an axis of symmetry of body, wheel, weight and charge."""
    i, j = (n for n in range(3) if n != k)
    return field.D[i] == field.D[j] and (k == 2 or field.E == 0) and not any(
        v != 0 for n in (i, j) for v in (field.s[n], field.Lambda[n]))


def _sleeps(field: Field, gamma) -> bool:
    """Whether gamma lies along an axis of symmetry (for three equal moments: along the weight and the wheel)."""
    if field.E == 0 and field.D[0] == field.D[1] == field.D[2]:
        return not any(v != 0 for v in cross(field.s, field.Lambda))
    return any(_symmetric(field, k) and all(gamma[n] == 0 for n in range(3) if n != k) for k in range(3))


def _verdict(field, gamma, a, b, determinant, trace):
    gap = a * a - 4 * b
    if b < 0:
        return "unstable", SADDLE
    if determinant > 0 and trace > 0:
        return ("stable" if gap > 0 else "degenerate"), MINIMUM
    if gap < 0:
        return "unstable", SPIRAL
    if b > 0 and gap > 0:
        if a < 0:
            return "unstable", REAL
        return "stable", SLEEPING if _sleeps(field, gamma) else GYROSCOPIC
    return "degenerate", OPEN


def spectrum(a, b) -> tuple[complex, ...]:
    """0, 0 and the roots of z^4 + a z^2 + b (balls or exact numbers), opposite ones exactly opposite."""
    from flint import acb, arb
    a, b = arb(a), arb(b)
    gap = a * a - 4 * b
    if gap < 0:
        ball = ((acb(-a) + acb(gap).sqrt()) / 2).sqrt()
        z = complex(float(ball.real.mid()), float(ball.imag.mid()))
        return (0j, 0j, z, -z, z.conjugate(), -z.conjugate())
    root = arb(max(float(gap.mid()), 0.0)).sqrt() if not gap > 0 else gap.sqrt()
    far = -(a + root) / 2 if a >= 0 else (root - a) / 2
    near = b / far if far != 0 else arb(0)
    return (0j, 0j, *_pair(far), *_pair(near))


def _pair(square):
    value = float(square.mid())
    z = complex(value**0.5, 0.0) if value > 0 else complex(0.0, (-value) ** 0.5)
    return z, -z
