"""Eight doubles at a time, which compiled code works on, and the door of numba for the kernels of spin-up.

A row of an array (n, 8) is loaded, worked on and stored as one value; lanes never meet, so that the numbers
of a motion depend on no neighbour. Each operation stands here twice: as NumPy has it, on rows of any length,
and (`vectors`) as instructions on vectors, which numba does not make of loops by itself. The two agree to the
last bit (x y + z is rounded twice in both), so that an answer does not depend on what the process has
compiled. numba's cache on disk watches the kernel's file alone: change both together.
"""
from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from ...numbers.numba_door import compiled

WIDE = 8
INLINED = {"fixed_kernel": {"put", "columns", "total", "falling", "value_of", "blurred", "search"},
           "moving_kernel": {"greatest"}}


def functions(kernel: ModuleType, fast: bool) -> dict[str, Any]:
    """A kernel's functions by name: compiled, or as they are written."""
    return compiled_functions(kernel) if fast else vars(kernel)


@lru_cache(maxsize=4)
def compiled_functions(kernel: ModuleType) -> dict[str, Any]:
    """A kernel's functions by name, compiled; stored on disk where there is a place for it."""
    name = kernel.__name__.rpartition(".")[2]
    return compiled(kernel, INLINED.get(name, ()), **vectors() if hasattr(kernel, "load") else {})


def loaded() -> bool:
    """Whether compiled functions are at hand, without loading them."""
    return bool(compiled_functions.cache_info().currsize)


def stored() -> bool:
    """Whether an earlier process left compiled steps beside the sources, where numba puts them unless told
    otherwise."""
    return any(Path(__file__).with_name("__pycache__").glob("steps.advance-*.nbi"))


def load(array, row):
    """A row of an array (n, 8)."""
    return array[row].copy()


def store(array, row, x):
    """Put a value into a row."""
    array[row] = x


def spread(number):
    """A number in all lanes."""
    return number


def plus(x, y):
    return x + y


def minus(x, y):
    return x - y


def times(x, y):
    return x * y


def times_plus(x, y, z):
    """x y + z."""
    return x * y + z


def size(x):
    return np.abs(x)


def greater(x, y):
    """The greater; y where they cannot be compared."""
    return np.where(x > y, x, y)


def lesser(x, y):
    """The lesser; y where they cannot be compared."""
    return np.where(x < y, x, y)


def logarithm(x):
    """Of positive x to the base 2: exact at powers of 2, linear between them, so at most 0.09 below."""
    return x.view(np.int64) * 2.0**-52 - 1023.0


def power_of_two(x):
    """The greatest that is not above x, 2^-1022 < x < infinity; x = 1 and more are meant."""
    return (x.view(np.int64) & EXPONENT).view(float)


def two_to(y):
    """2^y for |y| < 1000, within 0.3 per cent."""
    whole = np.floor(y)
    part = y - whole
    return (((whole + 1023.0).astype(np.int64)) << 52).view(float) * (1.0 + part * (0.6565 + 0.3435 * part))


EXPONENT = 0x7FF0000000000000


@lru_cache(maxsize=1)
def vector_type():
    """Numba's type of eight doubles, one for the process. Code that is kept on disk names it by this
    function: a copy of the class, as pickle would make for each process, is no type that numba knows, where
    some functions are kept and others are compiled anew."""
    from llvmlite import ir
    from numba.core import types
    from numba.extending import models, register_model

    class Lanes(types.Type):
        def __reduce__(self):
            return vector_type, ()

    register_model(Lanes)(type("LanesModel", (models.PrimitiveModel,),
                               {"__init__": lambda self, dmm, one: models.PrimitiveModel.__init__(
        self, dmm, one, ir.VectorType(ir.DoubleType(), WIDE))}))
    return Lanes("lanes")


