"""How many real zeros the equations have at a value of t, and between which values that is one number."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from .elements import Ratio, Residue
from .ideal import Basis, Polynomial
from .trace import characteristic, rank_and_signature
from .work import Work


@dataclass(frozen=True)
class System:
    """Polynomials in the unknowns, with polynomials in t for coefficients. tests: others, whose signs at the zeros are asked. endless: a polynomial in t;
    where it is zero what is counted lies on more curves than these equations tell."""

    unknowns: int
    zero_together: Sequence[Polynomial]
    tests: Sequence[Polynomial] = ()
    endless: Any = None


@dataclass(frozen=True)
class Count:
    """At one value. real: different real zeros, None where zeros are endless; tests: for each, at how many of these it is positive less at how many it is
    negative, and whether it is zero nowhere, complex zeros counted."""

    real: int | None
    tests: tuple[tuple[int, bool], ...] = ()


def count_at(system: System, place: Any, work: Work) -> Count:
    """At a place with a `polynomial` of which it is a zero and a `sign` of others there."""
    at = place.polynomial
    if system.endless is not None and system.endless % at == 0:
        return Count(None)
    return _counted(system, lambda c: Residue(c % at, at, work), lambda element: place.sign(element.value))[0]


def critical(system: System, work: Work) -> list[Any]:
    """Polynomials in t, not zero: between their real zeros every count is the same."""
    noted: list[Any] = []
    if system.endless == 0:
        return []
    _, basis = _counted(system, lambda c: Ratio.of(c, work), lambda element: 1, noted)
    return [part for element in (*basis.pivots, *noted) for part in (element.top, element.bottom)] + ([] if system.endless is None else [system.endless])


def _counted(system: System, lift: Callable[[Any], Any], sign: Callable[[Any], int], noted: list[Any] | None = None) -> tuple[Count, Basis]:
    """The count, and the basis it is worked out with. noted: collects the products of the eigenvalues that are not zero."""
    lifted = [{powers: e for powers, c in f.items() if (e := lift(c))} for f in system.zero_together]
    basis = Basis(lifted)
    monomials = basis.monomials(system.unknowns)
    if monomials is None:
        return Count(None), basis
    if not monomials:
        return Count(0, ((0, True),) * len(system.tests)), basis
    one = lift(_one(system))

    def judged(weight: Polynomial) -> tuple[int, int]:
        row = characteristic(basis, monomials, weight, one)
        rank, signature = rank_and_signature(row, sign)
        if noted is not None and rank:
            noted.append(row[rank - 1])
        return rank, signature
    different, real = judged({(0,) * system.unknowns: one})
    told = []
    for test in system.tests:
        weight = basis.rest({powers: e for powers, c in test.items() if (e := lift(c))})
        rank, signature = judged(weight)
        told.append((signature, rank == different))
    return Count(real, tuple(told)), basis


def _one(system: System) -> Any:
    from flint import fmpq_poly
    return fmpq_poly([1])
