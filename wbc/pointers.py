"""Arrays at fixed addresses, for kernels that read what Pinocchio has written.

Pinocchio's Data hands out views of its own memory, which stays where it is as long as
the Data lives. A kernel that is given the addresses once needs no call per array.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numba import types
from numba.extending import intrinsic

from wbc.arrays import Array
from wbc.compiled import inner
from wbc.errors import InputError

__all__ = ["address_of", "floats_at"]


_float64: Any = types.float64
_pointer_type: Any = types.CPointer  # numba has no annotations
_view: Any = numba.carray  # type: ignore[attr-defined] # nor a list of its exports


@intrinsic
def _as_pointer(typing_context: Any, address: Any) -> Any:
    """The address as a pointer to float64."""
    del typing_context, address

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        target = context.get_value_type(signature.return_type)
        return builder.inttoptr(arguments[0], target)

    return _pointer_type(_float64)(types.int64), generate


_pointer: Any = _as_pointer


@inner
def floats_at(address: int, count: int) -> Array:
    """The float64 numbers (count,) that start at an address; nothing is copied."""
    return _view(_pointer(address), (count,))  # type: ignore[no-any-return]


def address_of(view: Array) -> int:
    """Where an array begins; whoever takes the address must keep the array alive.

    Raises:
        InputError: not float64, or not contiguous.
    """
    if view.dtype != np.float64 or not view.flags.forc:
        raise InputError("a kernel reads contiguous arrays of float64 only.")
    return int(view.ctypes.data)
