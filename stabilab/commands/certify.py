"""`stabilab classify --certify`: the proof of an answer, written as a file that `stabilab verify` checks."""
from __future__ import annotations

from ..answers.certificate import certificate
from ..case.read import blamed_on
from ..errors import InputError
from ..show.files.endings import labelled
from ..show.text import certification
from .common.output import say


def checked(out, paths):
    """Refuse a file that no certificate can be, and more cases than one, before any work."""
    certification.checked(out)
    if len(paths) != 1:
        raise InputError(f"--certify: expected one case, got {len(paths)}; certify them one by one")


def certified(case, out) -> bool:
    """Write the certificate of one case; whether all of it could be certified."""
    with blamed_on(case):
        made = certificate(case.scene, case.exact_state)
    say(f"written: {certification.write(made, labelled(out, case))}\n{certification.summary(made)}")
    return not made["uncertified"]
