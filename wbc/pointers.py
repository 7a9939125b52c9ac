"""Arrays at fixed addresses, for kernels that read what Pinocchio has written.

Pinocchio's Data hands out views of its own memory, which stays where it is as long as
the Data lives. A kernel that is given the addresses once needs no call per array.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np import arrayobj

from wbc.arrays import Array
from wbc.errors import InputError

__all__ = ["address_of", "floats_at"]

_types: Any = types  # numba has no annotations
_arrays: Any = arrayobj


@intrinsic
def _view(typing_context: Any, address: Any, count: Any) -> Any:
    """An array that owns nothing; a compiled function must not return it."""
    del typing_context, address, count
    vector = _types.Array(_types.float64, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, count = arguments
        array = context.make_array(vector)(context, builder)
        word = context.get_constant(_types.intp, 8)
        _arrays.populate_array(
            array,
            data=builder.inttoptr(address, array.data.type),
            shape=cgutils.pack_array(builder, [count]),
            strides=cgutils.pack_array(builder, [word]),
            itemsize=word,
            meminfo=None,
        )
        return array._getvalue()

    return vector(_types.intp, _types.intp), generate


floats_at: Callable[[int, int], Array] = _view
"""The float64 numbers (count,) that start at an address; nothing is copied."""


def address_of(view: Array) -> int:
    """Where an array begins; whoever takes the address must keep the array alive.

    Raises:
        InputError: not float64, or not contiguous.
    """
    if view.dtype != np.float64 or not view.flags.forc:
        raise InputError("a kernel reads contiguous arrays of float64 only.")
    return int(view.ctypes.data)
