from __future__ import annotations

import re
from collections.abc import Callable
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest

from sims.course import Course
from sims.report.figures import lines3d, time_series, xy
from sims.report.panels import Panel, side_by_side
from sims.report.runs import run_figure
from sims.report.thinning import columns, thin_curve, thin_series
from wbc.errors import InputError

TIMES = np.arange(60_000) / 1000.0
NOISE = np.random.default_rng(0).standard_normal((7, TIMES.size))


def many_series() -> str:
    curves = {f"joint {i}": NOISE[i] for i in range(7)}
    spans = [("approach", 0.0, 5.0), ("weld", 5.0, 50.0)]
    return time_series("Torque", TIMES, curves, "torque [N m]", {"limit": 6.0}, spans)


def many_panels() -> str:
    ways = {way: (TIMES, {"a": NOISE[i], "b": NOISE[2]}) for i, way in enumerate("xy")}
    return side_by_side("Panels", [Panel("force [N]", ways), Panel("way [mm]", ways)])


def many_lanes() -> str:
    lanes = {(2, "goal"): abs(NOISE[0, ::10]), (1, "limits"): 0.0 * TIMES[::10]}
    active = {f"level 1: limits: joint{i}": NOISE[i] > 2.0 for i in range(6)}
    course = Course(
        t=TIMES,
        torque=abs(NOISE[0]),
        speed=abs(NOISE[1]),
        errors={"goal [m]": abs(NOISE[2])},
        active=active,
        sampled=TIMES[::10],
        shortfall=lanes,
    )
    return run_figure("Lanes", {"hqp": course, "nullspace": course})


def plane_curves() -> str:
    curves = {"planned": (TIMES, TIMES), "measured": (TIMES, NOISE[0])}
    return xy("Path", curves, "x [m]", "y [m]")


def space_curves() -> str:
    return lines3d("Path", {"planned": NOISE[:3].T, "measured": NOISE[3:6].T})


FIGURES = [many_series, many_panels, many_lanes, plane_curves, space_curves]


@pytest.mark.parametrize("draw", FIGURES)
def test_a_figure_of_a_long_run_is_small(draw: Callable[[], str]):
    assert len(draw().encode()) < 150_000


@pytest.mark.parametrize("draw", FIGURES)
def test_a_figure_is_one_element_without_date_size_or_foreign_names(draw):
    svg = draw()
    root = ElementTree.fromstring(svg)
    assert root.tag.endswith("svg")
    assert "width" not in root.attrib
    assert root.attrib["aria-label"] in ("Torque", "Panels", "Lanes", "Path")
    assert "<metadata" not in svg
    assert "<style" not in svg
    identities = re.findall(r' id="([^"]+)"', svg)
    assert len(identities) == len(set(identities))
    assert set(re.findall(r"url\(#([^)]+)\)", svg)) <= set(identities)


@pytest.mark.parametrize("draw", FIGURES)
def test_the_same_data_give_the_same_bytes(draw):
    assert draw() == draw()


def test_two_figures_in_a_page_share_no_identity():
    names = [set(re.findall(r' id="([^"]+)"', draw())) for draw in FIGURES]
    assert len(set.union(*names)) == sum(len(each) for each in names)


def test_drawing_leaves_the_global_style_alone():
    before = dict(mpl.rcParams)
    many_series()
    assert dict(mpl.rcParams) == before


def test_labels_units_limits_and_phases_are_written():
    svg = many_series()
    for text in ("torque [N m]", "time [s]", "limit", "approach", "weld", "joint 6"):
        assert f">{text}</text>" in svg


def test_labels_are_escaped():
    curves = {"a <b> & c": NOISE[0], "d": NOISE[1]}
    svg = time_series("<script>", TIMES, curves, "y [m]")
    assert "<script" not in svg
    assert "a &lt;b&gt; &amp; c" in svg


def test_a_limit_far_away_is_named_instead_of_squeezing_the_curves():
    svg = time_series("t", [0, 1], {"y": [0.0, 1.0]}, "y [m]", {"limit": 40.0})
    assert "limit: 40 (off scale)" in svg
    nameless = time_series("t", [0, 1], {"y": [0.0, 1.0]}, "y [m]", [40.0])
    assert "bound: 40 (off scale)" in nameless


def test_gaps_and_empty_records_are_drawn_without_complaint():
    gap = np.where(np.arange(10_000) % 100 < 50, np.nan, 1.0)
    assert time_series("t", TIMES[:10_000], {"y": gap}, "y [m]")
    assert time_series("t", [], {"y": []}, "y [m]")
    assert time_series("t", [0.0, 1.0], {"y": [np.nan, np.nan]}, "y [m]", [1.0])


def test_shapes_that_do_not_fit_are_refused():
    with pytest.raises(InputError, match="'y' has shape"):
        time_series("t", [0, 1], {"y": [0, 1, 2]}, "y [m]")
    with pytest.raises(InputError, match="same ways"):
        side_by_side("t", [Panel("y", {"a": ([0], {})}), Panel("y", {"b": ([0], {})})])
    with pytest.raises(InputError, match=r"\(N, 3\)"):
        lines3d("t", {"a": np.zeros((4, 2))})


def test_thinning_a_series_keeps_its_peaks_ends_and_gaps():
    values = np.sin(TIMES)
    values[12_345], values[23_456], values[34_567] = 9.0, -9.0, np.nan
    kept = thin_series(values, 500)
    assert len(kept) <= 500
    assert {0, 12_345, 23_456, 34_567, TIMES.size - 1} <= set(kept.tolist())
    assert (np.diff(kept) > 0).all()


def test_thinning_a_curve_keeps_its_spike_and_ends():
    points = np.column_stack([TIMES, np.zeros_like(TIMES)])
    points[12_345, 1] = 1.0
    kept = thin_curve(points, 100)
    assert len(kept) <= 101
    assert {0, 12_345, TIMES.size - 1} <= set(kept.tolist())


def test_a_column_shows_the_one_active_sample_of_its_interval():
    table = np.zeros((1, TIMES.size))
    table[0, 31_234] = -2.0
    strip = columns(TIMES, table, 600)
    assert strip.shape == (1, 600)
    assert np.flatnonzero(strip[0]).tolist() == [312]
    assert strip.min() == -2.0


def test_columns_without_a_sample_repeat_the_one_before():
    times = np.array([0.0, 0.1, 0.2, 1.0])
    strip = columns(times, np.array([[1.0, 2.0, 3.0, 4.0]]), 600)
    assert strip.tolist() == [[3.0, 3.0, 3.0, 4.0]]
