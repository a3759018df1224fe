"""The surface on which a motion stays: the sphere of its momentum, or the cylinder of a torque on an axis."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ... import style
from .. import canvas, which
from ..solid import in_space
from ..solid.cylinder import cylinder
from ..solid.momentum_sphere import momentum_sphere
from ..subject import subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def sphere(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None, size: tuple[float, float] | None = None,
           legend: bool = True) -> Axes:
    """Draw the surface on which a motion stays, with the other motions on it, and return the (three-dimensional) axes.

    Without a torque: the sphere of the angular momentum H, wheels included, whose size is constant; its components are those in the body. The lines
    are polhodes, the motions of other energies; the separatrices run through the saddles. Under a torque on a principal axis (or of scaled
    variables, which know no momentum): the cylinder whose base is the curve that the two rates across that axis cannot leave (circle, hyperbola
    or parabola); the height is the rate about the axis, and the phase plane is wrapped round it. Lines behind the surface are pale. Raises
    InputError where no such surface is known; it names the kinds of plot that there are.
    """
    one = subject(case, state)
    which.check("sphere", one)
    found = momentum_sphere(one) if one.physical and which.free(one) else cylinder(one, units)
    with canvas.on(ax, size, space=True) as target:
        in_space.facets(target, [(found.surface, style.GREY)], pale_by=0.22)
        for points, look, front in found.lines:
            in_space.line(target, points, look if front else look | BEHIND, zorder=6 if front else 3)
        for points, look in found.marks:
            in_space.line(target, points, look, zorder=8)
        in_space.furnish(target, found.box, found.labels, found.view)
        canvas.title(target, one.heading, found.words)
        if legend:
            canvas.legend(target, found.rows, ax is None)
    return target


BEHIND = {"alpha": 0.3, "linewidth": 0.7}
