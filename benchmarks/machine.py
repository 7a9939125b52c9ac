"""What the figures were measured on; nothing that identifies the machine."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

__all__ = ["SINGLE_THREAD", "describe"]

THREADS = ("OMP", "OPENBLAS", "MKL", "NUMBA")
SINGLE_THREAD = {f"{library}_NUM_THREADS": "1" for library in THREADS}
PACKAGES = (
    "wbc", "numpy", "scipy", "pin", "numba", "qpsolvers", "proxsuite", "daqp",
    "quadprog",
)  # fmt: skip


def describe(peers: Mapping[str, Mapping[str, str]]) -> str:
    """Processor, cores, load, Python, packages here and in the peers' environments."""
    lines = [
        f"processor: {_processor()}, {os.cpu_count()} cores, load {_load()}",
        f"system: {platform.system()} {platform.machine()}, single thread, "
        f"{platform.python_implementation()} {platform.python_version()}",
        "ours: " + ", ".join(f"{k} {v}" for k, v in _installed().items()),
    ]
    for peer, packages in peers.items():
        lines.append(f"{peer}: " + ", ".join(f"{k} {v}" for k, v in packages.items()))
    return "\n".join(lines) + "\n"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    return platform.processor() or "unknown"


def _load() -> str:
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def _installed() -> dict[str, str]:
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
