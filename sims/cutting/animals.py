"""`python -m sims.cutting.animals`: many animals, one after the other.

Every seed is another shape, stiffness, link strength and fibre offset; all have to be
separated without anybody's help.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from sims.cutting.meat import Meat
from sims.cutting.metrics import metrics
from sims.cutting.scene import PLACE
from sims.cutting.trial import Trial
from sims.metrics import format_value

__all__ = ["main"]

SHOWN = (
    "links_cut_fraction",
    "passages",
    "muscle_cut_length_m",
    "guide_error_rms_m",
    "pull_force_mean_n",
    "pull_force_std_n",
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Cut them all; 0 if all bounds hold for all."""
    parser = argparse.ArgumentParser(prog="python -m sims.cutting.animals")
    parser.add_argument("--count", type=int, default=20, help="how many animals")
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--resolver", default="hqp", help="as for wbc run")
    asked = parser.parse_args(arguments)
    print("seed  " + "  ".join(SHOWN))
    failed = 0
    for seed in range(asked.first, asked.first + asked.count):
        meat = Meat.generate(seed, place=PLACE)
        trial = Trial(meat, resolver=asked.resolver)
        run = trial.run()
        found = metrics(run, trial.experiment, len(trial.plan.depths))
        wrong = [metric.name for metric in found if not metric.holds]
        failed += bool(wrong)
        values = {metric.name: format_value(metric.value) for metric in found}
        cells = [f"{values[name]:>{len(name)}}" for name in SHOWN]
        print(f"{seed:<4}  {'  '.join(cells)}  {', '.join(wrong)}", flush=True)
        if run.job.stopped is not None:
            print(f"      {run.job.stopped}", flush=True)
    print(f"{asked.count - failed} of {asked.count} animals within all bounds")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
