"""How slow a motion with more than wheels and a constant torque becomes: a rate that it never falls below,
and a time by which it is below another.

Let D1 be the greatest and D3 the least moment, W = (omega . D omega)^(1/2).

What is constant keeps a body turning. Inside a body a liquid keeps |D omega|; a damper of moment k keeps |H|,
H = D omega + Lambda + k sigma, and its energy 2 T = omega . (D - k) omega + k |omega + sigma|^2 only falls,
so that with w = |omega|

    |H| - |Lambda| <= (D1 - k) w + (k (2 T(0) - (D3 - k) w^2))^(1/2),

which fails for w below its least root where it fails at 0. A torque across a direction gamma at rest in space
(gravity, eddy currents) keeps p = (D omega + Lambda) . gamma, so that D1 w >= |p| - |Lambda|. Where nothing
takes energy, D1 w^2 >= 2 T >= 2 (T(0) + V(0) - max V).

A resistance omega . R omega >= c W^2 and a torque M give W' <= |D^(-1/2) M| - c W, so that W, and with it
D3^(1/2) |omega|, is below each level above |D^(-1/2) M|/c from a time on."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot, log, sqrt
from typing import Any, NamedTuple

from ..equilibrium.dissipative import decay, energy_bound
from ..numbers.vectors import Float3, dot
from ..physics.coefficients import Content, content, relative, split
from ..physics.scene import Scene
from ..reasons import Energy, Momentum, PerSecond, Rate, Reason, Sentence

MOMENTUM_STAYS = Sentence(
    "slowest-momentum", "|H| = {momentum} stays, so |ω| ≥ {rate} always")
ALONG_STAYS = Sentence(
    "slowest-along-vertical", "H . γ = {momentum} stays, so |ω| ≥ {rate} always")
ENERGY_LEFT = Sentence(
    "slowest-energy", "nothing takes energy, and T ≥ {energy} wherever the body points, so |ω| ≥ {rate} "
    "always")
RESISTED = Sentence(
    "slow-by-resistance", "√(2 T) falls at least as exp(-c t), c = {c}, to what the torque holds up")


class Slowest(NamedTuple):
    """rate: rad/s, which |omega| is never below; reason: why."""

    rate: float
    reason: Reason


class SlowBy(NamedTuple):
    """time: s, from which on |omega| is below a rate; reason: why."""

    time: float
    reason: Reason


def least_rate(scene: Scene, state: Sequence[float] | Mapping[str, Float3]) -> Slowest | None:
    """The largest rate that a law keeps |omega| above; None where none does. state: as of `bounds.motion`."""
    parts = content(scene)
    if parts is None or any(parts.u) or any(parts.M) or parts.c or parts.damped or parts.movers:
        return None
    if parts.unproved_loss is not None:
        return None
    omega, gamma = split(parts, state)
    if parts.directed:
        return _directed(parts, omega, gamma or ()) if not (parts.kappa or parts.damper_inside) else None
    if parts.inside or parts.kappa and not (parts.printed or any(parts.Lambda)):
        return _inside(parts, omega, relative(parts, state))
    return None


def _inside(parts: Content, omega: Float3, sigma: Float3) -> Slowest | None:
    """Of a body that keeps |H|, with a damper or a liquid inside."""
    if parts.inside and parts.kappa:
        return None
    k, D = float(parts.inside), [float(d) for d in parts.D]
    H = hypot(*(d * w + float(l) + k * s for d, w, l, s in zip(D, omega, parts.Lambda, sigma)))
    left = H - hypot(*map(float, parts.Lambda))
    twice = (sum((d - k) * w * w for d, w in zip(D, omega))
             + k * sum((w + s) ** 2 for w, s in zip(omega, sigma)))
    if not left > sqrt(k * twice):
        return None
    a, square = max(D) - k, (max(D) - k) ** 2 + k * (min(D) - k)
    rate = (left * a - sqrt(max(0.0, (left * a) ** 2 - square * (left * left - k * twice)))) / square
    return Slowest(rate, MOMENTUM_STAYS(momentum=Momentum(H), rate=Rate(rate).lower))


def _directed(parts: Content, omega: Float3, gamma: Sequence[float]) -> Slowest | None:
    """Of a body on which a torque acts that depends on a direction at rest in space."""
    D, result = [float(d) for d in parts.D], []
    if not parts.E:
        p = sum((d * w + float(l)) * g for d, w, l, g in zip(D, omega, parts.Lambda, gamma))
        rate = (abs(p) - hypot(*map(float, parts.Lambda))) / max(D)
        result.append(Slowest(rate, ALONG_STAYS(momentum=Momentum(p), rate=Rate(rate).lower)))
    if not parts.dissipative:
        s, N = tuple(map(float, parts.s)), float(parts.N)
        begun = sum(d * w * w for d, w in zip(D, omega)) / 2
        V = -dot(s, gamma) + N / 2 * sum(d * g * g for d, g in zip(D, gamma))
        energy = begun + V - hypot(*s) - N / 2 * (max(D) if N > 0 else min(D))
        rate = sqrt(max(0.0, 2 * energy / max(D)))
        result.append(Slowest(rate, ENERGY_LEFT(energy=Energy(energy).lower, rate=Rate(rate).lower)))
    return max((item for item in result if item.rate > 0), key=lambda item: item.rate, default=None)


def below_by(scene: Scene, state: Any, rate: float) -> SlowBy | None:
    """By when |omega| is surely below `rate`, rad/s, for ever; None where no law says so. state: as of
    `bounds.motion`."""
    parts = content(scene)
    if (parts is None or any(parts.u) or parts.directed or parts.damper_inside
            or parts.unproved_loss is not None
            or parts.kappa and any(parts.Lambda)):
        return None
    slowest = float(decay(parts))
    if not slowest:
        return None
    omega, _ = split(parts, state)
    begun = sqrt(sum(float(d) * w * w for d, w in zip(parts.D, omega)))
    _, late = energy_bound(parts, begun)
    level = rate * sqrt(float(min(parts.D)))
    if not level > late:
        return None
    time = log((begun - late) / (level - late)) / slowest if begun > level else 0.0
    return SlowBy(max(0.0, time), RESISTED(c=PerSecond(slowest)))
