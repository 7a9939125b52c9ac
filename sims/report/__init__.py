"""Reports: figures, pictures, the 3-D replay, and the page that joins them."""

from sims.report.page import write_report
from sims.report.replay import Arrow, Marker, Replay, Trace
from sims.report.snapshot import Image, NoDisplay, render, write_png

__all__ = [
    "Arrow",
    "Image",
    "Marker",
    "NoDisplay",
    "Replay",
    "Trace",
    "render",
    "write_png",
    "write_report",
]
