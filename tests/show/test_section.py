"""The Poincaré section of a motion: what is drawn, by another integrator and by what is known of periodic
motions, and of what there is none."""
import math

import numpy as np
import pytest
from matplotlib import pyplot as plt

import stabilab
from stabilab import errors
from stabilab.show import style
from stabilab.show.plot import subject, to_file
from stabilab.show.plot import subject as which
from stabilab.unreduced.periodic import crossed, neighbours_of, returns
from tests.oracles.rigid import euler
from tests.shared import case as load

MOTION, BLUE, VERMILION, SAGE = style.VIOLET, style.BLUE, style.VERMILION, style.SAGE
D, M, WHEEL = np.array([1.2412, .3937,
                        1.3650]), np.array([.0987, .8450, .5255]), np.array([-.5224, .8309, .1914])
ISLAND = stabilab.Scene(stabilab.Body(D.tolist()), stabilab.Gyrostat(WHEEL.tolist()),
                        stabilab.ConstantTorque(M.tolist()))
START = (-1.572, .657, .738)
FAR = 10.0  # rad/s: this motion has 4.21 at most


def dots(ax, colour, alone=None):
    """(n, 2) of the points of a colour; alone: of those that stand alone, or of the others."""
    return np.concatenate([np.empty((0, 2)),
                           *(np.array(line.get_data()).T for line in ax.get_lines() if line.get_color() == colour
                             and alone in (None, len(line.get_xdata()) == 1))])


@pytest.fixture(scope="module")
def island():
    yield stabilab.plot.section(ISLAND, START, units="si", neighbours=4, passages=60)
    plt.close("all")


def passed(start, axis, level, count, span):
    """(count, 3) by DOP853 and its events: where the rate rises through the level."""
    from scipy.integrate import solve_ivp
    event = lambda t, w: w[axis] - level
    event.direction = 1
    return solve_ivp(euler(D, WHEEL, M), (0, span), start, "DOP853", rtol=1e-12, atol=1e-13,
                     events=event).y_events[0][:count]


def test_every_passage_is_one_that_another_integrator_finds_and_none_is_left_out():
    """Oracle: SciPy's DOP853 with events on Euler's equations written by hand."""
    plane = crossed(ISLAND, START)
    times, places = returns(ISLAND, START, plane, 40)
    assert np.abs(places - passed(START, plane.axis, plane.level, 40, times[-1] + 1)).max() < 1e-7


def test_a_passage_that_is_undone_within_the_same_step_is_found():
    """The plane lies just below the top of a rate, so that the rate is beyond it for a part of a step.
    Oracle: DOP853 in steps of 0.01."""
    from scipy.integrate import solve_ivp

    from stabilab.unreduced.periodic import Section, passage
    run = solve_ivp(euler(D, WHEEL, M), (0, 12), START, "DOP853", rtol=1e-12, atol=1e-13, max_step=0.01)
    for axis in range(3):
        top = int(run.y[axis].argmax())
        assert 0 < top < len(run.t) - 1
        level = run.y[axis, top] - 1e-5
        # the last place below the plane before the top
        last = top - 1 - int((run.y[axis, :top][::-1] < level).argmax())
        found = passage(ISLAND, START, Section(axis, level, 1), linear=False)
        assert found is not None and run.t[last] <= found[0] <= run.t[top]


@pytest.mark.slow
def test_passages_in_an_island_go_round_the_marked_periodic_motion(island):
    """The mark is a fixed point of the map (DOP853 brings it back), and the motion's passages surround it."""
    (mark,), own = dots(island, BLUE, alone=True), dots(island, MOTION)
    from stabilab.unreduced.periodic import in_the_middle
    orbit = in_the_middle(ISLAND, START)
    (back,) = passed(orbit.state, orbit.section.axis, orbit.section.level, 2, 1.5 * orbit.period)[-1:]
    assert mark == pytest.approx(np.array(orbit.state)[orbit.section.across]) and np.abs(
        back - orbit.state).max() < 1e-8
    angles = np.sort(np.arctan2(*(own - mark).T))
    assert len(own) == 60 and np.diff(angles).max() < 1 and angles[0] + 2 * math.pi - angles[-1] < 1


