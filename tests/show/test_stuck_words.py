"""The words of a stuck thruster: numbers that hold what they promise, each in the unit of the page."""
import json
import re

import pytest

from stabilab.case.read import load
from stabilab.show.report.one_case import sections
from tests.shared import craft_file

SATELLITE = craft_file([12.0, 9.0, 5.0], ([0.5, 0, 0], [0, 1, 0], "40 mN"), [([1, 0, 0], "0.8 N m s")],
                       ["5.7 deg/s", "2.9 deg/s", "1.1 deg/s"])


@pytest.mark.slow
def test_an_interval_that_keeps_the_motion_bounded_is_told_in_six_digits_and_lies_inside_the_exact_one(
    stabilab, tmp_path, case_file):
    case = case_file(SATELLITE, "satellite")
    text = stabilab("stuck", case)[1]
    told = json.loads(stabilab("stuck", case, "--json")[1])
    (wheel,) = (told[0] if isinstance(told, list) else told)["rows"][0]["wheel_intervals"]
    (_, most), (least, _) = wheel["keeps_bounded"]
    words = re.search(r"keeps it bounded at up to (\S+) N m s or (\S+) N m s or more", text)
    assert float(words[1]) <= most < float(words[1]) + 1e-6 and float(words[2]) - 1e-7 < least <= float(
        words[2])
    page = sections(load(case), tmp_path, "satellite", deep=False)["sensitivity"]["rows"][0]["because"]
    assert "rad/s" not in page and "beyond 25.5849 deg/s" in page
    # 0.44654 rad/s
    assert "rad/s" not in text and re.search(
        r"margin, rate +\S+ deg/s along .* beyond 25\.58\d* deg/s along the same line", text)


def test_an_equilibrium_of_a_turning_body_is_a_steady_rotation(stabilab, case_file):
    """D3 omega3' = M3 + (D1 - D2) omega1 omega2 = 0.03 + 3 (0.1)(-0.1) = 0 exactly, the other rates have
    omega3 = 0 as a factor: by hand."""
    case = case_file("[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = [0, 0, "
                     "0.03]\n[motion]\nangular_velocity = [0.1, -0.1, 0]\n", "steady")
    for command in ("stuck", "fate", "classify"):
        assert stabilab(command, case)[1].startswith("steady: STEADY ROTATION")
