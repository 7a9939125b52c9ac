"""How numba treats functions that compiled ones call: it links them, no more.

On its own it optimises each of them with all that it calls, and makes machine code of
it that no caller takes: a third of a first compilation. Here a function stays as it was
typed until a kernel of `wbc.compiled` is whole.

This overrides three internal methods of numba; where a version has others, functions
are compiled as numba would, which is slower and no less right.
"""

# mypy: allow-untyped-calls
# Hardly any of numba is typed.
from __future__ import annotations

from typing import Any, Final

import llvmlite.binding as llvm  # type: ignore[import-untyped]  # comes with numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import AnnotateTypes

__all__ = ["KERNEL", "PART"]

ENVIRONMENT = "NumbaEnv"
"""In the name of the variable by which numba hands a function its Python globals."""


class _Kernel(JITCodeLibrary):
    """Optimised code without machine code."""

    def _finalize_final_module(self) -> None:
        """Emit nothing but the variables that numba sets after this: a pointer each."""
        names = [v.name for v in self._final_module.global_variables]
        lines = [f'@"{x}" = common global i64 0' for x in names if ENVIRONMENT in x]
        self._codegen._add_module(llvm.parse_assembly("\n".join(lines)))
        self._finalized = True


class _Part(_Kernel):
    """Code as it was typed."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        """Left to the kernel."""


class _Into(LoweringPass):
    """Tells the pass that makes code of a function where to put it."""

    library: Any

    def __init__(self) -> None:
        LoweringPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        codegen, name = state.targetctx.codegen(), state.func_id.func_qualname
        state.library = self.library(codegen, name)
        return True


@register_pass(mutates_CFG=False, analysis_only=True)
class _IntoKernel(_Into):
    _name, library = "wbc_into_kernel", _Kernel


@register_pass(mutates_CFG=False, analysis_only=True)
class _IntoPart(_Into):
    _name, library = "wbc_into_part", _Part


class _AsKernel(CompilerBase):
    """Numba's own passes, but for the library."""

    into: Any = _IntoKernel

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(self.into, AnnotateTypes)
        passes.finalize()
        return [passes]


class _AsPart(_AsKernel):
    into = _IntoPart


OVERRIDDEN = ("_optimize_functions", "_optimize_final_module", "_finalize_final_module")
KNOWN: Final = all(hasattr(JITCodeLibrary, name) for name in OVERRIDDEN)
INSIDE: Final = {"cache": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""No door for calls from Python: for tuples of arrays it is larger than many a function
behind it."""


def _options(pipeline: type[_AsKernel]) -> dict[str, Any]:
    return INSIDE | ({"pipeline_class": pipeline} if KNOWN else {})


KERNEL: Final = _options(_AsKernel)
"""Options of `numba.njit` for a kernel in others: the same code through any door."""
PART: Final = _options(_AsPart)
"""And for what is only ever a part of kernels."""
