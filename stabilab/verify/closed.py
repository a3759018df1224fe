"""What a certificate says of a motion with a closed solution, read and judged by the rates alone.

free: no torque, so that sum D x^2 is constant. sphere: the rates are x' = m - n x x with a fixed n (or none); the part along n grows at the rate m . n/|n|, the
part across goes round a circle. axis of symmetry: x_i' = m_i, and the two others turn at the rate w = kappa_j x_i + sigma_j under a constant push: where m_i is
not zero w' is constant, so that (van der Corput) their size stays below that of the start and 8 |push|/|w'|^(1/2); where it is, w is constant.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .numbers import Malformed, ball, number, numbers, shown, word
from .precision import working
from .rates import AHEAD

LAWS = ("free", "sphere", "axis of symmetry")
BITS = 192


@dataclass(frozen=True)
class ClosedClaims:
    """law; direction of the growth (any length), gain: it grows at least so fast, most: what is across it, or the whole rate of a bounded motion, is never
    larger. None where nothing is claimed."""

    law: str
    direction: list[Fraction] | None
    gain: Fraction | None
    most: Fraction | None


@dataclass(frozen=True)
class Truth:
    """What holds: direction (None: bounded), square of the gain, balls whose sum bounds the size."""

    direction: list[Fraction] | None
    gain_square: Fraction | None
    most: object
    reason: str


def closed_of(table) -> ClosedClaims:
    """The claims on a closed solution. Raises `Malformed` before anything is worked out."""
    where = "motion.closed"
    if not isinstance(table, dict):
        raise Malformed(f"{where}: expected an object, got {shown(table)}")
    law, direction = word(table, "law", where, LAWS), table.get("direction")
    sizes = [None if table.get(key) is None else number(table[key], f"{where}.{key}") for key in ("gain", "most")]
    return ClosedClaims(law, None if direction is None else numbers(direction, f"{where}.direction", 3), *sizes)


def check_closed(rates, state, claims: ClosedClaims, note):
    """Findings on a closed solution; (fate, axis, sense, reason) that it proves, or (None, 0, 0, why it proves nothing)."""
    with working(BITS):
        truth = _truth(rates, state, claims.law)
        if isinstance(truth, str):
            note(f"law: {claims.law}", "refuted", truth)
            for name in ("direction", "gain", "most"):
                if getattr(claims, name) is not None:
                    note(name, "not checked", truth)
            return None, 0, 0, truth
        note(f"law: {claims.law}", "proved", truth.reason)
        _check_numbers(claims, truth, note)
    axis, sense = _axis(truth.direction)
    return ("spin-up" if truth.direction else "bounded"), axis, sense, truth.reason


def _check_numbers(claims, truth, note):
    if claims.direction is not None:
        right = truth.direction is not None and any(claims.direction) and _parallel(claims.direction, truth.direction)
        note("direction", "proved" if right else "refuted", "the growth has this direction" if right else "it is not that of the growth")
    if claims.gain is not None:
        right = truth.gain_square is not None and 0 < claims.gain and claims.gain**2 <= truth.gain_square
        note("gain", "proved" if right else "refuted", f"the rate {'grows' if right else 'does not grow'} at least as fast")
    if claims.most is not None:
        right = bool(truth.most <= ball(claims.most))
        note("most", "proved" if right else "not checked", "the size worked out anew is below it" if right else "the size worked out anew is not below it")


def _truth(rates, state, law):
    """What holds by a law, or why the law is not that of the scene."""
    if rates.parallel is None:
        return "the scene has no body"
    if law == "free":
        return _free(rates, state)
    return _sphere(rates, state) if law == "sphere" else _symmetric(rates, state)


def _free(rates, state):
    if any(rates.m):
        return "a torque acts"
    D = rates.parallel[0]
    return Truth(None, None, ball(sum((d * x * x for d, x in zip(D, state)), Fraction(0)) / min(D)).sqrt(), "without torque the energy is constant")


def _sphere(rates, state):
    if any(rates.kappa) or not any(rates.m):
        return "the moments are not all equal, or no torque acts"
    turn = [rates.rho[k] for _, k in AHEAD]  # lambda/D: rho_k = lambda_i/D with i ahead of k
    if [-v for v in turn] != [rates.sigma[j] for j, _ in AHEAD]:
        return "the rates are not those of a turn"
    if not any(turn):
        return Truth(list(rates.m), _dot(rates.m, rates.m), _across(state, rates.m), "equal moments without a wheel: the rates are constant")
    along, square = _dot(rates.m, turn), _dot(turn, turn)
    size = _across(state, turn) + 2 * _across(rates.m, turn) / ball(square).sqrt()
    if not along:
        return Truth(None, None, size + ball(_dot(state, turn) ** 2 / square).sqrt(), "equal moments, the torque across the wheel: the rates go round a circle")
    return Truth([v if along > 0 else -v for v in turn], along**2 / square, size, "equal moments: the rate along the wheel's momentum grows steadily")


def _symmetric(rates, state):
    if not any(rates.m):
        return "no torque acts"
    found = [i for i in range(3) if not rates.kappa[i] and not rates.rho[i] and not rates.sigma[i]]
    if len(found) != 1:
        return "no axis, or more than one, about which the spin obeys the torque alone"
    (i,) = found
    j, k = AHEAD[i]
    if rates.rho[j] or rates.sigma[k] or rates.kappa[j] != -rates.kappa[k] or rates.sigma[j] != -rates.rho[k] or not rates.kappa[j]:
        return "the other two rates do not turn as a body of revolution's"
    flat = [v * (n != i) for n, v in enumerate(rates.m)]
    cone, push = (ball(_dot(v, v)).sqrt() for v in ([x * (n != i) for n, x in enumerate(state)], flat))
    if rates.m[i]:
        size = cone + 8 * push / ball(abs(rates.kappa[j] * rates.m[i])).sqrt()
        unit = [Fraction((n == i) * (1 if rates.m[i] > 0 else -1)) for n in range(3)]
        return Truth(unit, rates.m[i] ** 2, size, "the spin about the axis of symmetry is linear in time")
    turn = rates.kappa[j] * state[i] + rates.sigma[j]
    if turn:
        return Truth(None, None, cone + 2 * push / ball(abs(turn)) + ball(abs(state[i])), "the turn about the axis of symmetry is steady")
    return Truth(flat, _dot(flat, flat), _across(state, flat), "the transverse rates do not turn: they grow along the torque")


def _axis(direction):
    """(axis 1, 2, 3 or 0, sense; 0, 1 for a direction along none; 0, 0 for none)."""
    if direction is None:
        return 0, 0
    entries = [n for n in range(3) if direction[n]]
    return (entries[0] + 1, 1 if direction[entries[0]] > 0 else -1) if len(entries) == 1 else (0, 1)


def _dot(a, b):
    return sum((x * y for x, y in zip(a, b)), Fraction(0))


def _across(vector, along):
    """The size of the part of a vector across another, a ball."""
    return ball(_dot(vector, vector) - _dot(vector, along) ** 2 / _dot(along, along)).sqrt()


def _parallel(a, b):
    """Whether two vectors have one direction and sense, exactly."""
    return all(a[j] * b[k] == a[k] * b[j] for j, k in AHEAD) and _dot(a, b) > 0
