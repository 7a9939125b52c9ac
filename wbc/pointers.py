"""Arrays at fixed addresses, for kernels that read what Pinocchio has written.

Pinocchio's Data hands out views of its own memory, which stays where it is as long as
the Data lives. A kernel that is given the addresses once needs no call per array.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray, types
from numba.extending import intrinsic

from wbc.arrays import Array
from wbc.compiled import compiled

__all__ = ["address_of", "floats_at"]


@intrinsic
def _pointer(typing_context: Any, address: Any) -> Any:
    """The address as a pointer to float64."""
    del typing_context, address

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        target = context.get_value_type(signature.return_type)
        return builder.inttoptr(arguments[0], target)

    return types.CPointer(types.float64)(types.int64), generate


@compiled
def floats_at(address: int, count: int) -> Array:
    """The float64 numbers (count,) that start at an address; nothing is copied."""
    return carray(_pointer(address), (count,))  # type: ignore[no-any-return]


def address_of(view: Array) -> int:
    """Where a float64 array begins; its owner must keep it alive and in place."""
    assert view.dtype == np.float64
    return int(view.ctypes.data)
