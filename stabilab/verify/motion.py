"""What a certificate claims of a motion, checked: its fate and the facts that carry it."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial, reduce

from flint import arb, ctx

from .numbers import (
    Malformed,
    Open,
    Rates,
    above,
    ball,
    below,
    bracket,
    exact_sign,
    field,
    narrowed,
    numbers,
    optional,
    shown,
    sign,
    whole,
    word,
    working,
)
from .orbit import ClosedClaims, Orbit, check_closed, closed_of, period_of, round_once
from .spin_up import SpinUpClaims, check_spin_up, spin_up_of

# --- What is proved of one orbit: walls, turning points, highest barriers and deepest wells, each enclosed
WINDOWS, REACH = 24, Fraction(1013, 1009)  # doublings of the reach of alpha in search of a wall


class Facts:
    """What is proved of one orbit at the working precision of so many bits: fate, reason, ends (balls or
    None), extremes."""

    def __init__(self, orbit: Orbit):
        self.orbit, self.bits = orbit, ctx.prec
        sense = exact_sign(orbit.tilt)
        self.fate, self.reason, self.ends = _fate(orbit, sense)
        self.round = self.fate == "bounded" and self.ends is None
        self.extremes = self._extremes(sense)

    def _extremes(self, sense: int):
        """[(low, high)] * 3 as balls, None where unbounded."""
        o = self.orbit
        if o.forceless():
            here = ball(o.y0 - o.s)
            ranges = {o.axis: (here, here)} | dict(zip((o.j, o.k), _whole_circle(o)))
        elif self.ends is not None:
            fastest = (-2 * _lowest(o, *self.ends)).sqrt()
            ranges = {o.axis: (-fastest - ball(o.s), fastest - ball(o.s))}
            ranges |= dict(zip((o.j, o.k), _ranges(o, *self.ends)))
        elif self.round:
            slow, fast = ((-2 * e).sqrt() for e in _heights_round(o))
            low, high = (slow, fast) if o.y0 > 0 else (-fast, -slow)
            ranges = {o.axis: (low - ball(o.s), high - ball(o.s))} | dict(zip((o.j, o.k), _whole_circle(o)))
        else:
            steady = o.constant(0) and o.constant(1)
            slowest = ball(sense * o.y0) if steady else _slowest_ahead(o, sense)
            low, high = (slowest - ball(o.s), None) if sense > 0 else (None, -slowest - ball(o.s))
            ranges = ({o.axis: (low, high)}
                      | dict(zip((o.j, o.k), _whole_circle(o) if o.kind < 0 else _to_the_end(o, sense))))
        return [ranges[i] for i in range(3)]


def _fate(orbit: Orbit, sense: int):
    """(fate, reason, the two turning points of a motion that has them, else None)."""
    circle, torque_free = orbit.kind < 0, "no torque: the energy is constant and positive definite"
    if orbit.forceless():
        if not circle:
            raise Open
        return ("bounded", "no force along the orbit: this rate is constant, and so is the circle's radius",
                None)
    if circle and sense:
        ahead = _turning(orbit, sense)
        if ahead is None:
            return ("spin-up", "no barrier within one turn ahead reaches the energy, and each turn is lower",
                    None)
        ends = sorted((ahead, _turning(orbit, -sense)), key=lambda end: float(end.mid()))
        return "bounded", "a barrier above the energy stands ahead, and the tilt rises behind", ends
    ends = [_turning(orbit, side) for side in (-1, 1)]
    if None not in ends:
        return "bounded", torque_free if circle else "walls above the energy stand on both sides", ends
    if not circle:
        return *_released(orbit, ends), None
    if ends != [None, None]:
        raise Open
    return "bounded", torque_free, None


def _turning(orbit: Orbit, side: int):
    """The turning point on one side as a ball; None where the motion passes every barrier of a circle's next
    turn, or no wall stands on a hyperbola or a parabola."""
    if orbit.y0 == 0 and exact_sign(orbit.F0) == -side:
        return ball(0)
    inner, circle = None, orbit.kind < 0
    against = circle and exact_sign(orbit.tilt) == -side
    spots = _ahead(orbit, side)
    if against:  # each turn behind is higher: skip those that are surely too low
        turns = _turns_below(orbit, spots)
        inner = side * turns * orbit.turn if turns else None
        spots = [site + side * n * orbit.turn for n in range(turns, turns + 4) for site in spots]
    for point in spots:
        if _over(orbit, point):
            return _crossing(orbit, inner, point)
        inner = point
    if circle and not against:
        return None
    if circle and spots:
        raise Open
    # from here on the potential is monotone
    end, reach = Fraction(0) if inner is None else above(inner) if side > 0 else below(inner), REACH
    for _ in range(WINDOWS):
        if _over(orbit, ball(end + side * reach)):
            return _crossing(orbit, inner, ball(end + side * reach))
        reach *= 2
    return None


def _ahead(orbit: Orbit, side: int):
    """The places on one side where the force changes sign, the nearest first: of one turn of a circle."""
    far = ball(orbit.past_a_turn) if orbit.kind < 0 else arb("inf")
    return orbit.spots(ball(0), far) if side > 0 else orbit.spots(-far, ball(0))[::-1]


def _over(orbit: Orbit, location: arb) -> bool:
    """Whether the potential is above the energy."""
    over = sign(orbit.excess(location))
    if over is None:
        raise Open
    return over > 0


def _turns_below(orbit: Orbit, spots: Sequence[arb]) -> int:
    """How many whole turns behind hold no barrier that reaches the energy, less one. spots: of the first."""
    highest = reduce(arb.max, map(orbit.excess, [ball(0), *spots]))
    if not highest < 0:
        return 0
    return max(int(below(-highest / (ball(abs(orbit.tilt)) * orbit.turn))) - 1, 0)


def _crossing(orbit: Orbit, inner: arb | None, outer: arb):
    """Where U = E between the last barrier or well below the energy (None: the start) and a place above it.
    """
    a = Fraction(0) if inner is None else (above(inner) if outer > inner else below(inner))
    b = below(outer) if outer > ball(a) else above(outer)
    low, high = sorted((a, b))
    df = lambda x: -orbit.force(x)
    # U - E is monotone between neighbouring zeros of the force, so a change of sign is a single zero
    lo_sign, hi_sign = sign(orbit.excess(ball(low))), sign(orbit.excess(ball(high)))
    # from rest a well comes first, so neither is zero
    if None in (lo_sign, hi_sign) or lo_sign * hi_sign >= 0:
        raise Open
    return narrowed(orbit.excess, df, low, high)


def _lowest(orbit: Orbit, left: arb, right: arb):
    """Least U - E on [left, right], which holds the start, as a ball (negative)."""
    if orbit.kind < 0 and orbit.tilt:  # wells further back than one turn are higher
        turn = ball(orbit.past_a_turn)
        left, right = (left.max(right - turn), right) if orbit.tilt > 0 else (left, right.min(left + turn))
    return reduce(arb.min, map(orbit.excess, [ball(0), *orbit.spots(left, right)]))


def _heights_round(orbit: Orbit):
    """(greatest, least) U - E on the whole circle without torque."""
    values = [*map(orbit.excess, [ball(0), *_ahead(orbit, 1)])]
    return reduce(arb.max, values), reduce(arb.min, values)


def _ranges(orbit: Orbit, left: arb, right: arb):
    """((low, high) of u, (low, high) of v) on [left, right]."""
    out = []
    for which in (0, 1):
        values = [orbit.place(left)[which], orbit.place(right)[which]]
        for z in [] if orbit.constant(which) else orbit.stationary(which, right):
            if z < left or z > right:
                continue
            value = orbit.place(z)[which]
            for end, there in ((left, values[0]), (right, values[1])):
                # beside the end by less than its own width: inside or not makes no difference
                if z.overlaps(end):
                    value = value.union(there)
            values.append(value)
        out.append((reduce(arb.min, values), reduce(arb.max, values)))
    return out


def _whole_circle(orbit: Orbit):
    """Ranges of u and v on the whole circle."""
    o = orbit
    ratio = -o.p / o.q
    radius_u = ball((o.u0 - o.cu) ** 2 + ratio * (o.v0 - o.cv) ** 2).sqrt()
    radius_v = ball((o.v0 - o.cv) ** 2 + (o.u0 - o.cu) ** 2 / ratio).sqrt()
    return [(ball(c) - r, ball(c) + r) for c, r in ((o.cu, radius_u), (o.cv, radius_v))]


def _slowest_ahead(orbit: Orbit, sense: int):
    """The least sense * y over the future of a motion that spins up."""
    if exact_sign(orbit.y0) * sense < 0:
        behind = _behind(orbit, sense)
        low, high = (behind, ball(0)) if sense > 0 else (ball(0), behind)
        return -(-2 * _lowest(orbit, low, high)).sqrt()
    slowest = reduce(arb.min, (-orbit.excess(point) for point in _ahead(orbit, sense)), ball(orbit.E))
    return (2 * slowest).sqrt()


def _behind(orbit: Orbit, sense: int):
    """Where a motion that runs against the torque first turns back."""
    behind = _turning(orbit, -sense)
    if behind is None:
        raise Open
    return behind


def _to_the_end(orbit: Orbit, sense: int):
    """Ranges of u and v on a decaying plane, from where the motion turns back to the plane's end; or
    constant."""
    if orbit.constant(0) and orbit.constant(1):
        return [(ball(v), ball(v)) for v in (orbit.u0, orbit.v0)]
    back = exact_sign(orbit.y0) * sense < 0
    starts = orbit.place(_behind(orbit, sense)) if back else (ball(orbit.u0), ball(orbit.v0))
    return [(start.min(ball(end)), start.max(ball(end))) for start, end in zip(starts, (orbit.cu, orbit.cv))]


def _released(orbit: Orbit, ends: Sequence[arb | None]):
    """(fate, reason) of an orbit without a wall on one side: pure spin, or a decaying plane of a hyperbola.
    """
    if orbit.constant(0) and orbit.constant(1) and orbit.F0:
        return "spin-up", "x_j and x_k stay constant, and so does the force"
    side = -1 if ends[0] is None else 1
    if orbit.kind > 0 and orbit.decays() == side == exact_sign(orbit.tilt):
        # behind its last change of sign the force has that of the tilt, to which it tends
        return ("spin-up",
                "a plane that decays in the direction of the torque; no barrier on it reaches the energy")
    raise Open


# --- Is the fate of the state what the certificate says, and do its brackets hold the extremes and the
# period?
BITS, MOST_BITS = 192, 6144
# times the bits that settled the fate: a bracket that these do not tell from the true value is left open
CLOSER = 4
GOALS = (48, 96, 192)  # bits of the period, likewise
FATES = ("bounded", "spin-up", "separatrix", "equilibrium", "undecided")


@dataclass(frozen=True)
class Claims:
    """The certificate's part `motion`, read. None: nothing is claimed; within extremes: unbounded."""

    state: list[Fraction]
    fate: str
    axis: int | None
    sense: int | None
    extremes: list | None
    period: tuple[Fraction, Fraction] | None
    spin_up: SpinUpClaims | None
    closed: ClosedClaims | None = None

    @property
    def words(self) -> str:
        """Fate, axis and sense as claimed."""
        spin = [f"{name} {value}" for name, value in (("axis", self.axis), ("sense", self.sense)) if value]
        return ", ".join([f"fate: {self.fate}", *spin])


