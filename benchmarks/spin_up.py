"""Spin-up under torques of any direction: how much is decided, by when and at what cost; many states of a
scene beside heyoka's own batches run to the times of the certificates.

python -m benchmarks.spin_up SEED SCENES [TIMES STEPS SECONDS
CONTINUED]: random bodies (half generic, the rest flat, rods, nearly equal moments), the torque uniform on the
sphere, wheels of 0, 0.1, 1, 10 and states of 0.1 to 30 natural units.
"""
from __future__ import annotations

import math
import random
import statistics
import sys
import time
from fractions import Fraction
from functools import lru_cache, partial

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up.follow import spin_up

from .rows import Row, numba_available

WHEELS, SHARES, RATES = (0, .1, 1, 10), (40, 20, 25, 15), (.1, 1, 3, 10, 30)
KINDS = ("generic", "flat", "rod", "near")


def measurements(small=False):
    if small:
        return [partial(pace, 1, 24, 50.0, 300), partial(one_by_one, 3)]
    return [*(partial(pace, 10, states) for states in (10, 100, 1000)), one_by_one]


def random_scene(rng):
    """(scene, state, kind, size of the wheel), in natural units."""
    kind = rng.choices(KINDS, (3, 1, 1, 1))[0]
    second = [rng.uniform(.02, 1) for _ in range(3)]
    i = rng.randrange(3)
    if kind == "flat":
        second[i] = rng.uniform(0, .02)
    elif kind == "rod":
        second = [1 if k == i else rng.uniform(0, .05) for k in range(3)]
    elif kind == "near":
        second[(i + 1) % 3] = second[i] * (1 + 10**rng.uniform(-3, -1) * rng.choice((-1, 1)))
    a, b, c = (Fraction(v) for v in second)
    D = [b + c, a + c, a + b]
    D = tuple(3 * v / sum(D) for v in D)
    wheel = rng.choices(WHEELS, SHARES)[0]
    size = rng.choice(RATES)
    scene = Scene(Body(D), Gyrostat(_sphere(rng, wheel)), ConstantTorque(_sphere(rng, 1)))
    return scene, _sphere(rng, size), kind, wheel


def _sphere(rng, size):
    v = [rng.gauss(0, 1) for _ in range(3)]
    return tuple(size * x / math.hypot(*v) for x in v)


def violations(scene, answer, span: float, points: int = 400) -> list[str]:
    """Where a run by a compiled Runge-Kutta formula leaves what the trap allows, over a span after it."""
    import numpy as np
    trap, i, c = answer.trap, answer.axis - 1, np.array(scene.quadratic().coefficients)
    pace = 1 + np.abs(c[1:3]).max() * 2 + max(map(abs, answer.state))
    span = min(span, 2e3 / pace)  # some three hundred turns
    times = np.linspace(answer.t, answer.t + span, points)
    run = _runge_kutta()(c, np.array(answer.state), times)
    spin = run @ np.array(answer.direction)
    low, high = np.array([trap.line(t) for t in times]).T
    wrong = [f"line {side}" for side,
             bad in (("below", spin < low * (1 - 1e-7)), ("above", spin > high * (1 + 1e-7))) if bad.any()]
    wrong += [f"axis {n + 1}" for n, (a, b) in enumerate(trap.bounds()) if n != i
              and ((run[:, n] < a) | (run[:, n] > b)).any()]
    for share in (.5, .9):
        limit = spin[0] + share * (spin[-1] - spin[0])
        early, late = trap.clock(limit)
        reached = times[np.argmax(spin >= limit)]
        step = times[1] - times[0]
        wrong += ["clock"] if early > reached or late < reached - step else []
    return wrong


@lru_cache(maxsize=1)
def _runge_kutta():
    """The classical formula of order 4 at a hundredth of a radian a step (its loss of amplitude is h^5/144 a
    radian)."""
    import numpy as np
    from numba import njit

    @njit
    def rates(c, y, out):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            out[i] = c[0, i] * y[j] * y[k] + c[1, i] * y[k] + c[2, i] * y[j] + c[3, i]

    @njit
    def run(c, start, times):
        out, y, k, total = np.empty((times.size, 3)), start.copy(), np.empty(3), np.empty(3)
        out[0] = y
        wheel = np.abs(c[1]).max() + np.abs(c[2]).max()
        for n in range(1, times.size):
            span = times[n] - times[n - 1]
            steps = int(span * (1 + wheel + np.abs(y).max() + span * np.abs(c[3]).max()) / 0.01) + 1
            h = span / steps
            for _ in range(steps):
                rates(c, y, k)
                total[:] = k
                rates(c, y + 0.5 * h * k, k)
                total += 2 * k
                rates(c, y + 0.5 * h * k, k)
                total += 2 * k
                rates(c, y + h * k, k)
                total += k
                y += h / 6 * total
            out[n] = y
        return out
    return run


def main(seed=1, scenes=100, times=2000.0, steps=60_000, seconds=170.0, continued=0.0):
    """Prints the table; returns the rows (kind, wheel, answer, milliseconds, violations)."""
    rng, rows, begun = random.Random(seed), [], time.perf_counter()
    for _ in range(scenes):
        scene, state, kind, wheel = random_scene(rng)
        at = time.perf_counter()
        answer = spin_up(scene, state, times, steps, fast=numba_available())
        took = 1e3 * (time.perf_counter() - at)
        wrong = violations(scene, answer, continued) if continued and answer.level == "certified" else []
        rows.append((kind, wheel, answer, took, wrong))
        if time.perf_counter() - begun > seconds:
            break
    _table(rows, continued)
    return rows


