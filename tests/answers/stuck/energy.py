"""The fate under a torque on a principal axis by the balance of energy alone, in plain NumPy: no run, no
reduced potential.

M and a: the torque's size and axis; D: the moment about it; u, P, l: rates, inertia and wheel momentum across
it. Per unit of the angle alpha about a, P u' = -a x (P u + l - D u): linear, so u = c + p cos x + q sin x
with x = n alpha. The kinetic energy grows by the work of the torque, so what is left to the spin about a is

    S(x) = T_0 + M x/n - u.P u/2,    a trigonometric polynomial of the second order and M x/n.

The motion goes where S > 0 without a break from x = 0, and a turn further S is greater by 2 pi M/n: it is
bounded exactly if S < 0 somewhere in the turn ahead. The least of S stands where S' = 0: roots of a quartic
in e^ix (`numpy.roots`).
"""
import numpy as np


def fate(J, M, l, w):
    """("bounded" or "spin-up", least S of the turn ahead): J (3, 3), M, l, w (3,), any frame. Endless growth
    by a wheel along the torque counts as inf."""
    size = np.linalg.norm(M)
    a = M / size
    if abs(l @ a) > 1e-9 * np.linalg.norm(l):
        return "spin-up", np.inf
    across = np.linalg.svd(a[None])[2][1:]
    if np.cross(*across) @ a < 0:
        across = across[::-1]
    D, P, u0, quarter = a @ J @ a, across @ J @ across.T, across @ w, np.array([[0.0, -1.0], [1.0, 0.0]])
    A, b = -np.linalg.solve(P, quarter @ (P - D * np.eye(2))), -np.linalg.solve(P, quarter @ (across @ l))
    square = np.linalg.det(A)
    # u grows without bound either way, like an exponential or a square of x: S < 0 on both sides but for a
    # set of measure zero
    if square < 1e-9:
        return "bounded", -np.inf
    n = np.sqrt(square)
    c = -np.linalg.solve(A, b)
    p = u0 - c
    q = A @ p / n
    cos_1, sin_1, cos_2, sin_2 = c @ P @ p, c @ P @ q, (p @ P @ p - q @ P @ q) / 4, p @ P @ q / 2
    mean = (c @ P @ c + (p @ P @ p + q @ P @ q) / 2) / 2
    stationary = np.roots([-sin_2 - 1j * cos_2, -(sin_1 + 1j * cos_1) / 2, size / n,
                           -(sin_1 - 1j * cos_1) / 2, -sin_2 + 1j * cos_2])
    x = np.append(np.angle(stationary) % (2 * np.pi), 2 * np.pi)
    left = (w @ J @ w / 2 + size * x / n - mean - cos_1 * np.cos(x) - sin_1 * np.sin(x)
            - cos_2 * np.cos(2 * x) - sin_2 * np.sin(2 * x))
    return ("bounded" if left.min() < 0 else "spin-up"), float(left.min())
