"""The pages' code runs as it stands, prints what they say, and leaves nothing out."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

import tasks
from tests.blocks import commands_of, run_page, same
from wbc import Task

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs").glob("*.md"))


NEWCOMER = {"add_task": ["check.py", "compare.py"], "add_cell": ["compare_reach.py"]}
"""Pages to follow from an empty folder, and the programs that are started there."""
OTHERS = [page for page in PAGES if page.stem not in NEWCOMER]


@pytest.mark.parametrize("page", OTHERS, ids=[page.stem for page in OTHERS])
def test_the_page_runs_and_prints_what_it_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_page(page, tmp_path)


@pytest.mark.parametrize("stem", NEWCOMER)
def test_a_newcomer_with_the_page_and_nothing_else_sees_the_comparison(stem, tmp_path):
    """Files are saved and programs started as it says; they print what it says."""
    done = run_page(ROOT / "docs" / f"{stem}.md", tmp_path)
    assert done.started == NEWCOMER[stem]
    assert done.compared == len(done.started)


def test_commands_on_the_pages_are_accepted_by_the_command_line():
    from benchmarks.cli import _options
    from sims.cli import _parser

    seen = 0
    for page in PAGES:
        for words in commands_of(page):
            if words[0] == "wbc":
                _parser().parse_args(words[1:])
                seen += 1
            elif words[:3] == ["python", "-m", "benchmarks"]:
                _options(words[3:])
                seen += 1
    assert seen > 5


def test_every_task_has_a_picture_in_the_catalogue():
    text = "".join(
        (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
        for page in ("tasks", "geometry", "force")
    )
    drawn = re.findall(r"^```\{picture\} (\w+)$", text, flags=re.MULTILINE)
    named = {
        name
        for name in tasks.__all__
        if inspect.isclass(item := getattr(tasks, name)) and issubclass(item, Task)
    }
    assert len(drawn) == len(set(drawn))
    assert set(drawn) == named | {"rim_grasp"}


def test_every_page_is_in_the_table_of_contents():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    listed = re.findall(r"^(\w+)$", index, flags=re.MULTILINE)
    assert set(listed) == {page.stem for page in PAGES} - {"index"}


@pytest.mark.parametrize(
    ("told", "printed", "agrees"),
    [
        ("a 1.00 b", "a 1.01 b", True),
        ("a 1.00 b", "a 1.10 b", False),
        ("a ... d", "a b c d", True),
        ("a ... d", "a b c", False),
        ("a b", "a b c", False),
        ("... z", "a b", False),
        ("2.1e-16", "3.5e-12", True),
    ],
)
def test_outputs_are_compared_word_by_word(told, printed, agrees):
    assert same(told, printed) is agrees
