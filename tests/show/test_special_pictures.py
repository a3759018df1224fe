"""Pictures of burns and of satellites on a circular orbit: what they draw, by equations written here, and what
they have no picture of."""
import numpy as np
import pytest
from PIL import Image
from scipy.integrate import solve_ivp

import stabilab
from stabilab.answers.stuck.burn import with_latest
from stabilab.case.read import load_any
from stabilab.errors import InputError
from stabilab.show import picture_kinds, style
from stabilab.show.plot import canvas, thumbnail, to_file
from stabilab.show.plot import subject as subjects
from stabilab.show.plot.subject import measures, subject
from stabilab.show.report import one_case
from stabilab.show.text.badge import badge
from stabilab.show.text.headline import look
from stabilab.show.text.stuck import burn_headline, burn_motion
from stabilab.show.units import SYSTEMS
from tests.oracles.rigid import euler
from tests.shared import CASES

BURN = """
title = "Two pulses"
[body]
inertia = [30, 20, 10]
[[thrusters]]
name = "P"
position = [0, 1, 0]
direction = [0.3, 0, 1]
force = 2
start = 1
stop = 8
period = 4
duty = 0.5
[limits]
rate = "15 deg/s"
[motion]
angular_velocity = ["3 deg/s", "10 deg/s", "-4 deg/s"]
"""
D, START = np.array([30.0, 20, 10]), np.radians([3.0, 10, -4])
TORQUE = np.cross([0, 1, 0], 2 * np.array([0.3, 0, 1]) / np.hypot(0.3, 1))
PULSES = ((0, 1, 0), (1, 3, 1), (3, 5, 0), (5, 7, 1), (7, 9.8, 0))  # s, s, whether it fires: by hand


def rates(times):
    """(n, 3), deg/s: by DOP853, pulse by pulse."""
    state, out = START, []
    for begin, end, fires in PULSES:
        run = solve_ivp(euler(D, torque=fires * TORQUE), (begin, end), state,
                        "DOP853", rtol=1e-11, atol=1e-12, dense_output=True)
        inside = times[(times >= begin) & (times < end)]
        out += [run.sol(inside).T] if len(inside) else []
        state = run.y[:, -1]
    return np.degrees(np.concatenate(out))


def test_rates_of_a_burn_are_drawn_across_its_switches():
    """Oracle: DOP853 from Euler's equations. The switches are where the schedule has them."""
    with style.drawing():
        ax = stabilab.plot.time(BURN)
        lines = {line.get_color(): line for line in ax.get_lines() if len(line.get_xdata()) > 100}
        times = np.linspace(0.05, 9.7, 40)
        for n, (colour, expected) in enumerate(zip(style.AXES, rates(times).T)):
            drawn = np.interp(times, *lines[colour].get_data())
            assert np.abs(drawn - expected).max() < 1e-3, n  # of some 20 deg/s, between 20,000 places
        ruled = {round(float(line.get_xdata()[0]), 9) for line in ax.get_lines()
                 if len(set(line.get_xdata())) == 1 and line.get_linestyle() == "-"}
        assert ruled == {1.0, 3.0, 5.0, 7.0}
        words = "; ".join(text.get_text() for text in ax.figure.legends[0].get_texts())
        assert all(part in words for part in ("firing: P", "last closing, 7 s", "close by", "then never above")), words
        assert ax.get_title().splitlines()[0] == "Two pulses"


def test_what_follows_a_burn_has_the_pictures_of_a_free_motion():
    """Their start is the state at the last closing: DOP853, 7 s."""
    item = subject(BURN)
    assert np.degrees(item.state) == pytest.approx(rates(np.array([7.0]))[0], rel=1e-8)
    assert item.heading == "Two pulses"
    assert {"time", "body", "sphere", "space", "equilibria", "attitude"} <= set(subjects.offered(item))


