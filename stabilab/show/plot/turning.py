"""The body turning in space, as an animation."""
from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.simulate import simulated, trajectory
from ...case.sections import attitude_of
from ...errors import InputError, RenderingUnavailable, printable
from ...files import whole_file
from ...physics.equations import rotation
from ...physics.states import quaternion, start_of
from .. import endings, style
from ..assumed import Assumed
from ..report import html
from ..turns.moment import moment
from ..units import SHORT, Unit, Units, number
from . import canvas, in_space
from . import subject as subjects
from .body import CORNERS, FACES, box_sides
from .subject import Measures, Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from mpl_toolkits.mplot3d import Axes3D


# --- The attitude of a body at the times of the pictures of a film, and the box that stands for the body
FRAMES = 150
# a body turns by no more from one picture to the next: the eye would see it turn backwards
STEP = np.radians(15)
TRIED = np.linspace(0.0, 1.0, 3001)[1:]  # shares of the span, at which the rate of turning is looked at
SLOW = {2: 0.35, 3: 0.24}  # of all pictures, those of each of the stretches that go slowly, of so many
FEWEST = 12  # pictures of a film that goes slow and fast
WIDE = 2.0  # steps: a film of which none is wider goes evenly
AROUND, CHOICES = 4.0, 120  # turns from which a picture is chosen where a film goes fast, and of how many
THINNEST = 0.06  # of the longest edge


@dataclass(frozen=True)
class Turn:
    """t: (n,) s; rotations: (n, 3, 3) from body to space; omega: (n, 3) rad/s; edges: (3,) half edges of the
    box, the longest 1; whole: whether the span that was asked for is shown to its end; asked: its length, s;
    momentum: (n, 3) of body and wheels in space, N m s; torque: (3,) the constant one, N m, body; wheel: (3,)
    momentum of the wheels, N m s, body; share: (n,) of the limit of the case, or, assumed, of the one
    that is taken where it states none; None without either. even: (first, last) picture of the stretches that
    go on evenly, between which it goes fast; moment: (time, words) of what matters in its time, None where
    nothing is known to; later: the same of what matters after its end."""

    t: np.ndarray
    rotations: np.ndarray
    omega: np.ndarray
    edges: np.ndarray
    whole: bool
    asked: float
    momentum: np.ndarray
    torque: np.ndarray
    wheel: np.ndarray
    share: np.ndarray | None
    even: tuple[tuple[int, int], ...] = ()
    moment: tuple[float, str] | None = None
    assumed: bool = False
    later: tuple[float, str] | None = None

    @property
    def arrows(self) -> list[tuple[str, str, np.ndarray]]:
        """(letter, colour, (n, 3) in space) of momentum, torque and wheels, the longest as long as is drawn.
        """
        result = (("H", style.BLACK, OUT, self.momentum),
                 ("M", style.GREY, OUT, self.rotations @ self.torque),
                 ("λ", style.GREY, WHEEL, self.rotations @ self.wheel))
        largest = [np.abs(rows).max() or 1.0 for *_, rows in result]  # of tiny ones the squares vanish
        return [(letter, colour, long * (rows / upper) / np.linalg.norm(rows / upper, axis=1).max())
                for (letter, colour, long, rows), upper in zip(result, largest) if rows.any()]

    @property
    def words(self) -> str:
        """What the arrows are."""
        text = {"H": "angular momentum of body and wheels", "M": "torque", "λ": "momentum of the wheels"}
        return "; ".join(f"{letter}: {text[letter]}" for letter, *_ in self.arrows)

    def part(self, units: Units) -> str:
        """How a film goes that is not even, or ends before its span or before what matters."""
        later = ("" if self.later is None
                 else f"It ends before what matters: {self.later[1]}, {units.time(self.later[0], SHORT)}.")
        return " ".join(filter(None, (self._pace(units), later)))

    def _pace(self, units: Units) -> str:
        if len(self.even) > 1:
            middle = (f", at {units.time(self.moment[0], SHORT)} ({self.moment[1]})"
                      if self.moment is not None and len(self.even) > 2 else "")
            return f"Slow at the start{middle} and at the end, fast between."
        return ("" if self.whole
                else f"The first {units.time(float(abs(self.t[-1] - self.t[0])), SHORT)} of "
                     f"{units.time(self.asked, SHORT)} are shown.")

    def noted(self, units: Units) -> str:
        """The moment that matters, and when it is; empty where there is none."""
        return "" if self.moment is None else f"{self.moment[1]}: {units.time(self.moment[0], SHORT)}"

    def notes(self, units: Units) -> list[tuple[int, int, str]]:
        """(first, last picture, what is said of them): of one even film from the moment that matters on."""
        if len(self.even) == 1 and self.moment is not None:
            return [(int(np.searchsorted(self.t, self.moment[0])), len(self.t) - 1, self.noted(units))]
        inside = [(a, b) for a, b in self.even if self.moment is not None
                  and self.t[a] <= self.moment[0] <= self.t[b]]
        fast = [(b + 1, c - 1, "fast") for (_, b), (c, _) in pairwise(self.even)]
        return [*((a, b, self.noted(units)) for a, b in inside), *fast]

    def since(self, frame: int) -> int:
        """The first picture of the stretch that a picture belongs to."""
        return next((a for a, b in self.even if a <= frame <= b), frame)


