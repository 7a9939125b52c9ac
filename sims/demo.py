"""What an application hands to the command line: options in, an outcome out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

from sims.course import Course
from sims.metrics import Metric
from wbc.arrays import Array

__all__ = ["Demo", "Options", "Outcome"]


@final
@dataclass(frozen=True, slots=True)
class Options:
    """What the user asked for.

    Attributes:
        resolver: name of a resolver (`sims.resolvers`).
        duration: longest simulated time of each job [s]; None for as long as it takes.
        seed: of everything random.
        mismatch: simulate a robot that differs from the controller's model.
        view: open a window while it runs.
        video: file for a video of it; None for none.
        quiet: no progress bar.
        experiment: which of the cell's experiments; "" for its first, or none.
        combined: both arms of a cell under one hierarchy.
    """

    resolver: str = "hqp"
    duration: float | None = None
    seed: int = 0
    mismatch: bool = False
    view: bool = False
    video: str | None = None
    quiet: bool = False
    experiment: str = ""
    combined: bool = False


@final
@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What a run of a cell gave.

    Attributes:
        metrics: the numbers that it is judged by.
        series: named time series, for the log file.
        figures: makes the (caption, svg) pairs of the report.
        replay: makes the 3-D replay, one HTML document.
        picture: makes a picture (height, width, 3) of the end of the run.
        facts: what it was made with.
        courses: of its runs by name; the report draws their levels.
    """

    metrics: list[Metric]
    series: dict[str, Array]
    figures: Callable[[], list[tuple[str, str]]]
    replay: Callable[[], str]
    picture: Callable[[], Any]
    facts: dict[str, str] = field(default_factory=dict)
    courses: Mapping[str, Course] = field(default_factory=dict)


@final
@dataclass(frozen=True, slots=True)
class Demo:
    """An application that the command line can run.

    Attributes:
        name: what it is called there.
        about: one line about it.
        run: options -> outcome.
        experiments: their names, the default first; empty where there are none.
        compared: resolver -> outcome of each, into (caption, svg) pairs of the cell's
            own that set them side by side; None for none.
        combined: whether `Options.combined` means something to it.
    """

    name: str
    about: str
    run: Callable[[Options], Outcome]
    experiments: tuple[str, ...] = ()
    compared: Callable[[Mapping[str, Outcome]], list[tuple[str, str]]] | None = None
    combined: bool = False
