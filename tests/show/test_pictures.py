"""Tables, pictures and meshes: the data in them, not their pixels."""
import csv
import io
import json
import math
import re
import struct
from dataclasses import replace

import numpy as np
import pytest

from stabilab import errors, load
from stabilab.case.read import read_text
from stabilab.orbit import phase_plane as phase
from stabilab.orbit.separatrix.homoclinic import Branch
from stabilab.papers import table
from stabilab.papers.figures import catalogue as figures
from stabilab.show import render_probe, style, surface
from stabilab.show import surface as drawing
from stabilab.show import surface as mesh
from stabilab.show.plot import to_file as plane
from stabilab.show.plot.subject import subject
from tests.shared import CASES

# -- tables --

HOSTILE = table.Table(9, 'a <b>bold</b> & "title"', "50 % of $5_000 {x} ~ ^ \\ # |", ("h<1>", "n|m"),
                      (("<script>alert(1)</script>", 1 / 3), ("a_b & c|d", math.inf), (None, 7)))


def test_csv_holds_every_digit():
    rows = list(csv.reader(io.StringIO(table.comma_separated(HOSTILE))))
    assert float(rows[1][1]) == 1 / 3 and float(rows[2][1]) == math.inf and rows[3][0] == ""


def test_html_escapes_hostile_cells():
    text = table.html_page(HOSTILE)
    assert "<script" not in text and "<b>" not in text and "&lt;script&gt;alert(1)&lt;/script&gt;" in text


def test_latex_escapes_every_special_character():
    text = table.latex(HOSTILE)
    assert r"a\_b \& c$|$d" in text
    assert r"50 \% of \$5\_000 \{x\} \textasciitilde{} \textasciicircum{} \textbackslash{} \#" in text
    assert text.count(r"\begin{tabular}") == text.count(r"\end{tabular}") == 1


def test_markdown_rows_keep_their_columns():
    lines = [line for line in table.markdown(HOSTILE).splitlines() if line.startswith("|")]
    assert {line.replace("\\|", "").count("|") for line in lines} == {3}


def test_readable_formats_show_six_digits():
    assert table.cell(1
                      / 3) == "0.333333" and table.cell(-math.inf) == "-unbounded" and table.cell(None) == "–"


def test_table_1_has_every_sign_pattern_with_and_without_the_wheel():
    """Rows that differ in signs alone are one; each of the 3^3 patterns stands in one row a wheel."""
    rows = table.torque_signs().rows
    for wheel in ("a ≠ b", "a = b"):
        patterns = [f"({signs})" for row in rows if row[0] == wheel for signs in row[1][1:-1].split("), (")]
        assert len(patterns) == 27
        assert len(set(patterns)) == 27


def test_a_minus_of_table_1_is_no_hyphen():
    words = [value for row in table.torque_signs().rows for value in row if value]
    assert not [value for value in words if re.search(r"\W-|-\W|-[ab]\b|\d-", value)]
    assert any("energy-Casimir" in value for value in words)


@pytest.mark.parametrize("number", table.EXTREMES)
def test_the_case_files_of_the_tables_hold_the_papers_data(number):
    import stabilab
    starts = {"minor-axis": table.START_MINOR, "middle-axis": table.START_MIDDLE,
              "middle-axis-equal": table.START_PLANE}
    for family in table.EXTREMES[number][0]:
        for lam in table.LAMBDAS:
            case = stabilab.load(CASES / f"{family}-{lam}.toml")
            assert case.scene == table.printed_scene(family.split("-")[0], lam)
            if family in starts:
                assert case.state == starts[family]
            else:  # the case that was meant lies in the invariant plane x1 + b = x3
                assert case.state[0] + case.scene.b == pytest.approx(case.state[2], abs=1e-15)


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "x.txt"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError):
        with style.whole_file(path) as waiting:
            waiting.write_text("half")
            raise ZeroDivisionError
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


# -- phase planes and figures --


