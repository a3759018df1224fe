"""Case files drawn at random, as engineers write them: tensors in every form and unit, thrusters anywhere,
wheels on any axis; and with the torque exactly on a principal axis of a tensor that is not diagonal, all in
decimals."""
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np

RATES = {"deg/s": np.pi / 180, "rpm": np.pi / 30, "rad/s": 1.0}
FORCES = {"N": 1.0, "mN": 1e-3, "lbf": 4.4482216152605}
BODIES = ("generic", "near-symmetric", "rod", "disc")
# whose squares sum to 2^a 5^b: the rotations are decimals
QUATERNIONS = ((1, 2, 0, 0), (4, 2, 2, 1), (1, 3, 3, 1), (1, 1, 2, 2), (2, 1, 2, 4), (1, 1, 1, 1))


def rotation(quaternion):
    """By the formula of Rodrigues, in the numbers of the quaternion."""
    w, x, y, z = quaternion
    n = w * w + x * x + y * y + z * z
    return [[1 - 2 * (y * y + z * z) / n, 2 * (x * y - z * w) / n, 2 * (x * z + y * w) / n],
            [2 * (x * y + z * w) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - x * w) / n],
            [2 * (x * z - y * w) / n, 2 * (y * z + x * w) / n, 1 - 2 * (x * x + y * y) / n]]


def moments(rng, kind):
    """That keep the triangle inequality, of the order of one."""
    a, b, c = rng.uniform(0.1, 1, 3)
    small = 10 ** rng.uniform(-4, -2)
    return {"generic": [b + c, a + c, a + b], "near-symmetric": [1, 1 + small, 0.3 + 1.4 * a],
            "rod": [1, 1 - 0.9 * small, 3 * small],
            "disc": [0.5 + a / 4, 0.8 - a / 4, 1.3 * (1 - small)]}[kind]


def written(numbers, unit="") -> str:
    return "[" + ", ".join(f'"{float(v)!r} {unit}"' if unit else repr(float(v)) for v in numbers) + "]"


def anywhere(rng, n) -> str:
    """A case with thruster T0 stuck, perhaps T1 too, 0 to 3 wheels, a limit of |omega| or of components. n:
    which form and body."""
    kind, form = BODIES[n % 4], ("tensor", "positive", "negative", "moments")[n // 4 % 4]
    size = 10 ** rng.uniform(-2, 4)
    R = np.array(rotation(rng.normal(size=4))) if form != "moments" else np.eye(3)[rng.permutation(3)]
    J = size * R @ np.diag(moments(rng, kind)) @ R.T
    J = (J + J.T) / 2
    lines = ["[body]", f"inertia = [{', '.join(map(written, J))}]" if form == "tensor"
             else f"inertia = {written(np.diag(J))}"]
    if form in ("positive", "negative"):
        sign = -1 if form == "positive" else 1
        xy, xz, yz = (repr(float(sign * v)) for v in (J[0, 1], J[0, 2], J[1, 2]))
        lines.append(f'products = {{xy = {xy}, xz = {xz}, yz = {yz}, convention = "{form}"}}')
    centre, start = rng.normal(size=3), rng.normal(size=3) * 10 ** rng.uniform(-3, 0)
    speed = np.linalg.norm(start)
    lines += [f"centre_of_mass = {written(centre)}"]
    for i in range(rng.integers(1, 3)):
        unit = list(FORCES)[rng.integers(3)]
        force = size * speed**2 * 10 ** rng.uniform(-1, 1) / FORCES[unit]
        lines += ["[[thrusters]]", f'name = "T{i}"', f"position = {written(centre + rng.normal(size=3))}",
                  f"direction = {written(rng.normal(size=3))}",
                  f'force = "{float(force)!r} {unit}"', "stuck = true"]
    for i in range(rng.integers(0, 4)):
        momentum = size * speed * 10 ** rng.uniform(-1, 0.5) * rng.choice([-1, 1])
        said = (f'momentum = "{float(momentum)!r} N m s"',
                ) if rng.random() < 0.5 else ('inertia = "0.5 kg m^2"',
                                              f'speed = "{float(momentum) / 0.5!r} rad/s"')
        lines += ["[[wheels]]", f'name = "W{i}"', f"axis = {written(rng.normal(size=3))}", *said]
    unit = list(RATES)[rng.integers(3)]
    if n % 3:
        limit = f'"{float(speed * rng.uniform(1.1, 5) / RATES[unit])!r} {unit}"'
    else:
        limit = written((abs(start) + speed * rng.uniform(0.3, 2, 3)) / RATES[unit], unit)
    return "\n".join([*lines, "[limits]", f"rate = {limit}", "[motion]",
                      f"angular_velocity = {written(start / RATES[unit], unit)}", ""])


def on_an_axis(rng, axis, across=True) -> str:
    """A case whose stuck thruster's torque is exactly along principal axis number `axis` (0 the major) and
    whose one wheel is across it, or is not."""
    R = rotation([Fraction(v) for v in QUATERNIONS[rng.integers(len(QUATERNIONS))]])
    column = [[row[i] for row in R] for i in range(3)]
    some = lambda low, high: Fraction(int(rng.integers(round(low * 1000), round(high * 1000))), 1000)
    a, b, c = (some(0.1, 1) for _ in range(3))
    D = sorted((b + c, a + c, a + b), reverse=True)
    J = [[sum(R[i][m] * D[m] * R[j][m] for m in range(3)) for j in range(3)] for i in range(3)]
    i, j, k = (column[(axis + n) % 3] for n in range(3))
    along, beside = 0 if across else some(0.1, 1), some(-1, 1)
    wheel = [along * x + beside * y + z for x, y, z in zip(i, j, k)]
    return "\n".join(["[body]", f"inertia = [{', '.join(map(decimals, J))}]",
                      "centre_of_mass = [0.3, -0.2, 0.1]", "[[thrusters]]", 'name = "A"',
                      f"position = {decimals(p + v for p, v in zip((Fraction(3, 10), Fraction(-1, 5), Fraction(1, 10)), j))}", f"direction = {decimals(k)}",
                      f"force = {float(some(0.02, 0.4))!r}", "stuck = true", "[[wheels]]", 'name = "W"',
                      f"axis = {decimals(wheel)}", f"momentum = {float(some(-1, 1))!r}",
                      "[motion]", f"angular_velocity = {decimals(some(-1, 1) for _ in range(3))}", ""])


def decimals(values) -> str:
    with localcontext() as context:
        context.prec = 60
        return ("[" + ", ".join(format(Decimal(v.numerator) / Decimal(v.denominator), "f") for v in values)
                + "]")
