"""Arrays under names behind one address, for functions that hand many arrays on.

Numba passes an array as seven numbers and a tuple of arrays as all of theirs: a call
with thirty arrays costs more than most functions do, and compiling it costs seconds.
A structure is one number, the address of a table of where its arrays lie.
"""

# mypy: allow-untyped-calls, allow-untyped-decorators
# Hardly any of numba is typed.
from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, final, get_type_hints

import numba
import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]  # comes with numba
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, models, register_model
from numba.np import arrayobj

from wbc.arrays import Array, IntArray
from wbc.pointers import WORD

__all__ = ["ENTRIES", "Structure"]

ENTRIES: Final = 3
"""Numbers in the table for every array: address, rows, columns (1 for a vector)."""

_types: Any = types  # numba has no annotations
_tools: Any = cgutils
_arrays: Any = arrayobj
_ir: Any = ir


class _Kind(_types.Type):  # type: ignore[misc]
    """Numba's type of a structure; `fields` are (number in the table, type) by name."""

    def __init__(self, name: str, fields: dict[str, tuple[int, Any]]) -> None:
        self.fields = fields
        super().__init__(name=name)


@register_model(_Kind)
class _Model(models.PrimitiveModel):
    """A structure is an integer."""

    def __init__(self, manager: Any, kind: _Kind) -> None:
        super().__init__(manager, kind, _ir.IntType(8 * WORD))


@infer_getattr
class _Fields(AttributeTemplate):
    key = _Kind

    def generic_resolve(self, kind: Any, name: str) -> Any:  # type: ignore[override]
        """The type of an array by name."""
        return kind.fields[name][1] if name in kind.fields else None


@lower_getattr_generic(_Kind)
def _field(context: Any, builder: Any, kind: _Kind, value: Any, name: str) -> Any:
    """Code for an array by name: its place and shape are read from the table."""
    number, vector = kind.fields[name]
    word = _ir.IntType(8 * WORD)
    table = builder.inttoptr(value, word.as_pointer())

    def entry(i: int) -> Any:
        at = context.get_constant(_types.intp, ENTRIES * number + i)
        return builder.load(builder.gep(table, [at]))

    array = context.make_array(vector)(context, builder)
    size = context.get_constant(_types.intp, WORD)
    shape, strides = [entry(1)], [size]
    if vector.ndim == 2:
        shape.append(entry(2))
        strides.insert(0, builder.mul(shape[1], size))
    _arrays.populate_array(
        array,
        data=builder.inttoptr(entry(0), array.data.type),
        shape=_tools.pack_array(builder, shape),
        strides=_tools.pack_array(builder, strides),
        itemsize=size,
        meminfo=None,
    )
    return array._getvalue()


@final
class Structure:
    """A named tuple of arrays, as compiled functions see it.

    Args:
        of: the tuple's type; its fields are annotated with the kind of array and with
            its shape in the words of `layout`: `Annotated[IntArray, "p + 1"]`.
        after: a structure that comes before it in the same table.

    Attributes:
        size: number of arrays, with those before.
        at: for compiled functions: address of the table -> structure.
    """

    def __init__(self, of: type[Any], after: Structure | None = None) -> None:
        self._shapes: list[list[str]] = [] if after is None else [*after._shapes]
        self._numbers: dict[str, tuple[int, type[Any]]] = {}
        fields: dict[str, tuple[int, Any]] = {}
        for name, hint in get_type_hints(of, include_extras=True).items():
            number = np.int_ if hint.__origin__ == IntArray else np.float64
            shape = hint.__metadata__[0].split(", ")
            kind = _types.Array(numba.from_dtype(np.dtype(number)), len(shape), "C")
            fields[name] = len(self._shapes), kind
            self._numbers[name] = len(self._shapes), number
            self._shapes.append(shape)
        self.size = len(self._shapes)
        self.at: Any = _reader(_Kind(f"{of.__module__}.{of.__qualname__}", fields))

    def layout(self, sizes: Mapping[str, int]) -> tuple[IntArray, int]:
        """The table (a, 3) of its arrays and of those before, end to end from 0 on.

        Args:
            sizes: what the words in the annotations stand for.

        Returns:
            with it, how many numbers there are in all.
        """
        table = np.zeros((len(self._shapes), ENTRIES), np.int_)
        used = 0
        for entry, words in zip(table, self._shapes, strict=True):
            shape = [*(sizes[word] for word in words), 1]
            entry[:] = WORD * used, shape[0], shape[1]
            used += shape[0] * shape[1]
        return table, used

    def view(self, name: str, block: Array, layout: IntArray) -> Any:
        """One of its arrays, in the block of numbers that was laid out."""
        number, kind = self._numbers[name]
        begin, rows, columns = layout[number]
        numbers = block.view(kind)[begin // WORD : begin // WORD + rows * columns]
        flat = len(self._shapes[number]) == 1
        return numbers if flat else numbers.reshape(rows, columns)


def _reader(kind: _Kind) -> Any:
    """An intrinsic that takes an address for a structure."""

    def type_it(typing_context: Any, address: Any) -> Any:
        del typing_context, address

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            del context, builder, signature
            return values[0]

        return kind(_types.intp), generate

    return intrinsic(type_it)