def test_saddles_without_wheel_are_where_the_paper_puts_them():
    """Amer et al. 2024, after (25): sin alpha = -2/F^2 for lambda1 = 0."""
    from stabilab import ScaledGyrostat
    found = phase.phase_plane(ScaledGyrostat(0, 0, (0, 0, 1)), (3.0, 0.0, 0.0))
    start = np.arctan2(3.0, 0.0)
    for y in found.saddles + found.centres:
        assert np.sin(2 * (start + y)) == pytest.approx(-2 / 9, abs=1e-12)
    assert len(found.saddles) == len(found.centres) == 2


@pytest.mark.parametrize("lam", table.LAMBDAS)
def test_the_drawn_separatrix_is_a_level_curve_of_the_true_integral(lam):
    scene = table.printed_scene("minor", lam)
    found = phase.phase_plane(scene, table.START_MINOR)
    saddle = found.saddles[0]
    y, W = found.separatrix(saddle, -4.0, 4.0)
    theta = np.arctan2(2.5 + scene.a, 4.0) + y
    A, c = np.hypot(2.5 + scene.a, 4.0), scene.b - scene.a
    # derived by hand from (13)
    energy = W**2 / 2 - theta - (A * np.sin(theta)) ** 2 / 2 - c * A * np.sin(theta)
    assert np.ptp(energy) < 1e-11 and W[np.argmin(np.abs(y - saddle))] == 0.0


def test_each_figure_has_a_note_with_its_command(tmp_path):
    figures.write([9], tmp_path)
    note = (tmp_path / "figure-09.txt").read_text(encoding="utf-8")
    assert "stabilab figures 9 --out figures" in note and "tolerance:" in note


def test_an_unknown_figure_is_refused():
    with pytest.raises(errors.InputError, match="figure 19: expected one of 1 to 18"):
        figures.figure(19)


def test_the_repository_keeps_a_small_picture_of_every_figure():
    folder = CASES.parent / "figures"
    assert figures.NUMBERS == tuple(range(1, 19))
    for row in figures.FIGURES:
        assert (folder / row.file).stat().st_size < 200_000
        assert row.command in (folder / row.file.replace(".png", ".txt")).read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("number", figures.NUMBERS)
def test_every_figure_can_be_drawn(number, tmp_path):
    assert figures.write([number], tmp_path)[0].stat().st_size > 5_000


# -- meshes --


def cone(rows=41, columns=81):
    """A branch with known geometry: circles of radius r at height r, from the fold (r = 0) to r = 1."""
    r, turn = np.linspace(0, 1, rows)[:, None], np.linspace(0, 2 * np.pi, columns)[None, :]
    points = np.stack(np.broadcast_arrays(r * np.cos(turn), r * np.sin(turn), r), -1).copy()
    points[:, -1] = points[:, 0]
    residual = np.full((rows, columns), 1e-17)
    residual[-1, 3] = 3e-16
    centre = points.mean(1)
    return Branch("cone", points, residual, points[:, 0], centre, r[:, 0])


