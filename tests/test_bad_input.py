"""Whatever stands in a case file: it is a case, or an error that names file and line; nothing in it is ever run."""
from hypothesis import HealthCheck, given, settings

from .fuzz.grammar import mutated_cases, written_cases
from .fuzz.judge import judged

QUICK = settings(max_examples=400, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@QUICK
@given(written_cases())
def test_a_file_by_grammar_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "written.toml")


@QUICK
@given(mutated_cases())
def test_a_mutated_case_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "mutated.toml")