def motion_of(table) -> Claims:
    """The claims on a motion. Raises `Malformed` before anything is worked out."""
    read = {"axis": partial(whole, where="motion.axis", known=range(4)),
            "sense": partial(whole, where="motion.sense", known=range(-1, 2)), "extremes": _pairs,
            "period": partial(bracket, where="motion.period"), "spin_up": spin_up_of, "closed": closed_of}
    return Claims(numbers(field(table, "state", "motion"), "motion.state", 3),
                  word(table, "fate", "motion", FATES),
                  **{key: optional(table, key, of) for key, of in read.items()})


def _pairs(claimed: Sequence[list[list[str] | None]]):
    """Three pairs of brackets, None for what is unbounded."""
    if not (isinstance(claimed, list)
            and [len(pair) if isinstance(pair, list) else 0 for pair in claimed] == [2, 2, 2]):
        raise Malformed(f"motion.extremes: expected three pairs of brackets, got {shown(claimed)}")
    return [[None if ends is None else bracket(ends, f"motion.extremes[{i}][{k}]")
             for k, ends in enumerate(pair)] for i, pair in enumerate(claimed)]


def check_motion(rates: Rates, claims: Claims, note: Callable[[str, str], None]):
    """Findings on the certificate's part `motion`: every claim of it is among them, unless the fate is wrong.
    """
    if not any(rates.at(claims.state)):
        _check_rest(claims, note)
        return
    if claims.fate == "equilibrium":
        note(claims.words, "refuted", "the rates do not vanish exactly at the state")
        return
    if claims.closed:
        _check_closed(rates, claims, note)
        return
    if claims.spin_up:
        _check_trapped(rates, claims, note)
        return
    orbit = _orbit(rates, claims.state)
    result = orbit and at_rising_precision(partial(_facts, orbit))
    if result is None:
        why = (f"not decided with {MOST_BITS} bits" if orbit
               else "the scene has no reduction to one degree of freedom")
        note(claims.words, "not checked", why)
        _leave_numbers(claims, why, note)
        return
    axis = orbit.axis + 1 if result.fate == "spin-up" else 0
    _check_words(claims, result.fate, axis, exact_sign(orbit.tilt) if axis else 0, result.reason, note)
    if claims.fate in (result.fate, "undecided"):
        _check_numbers(claims, orbit, result, note)


