"""From the scanned surface of a piece of meat to its sheets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np

from sims.cutting.meat.animal import GRID
from sims.cutting.meat.sheets import THINNEST, Sheets
from sims.cutting.meat.surface import Surface
from wbc import InputError
from wbc.arrays import Array, BoolArray

__all__ = ["Seam", "sheets_of"]

Seam: TypeAlias = Callable[[Array, Array], Array]
"""y = s(x, z) of the cutting surface, all (k,) [m], in the coordinates of the file."""

FINE: Final = 41
"""Heights at which a section is searched for the seam."""
INSET: Final = 0.02
"""Share of the length that is left out at either end, where the meat is thin."""
LONG: Final = 0.8
HIGH: Final = 0.6
BULK: Final = 0.7
"""Least shares of length, height of a section, and volume that the seam divides."""
SIZES: Final = (0.02, 1.0)
"""Smallest and largest extent of a piece of meat [m]."""


def sheets_of(surface: Surface, seam: Seam) -> Sheets:
    """Divide a piece of meat by a surface y = s(x, z), x along it, z upwards.

    Every line along y counts from where it first enters the meat to where it last
    leaves it; hollows between are filled. What lies beyond the ends of the seam, above
    and below it, is left out.

    Raises:
        InputError: a size that is no piece of meat's, or a cutting surface that is
            outside the meat, wholly or for too large a part.
    """
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    extent = high - low
    if extent.min() < SIZES[0] or extent.max() > SIZES[1]:
        raise InputError(
            f"the mesh measures {extent[0]:.3g} x {extent[1]:.3g} x {extent[2]:.3g} m; "
            f"a piece of meat {SIZES[0]} to {SIZES[1]} m. Is the file in millimetres? "
            "Then give scale=0.001."
        )
    inset = INSET * extent[0]
    fine = np.linspace(low[2], high[2], FINE)
    xs = np.linspace(low[0] + inset, high[0] - inset, FINE)
    runs = [_run(surface, seam, x, fine) for x in xs]
    first, last = _longest(np.array([run is not None for run in runs]))
    if last - first < LONG * (FINE - 1):
        raise InputError(
            "the cutting surface is outside the meat: "
            + (
                f"it divides it only from x = {xs[first]:.3f} to {xs[last - 1]:.3f} m "
                if last > first
                else "it divides it nowhere "
            )
            + f"of {low[0]:.3f} to {high[0]:.3f} m, with the lower part of the height "
            f"at most {1 - HIGH:.0%} missing. Move or bend it."
        )
    sheets = _sample(surface, seam, xs[first:last], runs[first:last])
    held, pulled = sheets.muscles()
    share = (held.volume + pulled.volume) / surface.volume
    if share < BULK:
        raise InputError(
            f"the cutting surface divides only {share:.0%} of the meat: turn the mesh "
            "so that x runs along the seam, y across it and z upwards."
        )
    return sheets


def _run(
    surface: Surface, seam: Seam, x: float, z: Array
) -> tuple[float, float] | None:
    """Lowest and highest z where the seam divides the section at x, None if hardly."""
    near, far = _cast(surface.corners, np.full(z.size, x), z)
    y = _values(seam, np.full(z.size, x), z)
    meat = np.isfinite(near)
    # the margin keeps sheets, which are sampled anew, from grazing the skin
    divided = meat & (y > near + 2 * THINNEST) & (y < far - 2 * THINNEST)
    first, last = _longest(divided)
    if last - first < max(HIGH * meat.sum(), 2):
        return None
    return float(z[first]), float(z[last - 1])


def _sample(
    surface: Surface, seam: Seam, xs: Array, runs: list[tuple[float, float] | None]
) -> Sheets:
    low, high = np.array([run for run in runs if run is not None]).T
    x = np.linspace(xs[0], xs[-1], GRID[0])
    share = np.linspace(0.0, 1.0, GRID[1])
    bottom, top = np.interp(x, xs, low)[:, None], np.interp(x, xs, high)[:, None]
    z = bottom + share * (top - bottom)
    x = np.repeat(x[:, None], GRID[1], axis=1)
    near, far = _cast(surface.corners, x.ravel(), z.ravel())
    y = _values(seam, x.ravel(), z.ravel())
    fixed, middle, pulled = (
        np.stack([x, side.reshape(x.shape), z], axis=-1) for side in (near, y, far)
    )
    return Sheets(fixed, middle, pulled)


def _values(seam: Seam, x: Array, z: Array) -> Array:
    y = np.asarray(seam(x, z), dtype=np.float64)
    if y.shape not in ((), x.shape) or not np.isfinite(y).all():
        raise InputError(
            f"the cutting surface must give {x.shape} finite numbers for arrays x and "
            f"z of that shape; it gave {y.shape}."
        )
    return np.broadcast_to(y, x.shape)


def _cast(corners: Array, x: Array, z: Array) -> tuple[Array, Array]:
    """Least and greatest y (k,) of the surface on lines along y, NaN without any."""
    near, far = np.full(x.size, np.nan), np.full(x.size, np.nan)
    low, high = corners[:, :, 0].min(axis=1), corners[:, :, 0].max(axis=1)
    for column in np.unique(x):
        crossed = corners[(low <= column) & (high >= column)]
        for i in np.flatnonzero(x == column):
            ys = _hits(crossed, np.array([column, z[i]]))
            if ys.size:
                near[i], far[i] = ys.min(), ys.max()
    return near, far


def _hits(corners: Array, p: Array) -> Array:
    """Heights y of triangles (k, 3, 3) that contain the point (x, z) = p (2,)."""
    a = corners[:, 0, ::2]
    ab, ac, ap = corners[:, 1, ::2] - a, corners[:, 2, ::2] - a, p - a
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    upright = area == 0.0
    safe = np.where(upright, 1.0, area)
    u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / safe
    v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / safe
    hit = ~upright & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
    weights = np.stack([1.0 - u - v, u, v], axis=1)[hit]
    return np.asarray((weights * corners[hit, :, 1]).sum(axis=1))


def _longest(flags: BoolArray) -> tuple[int, int]:
    """First index and end of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    if not edges.size:
        return 0, 0
    starts, ends = edges[::2], edges[1::2]
    best = int((ends - starts).argmax())
    return int(starts[best]), int(ends[best])
