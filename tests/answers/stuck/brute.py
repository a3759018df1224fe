"""A stuck thruster by brute force: Euler's equations in the frame of the file, whatever the tensor, by SciPy's DOP853.

J omega' = M - omega x (J omega + l). Nothing of the package is used: no principal axes, no Taylor series.
"""
import tomllib

import numpy as np
from scipy.integrate import solve_ivp

UNITS = {"N": 1.0, "mN": 1e-3, "lbf": 4.4482216152605, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "deg/s": np.pi / 180, "rpm": np.pi / 30, "rad/s": 1.0, "kg m^2": 1.0,
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
                    self.J[i, j] = self.J[j, i] = (-1 if body["products"]["convention"] == "positive" else 1) * number(value)
        centre = vector(body.get("centre_of_mass", [0, 0, 0]))
        self.torques = {}
        for t in data.get("thrusters", []):
            e = vector(t["direction"])
            self.torques[t["name"]] = np.cross(vector(t["position"]) - centre, number(t["force"]) * e / np.linalg.norm(e))
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
        M, l, inverse = self.torque() if torque is None else torque, self.l if l is None else l, np.linalg.inv(self.J)

        def rate(t, w):
            (x, y, z), (a, b, c) = w, self.J @ w + l
            return inverse @ (M - (y * c - z * b, z * a - x * c, x * b - y * a))

        def over(t, w):
            return max(np.abs(w) - self.limit) if np.ndim(self.limit) else np.linalg.norm(w) - self.limit
        over.terminal = True
        events = [over] if limit and self.limit is not None else None
        run = solve_ivp(rate, (0, t_end), self.start, "DOP853", rtol=rtol, atol=1e-3 * rtol, events=events)
        t = float(run.t_events[0][0]) if events and len(run.t_events[0]) else None
        return t, run.y[:, -1], float(np.linalg.norm(run.y, axis=0).max())
