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
from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.typed_passes import AnnotateTypes

__all__ = ["KERNEL", "PART", "WHOLE"]

ENVIRONMENT = "NumbaEnv"
"""In the name of the variable by which numba hands a function its Python globals."""


class _Whole(JITCodeLibrary):
    """Code for short vectors: loops as they are written, four terms at a time.

    Vector units are used where a loop's body has room for them. Loops made for long
    vectors never reach their fast part here, and are many times larger.
    """

    calls: tuple[Any, ...] = ()
    """Libraries that must be taken along with this one."""

    def add_linking_library(self, library: Any) -> None:
        """Take a library and what it calls: each once, not within every caller."""
        for one in (library, *getattr(library, "calls", ())):
            if one not in self._linking_libraries:
                super().add_linking_library(one)

    def _optimize_final_module(self) -> None:
        passes, builder = self._codegen._module_pass_manager(
            loop_vectorize=False, slp_vectorize=True
        )
        passes.run(self._final_module, builder)


class _Kernel(_Whole):
    """Optimised code without machine code."""

    def _finalize_final_module(self) -> None:
        """Emit nothing but the variables that numba sets after this: a pointer each."""
        names = [v.name for v in self._final_module.global_variables]
        lines = [f'@"{x}" = common global i64 0' for x in names if ENVIRONMENT in x]
        self._codegen._add_module(llvm.parse_assembly("\n".join(lines)))
        self._finalized = True


class _Part(_Kernel):
    """Code as it was typed, without that of what it calls."""

    def finalize(self) -> None:
        """Link nothing: whoever takes this takes what it calls, too."""
        self.calls, self._linking_libraries = tuple(self._linking_libraries), []
        super().finalize()

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
        if self.library is _Whole:
            state.library.enable_object_caching()
        return True


@register_pass(mutates_CFG=False, analysis_only=True)
class _IntoWhole(_Into):
    _name, library = "wbc_into_whole", _Whole


@register_pass(mutates_CFG=False, analysis_only=True)
class _IntoKernel(_Into):
    _name, library = "wbc_into_kernel", _Kernel


@register_pass(mutates_CFG=False, analysis_only=True)
class _IntoPart(_Into):
    _name, library = "wbc_into_part", _Part


NEEDLESS: Final = {
    "with_lifting",
    "inline_closure_likes",
    "dead_branch_prune",
    "Rewrite dynamic raises",
    "make_function_op_code_to_jit_function",
    "inline_inlinables",
    "literal_unroll",
    "inline_overloads",
    "nopython_rewrites",
}
"""Passes for what kernels do not have: closures, array expressions, branches on types,
raised exceptions."""


HASH: Final = hash(Flags())
"""Numba's hash of them: of their names, and so the same for all."""


class _Flags(Flags):
    """Numba's options of a compilation, quick to compare.

    It looks up every overload by its options, 60,000 times in a first compilation.
    """

    __slots__ = ()

    def __hash__(self) -> int:
        return HASH

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, Flags) and self._values == other._values
        return same or bool(super().__eq__(other))


class _AsWhole(CompilerBase):
    """Numba's own passes, less the needless ones, and our library."""

    into: Any = _IntoWhole

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.state.flags = _Flags(self.state.flags)

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(self.into, AnnotateTypes)
        passes.passes = [one for one in passes.passes if one[0].name() not in NEEDLESS]
        passes.finalize()
        return [passes]


class _AsKernel(_AsWhole):
    into = _IntoKernel


class _AsPart(_AsWhole):
    into = _IntoPart


OVERRIDDEN = (
    "_optimize_functions",
    "_optimize_final_module",
    "_finalize_final_module",
    "add_linking_library",
    "finalize",
)
KNOWN: Final = all(hasattr(JITCodeLibrary, name) for name in OVERRIDDEN)
INSIDE: Final = {"cache": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""No door for calls from Python: for tuples of arrays it is larger than many a function
behind it."""


def _options(pipeline: type[_AsWhole]) -> dict[str, Any]:
    return {"pipeline_class": pipeline} if KNOWN else {}


WHOLE: Final = _options(_AsWhole)
"""Options of `numba.njit` for a kernel as Python calls it."""
KERNEL: Final = INSIDE | _options(_AsKernel)
"""For a kernel in others: the same code through any door."""
PART: Final = INSIDE | _options(_AsPart)
"""And for what is only ever a part of kernels."""
