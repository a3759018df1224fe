"""How far two ways to the same answer part, in units of what they promise: 1 is the limit, inf a wrong label.

Each function takes (scene, oracle's model, state) and gives (size, words).
"""
from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np

import stabilab
from stabilab import Fate
from stabilab.answers.certificate import certificate
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.errors import InputError
from stabilab.verify import verify
from tests.oracles import energy
from tests.oracles.model import CYCLE
from tests.oracles.pairs import WORDS, physical, scaled

ELEVEN_DIGITS = 1e-11  # what `extremes` and `period` promise without `digits`
MARGIN = 1e-12  # what `fate` promises of a margin, relative to the kinetic energy and the barrier's height
MOST_TURNS = 1000  # that a method is asked to follow
BITS = 200  # of the series that settles which of two ways is right
MOST_STEPS = 500  # of a series that are looked at one by one: ten to twenty seconds
UNITS_A_STEP = 8  # roundings of three components, their rates and the sum of the series
EPS = float(np.finfo(float).eps)
WRONG = math.inf
NO_QUESTION = (0.0, "")
ROWS_AND_COLUMNS = (7, 17)  # of a branch whose places are asked
# times a place: so far from the centre of its conic, ten times as far as the program asks for, the way there
# costs it no digits
FAR_CENTRE = 1e3
# of a place and of the terms of its energy: some ten operations each for shift, place, turn and height
ROUNDINGS = 64


def worst(*found):
    return max(found, key=lambda pair: pair[0], default=NO_QUESTION)


def certified(scene, problem, state):
    """Arrays against the certificate, which the separate checker has proved."""
    made = certificate(scene, state)
    checked = verify(json.loads(json.dumps(made)))
    refuted = [f for f in checked.findings if f.status == "refuted"]
    if refuted:
        return WRONG, f"refuted: {refuted[0].claim}: {refuted[0].reason}"
    motion, states = made["motion"], np.array([state])
    label = Fate(int(stabilab.fate(scene, states).labels[0]))
    if motion is None:
        sure = (label in (Fate.BOUNDED, Fate.SPIN_UP) and motion is None
                and "separatrix" in str(made["uncertified"]))
        return (WRONG, f"{label.word}, but a tie by the certificate") if sure else NO_QUESTION
    if motion["fate"] != label.word:
        return WRONG, f"{label.word}, proved {motion['fate']}"
    found = []
    for fast in (False, True):
        box = stabilab.extremes(scene, states, fast=fast)[0]
        found += [_against(box[i], motion["extremes"][i], f"component {i + 1}") for i in range(3)
                  if motion["extremes"]]
        if motion["period"]:
            found.append(_against(stabilab.period(scene, states, fast=fast), [motion["period"]], "period"))
    return worst(*found)


def _against(values, brackets, name):
    """Doubles against brackets of exact numbers, relative to the largest of them."""
    middles = [(v if math.isinf(v) else math.nan) if b is None
               else (float(Fraction(b[0])) + float(Fraction(b[1]))) / 2 for v, b in zip(values, brackets)]
    return between(values, middles, f"{name}, proved", ELEVEN_DIGITS)


def oracle(scene, problem, state):
    """Label and margin against the reduced potential in 60 to 240 digits."""
    result = stabilab.fate(scene, np.array(state))
    label, margin = int(result.labels), float(result.margins)
    if math.isnan(margin):
        return WRONG, "the margin is no number"
    digits = _digits(state)
    word = energy.label(problem, state, digits=digits)
    if WORDS[word] != label:
        return WRONG, f"{Fate(label).word}, oracle {word}"
    if label == Fate.EQUILIBRIUM:
        return NO_QUESTION
    motion = energy.Reduced(problem, state, digits)
    saddles = [kind for _, kind in motion.stationary()].count("saddle") if not motion.at_centre else 0
    if motion.kind != "elliptic" and saddles != 1 or motion.tilt == 0 or not math.isfinite(margin):
        return NO_QUESTION
    exact = energy.margin(problem, state, digits=digits)
    if exact is None:
        return WRONG, f"margin {margin} where there is no barrier"
    return _margin_off(problem, motion.i, state, margin, float(exact))


def _digits(state):
    small = min((abs(v) for v in state if v), default=1.0)
    return int(100 + max(0.0, -2 * math.log10(small)))


def _margin_off(problem, axis, state, got, exact, promise=MARGIN):
    kinetic = 0.5 * float(problem.weight[axis]) * state[axis] ** 2
    terms = abs(exact + kinetic) + kinetic
    return (abs(got - exact) / (promise * terms) if terms
            else 0.0), f"margin {got!r}, expected {exact!r}, terms {terms:g}"


