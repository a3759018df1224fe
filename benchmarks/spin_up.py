"""Spin-up under torques of any direction: how much is decided, by when and at what cost; none against a run
of another kind.

python -m benchmarks.spin_up pace SEED SCENES STATES: many states of a scene beside heyoka's own batches run
to the times at which the certificates fire. python -m benchmarks.spin_up SEED SCENES [TIMES STEPS SECONDS
CONTINUED]: random bodies (half generic, the rest flat, rods, nearly equal moments), the torque uniform on the
sphere, wheels of 0, 0.1, 1, 10 and states of 0.1 to 30 natural units.
"""
from __future__ import annotations

import math
import random
import sys
import time
from fractions import Fraction
from functools import lru_cache

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up.follow import spin_up

from .rows import numba_available

WHEELS, SHARES, RATES = (0, .1, 1, 10), (40, 20, 25, 15), (.1, 1, 3, 10, 30)
KINDS = ("generic", "flat", "rod", "near")


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


def pace(seed=1, scenes=10, states=1000, times=2000.0, steps=20_000):
    """Prints, by scene, what deciding a state costs beside its raw integration by heyoka's batches up to the
    same time; returns (ours, raw), s."""
    import numpy as np

    from stabilab.unreduced.spin_up.follow import spin_up_many
    rng, total, ratios = random.Random(seed), np.zeros(2), []
    print(f"{'':>8}{'wheel':>6}{'undecided':>10}{'steps':>9}{'ours us':>9}{'raw us':>9}{'ratio':>7}")
    for number in range(scenes + 1):
        scene, _, kind, wheel = random_scene(rng)
        starts = np.array([_sphere(rng, rng.choice(RATES)) for _ in range(states)])
        at = time.process_time()
        found = spin_up_many(scene, starts, times, steps)
        ours = time.process_time() - at
        raw = _raw(scene, starts, found.t)
        if number:  # the first one compiles
            total += ours, raw
            ratios.append(ours / raw if raw else np.inf)  # a clock of ticks may see none go by
            left = int((found.level == 0).sum())
            print(f"{kind:>8}{wheel:6}{left:10d}{found.steps.mean():9.0f}{1e6 * ours / states:9.1f}"
                  f"{1e6 * raw / states:9.1f}{ratios[-1]:7.2f}")
    print(
        f"all together: {total[0] / total[1]:.2f} times the raw integration; median of the scenes "
        f"{sorted(ratios)[len(ratios) // 2]:.2f}")
    return tuple(total)


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
    if sys.argv[1:2] == ["pace"]:
        pace(*map(int, sys.argv[2:]))
    else:
        kinds = (int, int, float, lambda v: int(float(v)), float, float)
        main(*(kind(v) for kind, v in zip(kinds, sys.argv[1:])))
