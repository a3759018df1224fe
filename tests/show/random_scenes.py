"""Random case files with every effect and every kind of scene, for tests of what the views say of them."""
from __future__ import annotations

from pathlib import Path

import numpy as np

SEED = 43
UNITS = ("deg", "rpm", "si", "rev/s", "deg/day")


def written(folder: Path, count: int = 60, seed: int = SEED) -> dict[str, Path]:
    """{name: path} of so many scenes, one kind after the other; those of a smaller count are the first of a
    greater one."""
    rng, paths = np.random.default_rng(seed), {}
    for n in range(count):
        kind = [*KINDS][n % len(KINDS)]
        path = folder / f"{kind}-{n:02}.toml"
        path.write_text(KINDS[kind](rng), encoding="utf-8")
        paths[path.stem] = path
    return paths


def text(value) -> str:
    """A value of TOML: numbers as decimals between quotes, which are read exactly."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {text(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return f"[{', '.join(map(text, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else f'"{float(f"{value:.4g}")!r}"'


def table(heading: str, /, **values) -> str:
    return "\n".join([f"[{heading}]", *(f"{key} = {text(value)}" for key, value in values.items())])


def size(rng, low: float, high: float) -> float:
    """Between powers of ten, of either sign."""
    return rng.choice((-1, 1)) * 10 ** rng.uniform(low, high)


def moments(rng, symmetric: bool = False):
    result = np.sort(rng.uniform(0.6, 1.0, 3)) * 10 ** rng.uniform(-1, 2)
    if symmetric:
        result[1] = result[0]
        return result
    return rng.permutation(result)


def tensor(rng):
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    full = turn @ np.diag(moments(rng)) @ turn.T
    return np.round(full + full.T, 6) / 2


def along(rng, value: float):
    """On one axis."""
    result = np.zeros(3)
    result[rng.integers(3)] = value
    return result


def motion(rng, rates: float = 0.0, span: float = 20.0, **values) -> str:
    start = rng.normal(size=3) * 10 ** rng.uniform(rates - 1, rates)
    return table("motion", angular_velocity=start, **values, span=[0, span])


def upward(rng):
    result = rng.normal(size=3)
    return result / np.linalg.norm(result)


def blocks(*parts: str) -> str:
    return "\n\n".join(filter(None, parts)) + "\n"


def wheel(rng, body) -> str:
    return table("effects.gyrostat", momentum=rng.normal(size=3) * max(body) * 0.2 * (rng.random(3) < 0.7))


def limit(rng, low: float = 2.4) -> str:
    """Above the rates that a motion starts with."""
    return table("limits", rate=f"{10 ** rng.uniform(low, low + 1):.3g} deg/s")


def on_axis(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body), wheel(rng, body),
                  table("effects.constant_torque", torque=along(rng, size(rng, -2, 0) * max(body))),
                  motion(rng), limit(rng) * (rng.random() < 0.5),
                  f'[output]\nunits = "{rng.choice(UNITS)}"')


def full_tensor(rng) -> str:
    return blocks(table("body", inertia=tensor(rng)),
                  table("effects.constant_torque", torque=rng.normal(size=3) * 10 ** rng.uniform(-2, 0)),
                  motion(rng), limit(rng) * (rng.random() < 0.5))


def free(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body if rng.random() < 0.5 else tensor(rng)),
                  wheel(rng, body) * (rng.random() < 0.5), motion(rng), limit(rng) * (rng.random() < 0.5))


def wheel_motor(rng) -> str:
    body, endless = moments(rng), rng.random() < 0.3
    return blocks(table("body", inertia=body), wheel(rng, body) * (rng.random() < 0.5),
                  table("effects.wheel_motor", torque=along(rng, size(rng, -3, -1) * max(body)),
                        **({} if endless else {"duration": f"{rng.integers(5, 60)} s"})), motion(rng),
                  limit(rng) * (rng.random() < 0.5))


def damper(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body), wheel(rng, body) * (rng.random() < 0.3),
                  table("effects.viscous_damper", inertia=min(body) * rng.uniform(0.02, 0.3),
                        coefficient=min(body) * 10 ** rng.uniform(-3, 0)), motion(rng),
                  limit(rng) * (rng.random() < 0.3))


def eddy_currents(rng) -> str:
    return blocks(table("body", inertia=moments(rng)),
                  table("effects.eddy_currents", coefficient=10 ** rng.uniform(0, 2),
                        field=10 ** rng.uniform(-2, 0)), motion(rng, vertical=upward(rng)))


def rate_damper(rng) -> str:
    body = moments(rng)
    pushed = table("effects.constant_torque", torque=rng.normal(size=3) * 10 ** rng.uniform(-3, -1))
    return blocks(table("body", inertia=body), wheel(rng, body) * (rng.random() < 0.5),
                  table("effects.rate_damper", coefficient=rng.uniform(0.1, 1, 3) * 10 ** rng.uniform(-2, 0)),
                  pushed * (rng.random() < 0.5), motion(rng))


def top(rng) -> str:
    body = moments(rng, symmetric=True)
    return blocks(table("body", inertia=body),
                  table("effects.gravity", weight=max(body) * 10 ** rng.uniform(-1, 1),
                        centre_of_mass=[0, 0, rng.uniform(-1, 1)]),
                  table("motion", angular_velocity=[*rng.normal(size=2) * 0.3, size(rng, 0, 1)],
                        vertical=upward(rng), span=[0, 5]))


def heavy(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body),
                  table("effects.gravity", weight=max(body) * 10 ** rng.uniform(-1, 0),
                        centre_of_mass=rng.normal(size=3) * 0.3),
                  motion(rng, span=5, vertical=upward(rng)))


def charged(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body, mass=f"{rng.integers(1, 20)} kg"), wheel(rng, body),
                  table("effects.charge", charge=10 ** rng.uniform(-3, -1), field=100, arm=rng.uniform(0.1, 1),
                        angle=rng.uniform(0, 1)),
                  table("effects.constant_torque", torque=along(rng, size(rng, -2, 0))),
                  motion(rng))


def liquid(rng) -> str:
    body = moments(rng)
    pushed = table("effects.constant_torque", torque=along(rng, size(rng, -3, -1)))
    return blocks(table("body", inertia=body), wheel(rng, body) * (rng.random() < 0.5),
                  table("effects.liquid_cavity", density=1000, viscosity=1000,
                        P0=max(body) * 10 ** rng.uniform(-3, -1)),
                  table("effects.resistance", coefficient=10 ** rng.uniform(-3, -1)) * (rng.random() < 0.5),
                  pushed * (rng.random() < 0.5), motion(rng))


def resisted(rng) -> str:
    return blocks(table("body", inertia=moments(rng)),
                  table("effects.resistance", coefficient=10 ** rng.uniform(-3, -1)),
                  table("effects.constant_torque", torque=rng.normal(size=3) * 10 ** rng.uniform(-3, -1)),
                  motion(rng))


def field(rng) -> str:
    return blocks(table("body", inertia=moments(rng), mass="10 kg"),
                  table("effects.newtonian_field", strength=10 ** rng.uniform(-2, 1)),
                  motion(rng, span=5, vertical=upward(rng)))


def craft(rng) -> str:
    """Thrusters, of which some are stuck with a tolerance, and wheels."""
    thrusters = ""
    for n in range(rng.integers(1, 3)):
        thrusters += blocks(table("[thrusters]", name=f"T{n}", position=rng.normal(size=3) * 0.5,
                                  direction=upward(rng), force=f"{rng.uniform(0.01, 2):.3g} N",
                                  **({"misalignment": "1 deg"} if rng.random() < 0.5 else {}),
                                  **({"force_tolerance": "5 %"} if rng.random() < 0.5 else {}),
                                  stuck=bool(rng.random() < 0.7))) + "\n"
    wheels = table("[wheels]", name="pitch", axis=[0, 1, 0], momentum=f"{rng.uniform(0.1, 5):.3g} N m s")
    return blocks(table("body", inertia=tensor(rng), mass="100 kg", centre_of_mass=[0, 0, 0]),
                  thrusters, wheels * (rng.random() < 0.6), motion(rng, rates=-0.5, span=120.0),
                  limit(rng, 1.9))


def burning(rng) -> str:
    return blocks(table("body", inertia=tensor(rng), mass="100 kg"),
                  table("[thrusters]", name="B", position=rng.normal(size=3) * 0.5, direction=upward(rng),
                        force=f"{rng.uniform(0.01, 2):.3g} N", stop=f"{rng.integers(5, 50)} s"),
                  motion(rng, rates=-0.5), limit(rng, 1.9))


def satellite(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=body),
                  table("effects.gyrostat", momentum=along(rng, size(rng, -4, -2) * max(body))),
                  table("circular_orbit", altitude=f"{rng.integers(300, 1500)} km"))


def scaled(rng) -> str:
    return blocks(table("scaled", a=rng.uniform(0.1, 0.9), b=rng.uniform(0, 2),
                        mu=along(rng, size(rng, -1, 0))),
                  table("motion", x=rng.normal(size=3), tau=[0, 10]))


def uncertain(rng) -> str:
    body = moments(rng)
    return blocks(table("body", inertia=[f"{moment:.4g} +- 1 %" for moment in body]), wheel(rng, body),
                  table("effects.constant_torque", torque=along(rng, size(rng, -2, -1) * max(body))),
                  motion(rng))


KINDS = {"on-axis": on_axis, "full-tensor": full_tensor, "free": free, "motor": wheel_motor, "damper": damper,
         "eddy": eddy_currents, "rate-damper": rate_damper, "top": top, "heavy": heavy, "charged": charged,
         "liquid": liquid, "resisted": resisted, "field": field, "craft": craft, "burning": burning,
         "satellite": satellite, "scaled": scaled, "uncertain": uncertain}