def one_state(scene, problem, state):
    """The answer for one state without arrays against the arrays' answers."""
    one, many = motion_of(scene, state, needs=Needs.QUICK), stabilab.fate(scene, np.array([state]))
    if (one.fate, one.axis, one.sense) != (many.labels[0], many.axis[0], many.sense[0]):
        return WRONG, f"{one.fate}, arrays {Fate(int(many.labels[0])).word}"
    margin = float(many.margins[0])
    if (one.margin_energy is None) != (not math.isfinite(margin)):
        return WRONG, f"margin {one.margin_energy}, arrays {margin}"
    box = stabilab.extremes(scene, np.array([state]))[0]
    return worst(*(between(box[i], one.extremes[i], "xyz"[i]) for i in range(3)))


def between(values, others, name, promise=2 * ELEVEN_DIGITS):
    pairs = [(float(a), float(b)) for a, b in zip(values, others)]
    if any(math.isfinite(a) != math.isfinite(b) or (not math.isfinite(a) and a != b) for a, b in pairs):
        return WRONG, f"{name}: {pairs}"
    finite = [(a, b) for a, b in pairs if math.isfinite(a)]
    size = max((max(abs(a), abs(b)) for a, b in finite), default=0.0)
    off = max((abs(a - b) for a, b in finite), default=0.0)
    return (off / size / promise if size else 0.0), f"{name}: {pairs}"


def methods(scene, problem, state):
    """The state by quadrature against Taylor series, relative to what one unit in the last place of the state
    and of the period does: the series rounds a few times a step and the quadrature a few times. Where that is
    not enough, the way may hold what it leads to in its last places only, which the start did not: then both
    are asked one by one.
    """
    try:
        speed = _speed(problem, state)
        if not 0 < speed < 1e200 or _braked_turns(problem, state) > MOST_TURNS:
            return NO_QUESTION
        times = np.array([3.0, 20.0]) / speed
        here, effect = _and_one_unit_away(scene, problem, state, times)
    except InputError:
        return NO_QUESTION  # no such form, no digit, or a tie or a flat well one unit away: no measure of condition
    if not max(_speed(problem, x) for x in here.tolist()) * times[-1] < MOST_TURNS:
        return NO_QUESTION  # the series would take minutes
    run = stabilab.trajectory(scene, state, times, laws=False)
    if run.status != "reached":
        return NO_QUESTION
    size, at = _parted(run, here, effect)
    words = f"t = {times[at]!r}: {here[at].tolist()} and {run.states[at].tolist()}"
    return (size,
            words) if size <= 1 else worst(_against_many_digits(problem, state, times[at], here[at],
                                                                effect[at]),
                                           _step_by_step(scene, problem, state, times[at]))


def _and_one_unit_away(scene, problem, state, times):
    """(states by quadrature (n, 3), what one unit in the last place of the start and of the period does there
    (n,))."""
    runs = [stabilab.trajectory(scene, s, times, "reduced", laws=False) for s in _one_unit_away(state)]
    if any(run.status != "reached" for run in runs):
        raise InputError("so late that no digit of the state is known")
    here, *beside = (run.states for run in runs)
    period = float(stabilab.period(scene, np.array(state)))
    rates = np.array([[abs(float(r)) for r in problem.rate(x)] for x in here.tolist()])
    effect = sum(np.abs(there - here).max(axis=1) for there in beside) + EPS * np.abs(here).max(axis=1)
    return here, effect + EPS * rates.max(axis=1) * (np.maximum(times, period) if math.isfinite(period)
                                                     else times)


def _parted(run, states, effect):
    """(how far a run and the quadrature part, where)."""
    sizes = np.abs(run.states - states).max(axis=1) / (UNITS_A_STEP * (10 + run.counters["steps"]) * effect)
    return float(sizes.max()), int(sizes.argmax())


def _against_many_digits(problem, state, time, found, effect):
    """The quadrature against a Taylor series of `BITS`."""
    exact = many_digits(problem, state, time)
    return float(np.abs(exact - found).max()
                 / (UNITS_A_STEP * 10
                    * effect)), f"t = {time!r}: {found.tolist()}, in {BITS} bits {exact.tolist()}"


def many_digits(problem, state, time):
    """The state at a time by a Taylor series of `BITS`, rounded."""
    return _flow(series_of(problem), state, time)


