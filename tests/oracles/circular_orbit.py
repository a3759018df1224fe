"""A satellite with momentum wheels on a circular orbit: its equations of motion under the gravity gradient.

    I w' = (I w + h) x w + 3 n^2 a3 x I a3,     a1, a2, a3: velocity, orbit normal and vertical, body frame

w is the angular velocity in space, n the orbital rate; the orbital frame a1, a2, a3 turns with n a2, so that
a_i' = a_i x (w - n a2). The state is w and the quaternion from the body to the orbital frame. Conserved is
the Jacobi integral

    w . I w/2 - n a2 . (I w + h) + 3/2 n^2 a3 . I a3,

the energy of the motion relative to the orbital frame with the dynamic potential
U = 3/2 n^2 a3 . I a3 - n^2/2 a2 . I a2 - n h . a2 (Sarychev, Mirer and Degtyarev 2005).
"""
from sympy import Integer, Symbol

from stabilab.numbers.vectors import cross, dot
from stabilab.physics.circular_orbit import Satellite
from stabilab.physics.equations import Balance, Equations, rotation
from stabilab.physics.scene import BLOCKS


def orbital_equations(satellite: Satellite) -> Equations:
    """The equations of motion in symbols: angular velocity in space (rad/s) and the quaternion from the body
    to the orbital frame (velocity, normal, vertical). Its laws: the Jacobi integral and the length of the
    quaternion."""
    numbers = dict(zip(("D1", "D2", "D3"), satellite.moments)) | {"n": satellite.rate} | {
        f"h{i}": h for i, h in enumerate(satellite.momentum, 1) if h}
    symbols = {name: Symbol(name, real=True) for name in numbers}
    D, n = tuple(symbols[f"D{i}"] for i in (1, 2, 3)), symbols["n"]
    h = tuple(symbols.get(f"h{i}", Integer(0)) for i in (1, 2, 3))
    w, q = (tuple(Symbol(name, real=True) for name in BLOCKS[block].components)
            for block in ("omega", "attitude"))
    _, normal, vertical = rotation(q)
    spin, pulled = (tuple(d * v for d, v in zip(D, one)) for one in (w, vertical))
    torques = {"inertia": cross(spin, w), "gyrostat": cross(h, w),
               "gravity gradient": tuple(3 * n**2 * t for t in cross(vertical, pulled))}
    total = [sum(parts) for parts in zip(*torques.values())]
    a, b, c, d = q
    x, y, z = (v - n * t for v, t in zip(w, normal))  # relative to the orbital frame
    turning = ((-b*x - c*y - d*z) / 2, (a*x + c*z - d*y) / 2, (a*y + d*x - b*z) / 2, (a*z + b*y - c*x) / 2)
    energy = dot(spin, w) / 2
    carried = tuple(s + v for s, v in zip(spin, h))
    laws = (Balance("Jacobi", "the Jacobi integral: energy relative to the orbital frame, with the dynamic "
                              "potential, is constant",
                    energy - n * dot(normal, carried) + 3 * n**2 * dot(vertical, pulled) / 2, Integer(0)),
            Balance("quaternion", "the quaternion keeps its length", sum(v**2 for v in q), Integer(0)))
    return Equations("physical", w + q, numbers, symbols, D + (Integer(1),) * 4, torques,
                     (*(t / d for t, d in zip(total, D)), *turning), energy, laws, ("omega", "attitude"))
