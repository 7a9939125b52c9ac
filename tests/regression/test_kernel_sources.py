"""The cache of compiled code knows every file that the code comes from."""

from __future__ import annotations

import ast
from pathlib import Path

import tasks
import wbc

ROOTS = [Path(str(package.__file__)).parent for package in (wbc, tasks)]
MARKS = ("wbc.compiled", "NamedTuple", "numba")
"""What `wbc.cache` looks for in a file, to see whether kernels depend on it."""


def modules() -> dict[str, str]:
    """Text of every module of both packages, by its name."""
    found = {}
    for root in ROOTS:
        for path in root.rglob("*.py"):
            name = path.relative_to(root.parent).with_suffix("").parts
            found[".".join(name)] = path.read_text()
    return found


def constants(text: str) -> list[str]:
    """Modules from which constants are imported, or which are used as bags of them."""
    read = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [alias.name for alias in node.names]
            if any(name.isupper() for name in names):
                read.append(node.module)
            read += [f"{node.module}.{name}" for name in names if name.islower()]
    return read


def test_a_changed_constant_of_a_kernel_gives_the_cache_another_folder():
    texts = modules()
    kernels = {
        name: text
        for name, text in texts.items()
        if "@compiled" in text or "@inner" in text
    }
    assert len(kernels) > 20
    unknown = {
        (source, name)
        for name, text in kernels.items()
        for source in constants(text)
        if source in texts and not any(mark in texts[source] for mark in MARKS)
    }
    assert unknown == set()
