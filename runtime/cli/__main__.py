"""`python -m runtime.cli` is `icarus`."""

from runtime.cli import program

program()