@pytest.mark.slow
def test_neighbours_inside_the_island_stay_and_those_far_outside_leave(island):
    """By DOP853 until a rate is more than twice as large as any of this motion: the two neighbours inside
    never come so far, the last one outside does."""
    from scipy.integrate import solve_ivp

    from stabilab.unreduced.periodic import in_the_middle
    (mark,), stay = dots(island, BLUE, alone=True), dots(island, BLUE, alone=False)
    own, leave = dots(island, MOTION), dots(island, VERMILION)
    assert np.abs(stay - mark).max() <= np.abs(own - mark).max() and len(stay) == 2 * 61 and len(leave)
    orbit = in_the_middle(ISLAND, START)
    starts = neighbours_of(np.array(orbit.state), returns(ISLAND, START, orbit.section, 1)[1][0],
                           orbit.section, 4)
    far = lambda _, w: np.abs(w).max() - FAR
    far.terminal = True
    ended = [len(solve_ivp(euler(D, WHEEL, M), (0, 60 * orbit.period), start, "DOP853", rtol=1e-8, atol=1e-8,
                           events=far).t_events[0]) for start in starts[[0, 1, 3]]]
    assert ended == [0, 0, 1]


def test_axes_have_the_two_other_rates_in_the_units_asked_for():
    case = load("torque-free-body")
    deg, si = (stabilab.plot.section(case, units=units, neighbours=1) for units in ("deg", "si"))
    # the motion goes round the first axis
    assert (si.get_xlabel(), si.get_ylabel()) == (r"$\omega_2$ (rad/s)", r"$\omega_3$ (rad/s)")
    assert dots(deg, MOTION) == pytest.approx(np.degrees(dots(si, MOTION))) and "(deg/s)" in deg.get_xlabel()
    plt.close("all")


def lines(ax, colour):
    """[(n, 2)] of the lines of a colour."""
    return [np.array(line.get_data()).T for line in ax.get_lines()
            if line.get_color() == colour and len(line.get_xdata()) > 2]


def test_closed_orbits_of_a_free_body_are_ellipses_out_to_that_of_the_separatrix():
    """By hand: of 2 T = sum D w^2 and H^2 = sum D^2 w^2, H^2 - 2 T D1 = D2 (D2 - D1) w2^2 + D3 (D3 - D1) w3^2 is
    the same all along an orbit; at the separatrix 2 T D2 = H^2."""
    case = load("torque-free-body")
    ax = stabilab.plot.section(case, units="si")
    d1, d2, d3 = case.scene.body.inertia
    assert d1 > d2 > d3  # it goes round the first axis
    kept = lambda line: d2 * (d1 - d2) * line[:, 0]**2 + d3 * (d1 - d3) * line[:, 1]**2
    w = np.array(case.state)
    momentum, energy = np.sum((np.array([d1, d2, d3]) * w)**2), np.sum(np.array([d1, d2, d3]) * w**2)
    edge, own = momentum * (d1 / d2 - 1), energy * d1 - momentum
    rings = lines(ax, BLUE)
    sizes = [kept(ring).mean() for ring in rings]
    assert len(rings) == 10 and sizes == sorted(sizes) and 0 < sizes[0] and sizes[-1] < edge
    for ring in rings:
        assert np.ptp(kept(ring)) < 1e-9 * edge and ring[0] == pytest.approx(ring[-1], abs=1e-9)
    (rim,), (motion,) = lines(ax, style.BLACK), lines(ax, MOTION)
    assert kept(rim) == pytest.approx(np.full(len(rim), edge), rel=1e-4)
    assert kept(motion) == pytest.approx(np.full(len(motion), own), rel=1e-8)
    plt.close("all")


