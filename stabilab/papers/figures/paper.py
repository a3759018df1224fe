"""The data of the tables and figures of Amer et al. 2024 (Sci. Rep.): its body, momentum wheels, torques and
starts."""
from __future__ import annotations

from ...physics.coefficients import to_scaled, torque_from_mu
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Body, ScaledGyrostat, Scene

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
