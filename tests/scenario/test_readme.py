"""The README's code runs as it stands, and its commands are the real ones."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL)
COMMANDS = re.findall(r"^wbc (\w+)", TEXT, flags=re.MULTILINE)


@pytest.mark.parametrize("block", BLOCKS, ids=range(1, len(BLOCKS) + 1))
def test_code_block_runs(block, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {"__name__": "readme"})
    assert capsys.readouterr().out or "print" not in block


def test_every_command_of_the_command_line_is_documented(capsys):
    from sims.cli import main

    with pytest.raises(SystemExit):
        main(["--help"])
    listed = re.findall(r"^    (\w+)  ", capsys.readouterr().out, flags=re.MULTILINE)
    assert sorted(listed) == sorted(set(COMMANDS))


def test_set_up_takes_one_line_each_and_ci_runs_the_one_for_the_tests():
    lines = re.findall(r"^python3 -m venv .*", TEXT, flags=re.MULTILINE)
    assert len(lines) == 2
    assert "wbc run cutting" in lines[0]
    assert "pytest" in lines[1]
    assert "README.md" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
