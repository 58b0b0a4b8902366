"""The paper's six tasks, through every fault a cell can have: see `--help`, and `gearbox/`."""

from __future__ import annotations

# Each process that is started from here imports this module again: all else is imported below.
if __name__ == "__main__":
    from gearbox.command import main

    raise SystemExit(main())
