"""MJCF text for Pinocchio: what its reader would change is mended or refused.

The reader (`reader`) looks at the text as MuJoCo understands it (`source`), refuses
what the controller's model could not contain (`traps`), writes the robot anew in words
that both engines read alike (`tree`), takes limits and gravity itself (`limits`), and
says what only a simulator will do (`notes`).
"""

from wbc.mjcf.reader import Mjcf, read_mjcf

__all__ = ["Mjcf", "read_mjcf"]
