"""Whether a motion is held or spins up by running it: heyoka's Taylor integrator in double precision, with
events.

Decision rule, for a torque on axis i whose angle alpha (alpha' = w = x_i + h) reduces the motion, torque sign e:
* bounded once w crosses zero against the torque (e w falling): the motion (alpha, w) -> (alpha, -w) is
  reversible, so it runs back the way it came, and it has a turning point on the uphill side too;
* spin-up once e alpha has gained a whole turn of the conic (elliptic case): the same conic point is met again
  with more energy, so the next turn is passed as well, and so on.
For the hyperbolic case there is no turn: w must cross zero twice (periodic) within `patience` time units.
"""
from __future__ import annotations

from functools import cache

from tests.oracles.energy import Reduced
from tests.oracles.model import CYCLE, Model


class Undecided(RuntimeError):
    """Neither rule fired in time."""


@cache
def _integrator(axis: int):
    """(integrator, log of events): states x1, x2, x3, alpha; parameters kappa, rho, sigma, m (3 each), h,
    sign e, turn."""
    import heyoka as hy
    x, alpha, par, log = hy.make_vars("x1", "x2", "x3"), hy.make_vars("alpha"), hy.par, []
    rates = [par[i] * x[j] * x[k] + par[3 + i] * x[k] + par[6 + i] * x[j] + par[9 + i] for i,
             (j, k) in enumerate(CYCLE)]
    w = x[axis] + par[12]
    noted = lambda kind: lambda _, time, sign: log.append((time, kind, int(sign)))
    events = [hy.nt_event(w, noted("w")), hy.nt_event(par[13] * alpha - par[14], noted("turn"))]
    return hy.taylor_adaptive([*zip(x, rates), (alpha, w)], [1.0, 1.0, 1.0, 0.0], pars=[0.0] * 15,
                              nt_events=events), log


def label(model: Model, state, patience=1e4):
    """"bounded" or "spin-up" by the rule above. Raises Undecided."""
    motion = Reduced(model, state, 40)
    integrator, log = _integrator(motion.i)
    closed, sign = motion.kind == "elliptic", 1 if motion.tilt > 0 else -1
    # sign 0: the event of a full turn never fires
    integrator.pars[:] = [*(float(v) for row in (model.kappa, model.rho, model.sigma, model.m) for v in row),
                          float(motion.h), float(sign * closed), float(motion.turn) if closed else 1.0]
    integrator.time, integrator.state[:], zeros = 0.0, [*map(float, state), 0.0], 0
    log.clear()
    while integrator.time < patience:
        integrator.step(max_delta_t=patience)
        for _, kind, direction in sorted(log):
            if kind == "turn":
                return "spin-up"
            zeros += 1
            if direction == -sign if closed else zeros == 2:
                return "bounded"
        log.clear()
    raise Undecided(f"no decision by t = {patience}")
