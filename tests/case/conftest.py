"""What tests of case files share: a text read as a case, and the faults of one."""
import pytest

from stabilab import load
from stabilab.errors import CaseError


@pytest.fixture
def case(tmp_path):
    def read(text):
        path = tmp_path / "my.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load(path)
    return read


@pytest.fixture
def faults(case):
    """(line, key, message) of every fault of a text."""
    def collect(text):
        with pytest.raises(CaseError) as caught:
            case(text)
        return [(p.line, p.key, p.message) for p in caught.value.problems]
    return collect
