"""Of a full tensor: what leaves the program is in the frame of the file, beside Euler's equations with the
tensor itself, integrated by SciPy."""
import csv

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from tests.oracles.rigid import tensor

TENSOR = np.array([[12, 0.5, 0], [0.5, 9, 0.3], [0, 0.3, 7]])
TORQUE, WHEEL, RATES = np.array([0.01, 0, 0]), np.array([0, 0.2, 0.1]), np.array([0.1, 0.2, 0.3])
DATA = {"body": {"inertia": TENSOR.tolist()},
        "effects": {"constant_torque": {"torque": TORQUE.tolist()}, "gyrostat": {"momentum": WHEEL.tolist()}},
        "motion": {"angular_velocity": RATES.tolist(), "span": [0, 5]}}
TIMES = [0.0, 2.0, 5.0]


@pytest.fixture(scope="module")
def case():
    return stabilab.load(DATA)


@pytest.fixture(scope="module")
def expected():
    """Rates (3, 3) at TIMES: I w' = (I w + h) x w + M in the frame of the file, by DOP853."""
    return solve_ivp(tensor(TENSOR, WHEEL, TORQUE), (0, 5), RATES, "DOP853", TIMES, rtol=1e-12, atol=1e-13).y.T


def test_tables_of_a_run_are_in_the_frame_of_the_file(case, expected):
    run = case.simulate(TIMES)
    table, data = run.to_pandas(), run.to_xarray()
    np.testing.assert_allclose(table[["omega_x", "omega_y", "omega_z"]], expected, rtol=1e-9)
    np.testing.assert_allclose(data.omega, expected, rtol=1e-9)
    assert data.axis.values.tolist() == ["x", "y", "z"] and data.attrs["frame"] == "file"
    matrix = np.reshape(data.attrs["principal_axes"], (3, 3))
    # rows are principal axes of the tensor, and the other frame is theirs
    np.testing.assert_allclose(matrix @ TENSOR @ matrix.T, np.diag(np.diag(matrix @ TENSOR @ matrix.T)), atol=1e-12)
    principal = run.to_xarray(frame="principal")
    np.testing.assert_allclose(principal.omega, expected @ matrix.T, rtol=1e-9)
    assert principal.attrs["frame"] == "principal" and principal.axis.values.tolist() == [1, 2, 3]
    assert "omega1" in run.to_pandas("principal").columns
    with pytest.raises(stabilab.InputError, match='frame: expected "file" or "principal"'):
        run.to_xarray("body")


def test_an_attitude_turns_components_in_the_frame_of_the_file(case):
    """R (I w + h) is the momentum in space, which the torque alone changes: of the free body none does."""
    free = stabilab.load({**DATA, "effects": {"gyrostat": {"momentum": WHEEL.tolist()}}})
    for form in ("matrix", "quaternion"):
        data = free.simulate(TIMES, attitude=form).to_xarray()
        R = (data.matrix.values if form == "matrix" else
             np.array([_matrix(q) for q in data["quaternion"].values]))
        H = np.einsum("nij,nj->ni", R, data.omega.values @ TENSOR + WHEEL)
        np.testing.assert_allclose(H, np.broadcast_to(H[0], H.shape), rtol=1e-11, atol=1e-13)
        np.testing.assert_allclose(H, data.momentum, rtol=1e-11, atol=1e-13)


def _matrix(q):
    """Rotation matrix of a unit quaternion, scalar last (any textbook)."""
    v, w = q[:3], q[3]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def test_files_have_the_rates_in_the_frame_of_the_file_beside_those_along_principal_axes(
        case, expected, tmp_path, case_file, stabilab):
    xarray = pytest.importorskip("xarray")
    path = case_file(case.to_toml())
    for ending in ("csv", "nc"):
        assert stabilab("simulate", path, "--at", "0,2,5", "--out", tmp_path / f"run.{ending}")[0] == 0
    head, *rows = csv.reader((tmp_path / "run.csv").open())
    table = {name: np.array(column, float) for name, column in zip(head, zip(*rows))}
    found = np.stack([table[f"omega_{letter} (rad/s)"] for letter in "xyz"], axis=1)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as data:
        np.testing.assert_allclose(data.omega, expected, rtol=1e-9)
        matrix = np.reshape(data.attrs["principal_axes"], (3, 3))
        along = np.stack([table[f"omega{n} (rad/s)"] for n in (1, 2, 3)], axis=1)
        np.testing.assert_allclose(data.omega_principal, expected @ matrix.T, rtol=1e-9)
        np.testing.assert_allclose(along, expected @ matrix.T, rtol=1e-9)


def test_equilibria_are_tabled_in_the_frame_of_the_file():
    """(I w + h) x w + M = 0 there, by hand."""
    scene = stabilab.Scene(stabilab.Body(TENSOR.tolist()), stabilab.Gyrostat((0, "0.2", "0.1")),
                           stabilab.ConstantTorque(("0.01", "0.002", "0.001")))
    table = stabilab.equilibria(scene).to_pandas()
    assert len(table) and stabilab.equilibria(scene).frame is not None
    for w in table[["at_x", "at_y", "at_z"]].to_numpy():
        rest = np.cross(TENSOR @ w + [0, 0.2, 0.1], w) + [0.01, 0.002, 0.001]
        assert np.abs(rest).max() < 1e-12 * max(1, np.abs(w).max() ** 2)


def test_a_diagonal_tensor_has_one_frame():
    run = stabilab.load({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": [1, 2, 3]}}).simulate([0, 1])
    assert run.frame is None and "omega1" in run.to_pandas().columns and "frame" not in run.to_xarray().attrs


@pytest.mark.parametrize("question, options", [("fate", {"follow": 20.0}), ("extremes", {"span": 5}), ("motion", {"span": 5}),
                                               ("when", {"rate": "0.5 rad/s"}), ("simulate", {"times": TIMES}), ("stuck", {})])
def test_a_start_may_be_given_in_the_frame_of_the_file(case, question, options):
    """The file gives its own there."""
    ask, start = getattr(stabilab, question), [str(v) for v in RATES]
    wanted = ask(case, **options)
    for given in (case, case.scene):
        found = ask(given, state=start, frame="file", **options)
        turned = ask(given, state=case.exact_state, frame="principal", **options)
        if question == "simulate":
            assert found.state["omega"].tobytes() == wanted.state["omega"].tobytes() == turned.state["omega"].tobytes()
        else:
            assert repr(found).replace(" of scene", "") == repr(turned).replace(" of scene", "")
        if question == "fate":
            assert found.states.tolist() == list(case.state)
            many = ask(given, states=[RATES, 2 * RATES], frame="file", **options)
            np.testing.assert_allclose(many.states, [case.state, 2 * np.array(case.state)], rtol=1e-14)
    with pytest.raises(stabilab.InputError, match='frame: expected "principal" or "file"'):
        ask(case, state=start, frame="body", **options)
