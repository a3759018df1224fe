"""What acts on the body, in exact numbers: a constant charge turns it as a wheel of moment -k e3 would.

    D omega' = (D omega + Lambda) x omega + M - c D omega + kappa (omega'' + omega x omega')
               + s x gamma + N gamma x D gamma + E gamma3 omega x e3,      gamma' = gamma x omega

Lambda = lambda - k e3 (gyrostat, charge of constant angle; k is no part of the angular momentum, yet the rates are the
same), s = M g times the centre of mass, E = e H l^2 of a charge whose angle follows the attitude. A force at the centre
of mass does not turn the body.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import ClassVar

from ..asked import checked_scene
from ..numbers.vectors import Exact3, Number, Triple, cross
from ..record import record
from .body import Body
from .effects import effect_class
from .effects.base import Effect
from .scene import ZERO3, AnyScene, Scene

KNOWN = {"gyrostat", "constant_torque", "charge", "resistance", "liquid_cavity", "newtonian_field", "gravity", "body_force"}
ZERO = Fraction(0)


@record
class Content:
    """The coefficients of the equations above, exact. printed: the liquid's torque is the printed one."""

    D: Exact3
    Lambda: Exact3
    M: Exact3
    c: Fraction = ZERO
    kappa: Fraction = ZERO
    printed: bool = False
    s: Exact3 = ZERO3
    N: Fraction = ZERO
    E: Fraction = ZERO
    charged: bool = False
    forced: bool = False

    @property
    def directed(self) -> bool:
        """Whether the torque depends on where a direction of space lies in the body."""
        return bool(any(self.s) or self.E or (self.N and len(set(self.D)) > 1))

    @property
    def dissipative(self) -> bool:
        """Whether a liquid or a medium takes energy."""
        return bool(self.c or (self.kappa and len(set(self.D)) + any(self.Lambda) + self.directed > 1))

    @property
    def unproved_loss(self) -> str:
        """Why the liquid may give energy: T' = -kappa/(D1 D2 D3) sum (Di - Dj)^2 (Di + Dj - Dk) wi^2 wj^2 falls for the moments of a mass
        distribution alone. Empty where it only takes energy, as far as this sum goes, or there is none."""
        broken = self.kappa and 2 * max(self.D) > sum(self.D)
        return "undecided: the liquid takes energy for the moments of a rigid body alone, and no rigid body has these" if broken else ""

    @property
    def kind(self) -> str:
        """"gyrostat" (Lambda and M alone), "dissipative", "directed" or "directed and dissipative"."""
        words = [word for word, there in (("directed", self.directed), ("dissipative", self.dissipative)) if there]
        return " and ".join(words) or "gyrostat"

    @property
    def note(self) -> str:
        """What was put aside or taken together, for the reader; empty where nothing was."""
        parts = ["the charge turns the body as a gyrostatic moment -k e3 would: Lambda = lambda - k e3, as long as the angle of axis 3 to the "
                 "field is the constant one, which is judged where an attitude is given"] * self.charged
        parts += ["the force at the centre of mass does not turn the body: the rotation is judged as if it were absent"] * self.forced
        return "; ".join(parts)


def content(scene: AnyScene) -> Content | None:
    """The coefficients of a scene; None where it has an effect that is not in the equations above."""
    if scene.variables == "scaled" or {e.name for e in scene.effects} - KNOWN:
        return None
    lam, numbers = list(scene.vector("gyrostat")), {}
    charge, liquid, gravity = (scene.effect(name) for name in ("charge", "liquid_cavity", "gravity"))
    if charge is not None:
        if charge.follows_attitude:
            numbers["E"] = charge.exact
        else:
            lam[2] -= shortened(charge.exact)
            numbers["charged"] = bool(charge.exact)
    if liquid is not None:
        numbers |= {"kappa": liquid.exact, "printed": liquid.law == "printed"}
    for name, key in (("resistance", "c"), ("newtonian_field", "N"), ("gravity", "s")):
        if (effect := scene.effect(name)) is not None:
            numbers[key] = effect.exact
    return Content(scene.body.exact, tuple(lam), scene.vector("constant_torque"), forced=scene.effect("body_force") is not None,
                   **numbers)


