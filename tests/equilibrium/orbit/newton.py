"""Equilibria on a circular orbit by Newton's method from many starts, the linear motion by differences of the
equations of motion, and runs by SciPy; in doubles, shares no code with the package."""
import numpy as np
from scipy.integrate import solve_ivp

RIGHT = np.eye(3)


def torque(moments, momentum, rate, frames):
    """Of attitudes at rest in the orbital frame: rows a1, a2, a3 (n, 3, 3) -> (n, 3), body frame."""
    normal, up = frames[:, 1], frames[:, 2]
    spin = rate * normal
    return np.cross(spin * moments + momentum, spin) + 3 * rate**2 * np.cross(up, up * moments)


def turned(frames, turns):
    """The frames after the body turns by rotation vectors (n, 3), body frame (Rodrigues)."""
    angle = np.linalg.norm(turns, axis=1)[:, None, None]
    axis = np.where(angle > 0, turns[:, None] / np.where(angle > 0, angle, 1), 0)
    along = np.sum(frames * axis, axis=2, keepdims=True) * axis
    return frames * np.cos(angle) - np.cross(axis, frames) * np.sin(angle) + along * (1 - np.cos(angle))


def equilibria(moments, momentum, rate, starts=1500, seed=1):
    """(m, 3, 3) different ones that Newton's method reaches, and those a half turn from them."""
    moments, momentum = np.asarray(moments, float), np.asarray(momentum, float)
    q = np.random.default_rng(seed).normal(size=(starts, 4))
    a, b, c, d = (q / np.linalg.norm(q, axis=1)[:, None]).T
    frames = np.stack([a*a + b*b - c*c - d*d, 2*(b*c - a*d), 2*(b*d + a*c), 2*(b*c + a*d),
                       a*a - b*b + c*c - d*d, 2*(c*d - a*b), 2*(b*d - a*c), 2*(c*d + a*b),
                       a*a - b*b - c*c + d*d], axis=1).reshape(-1, 3, 3)
    scale, step = rate**2 * moments.max(), 1e-6
    for _ in range(40):
        value = torque(moments, momentum, rate, frames) / scale
        slopes = np.stack([(torque(moments, momentum, rate, turned(frames, sign * step * np.tile(e, (len(frames), 1))))
                            / scale) * sign / (2 * step) for e in RIGHT for sign in (1, -1)], axis=2)
        slopes = slopes[:, :, 0::2] + slopes[:, :, 1::2]
        move = -np.linalg.solve(slopes + 1e-14 * RIGHT, value[:, :, None])[:, :, 0]
        size = np.linalg.norm(move, axis=1)[:, None]
        frames = turned(frames, move * np.minimum(1, 0.5 / np.where(size > 0, size, 1)))
    good = frames[np.linalg.norm(torque(moments, momentum, rate, frames), axis=1) < 1e-11 * scale]
    found = []
    # a half turn about the orbit normal leaves the equations alone
    for frame in np.concatenate([good, good * np.array([-1, 1, -1])[:, None]]):
        if all(np.abs(frame - other).max() > 1e-5 for other in found):
            found.append(frame)
    return np.array(found)


def growth(moments, momentum, rate, frame):
    """The largest real part of an eigenvalue of the motion next to an equilibrium, over the orbital rate; by
    central differences of the rates of angular velocity and attitude."""
    moments, momentum = np.asarray(moments, float), np.asarray(momentum, float)

    def rates(x):
        """x: departure of the angular velocity (over the rate) and rotation vector from the equilibrium."""
        (_, normal, up), = turned(frame[None], x[None, 3:])
        omega = rate * (frame[1] + x[:3])
        pull = np.cross((omega * moments + momentum), omega) + 3 * rate**2 * np.cross(up, up * moments)
        relative, s = omega / rate - normal, x[3:]
        return np.concatenate([pull / moments / rate**2, relative + np.cross(s, relative) / 2])
    steps = 1e-6 * np.eye(6)
    jacobian = np.stack([(rates(e) - rates(-e)) / 2e-6 for e in steps], axis=1)
    return np.linalg.eigvals(jacobian)


def run(moments, momentum, rate, omega, frame, times):
    """(angular velocities (n, 3), frames (n, 3, 3)) at the times, the direction cosines themselves followed."""
    def cross(u, v):
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

    def rates(_, x):
        x = x.tolist()
        omega, rows = x[:3], (x[3:6], x[6:9], x[9:])
        spin, up = [d * w + h for d, w, h in zip(moments, omega, momentum)], rows[2]
        pull = cross(up, [3 * rate**2 * d * c for d, c in zip(moments, up)])
        relative = [w - rate * c for w, c in zip(omega, rows[1])]
        return [(a + b) / d for a, b, d in zip(cross(spin, omega), pull, moments)] + [
            v for row in rows for v in cross(row, relative)]
    found = solve_ivp(rates, (0, times[-1]), np.concatenate([omega, np.ravel(frame)]), "DOP853", times,
                      rtol=1e-11, atol=1e-13)
    return found.y[:3].T, found.y[3:].T.reshape(-1, 3, 3)
