"""A run that ends before its span shows nothing of the rest: arrays have NaN there, one motion says how far
it came."""
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, LiquidCavity, Scene, extremes, motion
from stabilab.integrate import events as extrema

STATES = [[0.05, 0.01, 0.01], [0.0, 0.0, 0.0]]
SCENES = {
    "off axis": Scene(Body((10, 10, 6)), Gyrostat((1e150, .1, .2)), ConstantTorque((.001, .01, .02))),
    "growth": Scene(Body((12, 9, 5)), Gyrostat((1e150, 0, 0)), ConstantTorque((1, 0, 0))),
    "aligned": Scene(Body((10, 10, 6)), Gyrostat((1e150, 2e150, 0)), ConstantTorque((.1, .2, 0))),
}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("kind", SCENES)
def test_extremes_that_no_run_has_seen_are_nan(kind, monkeypatch):
    """A wheel of 1e150 turns the transverse rates some 1e149 times a second (Euler's equations: D2 omega2' =
    -l1 omega3 + ..), so a least and a greatest rate equal to the start's cannot be; and in the growing sense
    the rate is infinite by law."""
    monkeypatch.setattr(extrema, "STEP_LIMIT", 20_000)  # of a million, half a minute
    found = extremes(SCENES[kind], np.array(STATES[:1]), span=1.0)
    assert (np.isnan(found) | np.isinf(found)).all() and np.isnan(found[0, 1]).all()


def test_extremes_beside_a_wheel_that_turns_all_rates_are_those_of_its_limit():
    """SciPy's, from Euler's equations with a wheel of 1e4, whose rates differ by some 1e-6."""
    found = extremes(Scene(Body((12, 9, 5)), Gyrostat((1e150, 1e150, 3))), np.array(STATES[:1]), span=1.0)
    np.testing.assert_allclose(found[0], [(0.0152, 0.05051), (0.00932, 0.0564), (-0.04178, 0.04178)], atol=1e-5)


CUT = {"off axis": ((.3, .1, .2), (.1, .2, .15)), "aligned, growing": ((.5, 0, 0), (.1, .2, 0))}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("kind", CUT)
def test_rows_whose_run_was_cut_are_nan_and_the_others_as_before(monkeypatch, kind):
    scene = Scene(Body((10, 10, 6)), *(effect(v) for effect, v in zip((Gyrostat, ConstantTorque), CUT[kind])))
    states = np.array([[.05, .01, .01], [40., 30., 50.]])
    whole = extremes(scene, states, span=5.0)
    monkeypatch.setattr(extrema, "STEP_LIMIT", 60)
    cut = extremes(scene, states, span=5.0)
    assert np.isfinite(whole).all() and np.array_equal(cut[0], whole[0]) and np.isnan(cut[1]).all()
    one = motion(scene, states[1], (0.0, 5.0))
    assert float(one.extremes_over.rpartition(", ")[2].rstrip("]")) < 5.0  # it says the span it came to


def test_a_growing_motion_between_equal_axes_has_no_extremes_for_all_time():
    """|H|^2/2 - D1 T' = M1 l1 > 0 by Euler's equations for D1 = D2 and a wheel on axis 1 alone: the motion is
    unbounded, so least and greatest rates of a run are those of its span."""
    scene = Scene(Body((10, 10, 6)),
                  *(effect(v) for effect, v in zip((Gyrostat, ConstantTorque), CUT["aligned, growing"])))
    seen, unseen = motion(scene, (.05, .01, .01), (0.0, 5.0)), motion(scene, (.05, .01, .01))
    assert seen.extremes_over == "s in [0, 5]"
    assert np.array_equal(seen.extremes, extremes(scene, (.05, .01, .01), span=5.0))
    assert unseen.extremes is None and "give span=T" in unseen.extremes_over


def test_a_run_that_breaks_off_is_told_in_words():
    found = motion(SCENES["off axis"], STATES[0])
    assert "broke off" in found.because and "nan" not in found.because


@pytest.mark.one_in(3)
@pytest.mark.parametrize("span, reach", [((2.0, 5.0), 5.0), ((-1.0, 5.0), 5.0), ((-5.0, 0.0), -5.0)])
@pytest.mark.parametrize("wheel, torque", [*CUT.values(), ((.5, 0, 0), (.1, 0, 0))])
def test_a_span_is_searched_from_the_start_at_time_0_for_one_state_and_for_arrays(wheel, torque, span, reach):
    scene, state = Scene(Body((10, 10, 6)), Gyrostat(wheel), ConstantTorque(torque)), (.05, .01, .01)
    whole = np.array(motion(scene, state, (0.0, reach)).extremes)
    assert np.array_equal(motion(scene, state, span).extremes, whole)
    assert np.array_equal(extremes(scene, state, span=span),
                          whole) and np.array_equal(extremes(scene, state, span=reach), whole)


def test_extremes_of_a_liquid_are_those_of_the_way_that_its_words_name():
    scene = Scene(Body((12, 9, 5)), LiquidCavity.of_sphere(970, "0.1", "0.2"))
    late, whole = (motion(scene, (.5, .3, .2), span) for span in ((2.0, 5.0), (0.0, 5.0)))
    assert late.extremes == whole.extremes and late.extremes_over == whole.extremes_over == "s in [0, 5]"
