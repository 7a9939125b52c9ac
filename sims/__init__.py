"""Simulated cells: the run loop, sensors, logs, reports, and one package a cell."""

from sims.cell import ArmCell, Cell, Observation
from sims.log import Log
from sims.run import run

__all__ = ["ArmCell", "Cell", "Log", "Observation", "run"]
