"""A stuck thruster by brute force: Euler's equations in the frame of the file, whatever the tensor, by
SciPy's DOP853.

J omega' = M - omega x (J omega + l). Nothing of the package is used: no principal axes, no Taylor series.
"""
import tomllib

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.oracles.rigid import tensor

UNITS = {"N": 1.0, "mN": 1e-3, "lbf": 4.4482216152605, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "deg/s": np.pi / 180,
         "rpm": np.pi / 30, "rad/s": 1.0, "kg m^2": 1.0,
         "N m s": 1.0, "kg": 1.0, "min": 60.0}


def number(value) -> float:
    """A number of a case file, with the units of the three spacecraft."""
    if not isinstance(value, str):
        return float(value)
    words = value.split("+-")[0].split(maxsplit=1)
    return float(words[0]) * UNITS[words[1].strip()] if len(words) > 1 else float(words[0])


def vector(values):
    return np.array([number(v) for v in values])


class Craft:
    """The spacecraft of a case file."""

    def __init__(self, text):
        data = tomllib.loads(text)
        body = data["body"]
        rows = body["inertia"]
        if isinstance(rows[0], list):
            self.J = np.array([vector(row) for row in rows])
        else:
            self.J = np.diag(vector(rows))
            for name, value in body.get("products", {}).items():
                if name != "convention":
                    i, j = ("xyz".index(c) for c in name)
                    self.J[i, j] = self.J[j, i] = (-1 if body["products"]["convention"] == "positive"
                                                   else 1) * number(value)
        centre = vector(body.get("centre_of_mass", [0, 0, 0]))
        self.torques = {}
        for t in data.get("thrusters", []):
            e = vector(t["direction"])
            self.torques[t["name"]] = np.cross(vector(t["position"]) - centre,
                                               number(t["force"]) * e / np.linalg.norm(e))
        self.stuck = [t["name"] for t in data.get("thrusters", []) if t.get("stuck")]
        self.l = np.zeros(3)
        self.wheels = len(data.get("wheels", []))
        for w in data.get("wheels", []):
            axis = vector(w["axis"])
            size = number(w["momentum"]) if "momentum" in w else number(w["inertia"]) * number(w["speed"])
            self.l = self.l + size * axis / np.linalg.norm(axis)
        limit = data.get("limits", {}).get("rate")
        self.limit = None if limit is None else vector(limit) if isinstance(limit, list) else number(limit)
        self.start = vector(data["motion"]["angular_velocity"])

    def torque(self, names=None):
        return sum((self.torques[n] for n in (self.stuck if names is None else names)), np.zeros(3))

    def run(self, t_end, torque=None, l=None, limit=True, rtol=1e-13):
        """(time of the limit or None, last state, largest |omega|)."""
        M, l = self.torque() if torque is None else torque, self.l if l is None else l

        def over(t, w):
            return max(np.abs(w) - self.limit) if np.ndim(self.limit) else np.linalg.norm(w) - self.limit
        over.terminal = True
        events = [over] if limit and self.limit is not None else None
        run = solve_ivp(tensor(self.J, l, M), (0, t_end), self.start, "DOP853", rtol=rtol, atol=1e-3 * rtol, events=events)
        t = float(run.t_events[0][0]) if events and len(run.t_events[0]) else None
        return t, run.y[:, -1], float(np.linalg.norm(run.y, axis=0).max())

    def fate(self, torque=None, l=None, start=None, rtol=1e-11):
        """"bounded" or "spin-up" by what a run of the motion proves, however slow its growth. The torque is
        along a principal axis a.

        With momentum l of the wheels along it |H|^2/2 - D T grows steadily at the rate l.M, H = J omega + l,
        2T = omega.J omega: spin-up, whatever the run shows (`law` measures the rate). Else the two rates
        across a depend on the angle alpha about it alone, alpha' = omega.a, and T on the work M alpha: the
        way there is the way back. So it is bounded once it has turned back against the torque and then with
        it again, and it spins up once it has gone one whole turn of the rates across a with the torque: it
        comes round to the same rates with more energy, for ever.
        """
        M, l, w = (self.torque() if torque is None else torque, self.l if l is None else l,
                   self.start if start is None else start)
        a = M / np.linalg.norm(M)
        if abs(l @ a) > 1e-12 * np.linalg.norm(l):
            return "spin-up"
        turn, rates = self.turn(a), tensor(self.J, l, M)
        rate = lambda t, y: [*rates(t, y[:3]), y[:3] @ a]
        back, again, round_ = (lambda t, y: y[:3] @ a), (lambda t, y: y[:3] @ a), (lambda t, y: y[3] - turn)
        back.direction, again.direction, round_.terminal = -1, 1, True
        again.terminal = 2  # one whole swing, whichever way it began
        span = 1e4 * np.sqrt(np.linalg.eigvalsh(self.J)[-1] / np.linalg.norm(M))
        run = solve_ivp(rate, (0, span), [*w, 0.0], "DOP853", rtol=rtol, atol=1e-3 * rtol,
                        events=[back, again, round_] if np.isfinite(turn) else [back, again])
        if len(run.t_events) > 2 and len(run.t_events[2]):
            return "spin-up"
        assert len(run.t_events[0]) and len(run.t_events[1]), "neither a turn nor a whole swing"
        return "bounded"

    def turn(self, a) -> float:
        """The angle about a principal axis after which the rates across it are the same again; inf where they
        are not.

        With D and P the moments along and across a: P u' = -a x (P u + l - D u) per unit of the angle, trace
        0, so u turns at sqrt(det).
        """
        D, across = a @ self.J @ a, np.linalg.svd(a[None])[2][1:]
        assert self.J @ a == pytest.approx(D * a, abs=1e-12 * D)
        P = across @ self.J @ across.T
        square = np.linalg.det(P - D * np.eye(2)) / np.linalg.det(P)
        return 2 * np.pi / np.sqrt(square) if square > 1e-12 else np.inf

    def law(self, l, t):
        """The rate at which |H|^2/2 - D T grows over a run of length t under the torque, and its size."""
        M, quantity = self.torque(), []
        D = M @ self.J @ M / (M @ M)
        for w in (self.start, self.run(t, M, l, limit=False, rtol=1e-12)[1]):
            H = self.J @ w + l
            quantity.append(H @ H / 2 - D * (w @ self.J @ w) / 2)
        return (quantity[1] - quantity[0]) / t
