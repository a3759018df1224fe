"""`stabilab classify`: equilibria, their stability, and the fate of the motion; and the questions of one
motion.

`stabilab extremes`, `fate` and `period`: one question about each motion, with the digits of its answer;
`attitude`: how it turns in space."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

from ..answers.attitude import attitude as turning
from ..answers.attitude import in_closed_form, of_motion
from ..answers.digits_asked import DEFAULT, by_bound, by_formula, short
from ..answers.equilibria import equilibria
from ..answers.motion import Needs
from ..case.read import blamed_on
from ..physics.coefficients import effective
from ..show.text import classification, headline, questions, scene
from ..show.text.angles import angle_lines, angle_rows, angles_dict
from ..show.text.motion import attitude_object, attitude_objects, attitude_text, row_of
from ..show.units import DEG
from .common import answers_of, drawn, expected, load_cases, motion_of, one_by_one, tilted, units_asked
from .runner import View, collected, every, judge, over_boxes, run, show, with_draws


def _swept(rows, units):
    """The table of the motions of a sweep; of each row the last but one is its motion."""
    motions = [row[-2] for row in rows]
    if None in motions:
        return f"{motions.count(None)} of them state no motion", [], [[] for _ in motions]
    return scene.fates(motions, units), *scene.of_motions(motions, units)


def _swept_extremes(rows, units):
    motions = [motion for _, motion, _ in rows]
    return scene.fates(motions, units), *scene.of_extremes(motions, rows[0][0].scene.components, units)


CLASSIFY = View(
    text=classification.text, swept=_swept, axes=True, boxes=("equilibria", "fate"), packed=every,
    data=lambda case, result, motion, turn: (classification.as_dict(case, result, motion)
                                            | {"attitude": turn and row_of(case, turn)}),
    law=lambda case, result, motion, turn: headline.worst(result.validity, motion and motion.validity),
    open=lambda result, motion, turn: classification.undecided(result, motion))
_ONE = View(text=questions.fate, data=questions.fate_dict, swept=_swept, between="\n", axes=True,
            packed=every, law=lambda case, motion, printed: motion.validity,
            open=lambda motion, printed: motion.fate.word == "undecided")
QUESTIONS = {"fate": replace(_ONE, boxes=("fate",)),
             "extremes": replace(_ONE, text=questions.extremes, data=questions.extremes_dict,
                                 csv=questions.EXTREMES_CSV, swept=_swept_extremes),
             "period": replace(_ONE, text=questions.period, data=questions.period_dict)}
ATTITUDE = View(text=attitude_text, data=attitude_object, packed=attitude_objects,
                open=lambda result: result.fate.word == "undecided")


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
    boxes, motions = over_boxes(CLASSIFY, loaded, motions)
    turns = [of_motion(case.scene, case.exact_state or case.state, motion)
             if motion is not None and in_closed_form(case.scene) else None
             for case, motion in zip(loaded, motions)]
    view = replace(CLASSIFY, text=partial(classification.text, proofs=why), swept=None if why else _swept)
    rows = collected(view, loaded, systems, list(zip([result for _, result in rests], motions, turns)), boxes)
    show(view, rows, json)
    certified = all([certificates.certified(case, out) for case in loaded]) if certify else True
    judge(view, rows, strict, certified)


def answer(question, cases, json, digits, strict, units, why, csv=False, follow=None, tilt=None,
           certify=False, angles=False, samples=None, seed=1, workers=None):
    """Answer a question for every case and say how many digits of it are known."""
    loaded = load_cases(cases, motion=True)
    systems = units_asked(loaded, units, tilt=tilt)
    motions, digits_of = [], []
    for case in one_by_one(loaded):
        result = motion_of(case, _needed(question, why or bool(case.variant and not json)), follow, certify)
        motions.append(tilted(case, result, tilt) if question == "fate" else result)
        digits_of.append(_told(question, case, motions[-1], digits))
    view = _view(question, digits, why)
    boxes, motions = over_boxes(view, loaded, motions)
    result = list(zip(motions, digits_of))
    if angles:
        view, result = with_angles(view), list(zip(map(_leaning, loaded), *zip(*result)))
    rows = with_draws(collected(view, loaded, systems, result, boxes),
                      drawn(samples, seed, workers, lambda case: False, True))
    show(view, rows, json, csv)
    judge(view, rows, strict)


def _leaning(case):
    from ..answers.motions.angles import angles
    with blamed_on(case):
        return angles(case)


def with_angles(view: View) -> View:
    """The view of a motion and its digits with the angles of the axes in front of both."""
    head, lines = view.csv
    swept = view.swept and (lambda rows, units: view.swept([(row[0], *row[2:]) for row in rows], units))
    return replace(
        view, swept=swept,
        text=lambda case, turned, *rest: "\n".join([view.text(case, *rest), *angle_lines(turned, rest[-1])]),
        data=lambda case, turned, *rest: view.data(case, *rest) | {"angles": angles_dict(turned)},
        csv=(head, lambda case, turned, *rest: [*lines(case, *rest), *angle_rows(case, turned)]),
        law=lambda case, turned, *rest: view.law(case, *rest), open=lambda turned, *rest: view.open(*rest),
        short=lambda turned, *rest: view.short(*rest))


def _needed(question: str, full: bool):
    """What of a motion the question prints. full: with a table of all margins, or what `--why` adds."""
    if question == "period" and not full:
        return Needs.PERIOD | Needs.FLIPS
    return Needs.QUICK if question == "extremes" else Needs.ALL


def _view(question, digits, why):
    """How the question is printed, with the digits that were asked for, or with proofs."""
    view, request = QUESTIONS[question], digits is not None
    return replace(view, swept=None if why or request else view.swept,
                   text=lambda case, motion, printed, units: view.text(case, motion, printed, units, request,
                                                                    request or not printed.enough, why),
                   short=lambda motion, text: ([f"{question}: {short(text)}"] if request and not text.enough
                                               else []))


def _told(question, case, motion, digits):
    """The answer with its digits; unasked, the bound of a formula on its own error is the check."""
    result = by_bound(question, motion) if digits is None else None
    if result is None and digits is None:
        with blamed_on(case):
            result = by_formula(question, effective(case.scene), motion, DEFAULT, case.exact_state)
    if result is None:
        from ..answers.digits import ask
        with blamed_on(case):
            result = ask(question, case.scene, case.start, DEFAULT if digits is None else digits, case.span,
                        motion, case.exact_state, tell=partial(expected, case),
                        **({"aim": True} if digits is None else {}))
    return result


def attitude(cases, json, digits, strict, units):
    """How each motion turns in space: answer every case, every combination where it has a [sweep]."""
    loaded = load_cases(cases, motion=True)
    systems = [DEG if system.scaled else system for system in units_asked(loaded, units)]  # all is in SI here
    run(ATTITUDE, loaded, partial(turning, digits=digits), systems=systems, json=json, strict=strict)
