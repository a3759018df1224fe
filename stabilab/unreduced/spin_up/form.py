"""The exact normal form of spin-up, about the major or minor axis, under a torque of any direction; and
what is seen of a motion that no certificate decides.

With the axis under study called 1 (cyclic relabelling), d2 = D1 - D2 and d3 = D1 - D3 of one sign s, a2 =
|d2|, a3 = |d3|, m2 = M2 - l1 l3/d3, m3 = M3 + l1 l2/d2, U = omega2 - l2/d2 and V = omega3 - l3/d3, Euler's
equations are exactly

    D2 U' = m2 - (d3 omega1 + l1) V,    D3 V' = m3 + (d2 omega1 + l1) U,
    D1 omega1' = M1 + (d3 - d2) U V - (l3 d2/d3) U + (l2 d3/d2) V        (its constant terms cancel).

With X = omega1 + s l1 (a2 + a3)/(2 a2 a3) and zeta = sqrt(D2 a2) U + i s sqrt(D3 a3) V, so that U V = s Im
zeta^2/(2 sqrt(D2 D3 a2 a3)), these two lines and the third become

    zeta' = i om X zeta + i h zeta* + mu,       D1 X' = G = M1 + gam Im zeta^2 + Re(kap* zeta),

om = sqrt(a2 a3/(D2 D3)), gam = (a3 - a2)/(2 sqrt(D2 D3 a2 a3)), h = s l1 gam, mu = sqrt(a2/D2) m2 + i s
sqrt(a3/D3) m3, kap = -(l3 a2/a3)/sqrt(D2 a2) + i s (l2 a3/a2)/sqrt(D3 a3): for d3 omega1 + l1 and d2 omega1 +
l1 are s a3 (X + c) and s a2 (X - c) with c = l1 (d2 - d3)/(2 d2 d3), and om c = -h. Zeta turns at the rate om
X: what oscillates can be taken away, and what is left grows as the torque says. Where the torque's component
is negative the body is turned by half a turn about axis 2 first, so that M1 > 0 and X grows.

The scaled gyrostat x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2 (x1 + b) + mu3 has such forms for
any a and b, those of no body as well: about x1 with zeta = x2 + i x3, X = x1 + (a + b)/2, h = (b - a)/2, kap
= 0, and about x3 with zeta = x2 + i (x1 + a), X = x3, h = 0, kap = b - a; om = 1 and gam = 1/2 in both.

Of an undecided motion it is said in words where averaging puts bounded islands, and when it looks like one.

Islands need a wheel. About an extremal axis (`form`; X the spin, I = |eta|^2 the action across, a = l2 M2/d2,
b = l3 M3/d3, c = (d3 - d2) M2 M3/(d2 d3), l1 = 0) the averaged flow is X' = f0 + I f1, I' = -(I f0' + I^2
f1'/2), with the stream function psi = I f0 + I^2 f1/2,

    D1 f0 = M1 + (a + b)/X - c/X^2,    D1 f1 = K/X^3,    K = s (d3 - d2)(a - b)/(4 D1 om sqrt(D2 D3)).

Where M1 c < 0, (a + b)^2 > 4 |M1 c| (both equilibria on one side) and (|d3| - |d2|)(b^2 - a^2) > 0, psi has a
centre with I > 0: an elliptic periodic orbit between two saddle-foci, which tori surround (by averaging, for
great X). This is a pointer, not a proof."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ...equilibrium.gyrostat import gyrostat_equilibria
from ...numbers.ratio import Ratio, ratios
from ...orbit.one_state import in_range
from ...reasons import Axis, Quantity, Reason, Sentence

if TYPE_CHECKING:
    from ...physics.scene import AnyScene

# --- The normal form
HALF_TURN = (-1, 1, -1)  # about axis 2: a rotation of the body, so every vector takes part


@dataclass(frozen=True)
class NormalForm:
    """The normal form about one body axis (index `axis`), for a torque whose component there has the sign
    `sense`.

    order: body axes in the order 1, 2, 3 of the form; shift: X - omega1; centre: what omega2 and omega3
    oscillate about; scale: zeta = scale[0] U + i scale[1] V; all in the turned frame. Relative errors are at
    most 4 units of rounding: rational parts, and squares of irrational ones, are exact before the one root.
    """

    axis: int
    sense: int
    order: tuple
    D1: float
    M1: float
    om: float
    gam: float
    h: float
    mu: complex
    kap: complex
    shift: float
    centre: tuple
    scale: tuple
    drag: float  # m* = -Im(kap* mu)/om = l2 M2/d2 + l3 M3/d3, exact before it is rounded

    @property
    def turn(self) -> tuple:
        """The signs of the turned frame, in the order of the form."""
        return (1, 1, 1) if self.sense > 0 else HALF_TURN

    @property
    def nu(self):
        """gam mu - h kap: how the transverse torque beats with the asymmetry of the body."""
        return self.gam * self.mu - self.h * self.kap

    def place(self, state: Sequence[float]):
        """(X, zeta) of a state (three rates in the body's principal axes)."""
        w1, w2, w3 = (turn * state[i] for turn, i in zip(self.turn, self.order))
        return w1 + self.shift, complex(self.scale[0] * (w2 - self.centre[0]),
                                        self.scale[1] * (w3 - self.centre[1]))


def normal_form(D: Sequence[Fraction], wheel: Sequence[Fraction], torque: Sequence[Fraction],
                axis: int) -> NormalForm | None:
    """The normal form about a body axis; None where the torque has no component there, or the axis is neither
    the major nor the minor one (or shares its moment with another).

    D, wheel, torque: three exact numbers each (floats are taken at their word), in principal axes.
    """
    i, j, k = order = axis, (axis + 1) % 3, (axis + 2) % 3
    sense = (torque[i] > 0) - (torque[i] < 0)
    if not sense or (D[i] > D[j]) != (D[i] > D[k]) or D[i] in (D[j], D[k]):
        return None
    turn = (1, 1, 1) if sense > 0 else HALF_TURN
    (l1, l2, l3), (M1, M2, M3) = ([t * v[n] for t, n in zip(turn, order)]
                                  for v in (ratios(wheel), ratios(torque)))
    D1, D2, D3 = (ratios(D)[n] for n in order)
    d2, d3 = D1 - D2, D1 - D3
    s = 1 if d2 > 0 else -1
    a2, a3 = abs(d2), abs(d3)
    m2, m3 = M2 - l1 * l3 / d3, M3 + l1 * l2 / d2
    across, apart, half = D2 * D3, a2 * a3, (a3 - a2) / 2
    return NormalForm(
        axis, sense, order, float(D1), float(M1), math.sqrt(apart / across),
        over_root(half, across * apart), over_root(s * l1 * half, across * apart),
        complex(over_root(m2, D2 / a2), over_root(s * m3, D3 / a3)),
        complex(over_root(-l3 * a2 / a3, D2 * a2), over_root(s * l2 * a3 / a2, D3 * a3)),
        float(s * l1 * (a2 + a3) / (2 * apart)), (float(l2 / d2), float(l3 / d3)),
        (math.sqrt(D2 * a2), s * math.sqrt(D3 * a3)), float(l2 * M2 / d2 + l3 * M3 / d3))


def over_root(numerator: Ratio | Fraction | float, square: Ratio | Fraction) -> float:
    """numerator/sqrt(square) of exact numbers: its square is exact before the root."""
    (n, d), (p, q) = numerator.as_integer_ratio(), square.as_integer_ratio()
    size = math.sqrt((n * n * q) / (d * d * p))
    return -size if n < 0 else size


def scaled_normal_form(a: Fraction, b: Fraction, mu: Sequence[Fraction], axis: int) -> NormalForm | None:
    """The normal form of the scaled gyrostat about x1 or x3 (index 0 or 2); None where mu vanishes there, and
    about x2."""
    a, b, mu = Fraction(a), Fraction(b), tuple(map(Fraction, mu))
    sense = (mu[axis] > 0) - (mu[axis] < 0)
    if not sense or axis == 1:
        return None
    a, b, m1, m3 = sense * a, sense * b, sense * mu[0], sense * mu[2]
    if axis == 0:
        return NormalForm(0, sense, (0, 1, 2), 1.0, float(m1), 1.0, 0.5, float((b - a) / 2),
                          complex(mu[1], m3), 0j, float((a + b) / 2), (0.0, 0.0), (1.0, 1.0), 0.0)
    return NormalForm(2, sense, (2, 1, 0), 1.0, float(m3), 1.0, 0.5, 0.0, complex(mu[1], m1),
                      complex(b - a), 0.0, (0.0, float(-a)), (1.0, 1.0), float((a - b) * m1))


def forms_of(scene: AnyScene) -> list[NormalForm]:
    """The normal forms of a scene (gyrostat and constant torque): one for each extremal axis that bears a
    torque."""
    with in_range("scene"):
        if scene.variables == "scaled":
            forms = [scaled_normal_form(*scene.exact_ab, scene.exact_mu, i)  # type: ignore[call-arg]
                     for i in range(3)]
        else:
            forms = [normal_form(scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque"),
                                 i) for i in range(3)]
    return [form for form in forms if form]


# --- Why a motion is undecided, in words
SMALL = 0.05  # a component of the torque below this share of it is called small
PARKED = 0.3  # relative distance from the saddle-focus, in spin and in cone, that is called parked
WIDE = 2.0    # transverse motion over spin beyond which the motion is not about the axis at all
# see `recurs`; doublings of the steps begin to count after 2^SETTLED of them
SAME, SWINGS, DOUBLINGS, SETTLED = 1.1, 0.9, 3, 10


SLOW = Sentence("spin-up-slow", "slow: the torque has not yet gathered the spin about an axis")()
NO_FORM_SYMMETRIC = Sentence(
    "no-form-symmetric", "the torque has no component about the axis of symmetry and no spin-up in the "
    "equator has a certificate: nothing to test")()
NO_FORM = Sentence(
    "no-form", "the torque has no component about the major or the minor axis (it lies along the "
    "intermediate axis, if anywhere): no certificate of spin-up exists about that axis, and nothing was "
    "followed")()
NEAR_SADDLE_FOCUS = Sentence(
    "parked-near-saddle-focus", "parked near a saddle-focus, a spin of {rate} against the torque about "
    "{axis}, which it leaves on the time scale of {time}")
SLOWING_DOWN = Sentence(
    "slowing-down", "spin against the torque about {axis}, still slowing down: it ends after some {time} and "
    "the fate is open until then")
WIDE_CONE = Sentence(
    "wide-cone", "wide cone about {axis}: the transverse motion is {ratio} times the spin, which gains only "
    "in the mean")
RATE_SWINGS = Sentence(
    "rate-swings", "spin along the torque about {axis}, whose rate swings by much more than the torque gives "
    "it")
SMALL_COMPONENT = Sentence(
    "small-torque-component", "small torque component about {axis} ({share} of the torque)")
ISLAND_POSSIBLE = Sentence(
    "island-possible", "between two equilibria, saddle-foci as a rule, where a bounded island may exist")()
ISLAND_SEEN = Sentence(
    "island-seen", "bounded over {time}, its largest rate no greater in any of the last doublings: an island "
    "is seen")
AVERAGED_CENTRE = Sentence("averaged-centre", "averaging has its centre about {axis} at a spin of {rate}")
OTHER_CENTRE = Sentence("other-averaged-centre", "about {axis} at a spin of {rate}")


def seen(scene: AnyScene, state: Sequence[float], recurrence: Reason | None = None) -> Reason:
    """The cause why spin-up about neither axis is certified at a state on its way, strongest first.
    recurrence: what is said of a motion that recurs, where it does."""
    forms = forms_of(scene)
    if not forms:
        symmetric = scene.variables != "scaled" and len(set(scene.body.exact)) == 2
        return NO_FORM_SYMMETRIC if symmetric else NO_FORM
    looks = sorted((_look(form, state, scene) for form in forms), key=lambda look: (look[0], str(look[1])))
    causes = [cause for _, cause in looks if cause]
    result = causes[0] if causes else SLOW
    for joint, cause in zip(("; ", ", ", ", "), _small(scene, forms)):
        result = result.then(cause, joint)
    return result.then(_between(scene, state, recurrence))


def _rate(scene: AnyScene, value: float) -> Quantity:
    return Quantity(value, "" if scene.variables == "scaled" else "rad/s", 4)


def _look(form: NormalForm, state: Sequence[float], scene: AnyScene) -> tuple[int, Reason | None]:
    """(rank, cause) of one form."""
    X, zeta = form.place(state)
    axis = Axis(form.axis + 1)
    cone = abs(zeta) / (abs(X) or 1e-300) / math.sqrt(form.D1 * abs(form.scale[0] * form.scale[1]))
    if X < 0:
        rest = form.drag / form.M1
        if form.drag > 0 and abs(X + rest) < PARKED * rest and cone < 3 * PARKED:
            return 0, NEAR_SADDLE_FOCUS(rate=_rate(scene, -form.sense * rest), axis=axis, time=Quantity(
                form.D1 * form.drag / form.M1**2, scene.time_unit, 3))
        if cone < 1:
            return 1, SLOWING_DOWN(axis=axis, time=Quantity(form.D1 * -X / form.M1, scene.time_unit, 3))
        return 4, None
    if cone > WIDE:
        return 4, None
    return (2, WIDE_CONE(axis=axis, ratio=Quantity(cone, digits=2))) if cone > 0.3 else (
        3, RATE_SWINGS(axis=axis))


def _small(scene: AnyScene, forms: Sequence[NormalForm]) -> list[Reason]:
    torque = [float(v)
              for v in (scene.exact_mu if scene.variables == "scaled" else scene.vector("constant_torque"))]
    size = math.hypot(*torque)
    return [SMALL_COMPONENT(axis=Axis(form.axis + 1), share=Quantity(form.M1 / size, digits=2))
            for form in forms if form.M1 < SMALL * size]


def _between(scene: AnyScene, state: Sequence[float], recurrence: Reason) -> Reason | None:
    """A pointer to bounded islands: with a wheel and two equilibria, the state no faster than thrice the
    farther of them."""
    ends = _equilibria(scene)
    if not ends:
        return None
    size = math.hypot(*state)
    if size > 3 * max(math.hypot(*end) for end in ends):
        return None
    return recurrence or ISLAND_POSSIBLE


def _equilibria(scene: AnyScene):
    """The two equilibria of a scene with a wheel, (3,) each; none where there are not two."""
    if scene.variables == "scaled" or not any(scene.vector("gyrostat")):
        return ()
    points = gyrostat_equilibria(scene).points
    return tuple(point.at for point in points) if len(points) == 2 else ()


@dataclass(frozen=True)
class Centre:
    """The centre of the averaged flow: axis (1, 2, 3), spin about it (signed, rad/s or the motion's unit),
    action |eta|^2 across."""

    axis: int
    spin: float
    action: float


def centres(scene: AnyScene) -> list[Centre]:
    """The centres of the averaged flow of a scene in physical variables, with the wheel's part along each
    axis left out (leading order)."""
    if scene.variables == "scaled":
        return []
    D, l, M = ([float(v) for v in vector]
               for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))
    return [result for i in range(3) if (result := _centre(D, l, M, i))]


