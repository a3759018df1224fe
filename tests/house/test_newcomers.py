"""Two newcomers: one walks the README from top to bottom, one goes from a spacecraft's data sheet to a
decision."""
import re

import pytest

from tests.shared import in_one_line

from .test_readme import README, blocks, commands, files, follow, in_python, run, run_here

# What a data sheet says: moments in kg m^2, places in m, an attitude thruster of 40 mN aligned to a degree,
# panels that break at 30 deg/s.
SHEET = """title = "Data sheet 7: small satellite"

[body]
inertia = [12.0, 9.0, 5.0]
centre_of_mass = [0, 0, 0]

[[wheels]]
name = "W1"
axis = [1, 0, 0]
momentum = "%s N m s"

[[thrusters]]
name = "T1"
position = [0.5, 0, 0]
direction = [0, 1, 0]
force = "40 mN"
misalignment = "1 deg"
stuck = true

[limits]
rate = "30 deg/s"

[motion]
angular_velocity = ["5.7 deg/s", "2.9 deg/s", "1.1 deg/s"]
span = [0, "5 min"]
"""


def walk(text, folder):
    """Do block by block what a page says: a file is there only after the page has shown it."""
    for language, body in blocks(text):
        block = f"```{language}\n{body}```\n"
        for path, content in files(block).items():
            (folder / path).write_text(content)
        follow(block, folder, lambda command: True)
        if ">>>" in body:
            in_python(block)


@pytest.mark.slow
def test_a_newcomer_walks_the_readme_from_top_to_bottom(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = README.read_text(encoding="utf-8")
    walk(text, tmp_path)
    shown = {command.split()[1] for command, _, _ in commands(text) if command.startswith("stabilab ")}
    assert {"fate", "when", "plot", "report", "period"} <= shown
    assert (tmp_path / "my-report/index.html").exists() and (tmp_path / "my.png").exists()
    for word in sorted(shown):  # what the README says of help
        code, words = said(f"stabilab {word} --help", tmp_path)
        assert code == 0 and "Example:" in words, word
    assert said("stabilab doctor", tmp_path)[0] == 0


def said(command, folder):
    """(exit code, what the terminal shows)."""
    words, code = run_here(command, folder)
    return code, words


@pytest.mark.slow
def test_an_engineer_goes_from_a_data_sheet_to_a_decision(tmp_path, case_file):
    """Each step uses what the one before has printed; the last two try the decision from both sides."""
    sheet = case_file(SHEET % "0.8", "sheet")

    understood, code = run("stabilab show sheet.toml", tmp_path)
    assert code == 0 and "thruster T1 (stuck)" in understood and "0.02" in understood

    code, answer = said("stabilab stuck sheet.toml", tmp_path)
    first = in_one_line(answer)
    assert code == 0 and first.startswith(
        "sheet: STAYS BOUNDED") and "only while the torque is exactly along z (minor axis)" in first
    reached = re.search(r"tilted by 1 deg it reaches 30 deg/s after ([\d.]+) (min|h)", first)
    hours = float(reached[1]) / (60 if reached[2] == "min" else 1)
    least = float(re.search(r"not before\s+([\d.]+) min", answer)[1]) / 60
    assert 0 < least < hours < 24  # so there is time to close a valve, and how much is proved
    threshold = float(
        re.search(r"wheel W1, now 0.8 N m s, keeps it bounded at up to \S+ N m s or ([\d.]+) N m s or more",
                  answer)[1])

    # the decision: keep the wheel above that
    for momentum, fate in ((threshold * 1.01, "BOUNDED"), (threshold * 0.99, "SPINS UP")):
        sheet.write_text(SHEET % f"{momentum:.9f}")
        code, answer = said("stabilab fate sheet.toml", tmp_path)
        assert code == 0 and f" {fate} " in answer.splitlines()[0], answer
    code, answer = said("stabilab when sheet.toml", tmp_path)
    assert code == 0 and re.match(r"sheet: reaches \|ω\| = 30 deg/s in [\d.]+ (s|min|h) \(proved", answer)

    sheet.write_text(SHEET % "0.8")
    assert said("stabilab report sheet.toml --out decision", tmp_path)[0] == 0
    page = (tmp_path / "decision/index.html").read_text(encoding="utf-8")
    assert "BOUNDED" in page and ("<svg" in page or "<img" in page)
