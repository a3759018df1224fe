"""`stabilab classify`: equilibria, their stability, and the fate of the motion; and the questions of one
motion.

`stabilab extremes`, `fate` and `period`: one question about each motion, with the digits of its answer;
`attitude`: how it turns in space."""
from __future__ import annotations

from functools import partial

from ..answers.attitude import attitude as turning
from ..answers.attitude import in_closed_form, of_motion
from ..answers.digits_asked import DEFAULT, by_bound, short
from ..answers.equilibria import equilibria
from ..answers.motion import Needs
from ..case.read import blamed_on
from ..show.data import as_json
from ..show.text import classification, headline, questions, scene
from ..show.text.motion import attitude_dict, attitude_text, row_of
from ..show.units import DEG
from .common import (
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
from .writing import all_reached, hold_laws, leave_undecided, write


def classify(cases, json, strict, certify, out, follow, tilt, units, why):
    """Answer every case; with certify write the certificate of the one that is given."""
    loaded = load_cases(cases)
    systems = units_asked(loaded, units, tilt=tilt)
    if certify:
        from . import certificates
        certificates.checked(out, cases)
    rests = answers_of(loaded, equilibria)
    motions = [tilted(case, motion_of(case, follow=follow, proof=certify), tilt) if case.state else None
               for case in one_by_one(loaded)]
    boxes, motions = over_boxes(loaded, motions, "equilibria", "fate")
    answered = [(case, found, motion, of_motion(case.scene, case.exact_state or case.state, motion)
                 if motion is not None and in_closed_form(case.scene) else None)
                for (case, found), motion in zip(rests, motions)]
    laws = [headline.worst(found.validity, motion and motion.validity) for _, found, motion, _ in answered]
    if json:
        write(as_json([classification.as_dict(case, found, motion)
                               | {"attitude": turn and row_of(case, turn)}
                               | headline.key(held, case if motion is None else None)
                               | classification.uncertain_dict(box)
                               for (case, found, motion, turn), held, box in zip(answered, laws, boxes)]))
    else:
        swept = lambda rows, units: swept_motions([motion for _, _, motion, _ in rows], units)
        tell_all(answered, systems, partial(classification.text, proofs=why), None if why else swept, laws,
                 boxes)
    certified = all([certificates.certified(case, out) for case in loaded]) if certify else True
    undecided = (any(classification.undecided(found, motion) for _, found, motion, _ in answered)
                 or any(map(classification.open_in_box, boxes)))
    leave_undecided(strict, not certified or undecided)
    hold_laws(strict, laws, loaded)


def answer(question, cases, json, digits, strict, units, why, csv=False, follow=None, tilt=None,
           certify=False):
    """Answer a question for every case and say how many digits of it are known."""
    loaded = load_cases(cases, motion=True)
    systems = units_asked(loaded, units, tilt=tilt)
    motions, digits_of = [], []
    for case in one_by_one(loaded):
        found = motion_of(case, _needed(question, why or bool(case.variant and not json)), follow, certify)
        motions.append(tilted(case, found, tilt) if question == "fate" else found)
        digits_of.append(_told(question, case, motions[-1], digits))
    boxes, motions = over_boxes(loaded, motions, *(["fate"] if question == "fate" else []))
    answered = list(zip(loaded, motions, digits_of))
    if json:
        write(as_json([
            getattr(questions, f"{question}_dict")(case, found, told) | headline.key(found.validity)
            | classification.uncertain_dict(box)
            for (case, found, told), box in zip(answered, boxes)]))
    elif csv:
        write(questions.extremes_csv(answered))
    else:
        _tell(question, answered, systems, digits, boxes, why)
    if digits is not None:
        all_reached((case, f"{question}: {short(told)}") for case, _, told in answered if not told.enough)
    leave_undecided(strict, any(motion.fate.word == "undecided" for _, motion, _ in answered)
                    or any(map(classification.open_in_box, boxes)))
    hold_laws(strict, (motion.validity for _, motion, _ in answered), loaded)


def _needed(question: str, whole: bool):
    """What of a motion the question prints. whole: with a table of all margins, or what `--why` adds."""
    if question == "period" and not whole:
        return Needs.PERIOD | Needs.FLIPS
    return Needs.QUICK if question == "extremes" else Needs.ALL


def _tell(question, answered, systems, digits, boxes, why):
    """The answers as text."""
    def text(case, motion, told, units):
        return getattr(questions, question)(case, motion, told, units, digits is not None,
                                            digits is not None or not told.enough, why)

    def swept(rows, units):
        motions = [motion for _, motion, _ in rows]
        if question != "extremes":
            return swept_motions(motions, units)
        return scene.fates(motions, units), *scene.of_extremes(motions, rows[0][0].scene.components, units)

    tell_all(answered, systems, text, None if why or digits is not None else swept,
             [motion.validity for _, motion, _ in answered], boxes, "\n")


def _told(question, case, motion, digits):
    """The answer with its digits; unasked, the bound of a formula on its own error is the check."""
    found = by_bound(question, motion) if digits is None else None
    if found is None:
        from ..answers.digits import ask
        with blamed_on(case):
            found = ask(question, case.scene, case.start, DEFAULT if digits is None else digits, case.span,
                        motion, case.exact_state,
                        **({"aim": True} if digits is None else {}))
    return found


def attitude(cases, json, digits, strict, units):
    """How each motion turns in space: answer every case, every combination where it has a [sweep]."""
    loaded = load_cases(cases, motion=True)
    systems = [DEG if system.scaled else system for system in units_asked(loaded, units)]  # all is in SI here
    answered = answers_of(loaded, partial(turning, digits=digits))
    if json:
        write(as_json(attitude_dict(answered)))
    else:
        tell_all(answered, systems, attitude_text)
    leave_undecided(strict, any(found.fate.word == "undecided" for _, found in answered))
