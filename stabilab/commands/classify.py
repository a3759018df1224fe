"""`stabilab classify`: equilibria, their stability, and the fate of the motion."""
from __future__ import annotations

from functools import partial

from ..answers.attitude.ask import in_closed_form, of_motion
from ..answers.equilibria import equilibria
from ..show.data import as_json
from ..show.text import classification, law, uncertain
from ..show.text.attitude import row_of
from .common.cases import (
    answers_of,
    load_cases,
    motion_of,
    one_by_one,
    over_boxes,
    swept_motions,
    tell_all,
    tilted,
    units_asked,
)
from .common.output import hold_laws, leave_undecided, write


def classify(cases, json, strict, certify, out, follow, tilt, units, why):
    """Answer every case; with certify write the certificate of the one that is given."""
    loaded = load_cases(cases)
    systems = units_asked(loaded, units, tilt=tilt)
    if certify:
        from . import certificates as proof
        proof.checked(out, cases)
    rests = answers_of(loaded, lambda case: equilibria(case.scene))
    motions = [tilted(case, motion_of(case, follow=follow, proof=certify), tilt) if case.state else None
               for case in one_by_one(loaded)]
    boxes, motions = over_boxes(loaded, motions, "equilibria", "fate")
    answered = [(case, found, motion, of_motion(case.scene, case.exact_state or case.state, motion)
                 if motion is not None and in_closed_form(case.scene) else None)
                for (case, found), motion in zip(rests, motions)]
    laws = [law.worst(found.validity, motion and motion.validity) for _, found, motion, _ in answered]
    if json:
        write(as_json([classification.as_dict(case, found, motion)
                               | {"attitude": turn and row_of(case, turn)}
                               | law.key(held, case if motion is None else None) | uncertain.as_dict(box)
                               for (case, found, motion, turn), held, box in zip(answered, laws, boxes)]))
    else:
        swept = lambda rows, units: swept_motions([motion for _, _, motion, _ in rows], units)
        tell_all(answered, systems, partial(classification.text, proofs=why), None if why else swept, laws,
                 boxes)
    certified = all([proof.certified(case, out) for case in loaded]) if certify else True
    undecided = (any(classification.undecided(found, motion) for _, found, motion, _ in answered)
                 or any(map(uncertain.undecided, boxes)))
    leave_undecided(strict, not certified or undecided)
    hold_laws(strict, laws, loaded)
