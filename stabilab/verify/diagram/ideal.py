"""Polynomials in a few unknowns, and a Groebner basis of the equations: which monomials remain, and any polynomial written in these.

A polynomial is a table from the powers of its unknowns to coefficients that are not zero (`elements`). The order of monomials is by total degree, then by
the powers. Buchberger's algorithm: every pair of the basis leaves the remainder zero, or its remainder joins the basis.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import Any

Powers = tuple[int, ...]
Polynomial = dict[Powers, Any]


def added(f: Polynomial, g: Polynomial, less: bool = False) -> Polynomial:
    """f + g, or f - g."""
    out = dict(f)
    for powers, c in g.items():
        old = out.pop(powers, None)
        new = (c - c) - c if old is None and less else c if old is None else old - c if less else old + c
        if new:
            out[powers] = new
    return out


def times(f: Polynomial, g: Polynomial) -> Polynomial:
    """f g."""
    out: Polynomial = {}
    for powers, c in g.items():
        out = added(out, _shifted(f, powers, c))
    return out


def _shifted(f: Polynomial, powers: Powers, c: Any) -> Polynomial:
    return {tuple(a + b for a, b in zip(old, powers)): value * c for old, value in f.items()}


def leading(f: Polynomial) -> Powers:
    """The greatest monomial."""
    return max(f, key=lambda powers: (sum(powers), powers))


def _divides(one: Powers, other: Powers) -> bool:
    return all(a <= b for a, b in zip(one, other))


class Basis:
    """A Groebner basis of polynomials that are zero together. pivots: the elements that were divided by; wherever none of them is zero the same
    basis, with what its coefficients are there, is one."""

    def __init__(self, given: Iterable[Polynomial]):
        self.pivots: list[Any] = []
        self.members: list[tuple[Powers, Polynomial]] = []
        waiting = [f for f in given if f]
        pairs: list[tuple[int, int]] = []
        while waiting or pairs:
            f = self.rest(waiting.pop(0) if waiting else self._against(*pairs.pop(0)))
            if f:
                top = leading(f)
                self.pivots.append(f[top])
                scale = f[top].inverse()
                self.members.append((top, {powers: c * scale for powers, c in f.items()}))
                last = len(self.members) - 1
                pairs += [(n, last) for n in range(last) if any(a and b for a, b in zip(self.members[n][0], top))]
                pairs.sort(key=lambda pair: sum(map(max, self.members[pair[0]][0], self.members[pair[1]][0])))

    def _against(self, n: int, k: int) -> Polynomial:
        """Two members, each raised to the least monomial that both leading ones divide, the one less the other."""
        (one, f), (two, g) = self.members[n], self.members[k]
        both = tuple(map(max, one, two))
        raised = lambda h, top: {tuple(p + b - t for p, b, t in zip(powers, both, top)): c for powers, c in h.items()}
        return added(raised(f, one), raised(g, two), less=True)

    def rest(self, f: Polynomial) -> Polynomial:
        """What remains of f: a sum of monomials that no leading one divides."""
        todo, out = dict(f), {}
        while todo:
            top = leading(todo)
            member = next((m for m in self.members if _divides(m[0], top)), None)
            if member is None:
                out[top] = todo.pop(top)
            else:
                todo = added(todo, _shifted(member[1], tuple(a - b for a, b in zip(top, member[0])), todo[top]), less=True)
        return out

    def monomials(self, unknowns: int) -> Sequence[Powers] | None:
        """Those that no leading one divides, rising: as many as there are zeros, each counted as often as it counts. None where these are endless."""
        tops = [top for top, _ in self.members]
        ends = []
        for n in range(unknowns):
            pure = [top[n] for top in tops if not any(p for k, p in enumerate(top) if k != n)]
            if not pure:
                return None
            ends.append(min(pure))
        found = [powers for powers in product(*map(range, ends)) if not any(_divides(top, powers) for top in tops)]
        return sorted(found, key=lambda powers: (sum(powers), powers))