def _centre(D, l, M, i):
    j, k = (i + 1) % 3, (i + 2) % 3
    d2, d3, M1 = D[i] - D[j], D[i] - D[k], M[i]
    if not (M1 and d2 * d3 > 0):
        return None
    a, b, c = l[j] * M[j] / d2, l[k] * M[k] / d3, (d3 - d2) * M[j] * M[k] / (d2 * d3)
    total = a + b
    if not (M1 * c < 0 and total**2 > 4 * abs(M1 * c) and (abs(d3) - abs(d2)) * (b * b - a * a) > 0):
        return None
    X = (-total - math.copysign(math.sqrt(total**2 - 12 * M1 * c), total)) / (6 * M1)
    om = math.sqrt(d2 * d3 / (D[j] * D[k]))
    K = math.copysign(1, d2) * (d3 - d2) * (a - b) / (4 * D[i] * om * math.sqrt(D[j] * D[k]))
    action = -(M1 + total / X - c / X**2) * X**3 / K
    return Centre(i + 1, X, action) if action > 0 else None


def recurs(largest: Sequence[float], smallest: Sequence[float], steps: int) -> bool:
    """Whether the size of a motion kept its greatest value over the last three doublings of the steps, and
    swung under it.

    largest, smallest: of |omega| during each doubling; one that is parked beside a saddle-focus does not
    swing."""
    last = int(math.log2(1 + steps))
    if last < SETTLED + DOUBLINGS:
        return False
    tops = largest[last - DOUBLINGS:last + 1]
    return max(tops) <= SAME * min(tops) and min(smallest[last - DOUBLINGS:last + 1]) < SWINGS * max(tops)


def island(scene: AnyScene, t: float) -> Reason:
    """What is said of a motion that recurs, followed for a time t."""
    result = ISLAND_SEEN(time=Quantity(t, scene.time_unit, 4))
    for n, centre in enumerate(centres(scene)):
        axis, rate = Axis(centre.axis), _rate(scene, centre.spin)
        result = (result.then(OTHER_CENTRE(axis=axis, rate=rate), " or ") if n
                 else result.then(AVERAGED_CENTRE(axis=axis, rate=rate)))
    return result
