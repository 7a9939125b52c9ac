"""The few lines that matter: ours over the peers, from the same run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from benchmarks.tables import late, median, micro, ratio, table

__all__ = ["Summary"]

PEERS = ("daqp", "placo", "tsid")


@dataclass
class Summary:
    """Collects a line from every section.

    Attributes:
        rows: of the table.
    """

    rows: list[list[str]] = field(default_factory=list)

    def add(
        self, case: str, ours: Sequence[int], peers: Mapping[str, Sequence[int]]
    ) -> None:
        """A case: our times [ns], and those of the peers that took part."""
        middle = median(ours)
        against = [ratio(middle, median(peers.get(name, ()))) for name in PEERS]
        tail = ratio(late(ours), middle)
        self.rows.append([case, micro(middle), micro(late(ours)), tail, *against])

    def table(self) -> str:
        """Medians, 99th percentiles, and ratios of medians."""
        head = ("wbc hqp", "median us", "p99", "p99 / median", "/ DAQP", "/ PlaCo")
        return table("Summary", (*head, "/ TSID"), self.rows)
