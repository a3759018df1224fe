"""The data of the tables and figures of Amer et al. 2024 (Sci. Rep.), its body, momentum wheels, torques and
starts; the formulas that it prints and several of these draw or try; and the equilibria."""
from __future__ import annotations

import numpy as np

from ...physics.coefficients import to_scaled, torque_from_mu
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Body, ScaledGyrostat, Scene
from ...show import style

PAPER = "Amer et al. 2024, Sci. Rep."
INERTIA = (2000, 1500, 1000)            # kg m^2
LAMBDAS = (100, 300, 500)               # kg m^2/s, along axis 1
TORQUE = {"major": (1, 0, 0), "middle": (0, 1, 0), "minor": (0, 0, 1)}
START_MINOR = (2.5, 4.0, 0.1)           # Figs 2-7, Table 2
START_MIDDLE = (1.7, 1.1, -0.2)         # Figs 16-17, Table 3
START_PLANE = (2.5, 1.3, 2.5)           # Table 4
START_MAJOR = (4.5, 1.8, 3.4)           # Figs 8-11
START_CAPTURED = (0.0, -1.0, 5.0)       # Figs 12-15
SPAN = (0.0, 15.0)                      # tau


def scene(axis: str, lambda1: float) -> ScaledGyrostat:
    """The paper's scaled system with the torque along the "major", "middle" or "minor" axis (u = 1)."""
    return to_scaled(physical(axis, lambda1), mu=TORQUE[axis])[0]


def physical(axis: str, lambda1: float) -> Scene:
    """The same system in physical variables."""
    body = Body(INERTIA)
    return Scene(body, Gyrostat((lambda1, 0, 0)), ConstantTorque(torque_from_mu(body, TORQUE[axis])))


# of Fig. 4 in the text: lambda1 -> (left and right saddle, left and right centre), alpha
FIG4 = {100: ((0.0, 6.2), (-3.0, 3.3)), 300: ((0.19, 6.15), (-3.1, 3.29)), 500: ((0.32, 5.8), (-3.13, 3.28))}


def height(radius, wheel):
    """Function of alpha, x^2/2 plus which is constant by (25): printed with F and b, true with A and b -
    a."""
    return lambda alpha: radius**2 * np.cos(alpha) - 4 * radius * wheel * np.sin(alpha / 2) - 2 * alpha


def saddle(radius, turn=0.0):
    """alpha of the saddle before a turn as printed below (25): sin alpha = -2/F^2."""
    return turn - np.arcsin(2 / radius**2)


def folds(c: float) -> list[float]:
    """x2 of the two points of the minor axis at which saddle and centre merge, c = b - a."""
    return [h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12]


def fold_radii(c: float) -> list[float]:
    """Radii of the circles about (-a, 0) through them, rising: the least carries the first equilibrium."""
    return sorted(float(np.sqrt(h * h + h**6)) for h in folds(c))


def circle(radius: float, centre: float = 0.0, count: int = 361) -> tuple[np.ndarray, np.ndarray]:
    """(x1, x2) of a circle about (centre, 0)."""
    turn = np.linspace(0, 2 * np.pi, count)
    return centre + radius * np.sin(turn), radius * np.cos(turn)


def side(branch) -> str:
    """The paper's name of a surface of the minor axis: the left loop of the phase plane has alpha in (-2 pi,
    0), where x1 + a < 0 about its centre."""
    return "left" if float(np.asarray(branch.centre)[-1, 0]) < 0 else "right"


def equilibria(axis: str, scene: ScaledGyrostat, heights):
    """(x1, h, whether stable) along both branches of the true equilibria of a torque on the "minor" axis, h =
    x2 and x1 + b = -1/h, or on the "middle" one, h = x3 and x1 + a = 1/h; heights: sizes of h."""
    for h in (heights, -heights):
        x1, sign = (-scene.b - 1 / h, -1) if axis == "minor" else (-scene.a + 1 / h, 1)
        yield x1, h, (x1 + scene.a) * (x1 + scene.b) + sign * h * h > 0


def draw_equilibria(ax, x1, h, stable) -> None:
    """A branch of `equilibria`, stable and unstable parts, in a plane or in space."""
    for kind, mask in (("stable", stable), ("unstable", ~stable)):
        line = np.where(mask, x1, np.nan), np.where(mask, h, np.nan), 0 * h
        ax.plot(*line[:3 if ax.name == "3d" else 2], **style.MEANING[kind])


def drift(runs) -> float:
    """The largest drift of the laws of the motion along the runs."""
    return max(d for run in runs for d in run.invariant_drift.values())


def name_space(ax, zoom=0.92, order=(1, 2, 3)):
    """Labels of the three axes of a 3-D picture, close to it and not clipped; `order`: components along its
    axes."""
    from matplotlib.ticker import MaxNLocator
    for setter, component, pad in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), order, (-2, -2, -4)):
        setter(f"$x_{component}$", labelpad=pad, rotation=0)
    ax.tick_params(pad=-1, labelsize=8)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_rotate_label(False)  # upright from every side
        axis.set_major_locator(MaxNLocator(5))
        axis.set_pane_color((1, 1, 1, 0))  # white would cover a label of the panel before
    ax.patch.set_visible(False)
    ax.set_box_aspect(None, zoom=zoom)
