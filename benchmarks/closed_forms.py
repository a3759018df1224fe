"""The charged, nearly axisymmetric body: closed forms against its linear model integrated by heyoka."""
from __future__ import annotations

from functools import partial

import numpy as np

from stabilab.integrate.to_heyoka import TAYLOR_TOLERANCE
from stabilab.theories.charged import solution
from stabilab.theories.charged_modes import ChargedBody

from .rows import Row, against
from .timing import side_by_side

# the body of Galal et al. at 2.7 turns a minute, with a start, torque and force that leave no term out;
# decimals exact
VALUES = dict(D1=8.75, D2=8.5, D3=11.0, r0=0.28125, lambda3=1.25, k=0.3125, M1=0.0625, M2=-0.03125,
              p0=0.03125, q0=-0.0625,
              psi0=0.03125, phi0=0.015625, theta0=0.375, f1=0.25, f2=-0.75, f3=3.0, m=10.0, v1=0.125,
              v2=-0.25, v3=0.375,
              x1=1.0, x2=-2.0, x3=0.5)
SPANS = ((50.0, "the paper's span"), (86_400.0, "a day"), (604_800.0, "a week"), (31_557_600.0, "a year"))
TIMES, CHECKED = 1000, 4


def measurements(small=False):
    return [partial(against_linear_model, *span, **({"count": 5, "rounds": 2} if small else {}))
            for span in SPANS[:2 if small else None]]


def body():
    """VALUES as the closed forms take them."""
    get = lambda *names: [VALUES[n] for n in names]
    return ChargedBody(get("D1", "D2", "D3"), VALUES["r0"], VALUES["lambda3"], VALUES["k"], get("M1", "M2"),
                       get("p0", "q0"),
                       get("psi0", "phi0", "theta0"), get("f1", "f2", "f3"), VALUES["m"],
                       get("v1", "v2", "v3"), get("x1", "x2", "x3"))


def against_linear_model(span, name, count=TIMES, rounds=7) -> Row:
    """`count` output times over the span: rates, angles, momentum, velocity and position against heyoka's
    rates, angles, velocity and position; the errors are those at a few of the times against the matrix
    exponential in 156 digits."""
    times, one, raw = np.linspace(0.0, span, count), body(), LinearRuns(VALUES, TAYLOR_TOLERANCE)
    # calls a round
    ours, theirs = (1, 1) if rounds < 7 else (5 if span < 1e3 else 50, 50 if span < 1e3 else 1)
    timed = side_by_side(lambda: [solution(one, times) for _ in range(ours)],
                         lambda: [raw(times) for _ in range(theirs)],
                         ours, theirs, min(rounds, 3) if span > 1e7 else rounds)
    ours = solution(one, times)
    ours = np.concatenate([ours.omega[:, :2], ours.angles[:, :2], ours.velocity, ours.position], axis=1)
    errors = "largest relative error: ours {:.0e}, theirs {:.0e}".format(*_errors(times, ours, raw(times)))
    return against(f"charged-{name.split()[-1]}", f"charged body, {count} times over {name}, "
                   f"{span * VALUES['r0'] / (2 * np.pi):.3g} turns", timed, f"heyoka, {raw.steps} steps",
                   errors, note="closed forms cost the same for any span, heyoka its steps")


def _errors(times, *answers):
    """Largest distance of each answer from the exact outputs at the last CHECKED times of eight, over each
    output's size."""
    from tests.oracles.axisymmetric import OUTPUTS, outputs
    keep = [i for i, name in enumerate(OUTPUTS) if not name.startswith("G")]
    chosen = np.linspace(0, len(times) - 1, 2 * CHECKED).astype(int)[-CHECKED:]
    exact = [outputs(VALUES | {"t": float(times[i])}) for i in chosen]
    gaps = [np.array([[float(abs(e[k] - float(x)).mid()) for k, x in zip(keep, answer[i])] for i,
                      e in zip(chosen, exact)])
            for answer in answers]
    size = np.abs([[float(e[k]) for k in keep] for e in exact]).max(axis=0)
    return [float((gap / size).max()) for gap in gaps]


class LinearRuns:
    """p, q, psi, phi, velocity and position of the charged body's linear model on a grid of times that begins
    at 0; cos and sin of theta are states too, which is faster than the functions."""

    def __init__(self, values, tolerance):
        import heyoka
        p, q, psi, phi, c, s, *moved = heyoka.make_vars("p", "q", "psi", "phi", "c", "s", "v1", "v2", "v3",
                                                        "x1", "x2", "x3")
        D1, D2, D3, r0, m, f1, f2, f3 = (values[n] for n in ("D1", "D2", "D3", "r0", "m", "f1", "f2", "f3"))
        away = values["lambda3"] - values["k"]
        a, b = ((D3 - D2) * r0 + away) / D1, ((D3 - D1) * r0 + away) / D2
        across, up = (f1 + f3 * phi) / m, (f2 - f3 * psi) / m
        system = [(p, values["M1"] / D1 - a * q), (q, values["M2"] / D2 + b * p), (psi, p + r0 * phi),
                  (phi, q - r0 * psi),
                  (c, -r0 * s), (s, r0 * c),
                  *zip(moved[:3], (c * across - s * up, s * across + c * up, (f3 - f1 * phi + f2 * psi) / m)),
                  *zip(moved[3:], moved[:3])]
        self.integrator = heyoka.taylor_adaptive(system, [0.0] * len(system), tol=tolerance)
        theta0 = values["theta0"]
        self.start = [*(values[n] for n in ("p0", "q0", "psi0", "phi0")), np.cos(theta0), np.sin(theta0),
                      *(values[n] for n in ("v1", "v2", "v3", "x1", "x2", "x3"))]
        self.steps = 0

    def __call__(self, times):
        """(len(times), 10)."""
        ta = self.integrator
        ta.time = 0.0
        ta.state[:] = self.start
        _, _, _, self.steps, *_, out = ta.propagate_grid(times)
        return np.delete(out, (4, 5), axis=1)