def _check_rest(claims: Claims, note: Callable[[str, str], None]):
    """A state at which the rates vanish exactly: it is its own extremes, and nothing repeats."""
    _check_words(claims, "equilibrium", 0, 0, "the rates vanish exactly at the state", note)
    for claim, ends, x in _named(claims.extremes, [(x, x) for x in claims.state]):
        right = ends is not None and ends[0] <= x <= ends[1]
        note(claim, "proved" if right else "refuted", "the state does not change")
    if claims.period is not None:
        note("period", "refuted", "an equilibrium has no period")
    if claims.spin_up:
        note("spin-up", "refuted", "the state does not change")
    if claims.closed:
        note(f"law: {claims.closed.law}", "refuted", "the state does not change")


def _check_trapped(rates: Rates, claims: Claims, note: Callable[[str, str], None]):
    """A motion that an inequality traps in spin-up."""
    status, reason = check_spin_up(rates, claims.state, claims.spin_up, note)
    if status == "proved":
        _check_words(claims, "spin-up", claims.spin_up.axis, claims.spin_up.sense, reason, note)
    else:
        note(claims.words, "not checked", reason)
    _leave_numbers(claims, "the inequality says nothing of the time before", note,
                   "refuted" if status == "proved" else "not checked",
                   "a motion that spins up does not repeat")


