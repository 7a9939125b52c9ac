"""Seeing a run: what its tasks want and miss, in a live window and in a video."""

from __future__ import annotations

from sims.view.display import Display, WindowClosed, nearer
from sims.view.geometry import geometry_of
from sims.view.jogger import Jogger
from sims.view.marks import Connector, Mark, Solid
from sims.view.video import NoVideo, check_video

__all__ = [
    "Connector",
    "Display",
    "Jogger",
    "Mark",
    "NoVideo",
    "Solid",
    "WindowClosed",
    "check_video",
    "geometry_of",
    "nearer",
]