def turn(item: Subject, frames: int = FRAMES, limit: Assumed | None = None) -> Turn:
    """The motion in so many pictures over its span: evenly where these are enough at `STEP`, else slow at its
    start, at the moment that matters and at its end, and fast between; as far as a run goes. limit: taken
    where the case states none."""
    if not 2 <= frames <= 5000:
        raise InputError(f"frames: expected 2 to 5000, got {frames!r:.40}")
    low, high = item.seen
    known = moment(item.motion, None if limit is None else limit.time)
    (t, rotations, omega), even = _paced(item, low, high, frames, known and known[0])
    matters = known if known is not None and low < known[0] <= t[-1] else None
    later = known if matters is None and known is not None and low < t[-1] < known[0] else None
    full = abs(t[-1] - high) <= 1e-9 * abs(high - low)
    scene: Any = item.scene  # physical: `which` refuses the others
    vector = lambda name: (np.array([float(v) for v in scene.vector(name)])
                           if scene.effect(name) is not None else np.zeros(3))
    wheel = vector("gyrostat")
    momentum = np.einsum("nij,nj->ni", rotations, omega * np.array(scene.body.inertia) + wheel)
    edges = np.maximum(box_sides(scene.body.inertia), THINNEST)
    return Turn(t, rotations, omega, edges, full, abs(high - low), momentum, vector("constant_torque"),
                wheel, _share(item, omega, limit), even, matters, limit is not None, later)


def _share(item: Subject, omega: np.ndarray, limit: Assumed | None):
    """(n,) how much of the limit of a case, or of the one assumed, rates (n, 3) have reached; None where
    nothing turns."""
    limits = None if item.case is None else item.case.limits
    if limits is None:
        return None if limit is None else np.linalg.norm(omega, axis=1) / limit.rate
    if limits.rate is not None:
        return np.linalg.norm(omega, axis=1) / float(limits.rate)
    parts = [(np.array([float(v) for v in axis]), float(largest))
             for axis, largest in limits.components(item.case.frame)]
    return np.max([np.abs(omega @ axis) / largest for axis, largest in parts], axis=0)


