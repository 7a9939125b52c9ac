"""The cutting cell: short cuts, what goes wrong, and one whole animal."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from sims.cli import main
from sims.cutting.camera import Camera
from sims.cutting.demo import trial_of
from sims.cutting.layout import Plan
from sims.cutting.loop import run_job
from sims.cutting.meat import Meat, Toughness
from sims.cutting.metrics import guide_error, metrics
from sims.cutting.playback import GUIDE_WIDTH, interface_lines, replay
from sims.cutting.scene import PLACE
from sims.cutting.trial import Trial
from sims.demo import Options
from wbc import InputError, UnknownName

SHORT = Plan(depths=(0.33,), stroke=1.4, travel=0.4, lift=0.4, settling=0.9)
"""One passage of two rows of links, in about four seconds."""
STROKE = 1.8
"""When its stroke begins [s], at the latest."""


def short(**options) -> Trial:
    return Trial(plan=SHORT, **options)


@pytest.fixture(scope="module")
def usual():
    """One short cut under the defaults."""
    return short().run()


def still(run, begin: float, end: float) -> float:
    """How far the knife moved between two times [m]."""
    tip = run.record.tip[(run.record.t > begin) & (run.record.t < end)]
    return float(np.linalg.norm(np.ptp(tip, axis=0)))


# ----------------------------------------------------------------------- one passage


@pytest.mark.parametrize(
    "options",
    [{}, {"resolver": "nullspace"}, {"combined": True, "rocking": True}],
    ids=["two arms", "nullspace", "one hierarchy"],
)
def test_a_passage_cuts_its_rows_and_no_muscle(options, usual):
    run = short(**options).run() if options else usual
    found = {m.name: m for m in metrics(run, "local", 1)}
    for name in ("links_cut_fraction", "separated"):
        found.pop(name)  # one passage is not the whole animal
    assert [m for m in found.values() if not m.holds] == []
    assert run.cell.tissue.links_cut_fraction == pytest.approx(1 / 3, abs=0.02)
    assert all(log.failures == 0 for log in run.logs)
    tau = max(np.abs(log.torque / log.robot.tau_max).max() for log in run.logs)
    assert tau < 1.0


def test_the_three_updates_come_as_near_to_the_line_as_their_equations_say(usual):
    """Local on it, printed half-way, initial where the line was at the start."""
    error = {
        name: guide_error(short(experiment=name).run().record)
        for name in ("printed", "initial")
    }
    error["local"] = guide_error(usual.record)
    assert error["local"] < 1e-3
    assert error["local"] < error["printed"] < error["initial"]


def test_a_poor_camera_still_leads_the_knife():
    camera = Camera(rate=30.0, delay=0.03, noise=3e-4, dropped=0.2, seed=3)
    run = short(camera=camera).run()
    assert run.job.stopped is None
    assert guide_error(run.record) < 2e-3
    assert run.cell.tissue.muscle_cut_length == 0.0


def test_the_replay_has_meat_guide_line_and_both_forces_thirty_times_a_second(usual):
    page = replay(usual)
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', page, re.DOTALL)[1])
    assert len(scene["soft"]) == 2
    assert "guide line in the meat" in {trace["name"] for trace in scene["traces"]}
    assert {a["name"] for a in scene["arrows"]} == {"knife on meat", "puller on meat"}
    frames = scene["times"]["count"]
    assert (frames - 1) / usual.record.coarse_t[-1] >= 30.0 - 1e-6


def test_the_guide_line_of_the_replay_is_where_the_knife_is_measured_against(usual):
    """A row of links and a surface through all differ by less than it is thick."""
    lines, guide = interface_lines(usual), usual.record.guide
    seen = np.flatnonzero(np.isfinite(guide[:, 0]))
    drawn = [np.interp(guide[j, 0], lines[j, :, 0], lines[j, :, 1]) for j in seen]
    assert np.abs(drawn - guide[seen, 1]).max() < 0.5 * GUIDE_WIDTH


# -------------------------------------------------------------------- what goes wrong


def test_a_camera_that_goes_blind_stops_the_knife_until_it_sees_again():
    begin, end = STROKE + 0.4, STROKE + 1.4
    run = short(camera=Camera(blind=[(begin, end)])).run()
    assert still(run, begin + 0.6, end) < 1e-3
    assert still(run, begin, end) < 0.08
    assert run.job.stopped is None
    assert run.job.passages.completed == 1
    assert run.cell.tissue.links_cut_fraction == pytest.approx(1 / 3, abs=0.02)


def test_a_camera_that_never_sees_keeps_the_knife_above_the_meat():
    run = short(camera=Camera(blind=[(0.0, 100.0)])).run(2.5)
    assert run.record.tip[:, 2].min() > SHORT.height - 1e-3
    assert run.job.passages.completed == 0


def test_a_knife_that_is_stuck_stops_the_cut_and_nothing_flies_apart():
    tough = Toughness(seam=60_000.0, muscle=60_000.0)
    run = short(meat=Meat.generate(0, place=PLACE, toughness=tough)).run()
    assert "knife" in run.job.stopped or "cutting force" in run.job.stopped
    assert "at (0." in run.job.stopped
    after = run.record.t[-1]
    assert still(run, after - 0.2, after) < 2e-3
    arm = run.logs[0]
    assert (np.abs(arm.v[-1]) < 0.1 * arm.robot.v_max).all()
    assert run.job.pull.due < 1.0


def test_a_passage_below_the_table_is_refused():
    with pytest.raises(InputError, match=r"passage 2 at z = 0\.25 m is deeper"):
        Plan(depths=(0.29, 0.25))
    with pytest.raises(InputError, match="must descend"):
        Plan(depths=(0.29, 0.31))
    with pytest.raises(InputError, match="at least one passage"):
        Plan(depths=())


@pytest.mark.parametrize("place", [(0.80, 0.14), (0.20, 0.05)])
def test_meat_out_of_reach_is_refused_before_anything_moves(place):
    trial = short(meat=Meat.generate(0, place=place))
    with pytest.raises(
        InputError, match=r"out of reach: .* reaches 0\.\d+ to 0\.\d+ m"
    ):
        trial.prepare()


def test_an_unknown_experiment_is_bad_usage(capsys):
    with pytest.raises(UnknownName, match="Valid names: local, initial, printed"):
        trial_of(Options(experiment="global"))
    assert main(["run", "cutting", "--experiment", "globl"]) == 2
    assert main(["run", "welding", "--experiment", "local"]) == 2
    assert "experiment" in capsys.readouterr().err


def test_the_same_seed_gives_the_same_cut_and_another_one_another():
    def cut(seed: int) -> np.ndarray:
        trial = short(meat=Meat.generate(seed, place=PLACE))
        return run_job(*trial.prepare(), 0.3).record.qpos

    assert np.array_equal(cut(0), cut(0))
    assert not np.array_equal(cut(0), cut(1))


# ------------------------------------------------------------------- the whole animal


def test_a_whole_animal_is_separated_within_every_bound():
    run = Trial(Meat.generate(4, place=PLACE)).run()
    assert [m for m in metrics(run, "local", 5) if not m.holds] == []
    assert run.job.stopped is None


def test_compare_shows_the_experiments_side_by_side(capsys):
    assert main(["compare", "cutting", "--duration", "0.05", "--quiet"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["metric", "local", "initial", "printed", "bound"]
