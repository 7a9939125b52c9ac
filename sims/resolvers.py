"""Resolvers by the names of the command line."""

from __future__ import annotations

from collections.abc import Callable

from wbc import (
    HierarchicalQP,
    NullSpace,
    Resolver,
    WeightedQP,
    backends,
)
from wbc.checks import known

__all__ = ["make_resolver", "resolver_names"]

FIXED: dict[str, Callable[[], Resolver]] = {
    "hqp": HierarchicalQP,
    "nullspace": NullSpace,
    "nullspace:tsid": lambda: NullSpace("tsid"),
    "nullspace:uf": lambda: NullSpace("uf"),
    "weighted": WeightedQP,
}


def resolver_names() -> list[str]:
    """Every name that `make_resolver` takes on this machine."""
    return [*FIXED, *(f"hqp:{name}" for name in backends())]


def make_resolver(name: str) -> Resolver:
    """A resolver by name, such as "hqp", "hqp:daqp" or "nullspace:tsid".

    Raises:
        UnknownName: no such resolver, or its QP backend is not installed.
    """
    known("resolver", name, resolver_names())
    if name in FIXED:
        return FIXED[name]()
    return HierarchicalQP(name.removeprefix("hqp:"))