def _paced(item: Subject, low: float, high: float, frames: int, middle: float | None):
    """(the motion at the times of the pictures, the stretches of these that go on evenly: one of all where no
    step is too wide). Where it goes fast each picture is the one, of those within some turns, that the body
    has turned least to."""
    direction = float(np.sign(high - low))
    t, _, omega = _at(item, low + abs(high - low) * direction * np.concatenate([[0.0], TRIED]))
    rate = np.linalg.norm(omega, axis=1)
    high = float(t[-1])
    if rate.max() * abs(high - low) <= WIDE * STEP * (frames - 1):
        return _at(item, np.linspace(low, high, frames)), ((0, frames - 1),)
    if direction < 0 or frames < FEWEST:  # its first part
        fits = np.maximum.accumulate(rate) * np.abs(t - low) <= STEP * (frames - 1)
        return _at(item, np.linspace(low, max(t[fits][-1], t[1], key=abs), frames)), ((0, frames - 1),)
    step = lambda at: STEP / max(float(np.interp(at, t, rate)), 1e-3 * float(rate.max()))
    inside = middle is not None and low < middle < high
    slow = _slow(low, high, middle if inside else None, frames, t, rate)
    left = frames - sum(map(len, slow))
    counts = [left // (len(slow) - 1) + (n < left % (len(slow) - 1)) for n in range(len(slow) - 1)]
    tried = []
    for (before, after), count in zip(pairwise(slow), counts):
        share = np.arange(1, count + 1) / (count + 1)
        # faster in its middle
        targets = before[-1] + (after[0] - before[-1]) * share**2 * (3 - 2 * share)
        wide = np.minimum(AROUND * 2 * np.pi / STEP * np.array([step(at) for at in targets]),
                          0.9 * np.diff(np.concatenate([before[-1:], targets])))
        tried.append(targets[:, None] - wide[:, None] * np.linspace(0, 1, CHOICES)[None, :])
    reached, rotations, rates = _at(item, np.unique(np.concatenate([*slow, *map(np.ravel, tried)])))
    index = lambda times: np.minimum(np.searchsorted(reached, times), len(reached) - 1)
    chosen: list[int] = []
    even = []
    for n, row in enumerate(slow):
        even.append((len(chosen), len(chosen) + len(row) - 1))
        chosen += index(row).tolist()
        for choices in tried[n] if n < len(tried) else ():
            places = index(choices)
            alike = np.einsum("nij,ij->n", rotations[places], rotations[chosen[-1]])
            chosen.append(int(places[alike.argmax()]))
    return (reached[chosen], rotations[chosen], rates[chosen]), tuple(even)


def _slow(low: float, high: float, middle: float | None, frames: int, t: np.ndarray,
          rate: np.ndarray) -> list[np.ndarray]:
    """The times of the pictures where a film goes slowly: at the start, about a moment, at the end."""
    times = [low, high] if middle is None else [low, middle, high]
    result: list[np.ndarray] = []
    for n, at in enumerate(times):
        before = n / (len(times) - 1)
        count, now = max(2, round(SLOW[len(times)] * frames)), float(np.interp(at, t, rate))
        step = min(STEP / max(now, 1e-3 * float(rate.max())), (high - low) / (len(times) * count))
        while step * _fastest(t, rate, at - before * count * step, at + (1 - before) * count * step) > STEP:
            step /= 1.1
        first = at - before * (count - 1) * step
        if result and first <= result[-1][-1]:
            first = result[-1][-1] + step
        result.append(np.minimum(first + step * np.arange(count), high))
    count = len(result[-1])
    first = max(result[-1][0], result[-2][-1] + (high - result[-2][-1]) / (2 * count))
    result[-1] = np.linspace(first, high, count)
    return result


def _fastest(t: np.ndarray, rate: np.ndarray, low: float, high: float) -> float:
    """The largest rate between two times."""
    inside = rate[(t > low) & (t < high)]
    return float(max(inside.max(initial=0.0), *np.interp((low, high), t, rate)))


def _at(item: Subject, times: np.ndarray):
    """(times, rotations, rates), as far as the run goes."""
    upright = attitude_of(item.blocks["gamma"]) if "gamma" in item.blocks else (0.0, 0.0, 0.0)
    first = tuple(item.blocks.get("attitude", upright))
    blocks = {**item.blocks, "attitude": first}
    if item.scene.plain:
        run = trajectory(item.scene, start_of(item.scene, item.state, blocks), times, laws=False)
        t, omega, attitudes = run.t, run.block("omega"), run.block("attitude")
    else:
        result = simulated(item.scene, item.state, times, blocks)
        t, omega = result.t, result.state["omega"]
        attitudes = np.array([quaternion(*row) for row in result.state["angles"]])
    if len(t) < 2:
        raise InputError("plot attitude: the motion cannot be followed: the run stopped at its start")
    return t, np.moveaxis(np.array(rotation(attitudes.T)), -1, 0), omega


# --- The body's box as it turns, as one page of HTML that needs nothing else
SMOOTH = 600  # frames of a page, which are numbers and no pictures


def drawn(item: Subject, result: Turn, time: Unit, rate: Unit, system: Units,
          row: Callable[[np.ndarray], Any]) -> dict[str, Any]:
    """What templates/turning.js draws. time, rate: units; system: in which its words are; row: what a page
    has for an array of any shape."""
    unit, per = time
    return {"t": row(result.t * per), "unit": unit, "rate": rate[0],
            "size": row(np.linalg.norm(result.omega, axis=1) * rate[1]), "rotations": row(result.rotations),
            "corners": (CORNERS * result.edges).round(5).tolist(), "edges": result.edges.round(5).tolist(),
            "faces": FACES, "colours": COLOURS, "names": [item.axes.label(n) for n in (1, 2, 3)],
            "tip": int(np.argmax(np.abs(result.omega[0]))), "real": float(abs(result.t[-1] - result.t[0])),
            "arrows": [[letter, colour, row(rows)] for letter, colour, rows in result.arrows],
            "share": None if result.share is None else row(result.share), "assumed": result.assumed,
            "even": result.even, "notes": result.notes(system)}


def page(item: Subject, result: Turn, scale: Measures, path: Path) -> Path:
    """Write the page."""
    def row(values: np.ndarray):
        return [float(f"{v:.6g}") + 0.0 for v in values.ravel()]
    data = drawn(item, result, scale.time(float(np.abs(result.t).max())), scale.rate, scale.system, row)
    # nothing of it ends the script
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return html.write(path, "attitude.html", title=printable(item.heading or "Attitude"), data=text,
                      part=result.part(scale.system), arrows=result.words, said=canvas.answer(item, scale))


# --- The body's box as it turns, as an animation of Matplotlib
ENDINGS = (".html", ".gif", ".mp4")
SIZE = (5.2, 5.2)
PER_SECOND, PICTURES = 20, 100  # of a film
DPI = 80
COLOURS = style.AXES  # faces across axes 1, 2, 3, and these axes
HALF_PICTURE = 1.75  # half the picture, in half edges
OUT, WHEEL = 1.5, 1.25  # lengths of the body's axes, momentum and torque; of the wheels' momentum
# of the eye, in half edges: ten units of Matplotlib, in which the box of the axes is zoom * 25/18 wide
DISTANCE = 10 * 2 * HALF_PICTURE / (1.1 * 25 / 18)
BEHIND, BEFORE = 1, 3  # the box


def attitude(case: Any, state: Any = None, ax: Any = None, span: Any = None, frames: int = FRAMES,
             units: str | None = None,
             size: tuple[float, float] | None = None) -> FuncAnimation:
    """The body turning in space, as an animation of Matplotlib (keep it, or nothing moves).

    The box is the even one with the body's moments of inertia; its faces and axes have the colours of the
    principal axes, and the line is the path of the tip of the axis about which the body turns most at the
    start. Arrows: angular momentum, constant torque, momentum of the wheels; in words, how much of the limit
    of the case the rates have reached. The start has the attitude of the case, else one that holds its
    vertical upright, else body and space are aligned. Where the span would need more pictures than `frames`
    at 15 degrees each, it goes slow at its start, at its limit (or where it turns over) and at its end, and
    fast between. Raises InputError for scaled variables.
    """
    from matplotlib.animation import FuncAnimation
    item = subject(case, state, span)
    subjects.check("attitude", item)
    out, scale = turn(item, frames, item.assumed), measures(item, units)
    with canvas.on(ax, size or SIZE, space=True) as target:
        draw = _stage(target, out, item, scale)
        if ax is None:  # laid out once, not for every picture
            target.figure.draw_without_rendering()
            target.figure.set_layout_engine("none")
        return FuncAnimation(target.figure, draw, frames=len(out.t), interval=1000 / PER_SECOND, blit=False)


def film(item: Subject, path: Path, units: str | None = None, size: tuple[float, float] | None = None,
         dpi: float | None = None) -> Path:
    """The animation as a file: .html, a page that needs nothing else; .gif; .mp4, where ffmpeg is installed.
    """
    import matplotlib.animation
    kind = endings.ending(endings.file(path, ENDINGS))
    if kind == ".html":
        return page(item, turn(item, SMOOTH, item.assumed), measures(item, units), path)
    if kind == ".mp4" and not matplotlib.animation.writers.is_available("ffmpeg"):
        raise RenderingUnavailable(
            "no .mp4 can be written: ffmpeg is not installed: apt install ffmpeg; .gif and .html need "
            "nothing more")
    moving = attitude(item, frames=PICTURES, units=units, size=size)
    writer = (matplotlib.animation.PillowWriter(fps=PER_SECOND) if kind == ".gif"
              else matplotlib.animation.FFMpegWriter(
        fps=PER_SECOND, extra_args=["-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1",
                                    "-pix_fmt", "yuv420p", "-f", "mp4"]))
    with whole_file(path) as waiting:
        beside = waiting.with_name(f"{waiting.name}{kind}")  # the writers know formats by their endings
        try:
            moving.save(beside, writer=writer, dpi=dpi or DPI)
            beside.replace(waiting)
        finally:
            beside.unlink(missing_ok=True)
    return Path(path)


def _stage(ax: Axes3D, result: Turn, item: Subject, scale: Measures):
    """The scene of the animation; draw(frame) moves it."""
    from matplotlib.patheffects import withStroke
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    box = Poly3DCollection(_faces(result, 0), facecolors=[in_space.pale(COLOURS[n // 2]) for n in range(6)],
                           edgecolors=style.BLACK, linewidths=0.8,
                           zorder=(BEHIND + BEFORE) / 2)
    ax.add_collection3d(box)
    # it sorts whole artists by their middles, and drew axes that leave by a hidden face before the box
    ax.computed_zorder = False
    axes = [ax.plot([], [], [], color=colour, linewidth=2.2)[0] for colour in COLOURS]
    halo = [withStroke(linewidth=3, foreground="white")]  # a name is to be read on a face of its colour
    names = [ax.text(0, 0, 0, item.axes.label(n), color=colour, fontsize=11, weight="bold", path_effects=halo)
             for n, colour in enumerate(COLOURS, 1)]
    now = ax.text2D(0.5, 0.97, "", transform=ax.transAxes, ha="center", va="center")
    canvas.title(ax, item.heading, canvas.answer(item, scale), most=style.TITLE_LINES)
    ax.text2D(0.5, -0.02, "\n".join(filter(None, (result.words, result.part(scale.system)))),
              transform=ax.transAxes, ha="center", va="top", fontsize="small")
    pointers: list[Any] = []
    ways = [ax.plot([], [], [], color=style.GREY, linewidth=0.9, zorder=order)[0]
            for order in (BEHIND, BEFORE)]
    tips = result.rotations[:, :, int(np.argmax(np.abs(result.omega[0])))] * OUT
    for setter in (ax.set_xlim, ax.set_ylim, ax.set_zlim):
        setter(-HALF_PICTURE, HALF_PICTURE)
    for setter, letter in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), "XYZ"):
        setter(f"{letter} (space)", labelpad=-12)
    for setter in (ax.set_xticklabels, ax.set_yticklabels, ax.set_zticklabels):
        setter([])
    ax.set_box_aspect((1, 1, 1), zoom=1.1)
    ax.view_init(*in_space.VIEW)
    unit, per = scale.time(float(np.abs(result.t).max()))
    rates = np.linalg.norm(result.omega, axis=1) * scale.rate[1]
    notes = result.notes(scale.system)

    limit = "an assumed limit" if result.assumed else "the limit"

    def draw(frame: int):
        box.set_verts(_faces(result, frame))
        eye = _eye(ax)
        for n, (line, name) in enumerate(zip(axes, names)):
            tip = result.rotations[frame][:, n] * OUT
            line.set_data_3d(*zip(tip * result.edges[n] / OUT, tip))  # from its face on
            name.set_position_3d(tip * 1.1)
            visited = result.rotations[frame][:, n] @ eye > result.edges[n]  # the face that it leaves by
            line.set_zorder(BEFORE if visited else BEHIND)
            name.set_zorder(BEFORE if visited else BEHIND)
        gone = tips[result.since(frame):frame + 1]
        for route, shown in zip(ways, (gone @ eye <= 0, gone @ eye > 0)):
            route.set_data_3d(*np.where(_with_ends(shown)[:, None], gone, np.nan).T)
        for artist in pointers:
            artist.remove()
        pointers[:] = [ax.quiver(0, 0, 0, *rows[frame], color=colour, linewidth=2.0, arrow_length_ratio=0.12,
                                 zorder=BEFORE + 1) for _, colour, rows in result.arrows]
        pointers.extend(ax.text(*(1.12 * rows[frame]), letter, color=colour, weight="bold", path_effects=halo,
                                zorder=BEFORE + 1) for letter, colour, rows in result.arrows)
        fraction = None if result.share is None else result.share[frame]
        note = "; ".join(text for first, last, text in notes if first <= frame <= last)
        now.set_text(f"{number(result.t[frame] * per)} {unit}, |ω| = {number(rates[frame])} {scale.rate[0]}"
                     + ("" if fraction is None else f", {fraction:.0%} of {limit}".replace("%", " %"))
                     + f"\n{note}")
        now.set_color(style.BLACK if fraction is None or fraction < 1 else style.VERMILION)
        return [box, *axes, *names, *ways, now]

    draw(0)
    return draw


def _eye(ax: Axes3D) -> np.ndarray:
    """Where the picture is seen from."""
    up, round_ = np.deg2rad((ax.elev, ax.azim))
    return DISTANCE * np.array([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)])


def _with_ends(shown: np.ndarray):
    """Points of a line, and those next to them, so that no piece between the two halves is missing."""
    result = shown.copy()
    result[1:] |= shown[:-1]
    return result


def _faces(result: Turn, frame: int) -> list[np.ndarray]:
    corners = (CORNERS * result.edges) @ result.rotations[frame].T
    return [corners[list(face)] for face in FACES]
