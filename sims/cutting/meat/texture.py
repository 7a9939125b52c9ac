"""How meat looks: fibres, a little fat, and the pale skin of the seam."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from wbc.arrays import Array

__all__ = ["fibres"]

SIZE: Final = (256, 512)
"""Rows from the outer face to the seam, columns along the muscle, which repeat."""
LEAN: Final = np.array([[0.40, 0.05, 0.06], [0.66, 0.16, 0.15]])
FAT: Final = np.array([0.90, 0.74, 0.66])
SKIN: Final = np.array([0.86, 0.77, 0.76])
PALE: Final = 0.93
"""Share of the way to the seam from which on its skin shows."""


def fibres(seed: int) -> NDArray[np.uint8]:
    """An image (rows, columns, 3) of the outside of a muscle."""
    rng = np.random.default_rng(seed)
    strands = _noise(rng, (2.0, 14.0))
    image = LEAN[0] + np.clip(0.5 + 0.28 * strands, 0, 1)[..., None] * (
        LEAN[1] - LEAN[0]
    )
    streaks = np.clip(_noise(rng, (5.0, 18.0)) - 1.5, 0.0, 0.7)
    image += streaks[..., None] * (FAT - image)
    depth = (np.arange(SIZE[0])[:, None] + 0.5) / SIZE[0]
    ragged = depth + 0.02 * _noise(rng, (6.0, 10.0))
    skin = np.clip((ragged - PALE) / 0.03, 0.0, 0.85)
    image += skin[..., None] * (SKIN - image)
    return np.asarray(255 * np.clip(image, 0.0, 1.0), dtype=np.uint8)


def _noise(rng: np.random.Generator, smooth: tuple[float, float]) -> Array:
    """Smooth noise (rows, columns) of standard deviation 1, periodic along columns."""
    noise = gaussian_filter(rng.normal(size=SIZE), smooth, mode=("nearest", "wrap"))
    return np.asarray(noise / noise.std())
