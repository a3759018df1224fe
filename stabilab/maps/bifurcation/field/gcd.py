"""The greatest common divisor of two polynomials over the field of an algebraic number, from its images modulo primes.

Euclid's algorithm over such a field doubles the length of its coefficients at every step; modulo a prime they have none. Where the polynomial of the number
keeps its degree and has no double root modulo the prime, and both polynomials are integral there, one with an invertible leading coefficient, a common factor
has an image of its own degree: so the degree of the images is never too low. What is put together from them is the answer if it divides both, and that is
tried exactly.
"""
from __future__ import annotations

from collections.abc import Iterator
from math import isqrt
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from flint import fmpq_poly, nmod_poly

Element: TypeAlias = Any  # a polynomial of the algebraic number, over the rationals or modulo a prime

MOST = 600  # primes tried
FIRST = 1 << 61  # they are below


def field_gcd(number: fmpq_poly, f: list[fmpq_poly], g: list[fmpq_poly]) -> list[fmpq_poly] | None:
    """The monic one; None where so many primes do not tell. number: an irreducible polynomial of the algebraic number; f, g: not zero, coefficients reduced by
    it, lowest power first."""
    whole = [int(c) for c in number.numer().coeffs()]
    size, product, found, tried = 0, 1, [[0]], 1
    for prime in _primes():
        image = _image(whole, prime, f, g)
        if image is None or (size and len(image) > size):
            continue
        if len(image) == 1:
            return [number * 0 + 1]
        if len(image) != size:
            size, product, tried = len(image), 1, 1
            found = [[0] * (len(whole) - 1) for _ in image]
        inverse = pow(product, -1, prime)
        for row, c in zip(found, image):
            for n in range(len(row)):
                row[n] += product * ((int(c[n]) - row[n]) * inverse % prime)
        product *= prime
        if product.bit_length() >= 61 * tried:
            tried *= 2
            if (made := _rational(found, product)) is not None and all(_divides(number, made, h) for h in (f, g)):
                return made
    return None


def _primes() -> Iterator[int]:
    from flint import fmpz
    at, number = FIRST, 0
    while number < MOST:
        at -= 1
        if at % 2 and fmpz(at).is_prime():
            number += 1
            yield at


def _image(whole: list[int], prime: int, f: list[fmpq_poly], g: list[fmpq_poly]) -> list[nmod_poly] | None:
    """The monic divisor modulo a prime, by Euclid; None where the prime does not serve."""
    from flint import nmod_poly
    modulus = nmod_poly(whole, prime)
    if modulus.degree() < len(whole) - 1 or modulus.gcd(modulus.derivative()).degree() > 0:
        return None
    if any(int(c.denom()) % prime == 0 for h in (f, g) for c in h):
        return None
    one, two = ([nmod_poly([int(n) for n in c.numer().coeffs()], prime) * pow(int(c.denom()), -1, prime) % modulus for c in h] for h in (f, g))
    if all(_inverse(h[-1], modulus) is None for h in (one, two)):
        return None
    while two:
        lead = _inverse(two[-1], modulus)
        if lead is None:
            return None
        two = [c * lead % modulus for c in two]
        one, two = two, _remainder(modulus, two, one)
    return one


def _inverse(element: nmod_poly, modulus: nmod_poly) -> nmod_poly | None:
    common, found, _ = element.xgcd(modulus)
    return found * pow(int(common[0]), -1, int(modulus.modulus())) if common.degree() == 0 else None


def _rational(rows: list[list[int]], product: int) -> list[fmpq_poly] | None:
    """Fractions with these residues, of numerators and denominators below the root of half the product; None where there are none."""
    from flint import fmpq, fmpq_poly
    bound = isqrt(product // 2)
    out = []
    for row in rows:
        values = []
        for residue in row:
            a, b, u, v = product, residue % product, 0, 1
            while b > bound:
                q = a // b
                a, b, u, v = b, a - q * b, v, u - q * v
            if abs(v) > bound or v == 0:
                return None
            values.append(fmpq(b if v > 0 else -b, abs(v)))
        out.append(fmpq_poly(values))
    return out


def _divides(number: fmpq_poly, monic: list[fmpq_poly], f: list[fmpq_poly]) -> bool:
    """Whether a monic polynomial divides f over the field."""
    return not _remainder(number, monic, f)


def _remainder(number: Element, monic: list[Element], f: list[Element]) -> list[Element]:
    """Of f by a monic polynomial, lowest power first, its leading coefficient not zero; [] where it divides f. number: what coefficients are reduced by."""
    rest = list(f)
    for n in range(len(rest) - len(monic), -1, -1):
        factor = rest[n + len(monic) - 1]
        if factor.degree() >= 0:
            for k, c in enumerate(monic):
                rest[n + k] = (rest[n + k] - factor * c) % number
    while rest and rest[-1].degree() < 0:
        rest.pop()
    return rest
