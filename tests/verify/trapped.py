"""What a certificate says of a spin-up, against a long run by SciPy: the formulas of the forms written out
for a body, and for the scaled gyrostat."""
import math
from fractions import Fraction as F
from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp

from tests.oracles import model

LATER = 40  # natural units of time after the trap


def model_of(scene):
    """The oracle's model of a certificate's scene."""
    if scene["variables"] == "scaled":
        return model.scaled(scene["a"], scene["b"], scene["mu"])
    return model.physical(scene["inertia"], scene["momentum"], scene["torque"])


def rates_of(scene, number=float):
    """(kappa, rho, sigma, m), three numbers each, of the kind that `number` makes."""
    made = model_of(scene)
    return [[number(v) for v in row] for row in (made.kappa, made.rho, made.sigma, made.m)]


def rates_at(kappa, rho, sigma, m):
    return lambda _, x: [kappa[i] * x[(i + 1) % 3] * x[(i + 2) % 3] + rho[i] * x[(i + 2) % 3]
                         + sigma[i] * x[(i + 1) % 3] + m[i] for i in range(3)]


@lru_cache(64)  # many forgeries leave the motion as it is
def run_of(rates, state, end):
    return solve_ivp(rates_at(*rates), (0, end), state, "DOP853", rtol=1e-12, atol=1e-12, dense_output=True)


def says_what_happens(claims) -> bool:
    """Whether no claim of motion.spin_up is against the run, with room for the run's own error."""
    said, scene, state = claims["motion"]["spin_up"], claims["scene"], [float(F(v))
                                                                        for v in claims["motion"]["state"]]
    kappa, rho, sigma, m = rates_of(scene)
    f = rates_at(*map(tuple, (kappa, rho, sigma, m)))
    t = float(F(said["t"]))
    end = t + LATER / math.sqrt(max(map(abs, m)))
    run = run_of(tuple(map(tuple, (kappa, rho, sigma, m))), tuple(state), end)
    for entry in said.get("way") or ():
        x = run.sol(float(F(entry["t"]))) if F(entry["t"]) else state
        if any(not float(F(low)) - 1e-6 <= v <= float(F(high)) + 1e-6 for v,
               (low, high) in zip(x, entry["box"])):
            return False
    times = np.linspace(t, end, 4000)
    states, about = run.sol(times), said.get("about", "fixed centre")
    if about == "fixed centre":
        X, amplitude = placed(states, (kappa, rho, sigma), said["axis"] - 1, said["sense"])
    else:
        frame = equator(scene) if about == "equator" else axes_from(said["axis"] - 1, said["sense"])
        X, amplitude = beside_the_centre(frame @ states, lambda x: frame @ f(0, frame.T @ x))
    cone, least, gain = (float(F(said[key])) for key in ("cone", "least", "gain"))
    return bool((amplitude < cone * (1 + 1e-6)).all() and (X > least + gain * (times - t) - 1e-6 * X).all())


def placed(x, rates, i, sense):
    """(X, |zeta|) of states (3, n): X = x_i + shift along the sense, zeta = U + i q V, U and V the rates
    about the two other axes from their centres."""
    (kappa, rho, sigma), j, k = rates, (i + 1) % 3, (i + 2) % 3
    # the coefficients of x_i in their rates vanish there, and so they do turned by half a turn
    U, V = x[j] + sigma[k] / kappa[k], x[k] + rho[j] / kappa[j]
    square = -kappa[j] / kappa[k]
    q = math.sqrt(square) * (1 if kappa[j] < 0 else -1)
    shift = sense * (q * rho[k] - sigma[j] / q) / (2 * math.sqrt(-kappa[j] * kappa[k]))
    return sense * x[i] + shift, np.sqrt(U**2 + square * V**2)


def axes_from(i, sense):
    """The rotation that calls axis i the first, turned by half a turn about the second where the sense is -1.
    """
    frame = np.zeros((3, 3))
    for row, (n, sign) in enumerate(zip((i, (i + 1) % 3, (i + 2) % 3), (sense, 1, sense))):
        frame[row, n] = sign
    return frame


def equator(scene):
    """The rotation whose first axis is -sgn(D1 - D2) l/|l|, l the wheel's momentum across the axis 1 of
    symmetry, and whose third is that axis."""
    D, l = ([float(F(v)) for v in scene[key]] for key in ("inertia", "momentum"))
    i = next(i for i in range(3) if D[(i + 1) % 3] == D[(i + 2) % 3])
    along = np.eye(3)[i]
    across = np.array(l) - l[i] * along
    first = -np.sign(D[i] - D[(i + 1) % 3]) * across / np.linalg.norm(across)
    return np.array([first, np.cross(along, first), along])


def beside_the_centre(x, rate):
    """(x1, |zeta|) of states (3, n) in a frame: at each x1 the other two rates are linear in the other two
    components, x2' = P v, x3' = Q u."""
    at = lambda second, third: np.array(rate(np.array([x[0], second, third])))
    zero, one = np.zeros_like(x[0]), np.ones_like(x[0])
    rest, by2, by3 = at(zero, zero), at(one, zero), at(zero, one)
    P, Q = (by3 - rest)[1], (by2 - rest)[2]  # of opposite signs
    u, v, ratio = x[1] + rest[2] / Q, x[2] + rest[1] / P, np.sqrt(-Q / P)
    return x[0], np.sqrt(ratio * u**2 + v**2 / ratio)