def test_the_mesh_is_one_disc_without_degenerate_triangles():
    made = mesh.triangulate(cone())
    corner = made.points[made.triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    edges = {tuple(sorted(e)) for t in made.triangles for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    assert len(made.points) - len(edges) + len(made.triangles) == 1  # Euler characteristic of a disc
    assert area.min() > 0 and area.sum() == pytest.approx(np.pi * np.sqrt(2), rel=2e-3)
    assert made.residual.max() == 3e-16


def test_triangles_of_a_size_whose_square_is_no_double_are_not_lost():
    large, small = (mesh.triangulate(replace(cone(), points=cone().points * scale)) for scale in (1.0, 1e-100))
    assert small.triangles.tolist() == large.triangles.tolist()


def test_equal_places_are_one_vertex_and_the_nearest_others_two():
    """Places that differ in the last digit of one coordinate alone, and two zeros, by hand."""
    one, zero, other = (0.75, 0.5, -0.25), (0.0, 2.0, 3.0), (0.75, 0.5, np.nextafter(-0.25, 0))
    points = np.array([[one, zero], [(3.0, 1.0, 2.0), other], [one, (-0.0, 2.0, 3.0)], [other, (2.0, 2.0, 0.0)]])
    made = mesh.triangulate(Branch("pair", points, np.zeros((4, 2)), points[:, 0], points[:, 0], np.arange(4.0)))
    assert made.points.tolist() == points.reshape(-1, 3)[[0, 1, 2, 3, 7]].tolist()


def test_stl_and_glb_hold_every_triangle():
    made = mesh.triangulate(cone())
    data = mesh.stl([made])
    assert struct.unpack("<I",
                         data[80:84])[0] == len(made.triangles) and len(data) == 84 + 50 * len(made.triangles)
    data = mesh.glb([made], style.SURFACES)
    magic, version, length = struct.unpack("<4sII", data[:12])
    size, kind = struct.unpack("<II", data[12:20])
    document = json.loads(data[20:20 + size])
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), 0x4E4F534A)
    position, _, index = (document["accessors"][i] for i in range(3))
    assert position["count"] == len(made.points) and index["count"] == 3 * len(made.triangles)
    assert position["max"] == pytest.approx([1, 1, 1])
    assert document["buffers"][0]["byteLength"] == len(data) - 28 - size


def test_empty_meshes_are_valid_files(tmp_path):
    import pyvista
    files = surface.write_meshes([], tmp_path, "none")
    assert pyvista.read(files[0]).n_cells == 0
    assert json.loads(files[1].read_bytes()[20:])["asset"]["version"] == "2.0"
    assert struct.unpack("<I", files[2].read_bytes()[80:84])[0] == 0


def test_the_same_mesh_gives_the_same_bytes(tmp_path):
    made = mesh.triangulate(cone())
    first, second = (surface.write_meshes([made], tmp_path / name, "cone") for name in ("a", "b"))
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in second]


def test_vtp_keeps_doubles_and_point_arrays(tmp_path):
    import pyvista
    made = mesh.triangulate(cone())
    data = pyvista.read(surface.write_meshes([made, made], tmp_path, "two")[0])
    assert data.points.dtype == np.float64 and np.array_equal(data.points[:len(made.points)], made.points)
    assert set(np.unique(data.point_data["sheet"])) == {0, 1} and data.point_data["residual"].max() == 3e-16


# -- rendering --


