"""Compilation of the numerical kernels: plain Python loops, compiled by numba.

Compiled code is kept in the user's cache folder, or a temporary one where that cannot
be written, so only the first use of a version waits. numba looks for changes in a
kernel's own file only, not in those of the kernels that it calls; therefore each state
of the sources has a cache folder of its own.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar, cast

import numba

from wbc.cache import CACHE, forgive
from wbc.linking import KERNEL, PART, WHOLE

__all__ = ["announce", "compiled", "inner", "python"]

Function = TypeVar("Function", bound=Callable[..., object])

SETTINGS: Any = numba.config
UNLITERAL: Any = numba.types.unliteral
ALLOWED: Final = {"reassoc", "contract", "arcp", "nsz"}
"""Sums may be reordered for the vector units; NaN and infinity keep their meaning."""


def compiled(function: Function) -> Function:
    """Compile a function at its first call, for the argument types of that call.

    It may neither allocate nor return arrays. Then references to its arrays need no
    counting, which in small kernels is most of the work. (Assigning an array to a slice
    of another allocates, in case they overlap.) Others that call it take its code
    as optimised on its own: a result does not depend on the door it came in by.
    """
    kernel: Any = _compile(function, WHOLE | {"cache": CACHE is not None})
    if CACHE is not None:
        forgive(kernel)
    within: Any = _compile(function, KERNEL)
    kernel.get_call_template = within.get_call_template
    kernel.get_overload = within.get_overload
    return cast(Function, kernel)


def inner(function: Function) -> Function:
    """Compile a function, under the same rules, that only compiled ones call.

    What calls it keeps its code in the cache.
    """
    return _compile(function, PART)


def python(function: Function) -> Function:
    """The Python function behind a compiled one."""
    return cast(Function, getattr(function, "py_func", function))


def _compile(function: Function, options: Mapping[str, Any]) -> Function:
    elsewhere = SETTINGS.CACHE_DIR
    SETTINGS.CACHE_DIR = elsewhere or str(CACHE or "")
    try:
        njit: Any = numba.njit  # typed without the options that are not for everyone
        compile_it = njit(fastmath=ALLOWED, error_model="numpy", _nrt=False, **options)
        return cast(Function, _one_version(compile_it(function)))
    finally:
        SETTINGS.CACHE_DIR = elsewhere


def _one_version(kernel: Any) -> Any:
    """Let constants in a call count as numbers; numba compiles anew for each."""
    find = kernel.get_call_template

    def find_for_types(args: Any, kws: Mapping[str, Any]) -> Any:
        named = {name: UNLITERAL(kind) for name, kind in kws.items()}
        return find(tuple(UNLITERAL(kind) for kind in args), named)

    kernel.get_call_template = find_for_types
    return kernel


def announce(kernel: Any, what: str) -> None:
    """Say on standard error that a compilation is about to start, if one is."""
    if kernel.signatures:
        return
    if CACHE is None or not any(CACHE.rglob(f"*{kernel.__name__}-*.nbc")):
        sys.stderr.write(
            f"wbc: compiling {what}, kept for later runs; up to half a minute ...\n"
        )
        sys.stderr.flush()
