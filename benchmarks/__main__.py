"""`python -m benchmarks`: one thread, whatever numpy is linked to."""

import os
import sys

from benchmarks.machine import SINGLE_THREAD

if __name__ == "__main__":
    os.environ.update(SINGLE_THREAD)  # before numpy is imported
    from benchmarks.cli import main

    sys.exit(main())