def test_pictures_of_what_follows_a_burn_say_so_and_what_limits_the_burn():
    """The propellant that leaves limits the rates at the last closing, and all that follows; a thruster's
    tolerance stands there once, in the words of the burn."""
    item = subject(CASES / "burns/stage.toml")
    for answered in (True, False):
        first, *others = (note.full for note in canvas.notes(item, measures(item), answered))
        assert first == canvas.AFTER_BURN
        assert any("12 kg of 4100 kg leave the body" in text for text in others)
    loose = subject(BURN.replace("force = 2\n", 'force = "2 N +- 5 %"\n'))
    assert sum("P" in note.full.split() for note in canvas.notes(loose, measures(loose))) == 1


def test_limits_of_the_components_are_drawn_across_a_burn():
    """Limits as the file has them, on both sides of zero."""
    with style.drawing():
        ax = stabilab.plot.time(BURN.replace('"15 deg/s"', '["15 deg/s", "12 deg/s", "90 deg/s"]'))
        dashed = {round(float(line.get_ydata()[0]), 9) for line in ax.get_lines() if line.get_linestyle() == "--"
                  and len(set(line.get_ydata())) == 1}
        assert dashed >= {15.0, -15.0, 12.0, -12.0, 90.0, -90.0}


@pytest.mark.parametrize("name", ["orbits/boom", "orbits/spinning"])
def test_attitudes_at_rest_are_drawn_at_rest(name):
    """From the axes of the body as each panel has them: gravity gradient and gyroscopic torque balance
    (3 n^2 u x D u = w x (D w + h), w along the orbit normal), with numbers of the file by hand."""
    D, wheel, rate = {"orbits/boom": ((2530, 2560, 85), (0, -1.3, 0), np.sqrt(398600441800000 / 7178137.0**3)),
                      "orbits/spinning": ((100, 100, 150), (0, 0, 0.15), 1e-3)}[name]
    item = subject(CASES / f"{name}.toml")
    with style.drawing():
        figure = stabilab.plot.equilibria(CASES / f"{name}.toml").figure
        count = {"orbits/boom": 8, "orbits/spinning": 4}[name]
        assert len(figure.axes) == count
        for ax in figure.axes:
            tips = [next(np.array(line.get_data_3d())[:, 1] for line in ax.get_lines()
                         if line.get_color() == colour) for colour in style.AXES]
            turn = np.array([tip / np.linalg.norm(tip) for tip in tips])  # rows: the body's axes in the frame
            assert np.linalg.det(turn) == pytest.approx(1)
            spin, up = rate * turn[:, 1], turn[:, 2]
            torque = 3 * rate**2 * np.cross(up, D * up) - np.cross(spin, D * spin + wheel)
            assert np.abs(torque).max() < 1e-9 * rate**2 * max(D)
            verdict = ax.get_title().partition(":")[2].split()[0]
            (box,) = [each for each in ax.collections if each.get_facecolor().shape[0] == 6]
            colour = {"stable": style.BLUE, "unstable": style.VERMILION, "undecided": style.AMBER}[verdict]
            assert np.allclose(box.get_edgecolor()[0, :3], [int(colour[n:n + 2], 16) / 255 for n in (1, 3, 5)])
    assert subjects.offered(item) == ("equilibria", "body")


@pytest.mark.parametrize(("source", "kinds"), [(BURN, ("tilt", "wheel", "budget")), (
    CASES / "orbits/boom.toml", set(picture_kinds.KINDS) - {"equilibria", "body"})])
def test_a_kind_without_a_picture_says_why_in_one_sentence(source, kinds, tmp_path):
    for kind in kinds:
        why = subjects.why_not(kind, subject(source))
        assert 20 < len(why) < 130 and "\n" not in why
        with pytest.raises(InputError, match=f"plot {kind}: "):
            to_file.write(source, tmp_path / ("a.html" if kind == "attitude" else "a.png"), kind)


