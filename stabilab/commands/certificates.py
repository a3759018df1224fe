"""`stabilab classify --certify`: the proof of an answer, written as a file; `verify`: a second look at it, by
code that shares nothing with what made it."""
from __future__ import annotations

from ..answers.certificate import certificate as proof_of
from ..answers.certificate import subject
from ..case.read import blamed_on
from ..errors import InputError, ToleranceNotMet, printable
from ..show import certification, endings
from ..show.names import spare
from ..show.terminal import say
from ..verify import verify as check
from ..verify.form import about, differences, line, read
from ..verify.numbers import Malformed
from .common import load_cases
from .writing import either, leave_undecided


def checked(out, paths):
    """Refuse a file that no certificate can be, and more cases than one, before any work."""
    endings.file(out, (".json",))
    if len(paths) != 1:
        raise InputError(f"--certify: expected one case, got {len(paths)}; certify them one by one")


def certified(case, out) -> bool:
    """Write the certificate of one case; whether all of it could be certified."""
    with blamed_on(case):
        built = proof_of(case.scene, case.exact_state)
    say(f"written: {certification.write(built, endings.labelled(out, case))}\n{certification.summary(built)}")
    return not built["uncertified"]


def verify(certificate, case, json, strict):
    """Check a certificate, and that it is of the case where one is named."""
    cases = load_cases([case]) if case else []
    try:
        claims = read(certificate)
        result = check(claims)
    except (Malformed, UnicodeDecodeError) as error:
        raise InputError(
            f"{certificate}: {error}; expected a certificate of stabilab classify --certify or stabilab "
            f"bifurcation --certify") from None
    printed = about(claims)
    spare(item for item in (*printed.values(), str(certificate), str(case)) if isinstance(item, str))
    other = _of_another(cases, printed, certificate)
    physical = printed.get("variables") == "physical"
    either(json, lambda: certification.as_dict(result, printed),
           lambda: certification.text(result, line(printed), case if other else "", physical))
    if result.status == "refuted":
        raise ToleranceNotMet(f"{certificate}: a claim is wrong")
    if other:
        raise ToleranceNotMet(other)
    leave_undecided(strict, result.status != "proved")


def _of_another(cases, printed, path):
    """What differs where a certificate is of none of the cases; empty where it is of one or none is named."""
    apart = [(case, differences(printed, subject(case.scene, case.exact_state))) for case in cases]
    return "" if not all(differing for _, differing in apart) else "\n".join(
        f"{printable(str(path))}: of another case than {case.place}: {text}"
        for case, differing in apart for text in differing)
