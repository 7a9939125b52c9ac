"""Whether something is touched, from the size of a measured force."""

from __future__ import annotations

from typing import final

from wbc.arrays import positive

__all__ = ["Contact"]

LOST = 0.05
"""Contact counts as lost once the force stayed low for so long [s]."""


@final
class Contact:
    """Begins at a threshold, and ends when the force stays below half of it.

    Args:
        threshold: of the force that counts as contact [N or Nm].

    Raises:
        InputError: the threshold is not greater than 0.
    """

    def __init__(self, threshold: float) -> None:
        self.threshold = positive(threshold, "threshold")
        self.reset()

    def reset(self) -> None:
        """Nothing is touched."""
        self.touching, self._low = False, 0.0

    def feel(self, force: float, dt: float) -> bool:
        """Take a force for dt [s]; whether contact began with it."""
        before = self.touching
        if force >= self.threshold:
            self.touching, self._low = True, 0.0
        elif force < 0.5 * self.threshold:
            self._low += dt
            self.touching = before and self._low < LOST
        return self.touching and not before