def _check_closed(rates: Rates, claims: Claims, note: Callable[[str, str], None]):
    """A motion that a closed solution tells."""
    fate, axis, sense, reason = check_closed(rates, claims.state, claims.closed, note)
    if fate:
        _check_words(claims, fate, axis, sense, reason, note)
    else:
        note(claims.words, "not checked", reason)
    _leave_numbers(claims, "the closed solution bounds sizes alone", note,
                   "refuted" if fate == "spin-up" else "not checked",
                   "the closed solution is not asked for a period")
    if claims.spin_up:
        check_spin_up(rates, claims.state, claims.spin_up, note)


def _check_words(claims, fate, axis, sense, reason, note):
    """Fate, axis and sense against what is found; what is not claimed is not compared."""
    said = [(claims.axis, axis), (claims.sense, sense)]
    if claims.fate != "undecided":
        said.append((claims.fate, fate))
    if any(claimed not in (None, true) for claimed, true in said):
        note(claims.words, "refuted", reason)
    elif claims.fate == "undecided":
        note(claims.words, "not checked", f"the certificate leaves open what is proved: {fate}: {reason}")
    else:
        note(claims.words, "proved", reason)


def _leave_numbers(claims: Claims, why: str, note: Callable[[str, str], None], period: str = "not checked",
                   because: str | None = None):
    """No extreme of the motion is checked; what becomes of its period, for a reason of its own."""
    for claim, *_ in _named(claims.extremes, [(None, None)] * 3):
        note(claim, "not checked", why)
    if claims.period is not None:
        note("period", period, because or why)


