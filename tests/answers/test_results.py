"""What every result promises of itself: it can be sent to another process, and compared."""
import pickle

import numpy as np
import pytest

import stabilab
from stabilab.representation import same

STATE = (0.1, 0.05, 0.02)
SCENES = {"bounded": stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.Gyrostat(("0.8", 0, 0)),
                                    stabilab.ConstantTorque((0, 0, "0.02"))),
          "off the axes": stabilab.Scene(stabilab.Body((12, 9, 5)),
                                         stabilab.ConstantTorque(("0.01", "0.02", "0.02"))),
          "free": stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.Gyrostat((1, 0, 2)))}
ASK = {"fate": lambda scene, x: stabilab.fate(scene, [x, STATE]), "equilibria": lambda scene,
       x: stabilab.equilibria(scene),
       "motion": stabilab.motion, "separatrix": lambda scene,
       x: stabilab.separatrix(scene, reach=2 + x[0], shape=(5, 9)),
       "time_to": lambda scene, x: stabilab.time_to(scene, x, rate=0.3, t_max=3),
       "trajectory": lambda scene, x: stabilab.trajectory(scene, x, [0, 1]), "ensemble": lambda scene,
       x: stabilab.ensemble(scene, [x], [0, 1]),
       "simulate": lambda scene, x: stabilab.simulate(scene, x, [0, 1]), "spin_up": stabilab.spin_up}


@pytest.mark.one_in(4)
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", ASK)
def test_a_result_survives_another_process_and_equals_itself_and_no_other(name, scene):
    found, other = ASK[name](SCENES[scene], STATE), ASK[name](SCENES[scene], (0.2, 0.05, 0.02))
    sent = pickle.loads(pickle.dumps(found))
    assert repr(sent) == repr(found)
    if name not in ("equilibria", "spin_up"):  # whose polynomials and fields are compared as objects
        assert sent == found
    if name in ("trajectory", "ensemble", "simulate"):
        assert found != other
    assert found != STATE


def test_arrays_are_the_same_by_their_bytes():
    one = {"a": np.array([1.0, np.nan]), "b": (np.array(["x", "y"], object), float("nan"))}
    assert same(one, {"a": np.array([1.0, np.nan]), "b": (np.array(["x", "y"], object), float("nan"))})
    for key, value in {"a": np.array([[1.0, np.nan]]),
                       "b": (np.array(["x", "z"], object), float("nan"))}.items():
        assert not same(one, one | {key: value})
    assert not same(np.zeros(2), np.zeros(2, int)) and not same([1], [1, 2])
