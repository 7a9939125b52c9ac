"""The command line: `wbc list`, `run`, `compare`, `bench` and `audit`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version

from sims.commands import audit_model, bench, compare, list_cells, run_cell
from sims.demo import Options
from sims.view import WindowClosed
from wbc import WbcError

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Returns:
        0 if everything held, 1 if a bound did not, 2 on bad usage or where a file or
        what is printed cannot be written, 130 if the user ended it, 141 if nobody
        read on what it printed.
    """
    parser = _parser()
    asked = parser.parse_args(arguments)
    try:
        code: int = asked.action(asked)
        print(end="", flush=True)  # fails here where standard output does
    except BrokenPipeError:  # as in `wbc list | head -1`
        _print_no_more()
        return 141
    except WbcError as error:
        sys.stderr.write(f"wbc: {error}\n")
        return 2
    except OSError as error:
        where = error.filename or ("" if _can_print() else "standard output")
        if not where:
            raise
        sys.stderr.write(f"wbc: {where}: {error.strerror or error}.\n")
        return 2
    except WindowClosed:
        sys.stderr.write("\nwbc: the window was closed, nothing was judged\n")
        return 130
    except KeyboardInterrupt:
        sys.stderr.write("\nwbc: interrupted\n")
        return 130
    return code


def _can_print() -> bool:
    """Whether standard output takes what is left for it; if not, it goes nowhere."""
    try:
        print(end="", flush=True)
    except OSError:
        _print_no_more()
        return False
    return True


def _print_no_more() -> None:
    """Let what is left for standard output go nowhere, or the interpreter complains."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="wbc", description="Whole-body control in simulated cells."
    )
    parser.add_argument("--version", action="version", version=version("wbc"))
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add(commands, "list", "names the cells", lambda _: list_cells())
    run = _add(
        commands,
        "run",
        "runs a cell",
        lambda a: run_cell(a.cell, _options(a), a.out),
        "Exit code: 0 if all bounds hold, 1 if one does not or was not measured.",
    )
    run.add_argument("cell", metavar="CELL", help="see 'wbc list'")
    run.add_argument("--resolver", default="hqp", help=RESOLVERS)
    run.add_argument("--experiment", default="", help="such as initial (cutting only)")
    run.add_argument("--view", action="store_true", help="open a window")
    run.add_argument(
        "--video", metavar="FILE.mp4", help="film it; needs pip install 'wbc[video]'"
    )
    _common(run)
    against = _add(
        commands,
        "compare",
        "runs a cell, or a study, under several resolvers, or a cell's experiments",
        lambda a: compare(a.cell, a.resolvers, _options(a), a.out),
        "Exit code: for a cell 0 once all runs are done, whatever their metrics say, "
        "since the weaker resolvers are there to fail; for random and transitions 1 "
        "if a bound does not hold.",
    )
    against.add_argument(
        "cell",
        metavar="CELL",
        help="see 'wbc list'; or 'random' for random stacks, 'transitions' for "
        "changes of the hierarchy at run time",
    )
    against.add_argument(
        "--resolvers",
        type=lambda text: text.split(","),
        default=[],
        help=f"names with commas between: {RESOLVERS}; by default a cell's "
        "experiments, or hqp, nullspace and weighted where it has none",
    )
    _common(against)
    speed = _add(
        commands, "bench", "times the tick of every resolver", lambda a: bench(a.ticks)
    )
    speed.add_argument("--ticks", type=count, default=2000, help="ticks of each")
    audit = _add(
        commands,
        "audit",
        "compares what Pinocchio and MuJoCo make of a model",
        lambda a: audit_model(a.model),
    )
    audit.add_argument("model", metavar="MODEL", help="an MJCF or URDF file")
    return parser


RESOLVERS = "hqp, hqp:BACKEND, nullspace, nullspace:tsid, nullspace:uf or weighted"


def _add(commands, name, about, action, end=None):  # type: ignore[no-untyped-def] # private class
    command = commands.add_parser(name, help=about, description=about, epilog=end)
    command.set_defaults(action=action)
    return command


def _common(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--duration",
        type=seconds,
        metavar="S",
        help="longest simulated time of each job of a cell [s]",
    )
    command.add_argument("--seed", type=seed, default=0, help="of everything random")
    command.add_argument(
        "--mismatch",
        action="store_true",
        help="simulate a robot that differs from the controller's model (cells only)",
    )
    command.add_argument(
        "--combined",
        action="store_true",
        help="both arms under one hierarchy (cutting only)",
    )
    command.add_argument("--out", metavar="DIR", help="write metrics, log and report")
    command.add_argument("--quiet", action="store_true", help="no progress bar")


def _options(asked: argparse.Namespace) -> Options:
    return Options(
        resolver=getattr(asked, "resolver", "hqp"),
        duration=asked.duration,
        seed=asked.seed,
        mismatch=asked.mismatch,
        view=getattr(asked, "view", False),
        video=getattr(asked, "video", None),
        experiment=getattr(asked, "experiment", ""),
        combined=asked.combined,
        quiet=asked.quiet,
    )


def seconds(text: str) -> float:
    """A positive time, for the argument parser."""
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"must be a positive number, got {text}")
    return value


def seed(text: str) -> int:
    """A seed, for the argument parser."""
    value = int(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"must not be negative, got {text}")
    return value


def count(text: str) -> int:
    """A positive number, for the argument parser."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, got {text}")
    return value


if __name__ == "__main__":
    sys.exit(main())