@lru_cache(maxsize=1)
def vectors() -> dict:
    """The operations by name for code that numba compiles."""
    from llvmlite import ir
    from numba.core import cgutils, types
    from numba.extending import intrinsic

    lanes, double, whole = vector_type(), ir.VectorType(ir.DoubleType(),
                                                        WIDE), ir.VectorType(ir.IntType(64), WIDE)

    def operation(emit, *arguments, result=lanes):
        def typed(context, *given):
            return result(*(old if new is None else new for old,
                            new in zip(given, arguments))), lambda *all_: emit(*all_)
        counted = {1: lambda context, x: typed(context, x), 2: lambda context, x, y: typed(context, x, y),
                   # numba counts the arguments by their names
                   3: lambda context, x, y, z: typed(context, x, y, z)}
        return intrinsic(counted[len(arguments)])

    def place(context, builder, signature, given):
        array = context.make_array(signature.args[0])(context, builder, given[0])
        start = builder.mul(given[1], ir.Constant(given[1].type, WIDE))
        return builder.bitcast(builder.gep(array.data, [start]), double.as_pointer())

    def loaded(context, builder, signature, given):
        value = builder.load(place(context, builder, signature, given))
        value.align = 8
        return value

    def stored(context, builder, signature, given):
        builder.store(given[2], place(context, builder, signature, given)).align = 8
        return context.get_dummy_value()

    def spread_out(context, builder, signature, given):
        empty, where = ir.Constant(double, ir.Undefined), ir.VectorType(ir.IntType(32), WIDE)
        return builder.shuffle_vector(builder.insert_element(empty, given[0], ir.IntType(32)(0)), empty,
                                      ir.Constant(where, [0] * WIDE))

    def called(name, n):
        def emit(context, builder, signature, given):
            kind = ir.FunctionType(double, [double] * n)
            return builder.call(cgutils.get_or_insert_function(builder.module, kind,
                                                               f"llvm.{name}.v{WIDE}f64"), given)
        return emit

    def product_plus(context, builder, signature, given):
        # not the processor's one instruction, which rounds once
        return builder.fadd(builder.fmul(given[0], given[1]), given[2])

    def all_of(kind, number):
        return ir.Constant(kind, [number] * WIDE)

    def chosen(sign):
        return lambda context, builder, signature, given: builder.select(
            builder.fcmp_ordered(sign, *given), *given)

    def logarithm_of(context, builder, signature, given):
        bits = builder.sitofp(builder.bitcast(given[0], whole), double)
        return builder.fsub(builder.fmul(bits, all_of(double, 2.0**-52)), all_of(double, 1023.0))

    def power_below(context, builder, signature, given):
        return builder.bitcast(builder.and_(builder.bitcast(given[0], whole), all_of(whole, EXPONENT)),
                               double)

    def raised(context, builder, signature, given):
        floor = called("floor", 1)(context, builder, signature, given)
        part = builder.fsub(given[0], floor)
        share = builder.fadd(all_of(double, 0.6565), builder.fmul(all_of(double, 0.3435), part))
        share = builder.fadd(all_of(double, 1.0), builder.fmul(part, share))
        bits = builder.fptosi(builder.fadd(floor, all_of(double, 1023.0)), whole)
        return builder.fmul(builder.bitcast(builder.shl(bits, all_of(whole, 52)), double), share)

    two = {name: operation(lambda c, b, s, g, name=name: getattr(b, name)(*g), lanes, lanes)
           for name in ("fadd", "fsub", "fmul")}
    return {"load": operation(loaded, None, types.int64),
            "store": operation(stored, None, types.int64, lanes, result=types.none),
            "spread": operation(spread_out, types.float64), "plus": two["fadd"], "minus": two["fsub"],
            "times": two["fmul"],
            "times_plus": operation(product_plus, lanes, lanes, lanes),
            "size": operation(called("fabs", 1), lanes),
            "greater": operation(chosen(">"), lanes, lanes), "lesser": operation(chosen("<"), lanes, lanes),
            "logarithm": operation(logarithm_of, lanes), "power_of_two": operation(power_below, lanes),
            "two_to": operation(raised, lanes)}
