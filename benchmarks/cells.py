"""Section: whole ticks of the cells' own stacks, under every resolver."""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.jobs import Job
from benchmarks.pipes import Worker
from benchmarks.stacks import STACKS
from benchmarks.summary import Summary
from benchmarks.ticks import Entry, race, summarise, tick_table
from sims.resolvers import resolver_names

__all__ = ["cell_resolvers", "cell_tables"]

LONGEST = 6000
"""Ticks of a recorded run: the first six seconds of a job."""
CASCADES = ("hqp:daqp", "hqp:proxqp")
"""The first that is there stands for all of them."""


def cell_resolvers() -> list[str]:
    """Every resolver, but one cascade only."""
    known = resolver_names()
    own = [name for name in known if not name.startswith("hqp:")]
    return own + [name for name in CASCADES if name in known][:1]


def cell_tables(ours: Worker, quick: bool, summary: Summary) -> Iterator[str]:
    """One table a stack; every resolver goes through the same recorded run."""
    ticks = 60 if quick else LONGEST
    for stack, size in STACKS.items():
        cell, _, name = stack.partition(": ")
        job = Job(f"{cell} cell, {name}: {size}", cell=stack, recorded=ticks)
        entries = [Entry(ours, resolver) for resolver in cell_resolvers()]
        race(job, entries, ticks)
        summarise(job, entries, summary)
        yield tick_table(job, entries)