def _named(claimed: Sequence[list[tuple[Fraction, Fraction] | None]] | None,
           result: Sequence[Sequence[Fraction | tuple[int, int] | None]]):
    """(claim, claimed, found) of the six extremes."""
    for i, pair in enumerate(claimed or ()):
        for word_, said, true in zip(("least", "greatest"), pair, result[i]):
            yield f"{word_} x{i + 1}", said, true


def _orbit(rates: Rates, state: Sequence[Fraction]):
    """The orbit about the torque's axis, or, without one, about the first axis that allows it, circles first.
    """
    acting = [i for i in range(3) if rates.m[i]]
    if len(acting) > 1:
        return None
    built = []
    for axis in acting or range(3):
        try:
            built.append(Orbit(rates, axis, state))
        except ValueError:
            pass
    return min(built, key=lambda o: (-1, 1, 0).index(o.kind), default=None)


def at_rising_precision(question: Callable[[], str] | partial[Facts], smallest: int | None = None,
                        largest: int | None = None):
    """question() at more and more bits while it raises Open; None when the most are not enough, or the work
    is too much."""
    bits = smallest or BITS
    while bits <= (largest or MOST_BITS):
        with working(bits):
            try:
                return question()
            except Open:
                bits *= 2
    return None


def _check_numbers(claims, orbit, result, note):
    """The brackets of extremes and period."""
    for claim, said, true in _named(claims.extremes, [[(i, k) for k in (0, 1)] for i in range(3)]):
        i, k = true
        if said is None or result.extremes[i][k] is None:
            unbounded = result.extremes[i][k] is None
            note(claim, "proved" if unbounded and said is None else "refuted",
                 "unbounded" if unbounded else "bounded")
        else:
            status = at_rising_precision(lambda i=i, k=k, said=said:
                                         _within(_facts(orbit).extremes[i][k], *said), result.bits,
                                         CLOSER * result.bits)
            note(claim, status or "not checked",
                 "roots on the potential" if status else "the bracket ends too close to the true value")
    if claims.period is not None and result.fate != "bounded":
        note("period", "refuted", "a motion that spins up does not repeat")
    elif claims.period is not None:
        status = _period_status(orbit, claims.period, result.bits)
        note("period", status or "not checked",
             "verified quadrature between the turning points, or round the circle" if status
             else "the verified quadrature did not close, or not on one side of the bracket's ends")


def _period_status(orbit: Orbit, said: Sequence[Fraction], bits: int):
    """Whether the bracket holds the period, by quadratures to more and more digits; None where they leave it
    open."""
    for goal in GOALS:
        true = at_rising_precision(partial(_period, orbit, goal), max(bits, 4 * goal))
        try:
            return true and _within(true, *said)
        except Open:
            pass
    return None


def _facts(orbit: Orbit) -> Facts:
    """What is proved of an orbit at the working precision. Raises Open where it does not do."""
    return _facts_of(orbit, ctx.prec)


@lru_cache(maxsize=16)
def _facts_of(orbit: Orbit, bits: int):
    return Facts(orbit)


def _period(orbit: Orbit, goal: int):
    """The period to about so many bits, as a ball."""
    facts = _facts(orbit)
    if orbit.forceless():
        return orbit.turn / abs(ball(orbit.y0))
    return round_once(orbit, goal) if facts.round else period_of(orbit, facts.ends, goal)


def _within(true: arb, low: Fraction, high: Fraction) -> str:
    """"proved" or "refuted": that the ball lies in the bracket. Raises Open where it is neither inside nor
    outside."""
    smallest, largest = below(true), above(true)
    if low <= smallest and largest <= high:
        return "proved"
    if smallest <= high and low <= largest:
        raise Open
    return "refuted"