def series_of(problem, bits=BITS):
    """Euler's equations as a Taylor series of so many bits."""
    import heyoka as hy
    of = lambda value: number_of(value, bits)
    x = hy.make_vars("x", "y", "z")
    rates = [of(problem.kappa[i]) * x[j] * x[k] + of(problem.rho[i]) * x[k] + of(problem.sigma[i]) * x[j]
             + of(problem.m[i]) for i, (j, k) in enumerate(CYCLE)]
    return hy.taylor_adaptive(list(zip(x, rates)), [of(0)] * 3, fp_type=hy.real, prec=bits,
                              tol=hy.real(2.0 ** (20 - bits), bits))


def number_of(value, bits=BITS):
    """A Fraction, float or integer in so many bits."""
    import heyoka as hy
    value = Fraction(value)
    return hy.real(str(value.numerator), bits) / hy.real(str(value.denominator), bits)


def _flow(series, state, time):
    series.time, series.state[:] = number_of(0), [number_of(v) for v in state]
    series.propagate_until(number_of(time))
    return np.array([float(v) for v in series.state])


def _step_by_step(scene, problem, state, time):
    """The doubles' series against that of `BITS` over ways of a step's length, relative to what a unit of
    rounding at the beginning of each does: what the steps round, and not where that leads."""
    steps = stabilab.trajectory(scene, state, [time], laws=False).counters["steps"]
    count = min(steps, MOST_STEPS)
    times = np.linspace(0, time / steps * count, count + 1)
    ends = stabilab.trajectory(scene, state, times[1:], laws=False).states
    series, found = series_of(problem), [NO_QUESTION]
    for start, end, length in zip([state, *ends.tolist()], ends, np.diff(times)):
        start = np.array(start)
        exact, *beside = (_flow(series, start + off, length)
                          for off in (0, *np.eye(3) * EPS * np.abs(start).max()))
        effect = sum(np.abs(other - exact).max() for other in beside) + EPS * np.abs(exact).max()
        size = float(np.abs(end - exact).max() / (UNITS_A_STEP * effect))
        if size > 1:  # a way that takes several steps
            size /= stabilab.trajectory(scene, start, [length], laws=False).counters["steps"] + 1
        found.append((size,
                      f"from {[v.hex() for v in start.tolist()]} for {length!r}: {end.tolist()}, in {BITS} "
                      f"bits {exact.tolist()}"))
    return worst(*found)


def _speed(problem, state):
    """How fast the state changes, relative to its size."""
    return max(abs(float(r)) for r in problem.rate(state)) / (max(map(abs, state)) or 1.0)


def _braked_turns(problem, state):
    """Turns that the torque needs to use up the spin about its axis."""
    axis = next((i for i in range(3) if problem.m[i]), None)
    return 0.0 if axis is None else state[axis] ** 2 / (4 * math.pi * abs(float(problem.m[axis])))


def _one_unit_away(state):
    """The state, and it with one component after another a unit in the last place larger."""
    return [state, *(tuple(float(np.nextafter(v, np.inf)) if i == n else v for n, v in enumerate(state))
                     for i in range(3))]


def twins(scene, problem, state):
    """Renamed axes, half a turn, and units of time and mass that are powers of two: the same answers."""
    return worst(*(_twin(scene, problem, state, name, *made) for name,
                   made in _twins_of(scene, state).items()))


def _twins_of(scene, state):
    """name -> (scene, state, order of axes, signs, factor of rates, factor of energies)."""
    if scene.variables == "scaled":
        a, b, mu = scene.a, scene.b, scene.mu
        return {"half a turn": (scaled(a, b, (mu[0], -mu[1], -mu[2]))[0], _signed(state, (1, -1, -1)),
                                (0, 1, 2), (1, -1, -1), 1, 1),
                "other side": (scaled(-a, -b, (-mu[0], mu[1], -mu[2]))[0], _signed(state, (-1, 1, -1)),
                               (0, 1, 2), (-1, 1, -1), 1, 1)}
    D, (lam, M) = list(map(float, scene.body.exact)), ([float(v) for v in scene.vector(n)]
                                                       for n in ("gyrostat", "constant_torque"))
    order = (1, 2, 0)
    turn = lambda v: [v[i] for i in order]
    fast, heavy = 2.0 ** 9, 2.0 ** -7
    return {"renamed": (physical(turn(D), turn(lam), turn(M))[0], turn(state), order, (1, 1, 1), 1, 1),
            "half a turn": (physical(D, _signed(lam, (-1, 1, -1)), _signed(M, (-1, 1, -1)))[0],
                            _signed(state, (-1, 1, -1)),
                            (0, 1, 2), (-1, 1, -1), 1, 1),
            "faster": (physical(D, [v * fast for v in lam], [v * fast**2 for v in M])[0],
                       [v * fast for v in state], (0, 1, 2),
                       (1, 1, 1), fast, fast**2),
            "heavier": (physical([v * heavy for v in D], [v * heavy for v in lam], [v * heavy for v in M])[0],
                        state, (0, 1, 2),
                        (1, 1, 1), 1, heavy)}


