"""What the packages say they export is there, and nothing of theirs is hidden."""

from __future__ import annotations

import importlib
import inspect
import subprocess
import sys
from importlib.metadata import (
    PackageNotFoundError,
    distribution,
    packages_distributions,
)

import pytest

PACKAGES = ("wbc", "tasks", "robots", "sims")


def exported() -> list[tuple[str, str]]:
    return [
        (package, name)
        for package in PACKAGES
        for name in getattr(importlib.import_module(package), "__all__", ())
    ]


@pytest.mark.parametrize(("package", "name"), exported())
def test_every_exported_name_can_be_imported(package, name):
    if not hasattr(importlib.import_module(package), name):
        importlib.import_module(f"{package}.{name}")  # a sub-package


@pytest.mark.parametrize("package", PACKAGES)
def test_no_name_is_exported_twice(package):
    names = list(getattr(importlib.import_module(package), "__all__", ()))
    assert len(names) == len(set(names))


@pytest.mark.parametrize("package", ["wbc", "tasks"])
def test_the_two_libraries_export_something(package):
    assert importlib.import_module(package).__all__


@pytest.mark.parametrize("package", ["wbc", "tasks"])
def test_every_public_name_of_a_library_is_in_its_list(package):
    module = importlib.import_module(package)
    public = {
        name
        for name, item in vars(module).items()
        if not name.startswith("_")
        and (inspect.isclass(item) or inspect.isfunction(item))
    }
    assert public == set(module.__all__)


@pytest.mark.parametrize(("package", "name"), exported())
def test_every_exported_class_and_function_is_documented(package, name):
    item = getattr(importlib.import_module(package), name, None)
    if inspect.isclass(item) or inspect.isfunction(item):
        assert item.__doc__
        assert item.__doc__.strip()


def installed() -> bool:
    try:
        distribution("wbc")
    except PackageNotFoundError:
        return False
    return True


@pytest.mark.skipif(not installed(), reason="run from a checkout, not an installation")
def test_one_distribution_provides_the_four_packages():
    provided = packages_distributions()
    assert {name: set(provided.get(name, ())) for name in PACKAGES} == {
        name: {"wbc"} for name in PACKAGES
    }


def test_modules_of_robots_are_there_without_an_import_of_their_own():
    code = (
        "import sys, robots; assert 'wbc' not in sys.modules; "
        "robots.compose.load; robots.lwr4.load; sys.exit(hasattr(robots, 'nothing'))"
    )
    done = subprocess.run([sys.executable, "-c", code], check=False)
    assert done.returncode == 0
