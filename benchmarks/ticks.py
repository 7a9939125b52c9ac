"""Section (b): whole ticks, ours and the peers', chunk by chunk in turn."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.arm import arms_urdf
from benchmarks.jobs import Job
from benchmarks.pipes import Worker, WorkerError
from benchmarks.summary import Summary
from benchmarks.tables import late, median, micro, ratio, table

__all__ = ["Entry", "arm_job", "race", "summarise", "tick_table", "tick_tables"]

CHUNK = 300
"""Ticks that a worker runs before the next has its turn."""
DROPPED = 200
"""First ticks of a job, and..."""
REWARMED = 10
"""...first ticks of each further chunk that do not count: another process was on."""


@dataclass
class Entry:
    """One contender on one job.

    Attributes:
        worker: the process that runs it.
        kind: our resolver's name; the peer's name.
        ticks: time of each [ns].
        aims: time of moving the references [ns].
        report: what its loop checked.
        failure: why there is nothing, if so.
    """

    worker: Worker
    kind: str
    ticks: list[int] = field(default_factory=list)
    aims: list[int] = field(default_factory=list)
    report: Mapping[str, Any] = field(default_factory=dict)
    failure: str = ""


def arm_job(name: str, arms: int, folder: Path, **changes: Any) -> Job:
    """A job of one or more arms, its model written to the folder."""
    arm = arms_urdf(arms)
    path = folder / f"arms{arms}.urdf"
    path.write_text(arm.urdf)
    robot = {"tips": arm.tips, "home": arm.home, "acceleration": arm.acceleration}
    return Job.from_dict({"name": name, "urdf": str(path), **robot, **changes})


def tick_tables(
    ours: Worker, peers: Sequence[Worker], resolvers: Sequence[str], quick: bool,
    folder: Path, summary: Summary,
) -> Iterator[str]:  # fmt: skip
    """One table a job."""
    ticks = 60 if quick else 3000 + DROPPED
    saturated = {"torque_share": 0.26, "pace": 9.0}
    jobs = [arm_job("one arm, 7 axes: limits >> pose >> posture", 1, folder)]
    if not quick:
        jobs += [
            arm_job("one arm, torques saturated", 1, folder, **saturated),
            arm_job("two arms, 14 axes: limits >> 2 poses >> posture", 2, folder),
        ]
    five = "one arm, 5 strict levels: torques >> joints >> p >> R >> posture"
    jobs.append(arm_job(five, 1, folder, split=True))
    for job in jobs:
        entries = [Entry(ours, name) for name in resolvers]
        entries += [Entry(peer, peer.name) for peer in peers]
        race(job, entries, ticks)
        summarise(job, entries, summary)
        yield tick_table(job, entries)


def race(job: Job, entries: Sequence[Entry], ticks: int) -> None:
    """Run all entries through the job, one chunk each in turn."""
    ids: dict[int, int] = {}
    for k, entry in enumerate(entries):
        try:
            opened = entry.worker.ask("open", job=vars(job), kind=entry.kind)
            ids[k] = opened["id"]
        except WorkerError as error:
            entry.failure = str(error)
    for start in range(0, ticks, CHUNK):
        count = min(CHUNK, ticks - start)
        for k, key in ids.items():
            if not entries[k].failure:
                _run(entries[k], key, count, drop=REWARMED if start else DROPPED)
        _progress(job.name, start + count, ticks)
    for k, key in ids.items():
        if not entries[k].failure:
            entries[k].report = entries[k].worker.ask("close", id=key)["report"]


def _run(entry: Entry, key: int, count: int, drop: int) -> None:
    try:
        answer = entry.worker.ask("run", id=key, ticks=count)
    except WorkerError as error:
        entry.failure = str(error)
        return
    drop = min(drop, count // 2)
    entry.ticks += answer["ticks"][drop:]
    entry.aims += answer["aims"][drop:]


def summarise(job: Job, entries: Sequence[Entry], summary: Summary) -> None:
    """Our default resolver against the peers."""
    times = {entry.kind: entry.ticks for entry in entries}
    summary.add(f"tick, {job.name}", times["hqp"], times)


def tick_table(job: Job, entries: Sequence[Entry]) -> str:
    """Times and checks of every contender."""
    peers = [e for e in entries if e.kind == e.worker.name]
    head = ["contender", "median us", "p99", "p99 / median"]
    head += [f"/ {peer.kind}" for peer in peers]
    check = "off record Nm" if job.recorded else "dynamics Nm"
    head += ["references us", "end error mm", "saturated", check, "note"]
    rows = []
    for entry in entries:
        report, middle = entry.report, median(entry.ticks)
        mine = entry not in peers
        row = [entry.kind if not mine else f"wbc {entry.kind}"]
        row += [micro(middle), micro(late(entry.ticks))]
        row += [ratio(late(entry.ticks), middle)]
        row += [ratio(middle, median(peer.ticks)) for peer in peers]
        row += [micro(median(entry.aims))]
        rows.append(row + _checks(job, entry, report))
    return table(f"Tick: {job.name}", head, rows)


def _checks(job: Job, entry: Entry, report: Mapping[str, Any]) -> list[str]:
    """What the loop found.

    Error of the tips, saturation, and tau = RNEA(q, v, dv), or tau as recorded.
    """
    if not report:
        return ["-", "-", "-", entry.failure]
    note = report["failure"]
    if report["torque_share"] > 1 + 1e-9:
        note += f" torque {report['torque_share']:.9f} of the limit"
    if report["beyond_limits_rad"] > 0:
        note += f" {report['beyond_limits_rad']:.1e} rad beyond a joint limit"
    error = f"{report['end_error_mm']:.2f}" if job.tips else "-"
    return [
        error,
        f"{100 * report['saturated']:.0f} %",
        f"{report['off_record_nm' if job.recorded else 'dynamics_nm']:.0e}",
        note,
    ]


def _progress(name: str, done: int, ticks: int) -> None:
    if sys.stderr.isatty():
        end = "\n" if done >= ticks else ""
        print(f"\r{name}: {done}/{ticks} ", end=end, file=sys.stderr, flush=True)