def test_closed_orbits_under_a_torque_are_those_that_another_integrator_follows():
    """Oracle: DOP853 on the scaled equations from a state of a ring, for as long as it takes to come back; the rings
    and the separatrix go round each other."""
    from matplotlib.path import Path
    from scipy.integrate import solve_ivp

    from stabilab.show.plot import rings
    item = subject.subject(load("minor-axis-100"))
    found = rings.island(item, 4)
    assert found.axis is not None and found.kept.endswith("integral")
    shown = [*found.rings, found.rim]
    assert all(Path(b).contains_points(a[:-1]).all() for a, b in zip(shown, shown[1:]))
    rate = item.scene.quadratic().rate
    run = solve_ivp(lambda t, x: rate(list(x)), (0, float(item.motion.period)), item.state, "DOP853", rtol=1e-10,
                    atol=1e-12, max_step=0.002)
    path = np.delete(run.y.T, found.axis, axis=1)
    # a place of the ring is at most half a step of the run from one of its places
    step = np.linalg.norm(np.diff(path, axis=0), axis=1).max()
    apart = [np.linalg.norm(path - at, axis=1).min() for at in found.own[::40]]
    assert max(apart) < 0.51 * step < 0.03 and found.own[0] == pytest.approx(path[0])


def test_rings_that_would_lie_on_others_are_drawn_over_the_turn():
    from stabilab.show.plot import rings
    found = rings.island(subject.subject(load("two-wheels-minor-axis")), 10)
    assert found.axis is None and found.about == 2 and rings.nested([*found.rings, found.rim]) == 11


@pytest.mark.slow
def test_a_periodic_motion_passes_at_one_place_once_a_period():
    """A motion that reduces to one degree of freedom and is bounded repeats; its period by the integral of
    the reduced motion."""
    case = load("minor-axis-100")
    ax = stabilab.plot.section(case, neighbours=3)
    assert len(lines(ax, BLUE)) == 3
    times, _ = returns(case.scene, case.state, crossed(case.scene, case.state), 3)
    assert np.diff(times) == pytest.approx(float(stabilab.period(case.scene, case.state)), rel=1e-10)
    assert "periodic, 1.804 τ" in ax.get_title()
    plt.close("all")


@pytest.mark.slow
def test_of_a_motion_that_spins_up_the_passages_until_that_is_certain_are_drawn():
    """cubesat-3u: its certificate holds from 109.7 s on; the passage after the last one that is drawn is
    later."""
    one = subject.subject(load("cubesat-3u"))
    until, ax = which.certain_from(one), stabilab.plot.section(one.case)
    times, places = returns(one.twin, one.state, crossed(one.twin, one.state, until), 100)
    assert len(dots(ax, MOTION)) == np.count_nonzero(times <= until) < 100
    assert "until spin-up about the minor axis is certain" in ax.figure.legends[0].get_title().get_text()
    plt.close("all")


def test_several_motions_are_drawn_on_the_plane_of_the_first():
    scene, states = load("minor-axis-100").scene, np.array([[2.5, 4, .1], [2.6, 4, .1], [2.4, 4, .1]])
    ax = stabilab.plot.section(scene, states, passages=6)
    assert len(dots(ax, MOTION)) == 6 and len(np.unique(dots(ax, SAGE).round(6), axis=0)) == 2
    plt.close("all")


def test_what_has_no_section_is_refused_with_the_reason():
    rest = stabilab.Scene(stabilab.Body((3, 2, 1)))
    for given, words in (((load("major-axis-100"),),
                          "spin-up about the x1 axis is certain from its start on"),
                         ((load("liquid-base"),), "not with .*liquid"),
                         ((rest, (0.1, 0, 0)), "an equilibrium"),
                         ((load("off-axis-two").scene,), "needs a state"),
                         ((load("torque-free-body"), np.empty((0, 3))), "at least one state")):
        with pytest.raises(errors.InputError, match=words):
            stabilab.plot.section(*given)
    for options, words in (({"neighbours": -1}, "whole number from 0"),
                           ({"passages": 0}, "whole number from 1")):
        with pytest.raises(errors.InputError, match=words):
            stabilab.plot.section(load("minor-axis-100"), **options)


@pytest.mark.slow
def test_a_section_with_neighbours_is_written_the_same_again_and_other_kinds_have_none(tmp_path):
    case = load("torque-free-body")
    one, two = (to_file.write(case, tmp_path / f"{n}.png", "section", neighbours=2).read_bytes()
                for n in (1, 2))
    assert one == two and one.startswith(b"\x89PNG")
    with pytest.raises(errors.InputError, match="a section alone shows them"):
        to_file.write(case, tmp_path / "a.png", "time", neighbours=2)
    assert not (tmp_path / "a.png").exists()
