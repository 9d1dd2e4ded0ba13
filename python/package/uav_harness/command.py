"""The command `harness`, without a second program in the wheel."""

import os
import sys

from uav_harness import native


def main() -> None:
    """Executes the command line of this process, and ends it with the exit code of the command."""
    os.environ.setdefault("HARNESS_PROGRAM", sys.argv[0])
    sys.exit(native.command(sys.argv))