def _signed(vector, signs):
    return [float(v) * s for v, s in zip(vector, signs)]


def _twin(scene, problem, state, name, other, image, order, signs, rate, unit):
    one, two = stabilab.fate(scene, np.array([state])), stabilab.fate(other, np.array([image]))
    if one.labels[0] != two.labels[0]:
        return WRONG, f"{name}: {Fate(int(one.labels[0])).word} and {Fate(int(two.labels[0])).word}"
    axis = next((i for i in range(3) if problem.m[i]), None)
    margins = float(one.margins[0]), float(two.margins[0]) / unit
    if axis is None:
        if math.isfinite(margins[0]) != math.isfinite(margins[1]):
            return NO_QUESTION  # without a torque the axis of the reduction is a choice
        return worst()
    if math.isfinite(margins[0]) != math.isfinite(margins[1]):
        return WRONG, f"{name}: margins {margins}"
    found = [NO_QUESTION]
    if math.isfinite(margins[0]):
        found.append(_margin_off(problem, axis, state, margins[1], margins[0], 2 * MARGIN))
    box, image_box = stabilab.extremes(scene,
                                       np.array([state]))[0], stabilab.extremes(other,
                                                                                np.array([image]))[0] / rate
    for i in range(3):
        values = [v * signs[i] for v in box[order[i]]]
        found.append(between(sorted(values), image_box[i], f"component {i + 1}"))
    times = stabilab.period(scene, np.array([state])), stabilab.period(other, np.array([image])) * rate
    found.append(between(*times, "period"))
    size, words = worst(*found)
    return size, f"{name}: {words}"


def surfaces(scene, problem, state):
    """Places of the separatrix' branches against the reduced potential in many digits: each has the energy of a
    saddle on its own orbit, up to what a few roundings of the place, measured from the centre of its conic,
    and of the potential's terms do to that."""
    acting = [i for i in range(3) if problem.m[i]]
    if not acting:
        return NO_QUESTION  # without a torque the axis of the reduction is a choice
    found = [NO_QUESTION]
    for branch in stabilab.separatrix(scene, shape=ROWS_AND_COLUMNS).branches:
        rows, columns, _ = branch.points.shape
        for row, column in ((1, columns // 2), (rows // 2, columns // 4), (rows - 1, columns - 2)):
            found.append(off_surface(problem, acting[0], branch, row, column))
    return worst(*found)


def off_surface(problem, axis, branch, row, column):
    point, (j, k) = tuple(branch.points[row, column].tolist()), CYCLE[axis]
    if not all(map(math.isfinite, point)):
        return WRONG, f"{branch.name}, row {row}: {point}"
    # of omega_j, omega_k
    centre = abs(float(problem.sigma[k] / problem.kappa[k])), abs(float(problem.rho[j] / problem.kappa[j]))
    asymptotes = (abs(problem.rho[axis] / problem.kappa[axis])
                  + abs(problem.sigma[axis] / problem.kappa[axis]) if problem.kappa[axis] else math.inf)
    if max(centre) > FAR_CENTRE * (abs(point[j]) + abs(point[k]) + float(asymptotes)):
        centre = 0.0, 0.0  # there places are told from their saddles
    u, v = abs(point[j]) + centre[0], abs(point[k]) + centre[1]
    terms = float(problem.weight[axis]) * (abs(float(problem.kappa[axis])) * u * v
                                           + abs(float(problem.rho[axis])) * v
                                           + abs(float(problem.sigma[axis])) * u + abs(float(problem.m[axis]))
                                           + point[axis] ** 2)
    unit = EPS * max(u, v, abs(point[axis]))
    beside = [tuple(v + sign * unit * (n == i) for i, v in enumerate(point)) for n in range(3)
              for sign in (-1, 1)]
    gap, *moved = (energy.from_a_saddle(problem, p, digits=_digits(p)) for p in (point, *beside))
    if gap is None or None in moved:
        # of rates 1e11 times the wheel's, about nearly equal moments, rounding of the place unmakes the
        # saddle of its orbit
        return NO_QUESTION
    shaken = float(sum(abs(other - gap) for other in moved)) + EPS * terms
    return float(gap) / (ROUNDINGS
                         * shaken), f"{branch.name}, row {row}, column {column}: {point} is {float(gap):.3g} off in energy; rounding: {shaken:.3g}"


DISAGREEMENTS = {f.__name__: f for f in (certified, oracle, one_state, methods, twins, surfaces)}