def pace(scenes=10, states=1000, times=2000.0, steps=20_000, seed=1) -> Row:
    """What deciding a state of a scene costs beside its raw integration by heyoka's batches up to the same
    time, processor times."""
    import numpy as np

    from stabilab.unreduced.spin_up.follow import spin_up_many
    rng, total, ratios, left = random.Random(seed), np.zeros(2), [], 0
    for number in range(scenes + 1):
        scene = random_scene(rng)[0]
        starts = np.array([_sphere(rng, rng.choice(RATES)) for _ in range(states)])
        at = time.process_time()
        found = spin_up_many(scene, starts, times, steps)
        ours = time.process_time() - at
        raw = _raw(scene, starts, found.t)
        if number:  # the first one compiles
            total += ours, raw
            # a clock of ticks may see none go by
            ratios.append(raw / ours if raw and ours else 1.0)
            left += int((found.level == 0).sum())
    ratios.sort()
    ours, raw = (max(float(v), 1e-9) / (scenes * states) for v in total)
    return Row(f"spin-up-{states}", f"{states} states of each of {scenes} random scenes, torque off the "
               "axes, decided", ours, "each", raw, "raw integration by heyoka's batches to the same times",
               raw / ours,
               min(ratios[0], raw / ours), max(ratios[-1], raw / ours), f"{left} undecided", 1 / 1.5,
               "processor time; the ratio is that of all scenes together, its range that of single scenes; "
               "ours evaluates the certificate as well, whose tables a scene needs once")


def one_by_one(scenes=200) -> list[Row]:
    """One state of each of many new scenes: the certificate, and with the proof, where one was found;
    medians of processor time."""
    from stabilab.unreduced.enclosure import proved
    rng, certified, sure, fast = random.Random(7), [], [], numba_available()
    for number in range(scenes + 1):
        scene, state, *_ = random_scene(rng)
        at = time.process_time()
        found = spin_up(scene, state, fast=fast)
        took = time.process_time() - at
        done = found.level == "certified" and number % 4 == 1 and proved(
            scene, state, found, fast=fast).level == "proved"
        if number:  # the first one loads what is compiled
            certified.append(took)
            sure += [time.process_time() - at] * done
    what = "random scenes, torque off the axes, one state each: "
    return [Row("spin-up-one", f"{len(certified)} {what}certified, median", statistics.median(certified)),
            *(Row("spin-up-one-proved", f"{len(sure)} {what}proved, median", statistics.median(sure))
              for _ in sure[:1])]


def _raw(scene, starts, times):
    """Processor time of heyoka's batch integrator for the same starts and times, eight lanes of like times
    together."""
    import heyoka
    import numpy as np
    D, l, M = ([float(v) for v in vector]
               for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))
    x = heyoka.make_vars("x", "y", "z")
    rates = [(M[i] + (D[j] - D[k]) * x[j] * x[k] + l[j] * x[k] - l[k] * x[j]) / D[i] for i, j,
             k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    ta = heyoka.taylor_adaptive_batch(list(zip(x, rates)), np.zeros((3, 8)), tol=2.0**-53)
    order = np.argsort(times)
    order = np.append(order, np.repeat(order[-1:], -len(order) % 8)).reshape(-1, 8)
    at = time.process_time()
    for group in order:
        ta.set_time(0.0)
        ta.state[:] = starts[group].T
        ta.propagate_until(times[group])
    return time.process_time() - at


def _table(rows, continued):
    print(f"{'':>12}{'scenes':>7}{'t<10':>7}{'<100':>7}{'<1e3':>7}{'<5e3':>7}{'all':>7}{'1e3 st':>8}"
          f"{'1e4':>7}{'1e5':>7}{'med t':>8}{'steps':>7}{'ms':>7}")
    groups = ([(f"wheel {w}", [r for r in rows if r[1] == w]) for w in WHEELS]
              + [(k, [r for r in rows if r[0] == k]) for k in KINDS])
    groups += [("generic l<=1", [r for r in rows if r[0] == "generic" and r[1] <= 1]), ("all", rows)]
    for name, group in groups:
        if group:
            print(f"{name:>12}{len(group):7d}" + _line(group))
    for kind, wheel, answer, _, wrong in rows:
        if answer.level == "undecided":
            print(f"undecided {kind} {wheel}: {answer.cause}")
        if wrong:
            print("VIOLATION", kind, wheel, wrong, answer)
    forms = [(r[2].trap.form, r[2].trap.orders) for r in rows if r[2].level == "certified"]
    print({form: forms.count(form) for form in sorted(set(forms))})
    if continued:
        print("continued beyond the certificate:", len(forms), "violations:",
              sum(bool(row[4]) for row in rows))


def _line(group):
    good = [r[2] for r in group if r[2].level != "undecided"]
    def share(test):
        return f"{sum(map(test, good)) / len(group):7.3f}"
    text = "".join(share(lambda a, t=t: a.t < t) for t in (10, 100, 1000, 5000, math.inf))
    text += " " + "".join(share(lambda a, n=n: a.steps < n) for n in (1e3, 1e4, 1e5))
    middle = lambda values: sorted(values)[len(values) // 2]
    return (text
            + f"{middle([r[2].t for r in group]):8.3g}{middle([r[2].steps for r in group]):7d}"
              f"{middle([r[3] for r in group]):7.1f}")


if __name__ == "__main__":
    kinds = (int, int, float, lambda v: int(float(v)), float, float)
    main(*(kind(v) for kind, v in zip(kinds, sys.argv[1:])))
