"""Arrays at fixed addresses, for kernels that read what Pinocchio has written.

Pinocchio's Data hands out views of its own memory, which stays where it is as long as
the Data lives. A kernel that is given the addresses once needs no call per array.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np import arrayobj

from wbc.arrays import Array, IntArray
from wbc.errors import InputError

__all__ = ["address_of", "floats_at", "integers_at", "matrix"]

WORD = 8

_types: Any = types  # numba has no annotations
_arrays: Any = arrayobj
_tools: Any = cgutils


def _view_of(kind: Any) -> Any:
    """An intrinsic: the numbers of this kind at an address, as an array."""

    def type_it(typing_context: Any, address: Any, count: Any) -> Any:
        del typing_context, address, count
        vector = _types.Array(kind, 1, "C")

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            del signature
            address, count = arguments
            array = context.make_array(vector)(context, builder)
            word = context.get_constant(_types.intp, WORD)
            _arrays.populate_array(
                array,
                data=builder.inttoptr(address, array.data.type),
                shape=_tools.pack_array(builder, [count]),
                strides=_tools.pack_array(builder, [word]),
                itemsize=word,
                meminfo=None,
            )
            return array._getvalue()

        return vector(_types.intp, _types.intp), generate

    return intrinsic(type_it)


def _in_rows(typing_context: Any, vector: Any, rows: Any, columns: Any) -> Any:
    del typing_context, rows, columns
    kind = _types.Array(vector.dtype, 2, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        of, rows, columns = arguments
        numbers = context.make_array(signature.args[0])(context, builder, of)
        array = context.make_array(kind)(context, builder)
        word = context.get_constant(_types.intp, WORD)
        _arrays.populate_array(
            array,
            data=numbers.data,
            shape=_tools.pack_array(builder, [rows, columns]),
            strides=_tools.pack_array(builder, [builder.mul(columns, word), word]),
            itemsize=word,
            meminfo=None,
        )
        return array._getvalue()

    return kind(vector, _types.intp, _types.intp), generate


floats_at: Any = _view_of(_types.float64)
"""(address, count) -> the float64 numbers (count,) there; nothing is copied.

The array owns nothing, and a compiled function must not return it.
"""
integers_at: Any = _view_of(_types.intp)
"""The same for integers."""
matrix: Any = intrinsic(_in_rows)
"""(vector, rows, columns) -> the same numbers in rows; nothing is copied.

The vector must be contiguous and as long. Nothing is checked, unlike by `reshape`.
"""


def address_of(view: Array | IntArray) -> int:
    """Where an array begins; whoever takes the address must keep the array alive.

    Raises:
        InputError: neither float64 nor integers, or not contiguous.
    """
    if view.dtype not in (np.float64, np.intp) or not view.flags.forc:
        raise InputError("a kernel reads contiguous arrays of float64 or intp only.")
    return int(view.ctypes.data)
