"""The laws of a scene in symbols: what is conserved, and how fast the rest changes."""
from __future__ import annotations

from collections.abc import Iterator
from functools import reduce

from ..numbers.vectors import Triple, cross, dot
from .equations import SCALED, Balance, Equations, add_terms, derive, strengths, turn_angles, with_zeros
from .scene import AnyScene, Scene


def invariants(scene: AnyScene) -> tuple[Balance, ...]:
    """The laws that hold for this very scene, its numbers put in.

    A Balance whose rate is 0 is a constant of the motion; a constant rate grows exactly in proportion to time; a
    quantity may hold turn angles alpha_i; a rate that is a multiple of its quantity makes quantity = 0 an invariant
    plane. Derived from the assembled equations, so a new effect is judged without being named here.
    """
    equations = derive(scene)
    laws = [*conserved(equations)]
    laws += _scaled_laws(equations) if scene.variables == "scaled" else _physical_laws(scene, equations)
    return tuple(laws)

CONSERVED = {
    "energy": "no torque does work: kinetic energy is constant",
    "momentum": "no outer torque: the size of the angular momentum is constant",
    "area": "no torque along gamma but the part accounted for: this area integral is constant",
    "gamma": "gamma is a unit vector fixed in space",
    "quaternion": "the quaternion of the attitude has length one"}


def conserved(equations: Equations) -> Iterator[Balance]:
    for law in equations.balances:
        if equations.numeric(law.rate) == 0 and (quantity := equations.numeric(law.quantity)) != 0:
            words = CONSERVED.get(law.name, f"no torque acts in it: the {law.name} is constant")
            if law.name == "energy" and law.quantity != equations.energy:
                words = "all torques that do work have a potential: kinetic plus potential energy is constant"
            yield Balance(law.name, words, quantity, law.rate * 0)


def _outer(scene: Scene, equations: Equations) -> tuple[Triple, ...] | None:
    """(carried momentum, outer torque) of a physical scene as exact numbers, or None where they vary with the state."""
    from sympy import Integer, expand
    zero, p = (Integer(0),) * 3, strengths(scene, equations.symbols)
    momenta = [e.momentum(p) or zero for e in scene.effects]
    parts = [equations.torques[e.name] for e in scene.effects]
    torques = [tuple(a - b for a, b in zip(part, cross(h, equations.state[:3]))) for part, h in zip(parts, momenta)]
    pair = tuple(tuple(equations.numeric(expand(Integer(0) + v)) for v in reduce(add_terms, rows, zero)) for rows in (momenta, torques))
    return None if any(v.free_symbols for row in pair for v in row) else pair


def _physical_laws(scene: Scene, equations: Equations) -> Iterator[Balance]:
    known = _outer(scene, equations)
    if known is None:
        return
    (lam, M), omega, alpha = known, equations.state, turn_angles()
    D = [equations.numeric(d) for d in equations.inertia]
    T, half_H2 = (equations.numeric(law.quantity) for law in equations.balances[:2])
    if any(M):
        yield Balance("energy with turn angles", "constant torque: T - M . (turn angles) is constant, alpha_i' = omega_i",
                      T - dot(M, alpha), T * 0)
    moments = {D[i] for i in range(3) if M[i]}
    if len(moments) == 1:
        d, rate = moments.pop(), dot(M, lam)
        words = ("torque along a principal axis (or in a plane of equal moments), no gyrostatic component along it: "
                 "the quadratic invariant C is constant" if rate == 0 else "torque along a principal axis: |H|^2/2 - D_M T grows by lambda . M each second, "
                                   "so there is no equilibrium and no bounded motion")
        yield Balance("quadratic", words, half_H2 - d * T, rate)
    elif moments:
        turned = dot(tuple(d * m for d, m in zip(D, M)), alpha)
        yield Balance("momentum with turn angles", "constant torque: |H|^2/2 - (D M) . (turn angles) changes by lambda . M "
                      "each second", half_H2 - turned, dot(M, lam))
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        if D[j] == D[k] and lam[j] == lam[k] == 0:
            yield Balance(f"spin {i + 1}", f"symmetric body: the spin about axis {i + 1} changes by its torque alone",
                          omega[i], M[i] / D[i])


def _scaled_laws(equations: Equations) -> Iterator[Balance]:
    x1, x2, x3 = equations.state
    a, b, mu1, mu2, mu3 = (equations.numeric(s) for s in with_zeros(SCALED, equations.symbols).values())
    alpha = turn_angles()
    if mu1 != 0 or mu2 != 0:
        yield Balance("circle with turn angles", "((x1+a)^2 + x2^2)/2 - mu1 alpha1 - mu2 alpha2 changes by mu1 a per unit "
                      "of tau, alpha_i' = x_i", ((x1 + a)**2 + x2**2) / 2 - mu1 * alpha[0] - mu2 * alpha[1], mu1 * a)
    if mu1 != 0 or mu3 != 0:
        yield Balance("hyperbola with turn angles", "((x1+b)^2 - x3^2)/2 - mu1 alpha1 + mu3 alpha3 changes by mu1 b per "
                      "unit of tau, alpha_i' = x_i", ((x1 + b)**2 - x3**2) / 2 - mu1 * alpha[0] + mu3 * alpha[2], mu1 * b)
    if mu2 == 0 and mu3 == 0 and mu1 != 0:
        words = ("a = b, torque on axis 1: x2^2 + x3^2 is constant" if a == b else
                 "torque on axis 1: J = x2^2 + x3^2 - 2(b-a) x1 changes by -2(b-a) mu1 per unit of tau, "
                 "so there is no equilibrium and no bounded motion")
        yield Balance("J", words, x2**2 + x3**2 - 2 * (b - a) * x1, -2 * (b - a) * mu1)
    if mu1 == mu3:
        yield Balance("plane x1 + b = x3", "mu1 = mu3: the plane x1 + b = x3 is invariant", x1 + b - x3, -x2 * (x1 + b - x3))
    if mu1 == -mu3:
        yield Balance("plane x1 + b = -x3", "mu1 = -mu3: the plane x1 + b = -x3 is invariant", x1 + b + x3, x2 * (x1 + b + x3))
