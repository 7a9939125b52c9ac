from __future__ import annotations

import json
import math

import pytest

from sims.metrics import Metric, format_value, table, to_json, verdict
from wbc.errors import InputError, UnknownName, WbcError


@pytest.mark.parametrize(
    ("value", "sense", "holds"),
    [
        (1.0, "<=", True),
        (1.5, "<=", False),
        (1.0, ">=", True),
        (0.5, ">=", False),
        (1.0, "==", True),
        (1.0 + 1e-12, "==", False),
        (1.0, ">", False),
        (1.1, ">", True),
        (math.inf, "<=", False),
        (math.inf, ">", True),
    ],
)
def test_a_bound_is_read_as_value_sense_bound(value, sense, holds):
    assert Metric("error_m", value, 1.0, sense).holds is holds


def test_without_a_bound_a_metric_holds():
    assert Metric("ticks", 12.0).holds


@pytest.mark.parametrize("bound", [None, 1.0])
@pytest.mark.parametrize("sense", ["<=", ">=", "==", ">"])
def test_nan_never_holds(bound, sense):
    metric = Metric("error_m", math.nan, bound, sense)
    assert not metric.holds
    assert metric.mark == "not measured"


def test_a_nan_bound_an_empty_name_and_an_unknown_sense_are_refused():
    with pytest.raises(InputError, match="NaN"):
        Metric("error_m", 1.0, math.nan)
    with pytest.raises(InputError, match="name"):
        Metric("", 1.0)
    with pytest.raises(UnknownName, match="<=, >=, ==, >"):
        Metric("error_m", 1.0, 1.0, "<")


def test_values_show_four_digits_and_counts_in_full():
    shown = [format_value(x) for x in (1.23456e-5, 123456.0, 0.1 + 0.2, math.nan, -0.5)]
    assert shown == ["1.235e-05", "123456", "0.3", "-", "-0.5"]


def test_the_table_is_aligned_and_says_how_each_metric_ended():
    lines = table(
        [
            Metric("ticks", 5000.0),
            Metric("tilt_error_max_rad", 0.0123456, 0.01),
            Metric("realtime_factor", 3.5, 1.0, ">="),
            Metric("seam_error_m", math.nan, 1.0),
        ]
    ).splitlines()
    assert lines == [
        "ticks                  5000",
        "tilt_error_max_rad  0.01235  <= 0.01  FAIL",
        "realtime_factor         3.5  >= 1     ok",
        "seam_error_m              -  <= 1     not measured",
    ]


def test_json_is_flat_and_null_where_a_value_is_not_finite():
    text = to_json([Metric("a_m", 0.1), Metric("b_s", math.nan), Metric("c", math.inf)])
    assert json.loads(text) == {"a_m": 0.1, "b_s": None, "c": None}


def test_json_keeps_every_digit():
    value = 0.1 + 0.2
    assert json.loads(to_json([Metric("a_m", value)]))["a_m"] == value


@pytest.mark.parametrize("write", [table, to_json])
def test_names_that_occur_twice_are_refused(write):
    with pytest.raises(WbcError, match="more than once: a_m"):
        write([Metric("a_m", 1.0), Metric("b_m", 1.0), Metric("a_m", 2.0)])


def test_nothing_makes_an_empty_table_and_an_empty_object():
    assert table([]) == ""
    assert json.loads(to_json([])) == {}


def test_the_verdict_counts_bounds_and_unmeasured_values():
    good, bad = Metric("a", 1.0, 2.0), Metric("b", 3.0, 2.0)
    assert verdict([Metric("n", 1.0)]) == "no bounds to hold"
    assert verdict([good, Metric("n", 1.0)]) == "the one bound holds"
    assert verdict([good, good]) == "all 2 bounds hold"
    nothing = Metric("n", math.nan, 1.0)
    assert verdict([good, bad]) == "1 of 2 bounds fail"
    assert verdict([good, bad, nothing]) == "1 of 3 bounds fail, 1 not measured"
    assert verdict([good, nothing]) == "1 of 2 bounds not measured, the others hold"