@pytest.fixture
def no_gl(monkeypatch):
    """A machine whose VTK crashes at the first picture."""
    render_probe.probe.cache_clear()
    monkeypatch.setattr(render_probe, "_CHILD", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    yield
    render_probe.probe.cache_clear()


def test_a_renderer_that_crashes_is_reported_and_not_fatal(no_gl):
    assert not render_probe.probe().available and "GL libraries" in render_probe.probe().description


# what a file of each kind begins with, by the definition of the format
BEGINS = {".png": b"\x89PNG\r\n\x1a\n", ".svg": b"<?xml", ".pdf": b"%PDF-"}


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", ["plane.png", "plane.svg", "plane.pdf", "PLANE.SVG"])
def test_a_picture_is_what_its_ending_says_and_the_same_bytes_again(name, tmp_path):
    import stabilab
    case = stabilab.load(CASES / "minor-axis-100.toml")
    first, second = (plane.write(case, tmp_path / side / name) for side in ("a", "b"))
    assert first.read_bytes().startswith(BEGINS[first.suffix.lower()])
    assert first.read_bytes() == second.read_bytes()


@pytest.fixture
def undrawn(monkeypatch):
    """A function that writes meshes without a picture."""
    monkeypatch.setattr(surface, "probe", lambda: render_probe.Renderer(False, "none here"))

    def write(case, out):
        with pytest.raises(errors.RenderingUnavailable) as unavailable:
            surface.write_all([case], out)
        return unavailable.value.summaries[0]
    return write


def test_the_surface_of_a_case_read_from_a_text_is_written_without_a_file_to_name(tmp_path, undrawn):
    case = read_text("own.toml", (CASES / "wheel-and-thruster.toml").read_text(encoding="utf-8"))
    assert undrawn(case, tmp_path)["triangles"] > 0
    assert json.loads((tmp_path / "manifest.json").read_text())["inputs"] == []


def test_the_summary_counts_what_the_mesh_holds(tmp_path, undrawn):
    import pyvista
    summary = undrawn(load(CASES / "minor-axis-300.toml"), tmp_path)
    data = pyvista.read(tmp_path / "minor-axis-300.vtp")
    assert (data.n_points, data.n_cells) == (summary["vertices"], summary["triangles"])
    assert summary["largest_residual"] == data.point_data["residual"].max() < 1e-12
    assert json.loads((tmp_path / "minor-axis-300.json").read_text())["sheets"] == summary["sheets"]


def test_a_surface_picture_names_the_axes_of_its_case(tmp_path):
    """Expected by eye: the largest, middle and least moment of the file, its principal axes where it is
    turned, the paper's letters."""
    text = ("[body]\ninertia = {}\n[effects.gyrostat]\nmomentum = [0.8, 0, "
            "0]\n[effects.constant_torque]\ntorque = {}\n"
            "[motion]\nangular_velocity = [0.1, 0.05, 0.02]\n")
    plain, turned = tmp_path / "plain.toml", tmp_path / "turned.toml"
    plain.write_text(text.format("[12, 9, 5]", "[0, 0, 0.02]"))
    turned.write_text(text.format("[[12, 0, 0], [0, 7, 2], [0, 2, 7]]", "[0, 0.02, -0.02]"))
    named = [drawing.of(subject(given)).names for given in
             (*map(load, (plain, turned, CASES / "minor-axis-100.toml")), table.printed_scene("minor", 100))]
    assert named == [("ω₁, x (major) (deg/s)", "ω₂, y (intermediate) (deg/s)", "ω₃, z (minor) (deg/s)"),
                     ("ω₁, major (deg/s)", "ω₂, intermediate (deg/s)", "ω₃, minor (deg/s)"),
                     ("x₁", "x₂", "x₃"), ("x₁", "x₂", "x₃")]


@pytest.mark.slow
def test_a_surface_is_drawn_with_a_body_at_rest(tmp_path):
    """Its path has no length, of which no tube can be made."""
    if not render_probe.probe().available:
        pytest.skip(render_probe.probe().description)
    path = tmp_path / "rest.toml"
    path.write_text("[body]\ninertia = [3, 2, 1.5]\n[motion]\nangular_velocity = [0, 0, 0]\n")
    drawing.plotter(drawing.of(subject(load(path)))).close()


@pytest.mark.slow
def test_in_a_surface_picture_everything_is_drawn_and_the_box_holds_the_surface():
    if not render_probe.probe().available:
        pytest.skip(render_probe.probe().description)
    case = load(CASES / "minor-axis-100.toml")
    found = drawing.of(subject(case))
    stage = drawing.plotter(found)
    try:
        drawn = {tuple(actor.prop.color.int_rgb) for actor in stage.actors.values() if hasattr(actor, "prop")}
        kinds = ("this motion", "start", "nearest point of the separatrix", "stable equilibria",
                 "unstable equilibria")
        assert {tuple(int(style.SPACE[words]["color"][i:i + 2], 16) for i in (1, 3, 5))
                for words in kinds} < drawn and set(kinds) < set(found.legend)
        places = np.concatenate([branch.points for _, branch in found.branches])
        low, high = found.box.low, found.box.high
        assert len(found.arrows) == 3
        assert (places.min(axis=0) < high).all() and (places.max(axis=0) > low).all()
    finally:
        stage.close()