def shortened(value: Fraction) -> Fraction:
    """A cosine known to 240 bits, cut to 96: far within a double, and polynomials with it stay short. Short numbers stay exact."""
    excess = value.denominator.bit_length() - 96
    if excess <= 32:
        return value
    shift = 96 + value.denominator.bit_length() - value.numerator.bit_length()
    return Fraction(round(value * 2**shift), 2**shift)


@record
class Together(Effect):
    """What turns the body as a wheel of moment Lambda would: wheel and charge of constant angle in one."""

    name: ClassVar[str] = "gyrostat"
    works: ClassVar[bool] = False

    exact: Exact3

    def parameters(self) -> dict[str, Fraction]:
        return dict(zip(("lambda1", "lambda2", "lambda3"), self.exact))

    def momentum(self, p: Mapping[str, Number]) -> Triple:
        return (p["lambda1"], p["lambda2"], p["lambda3"])


def gyrostat_scene(parts: Content) -> Scene:
    """The scene of a gyrostat and a constant torque that has the same rates (kind "gyrostat")."""
    torque = [effect_class("constant_torque")(parts.M)] if any(parts.M) else []  # a scene loads no effect that it does not have
    return Scene(Body(parts.D), Together(parts.Lambda), *torque)


def linear_rates(D: Sequence[Number], omega: Sequence[Number], H: Sequence[Number]) -> list[list[Number]]:
    """Rows of the derivative by omega of D^-1 (D omega + Lambda) x omega, where H = D omega + Lambda (any scalar type)."""
    rows = []
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):  # D_i a_i = H_j omega_k - H_k omega_j
        row = [omega[0] * 0] * 3
        row[j] = (omega[k] * D[j] - H[k]) * (1 / D[i])
        row[k] = (H[j] - omega[j] * D[k]) * (1 / D[i])
        rows.append(row)
    return rows


def rates(parts: Content, omega: Sequence[Number], gamma: Sequence[Number] | None) -> tuple[Exact3, Exact3]:
    """(omega', gamma') in exact fractions; with a liquid only where nothing depends on gamma."""
    w = tuple(map(Fraction, omega))
    g = tuple(map(Fraction, gamma)) if gamma else (Fraction(0),) * 3
    D = parts.D
    H = tuple(d * x + l for d, x, l in zip(D, w, parts.Lambda))
    total = list(cross(H, w))
    total = [t + m - parts.c * d * x for t, m, d, x in zip(total, parts.M, D, w)]
    if parts.kappa:
        total = [t + parts.kappa * v for t, v in zip(total, liquid_torque(parts, w))]
    if gamma:
        field = (cross(parts.s, g), cross(g, tuple(parts.N * d * x for d, x in zip(D, g))), cross(w, (0, 0, parts.E * g[2])))
        total = [t + sum(part[i] for part in field) for i, t in enumerate(total)]
    return tuple(t / d for t, d in zip(total, D)), cross(g, w) if gamma else ()


def liquid_torque(parts: Content, w: Sequence[Number]) -> Triple:
    """omega'' + omega x omega' along the motion without small effects (any scalar type)."""
    D = parts.D
    moment = (0, 0, 0) if parts.printed else parts.Lambda
    H = tuple(d * x + l for d, x, l in zip(D, w, moment))
    first = tuple(t * (1 / d) for t, d in zip(cross(H, w), D))
    turned = tuple(p + q for p, q in zip(cross(tuple(d * a for d, a in zip(D, first)), w), cross(H, first)))
    return tuple(t * (1 / d) + v for t, d, v in zip(turned, D, cross(w, first)))


def at_rest(parts: Content, omega: Sequence[Number], gamma: Sequence[Number] | None) -> bool:
    """Whether every rate vanishes exactly (not asked with a liquid in a field)."""
    return not (parts.kappa and gamma) and not any(v for block in rates(parts, omega, gamma) for v in block)


def effective(scene: AnyScene) -> AnyScene:
    """The scene itself, or, where charges of constant angle and forces are all it has besides, its twin with the
    gyrostatic moment lambda - k e3. Other scenes come back as they are."""
    if checked_scene(scene).plain:
        return scene
    parts = content(scene)
    return gyrostat_scene(parts) if parts is not None and parts.kind == "gyrostat" else scene

