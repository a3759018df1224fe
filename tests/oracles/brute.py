"""The fate by running the motion: heyoka's Taylor integrator in double precision, with
events.

Decision rule, for a torque on axis i whose angle alpha (alpha' = w = x_i + h) reduces the motion, torque sign
e:
* bounded once w crosses zero against the torque (e w falling): the motion (alpha, w) -> (alpha, -w) is
reversible, so
  it runs back the way it came, and it has a turning point on the uphill side too;
* spin-up once e alpha has gained a whole turn of the conic (elliptic case): the same conic point is met again
with more
  energy, so the next turn is passed as well, and so on.
For the hyperbolic case there is no turn: w must cross zero twice (periodic) within `patience` time units.
"""
from __future__ import annotations

from functools import cache

import numpy as np

from tests.oracles.energy import Reduced
from tests.oracles.model import CYCLE, Model


class Undecided(RuntimeError):
    """Neither rule fired in time."""


@cache
def _integrator(axis: int):
    """(integrator, log of events): states x1, x2, x3, alpha; parameters kappa, rho, sigma, m (3 each), h,
    sign e, turn."""
    import heyoka as hy
    x = hy.make_vars("x1", "x2", "x3")
    alpha = hy.make_vars("alpha")
    par = hy.par
    rates = [par[i] * x[j] * x[k] + par[3 + i] * x[k] + par[6 + i] * x[j] + par[9 + i] for i,
             (j, k) in enumerate(CYCLE)]
    w = x[axis] + par[12]
    log = []

    def record(kind):
        def callback(integrator, time, sign):
            log.append((kind, time, sign))
        return callback

    events = [hy.nt_event(rates[i], callback=record(i)) for i in range(3)]
    events += [hy.nt_event(w, callback=record("w")),
               hy.nt_event(par[13] * alpha - par[14], callback=record("turn"))]
    system = [(v, r) for v, r in zip(x, rates)] + [(alpha, w)]
    return hy.taylor_adaptive(system, state=[1.0, 1.0, 1.0, 0.0], pars=[0.0] * 15, nt_events=events), log


def _prepare(model: Model, state):
    motion = Reduced(model, state, 40)
    integrator, log = _integrator(motion.i)
    sign = 1.0 if motion.tilt > 0 else -1.0
    turn = float(motion.turn) if motion.kind == "elliptic" else 1.0
    pars = [float(v) for row in (model.kappa, model.rho, model.sigma, model.m) for v in row]
    # 0: the event of a full turn never fires
    pars += [float(motion.h), sign if motion.kind == "elliptic" else 0.0, turn]
    integrator.pars[:] = pars
    integrator.time = 0.0
    integrator.state[:] = [*map(float, state), 0.0]
    log.clear()
    return motion, integrator, log, sign


def _run(model, state, stop, patience):
    """Step until stop(log) is true; returns (motion, integrator, log, sign, rows): rows are (event kind,
    time, state)."""
    motion, integrator, log, sign = _prepare(model, state)
    rows = []
    while integrator.time < patience:
        integrator.step(max_delta_t=patience, write_tc=True)
        for kind, time, direction in log:
            integrator.update_d_output(time)
            rows.append((kind, time, int(direction), np.array(integrator.d_output[:3])))
        log.clear()
        if stop(rows):
            return motion, sign, sorted(rows, key=lambda r: r[1])
    raise Undecided(f"no decision by t = {patience}")


def label(model: Model, state, patience=1e4):
    """"bounded" or "spin-up" by the rule above. Raises Undecided."""
    motion = Reduced(model, state, 40)
    sign = 1 if motion.tilt > 0 else -1
    if motion.kind == "elliptic":
        def stop(rows):
            return any(k == "turn" or (k == "w" and d == -sign) for k, _, d, _ in rows)
        _, _, rows = _run(model, state, stop, patience)
        for kind, _, direction, _ in rows:
            if kind == "turn":
                return "spin-up"
            if kind == "w" and direction == -sign:
                return "bounded"
    _run(model, state, lambda rows: sum(k == "w" for k, *_ in rows) >= 2, patience)
    return "bounded"
