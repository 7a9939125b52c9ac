"""`python -m sims.cutting`: the demo, with the options of `wbc run`."""

from __future__ import annotations

import sys

from sims.cli import main

if __name__ == "__main__":
    sys.exit(main(["run", "cutting", *sys.argv[1:]]))
