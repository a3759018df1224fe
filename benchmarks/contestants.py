"""What a careful user of the general tools would write: heyoka's batch mode with compaction, heyoka and SciPy
with events."""
from __future__ import annotations

import numpy as np


def scaled_minor_system(a, b, heyoka):
    """The paper's minor-axis system with the turn angle as a fourth state (theta' = x3)."""
    x1, x2, x3, theta = heyoka.make_vars("x1", "x2", "x3", "theta")
    return (x1, x2, x3, theta), [(x1, x2 * x3), (x2, -x3 * (x1 + a)), (x3, x2 * (x1 + b) + 1.0),
                                 (theta, x3 + 0.0 * x1)]


def turning_system(scene, heyoka):
    """(variables, equations, axis, turn) of a scene whose torque is on a principal axis, with the turn angle
    about it as fourth state, positive in the torque's direction; turn: a full one, infinite where the angle
    is hyperbolic."""
    x = heyoka.make_vars("x1", "x2", "x3", "theta")
    form = scene.quadratic()
    kappa, rho, sigma, m = form.coefficients
    rates = [kappa[i] * x[j] * x[k] + rho[i] * x[k] + sigma[i] * x[j] + m[i] for i, j,
             k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    axis = int(np.flatnonzero(m)[0])
    product = kappa[(axis + 1) % 3] * kappa[(axis + 2) % 3]
    angle_rate = np.sign(m[axis]) * np.sqrt(abs(product)) * x[axis] + 0.0 * x[axis - 1]
    return x, [*zip(x, rates), (x[3], angle_rate)], axis, 2 * np.pi if product < 0 else np.inf


class BatchFate:
    """Integrate in batches until each state is decided: a full turn ahead is spin-up, the third reversal of
    the turn is bounded (two reversals enclose the well). Decided states leave their lane at once
    (compaction). A motion that leaves the range of doubles stays undecided, and after so many steps of the
    batch in all what is left."""

    def __init__(self, scene, tolerance=1e-15, batch=8, steps=None):
        import heyoka
        _, system, self.axis, self.turn = turning_system(scene, heyoka)
        self.sense = np.sign(scene.quadratic().coefficients[3][self.axis])
        self.batch, self.steps = batch, steps
        self.integrator = heyoka.taylor_adaptive_batch(system, np.zeros((4, batch)), tol=tolerance,
                                                       high_accuracy=False)

    def __call__(self, states):
        """Labels (n,): 0 bounded, 1 spin-up, -1 undecided."""
        n, batch, ta, axis, turn = len(states), self.batch, self.integrator, self.axis, self.turn
        start_sign = np.sign(self.sense * states[:, axis])
        labels = np.full(n, -1, np.int8)
        lane, following = np.full(batch, -1), 0
        reversals, sign = np.zeros(batch, int), np.zeros(batch)
        lowest = np.zeros(batch)
        state = ta.state
        for i in range(batch):
            if following < n:
                state[:3, i], state[3, i] = states[following], 0.0
                lane[i], sign[i], reversals[i], lowest[i] = following, start_sign[following], 0, 0.0
                following += 1
        taken = 0
        while (lane >= 0).any() and taken != self.steps:
            ta.step()
            taken += 1
            rate, theta = self.sense * state[axis], state[3]
            lowest = np.minimum(lowest, theta)
            turned = (np.sign(rate) != sign) & (rate != 0)
            reversals += turned
            sign = np.where(turned, np.sign(rate), sign)
            lost = theta != theta
            done = (lane >= 0) & ((rate > 0) & (theta > lowest + turn) | (reversals >= 3) | lost)
            if done.any():
                for i in np.nonzero(done)[0]:
                    labels[lane[i]] = -1 if lost[i] else 0 if reversals[i] >= 3 else 1
                    if following < n:
                        state[:3, i], state[3, i] = states[following], 0.0
                        lane[i], sign[i], reversals[i], lowest[i] = following, start_sign[following], 0, 0.0
                        following += 1
                    else:
                        lane[i] = -1
                        state[:, i] = 0.0
        return labels


class SciPyFate:
    """The same decision with SciPy's DOP853 and its events, one state after the other; as tight as it goes,
    for an energy that is off by 1e-9 gives wrong labels within 1e-9 of the separatrix."""

    def __init__(self, scene, rtol=1e-13, atol=1e-14):
        kappa, rho, sigma, m = scene.quadratic().coefficients
        (k1, k2, k3), (r1, r2, r3), (s1, s2, s3), (m1, m2, m3) = kappa, rho, sigma, m
        self.axis = int(np.flatnonzero(m)[0])
        product = kappa[(self.axis + 1) % 3] * kappa[(self.axis + 2) % 3]
        axis, factor, turn = self.axis, np.sign(m[self.axis]) * np.sqrt(
            abs(product)), 2 * np.pi if product < 0 else np.inf
        self.rtol, self.atol = rtol, atol

        def rates(t, y):
            a, b, c, _ = y.tolist()
            return (k1 * b * c + r1 * c + s1 * b + m1, k2 * c * a + r2 * a + s2 * c + m2,
                    k3 * a * b + r3 * b + s3 * a + m3,
                    factor * y[axis])

        def reversal(t, y):
            return y[axis]

        def spun(t, y):
            self.lowest = min(self.lowest, y[3])
            return y[3] - self.lowest - turn
        reversal.terminal, spun.terminal = 3, True
        self.rates, self.events = rates, (reversal, spun)

    def __call__(self, states):
        """Labels (n,): 0 bounded, 1 spin-up."""
        from scipy.integrate import solve_ivp
        labels = np.empty(len(states), np.int8)
        for n, state in enumerate(states):
            self.lowest = 0.0
            run = solve_ivp(self.rates, (0.0, 1e6), [*state, 0.0], method="DOP853", rtol=self.rtol,
                            atol=self.atol,
                            events=self.events)
            labels[n] = len(run.t_events[0]) < 3
        return labels


class EventExtremes:
    """Extremes over one period: heyoka with events at the zeros of each rate, stopped at the third reversal
    of the turn."""

    def __init__(self, a, b, tolerance=1e-16):
        import heyoka
        (x1, x2, x3, theta), system = scaled_minor_system(a, b, heyoka)
        self.values = []

        def note(ta, time, sign, component):
            ta.update_d_output(time)
            self.values.append((component, ta.d_output[component]))
        rates = (x2 * x3, -x3 * (x1 + a), x2 * (x1 + b) + 1.0)
        events = [heyoka.nt_event(rate, lambda ta, t, s, k=k: note(ta, t, s, k)) for k,
                  rate in enumerate(rates)]
        self.reversals = 0

        def turned(ta, sign):
            # x1 and x2 are extreme where x3 = 0: the stop cuts the step there, so note them here
            self.values += [(0, ta.state[0]), (1, ta.state[1])]
            self.reversals += 1
            return self.reversals < 3
        stop = heyoka.t_event(x3, callback=turned)
        self.integrator = heyoka.taylor_adaptive(system, [0.0] * 4, tol=tolerance, nt_events=events,
                                                 t_events=[stop])

    def __call__(self, states):
        out = np.empty((len(states), 3, 2))
        ta = self.integrator
        for n, state in enumerate(states):
            ta.time, ta.state[:], self.reversals = 0.0, [*state, 0.0], 0
            ta.reset_cooldowns()
            self.values.clear()
            ta.propagate_until(1e4)
            out[n] = np.stack([state, state], axis=1)
            for k, value in self.values:
                out[n, k] = min(out[n, k, 0], value), max(out[n, k, 1], value)
        return out


class SceneEvents:
    """Extremes over one period of any scene with its torque on a principal axis: events at the zeros of each
    rate, stopped at the third reversal of the turn, or after so many steps."""

    def __init__(self, scene, tolerance=1e-16, steps=100_000):
        import heyoka
        x, system, axis, _ = turning_system(scene, heyoka)
        self.values, self.reversals, across = [], 0, [k for k in range(3) if k != axis]
        self.steps = steps

        def note(ta, time, sign, component):
            ta.update_d_output(time)
            self.values.append((component, ta.d_output[component]))

        def turned(ta, sign):
            # the two rates across the axis are extreme there: the stop cuts the step, so note them here
            self.values += [(k, ta.state[k]) for k in across]
            self.reversals += 1
            return self.reversals < 3
        form = scene.quadratic()
        changing = [any(part[k] for part in (form.kappa, form.rho, form.sigma)) for k in range(3)]
        events = [heyoka.nt_event(rate, lambda ta, t, s, k=k: note(ta, t, s, k)) for k,
                  (_, rate) in enumerate(system[:3]) if changing[k]]  # heyoka takes no constants
        self.integrator = heyoka.taylor_adaptive(system, [0.0] * 4, tol=tolerance, nt_events=events,
                                                 t_events=[heyoka.t_event(x[axis], callback=turned)])

    def __call__(self, states):
        out, ta = np.empty((len(states), 3, 2)), self.integrator
        for n, state in enumerate(states):
            ta.time, ta.state[:], self.reversals = 0.0, [*state, 0.0], 0
            ta.reset_cooldowns()
            self.values.clear()
            ta.propagate_until(1e9, max_steps=self.steps)
            out[n] = np.stack([state, state], axis=1)
            for k, value in self.values:
                out[n, k] = min(out[n, k, 0], value), max(out[n, k, 1], value)
        return out


class TurningTimes:
    """Periods of any scene with its torque on a principal axis: one terminal event at each reversal of the
    turn, stopped at the third, or after so many steps."""

    def __init__(self, scene, tolerance=1e-16, steps=100_000):
        import heyoka
        x, system, axis, _ = turning_system(scene, heyoka)
        self.times, self.steps = [], steps

        def turned(ta, sign):
            self.times.append(ta.time)
            return len(self.times) < 3
        self.integrator = heyoka.taylor_adaptive(system, [0.0] * 4, tol=tolerance,
                                                 t_events=[heyoka.t_event(x[axis], callback=turned)])

    def __call__(self, states):
        periods, ta = np.empty(len(states)), self.integrator
        for n, state in enumerate(states):
            ta.time, ta.state[:] = 0.0, [*state, 0.0]
            ta.reset_cooldowns()
            self.times.clear()
            ta.propagate_until(1e9, max_steps=self.steps)
            periods[n] = self.times[2] - self.times[0] if len(self.times) > 2 else np.nan
        return periods


def off_axis_rates(inertia, moment, torque):
    """(variable, rate) of Euler's equations with numbers for coefficients, multiplied out: the fastest of the
    forms tried."""
    import heyoka
    (D1, D2, D3), (h1, h2, h3), (M1, M2, M3) = inertia, moment, torque
    p, q, r = heyoka.make_vars("p", "q", "r")
    return [(p, (D2 - D3) / D1 * q * r + h2 / D1 * r - h3 / D1 * q + M1 / D1),
            (q, (D3 - D1) / D2 * r * p + h3 / D2 * p - h1 / D2 * r + M2 / D2),
            (r, (D1 - D2) / D3 * p * q + h1 / D3 * q - h2 / D3 * p + M3 / D3)]


def with_effects(inertia, moment, torque, c=0.0, kappa=0.0, centre=(0.0, 0.0, 0.0), turning=0.0):
    """The same with more effects, as one writes them by hand, only those asked for: c of a medium, kappa of a
    liquid (omega'' + omega x omega' along the motion without small effects), `centre` the weight times the
    centre of mass, `turning` e H l^2 of a charge whose angle follows the attitude. gamma rides along where
    needed."""
    import heyoka
    system = off_axis_rates(inertia, moment, torque)
    w = [variable for variable, _ in system]
    more = [[] for _ in w]
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    if c:
        more = [[-c * one] for one in w]
    g = heyoka.make_vars("f", "g", "h") if any(centre) or turning else ()
    pulls = cross(centre, g) if any(centre) else ()
    for terms, D, pull in zip(more, inertia, pulls):
        terms.append(pull / D)
    if kappa:
        free = [rate for _, rate in off_axis_rates(inertia, moment, (0.0, 0.0, 0.0))]
        H = [D * one + h for D, one, h in zip(inertia, w, moment)]
        free = [rate + pull / D for rate, pull, D in zip(free, pulls, inertia)] if pulls else free
        bent = [a + b for a, b in zip(cross([D * one for D, one in zip(inertia, free)], w), cross(H, free))]
        bent = [a + b for a, b in zip(bent, cross(centre, cross(g, w)))] if pulls else bent
        for terms, D, a, b in zip(more, inertia, bent, cross(w, free)):
            terms.append(kappa / D * (a / D + b))
    if turning:
        more[0].append(turning / inertia[0] * g[2] * w[1])
        more[1].append(-turning / inertia[1] * g[2] * w[0])
    return [*((one, sum(terms, rate)) for (one, rate), terms in zip(system, more)),
            *zip(g, cross(g, w) if g else ())]


class BatchSpinUp:
    """Follow motions off the axes in batches until the largest rate passes HIGH, and name its axis with the
    sign. Decided motions leave their lane at once (compaction)."""

    HIGH = 10.0

    def __init__(self, scene, tolerance=1e-15, batch=8):
        import heyoka
        inertia, moment, torque = ([float(c) for c in part]
                                   for part in (scene.body.exact, scene.vector("gyrostat"),
                                                scene.vector("constant_torque")))
        self.batch = batch
        self.integrator = heyoka.taylor_adaptive_batch(off_axis_rates(inertia, moment, torque),
                                                       np.zeros((3, batch)), tol=tolerance)

    def __call__(self, states):
        """(n,): the axis 1, 2 or 3 with the sign of its rate."""
        ta, batch, waiting = self.integrator, self.batch, list(range(len(states)))[::-1]
        lane, found = [None] * batch, np.zeros(len(states), int)
        while True:
            for i in range(batch):
                if lane[i] is None:
                    lane[i] = waiting.pop() if waiting else None
                    ta.state[:, i] = states[lane[i]] if lane[i] is not None else 0.0
            if all(number is None for number in lane):
                return found
            ta.step()
            largest = np.abs(ta.state).max(axis=0)
            for i in np.flatnonzero(largest > self.HIGH):
                if lane[i] is not None:
                    axis = int(np.abs(ta.state[:, i]).argmax())
                    found[lane[i]], lane[i] = (axis + 1) * int(np.sign(ta.state[axis, i])), None


class ScalarRuns:
    """States of one motion on a grid of times that begins at 0, compiled beforehand."""

    def __init__(self, system, tolerance):
        import heyoka
        self.integrator = heyoka.taylor_adaptive(system, [0.0] * len(system), tol=tolerance)

    def __call__(self, start, times):
        ta = self.integrator
        ta.time = 0.0
        ta.state[:] = start
        return ta.propagate_grid(times)[-1]


class BatchRuns:
    """States of many motions on a grid of times that begins at 0, `lanes` at a time; their number is a
    multiple of that or the last row starts earlier."""

    def __init__(self, system, tolerance, lanes=8):
        import heyoka
        self.lanes, self.integrator = lanes, heyoka.taylor_adaptive_batch(system,
                                                                          np.zeros((len(system), lanes)),
                                                                          tol=tolerance)

    def __call__(self, states, times):
        ta, lanes, n = self.integrator, self.lanes, len(states)
        grid, out = np.repeat(times[:, None], lanes, axis=1), np.empty((n, len(times), states.shape[1]))
        for first in range(0, n, lanes):
            part = slice(min(first, n - lanes), min(first, n - lanes) + lanes)
            ta.set_time(0.0)
            ta.state[:] = states[part].T
            out[part] = ta.propagate_grid(grid)[1].transpose(2, 0, 1)
        return out