def test_a_burn_is_followed_once_for_a_page(tmp_path, monkeypatch):
    """Its pictures, its limits and its words are of one answer; the latest closing time is added to it."""
    calls, burn = [], subjects.burn
    monkeypatch.setattr(subjects, "burn", lambda *of: (calls.append(of), burn(*of))[1])
    monkeypatch.setattr(style, "save", lambda figure, path, *rest, **more: path)
    monkeypatch.setattr(one_case, "picture", lambda path, narrow=None, **text: text | {"file": path.name})
    page = one_case.sections_of_special(load_any(BURN), tmp_path, "burn", deep=False)
    assert [row["kind"] for row in page["pictures"]][:1] == ["time"] and len(calls) == 1
    answer, burning = stabilab.burn(BURN), load_any(BURN)
    assert with_latest(answer, burning, burning.craft.limits.rate) == stabilab.burn(
        BURN, below=burning.craft.limits.rate)


def test_a_card_of_a_burn_shows_its_rates_and_of_an_orbit_its_body(tmp_path):
    """The largest |omega| of the burn by DOP853 between its switches, from the file of the picture's curve."""
    with style.drawing() as plt:
        ax = thumbnail._picture(plt, [(subject(BURN.replace("[limits]\nrate = \"15 deg/s\"\n", "")), "bounded")],
                                None).axes[0]
        t, drawn = ax.get_lines()[0].get_data()
        times = np.linspace(0.05, 9.7, 40)
        expected = np.linalg.norm(rates(times), axis=1)
        assert np.abs(np.degrees(np.interp(times, t, drawn)) - expected).max() < 1e-3
        assert "deg/s" in ax.texts[0].get_text()
    made = thumbnail.write([(subject(CASES / "orbits/boom.toml"), "")], tmp_path / "a.png")
    assert len(Image.open(made).convert("RGB").getcolors(1000)) > 8


@pytest.mark.parametrize("titled", [True, False])
def test_a_narrow_picture_of_attitudes_has_the_verdict_of_each(tmp_path, monkeypatch, titled):
    """The heading of the case, which a page has, is the title of the whole figure, not of its first panel."""
    saved = []
    monkeypatch.setattr(to_file.narrow_pictures, "save", lambda figure, path, *more: saved.append(
        [ax.get_title().partition(":")[0] for ax in figure.axes]))
    monkeypatch.setattr(to_file.style, "save", lambda figure, path, *more: path)
    to_file.write_all(CASES / "orbits/spinning.toml", tmp_path / "a.png", "equilibria",
                      narrow=tmp_path / "b.png", titled=titled)
    assert saved == [["one of a family"] * 4]


@pytest.mark.slow
def test_their_pages_begin_with_these_pictures(tmp_path):
    for name, kind, line in (("burns/stage", "time", "CLOSED at t = 20.4082 min"),
                             ("orbits/boom", "equilibria", "16 EQUILIBRIA, 2 STABLE")):
        page = one_case.sections_of_special(load_any(CASES / f"{name}.toml"), tmp_path, "a", deep=False)
        assert page["first"].startswith(line) and page["headline"].startswith(line)
        assert [name for name, _ in page["answer"][0]["rows"]][0] in ("last closing", "orbit")
        assert page["pictures"][0]["kind"] == kind and (tmp_path / page["thumbnail"]["file"]).exists()
        assert any("orbit" in why or "burn" in why for _, why in page["absent"])


def test_a_burn_that_passes_the_limit_of_its_file_says_when_in_every_view():
    """The time by DOP853, pulse by pulse; of a limit above all rates nothing is said."""
    times = np.linspace(0.0, 9.7, 97_001)
    at = times[np.argmax(np.linalg.norm(rates(times), axis=1) >= 15)]
    answer = stabilab.burn(BURN)
    (caveat,) = (item for item in answer.caveats if item.kind == "limit")
    assert caveat.reason.quantities["time"].value == pytest.approx(at, abs=1.5e-4)
    moved = burn_motion(answer)
    assert (badge(moved), look(moved)) == ("bounded, reaches its limit", "changes")
    assert f"reaches 15 deg/s after {at:.4g} s (proved)" in burn_headline(answer, SYSTEMS["deg"])
    assert badge(burn_motion(stabilab.burn(BURN.replace('"15 deg/s"', '"90 deg/s"')))) == "bounded"
