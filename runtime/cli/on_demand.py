"""Which module has which command; only that of the command that is called is imported."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from importlib import import_module
from typing import TYPE_CHECKING

import typer
from typer.core import TyperGroup

if TYPE_CHECKING:
    from typer._click import Command, Context

HOMES = {
    "check": ("checking",),
    "controller": ("controller",),
    "lsp": ("editing",),
    "explain-rule": ("explain",),
    "fmt": ("formatting",),
    "infer": ("inferring",),
    "why": ("inspecting",),
    "why-not": ("inspecting",),
    "when": ("inspecting",),
    "diff": ("inspecting",),
    "replay": ("inspecting",),
    "report": ("inspecting",),
    "view": ("inspecting",),
    "plan": ("planning",),
    "repl": ("repl",),
    "run": ("running",),
    "test": ("testing",),
    "track": ("tracking",),
    "cater": ("cater", "cater_generate", "cater_train"),
    "pddl": ("pddl",),
}
"""The modules of each command, in the order in which `icarus --help` lists the commands."""


class CommandsOnDemand(TyperGroup):
    """A group whose commands are imported when they are asked for."""

    def list_commands(self, ctx: Context) -> list[str]:
        """Give the names of all commands, in the order of `HOMES`."""
        self._import(name for names in HOMES.values() for name in names)
        places = {name: place for place, name in enumerate(HOMES)}
        return sorted(super().list_commands(ctx), key=lambda name: places.get(name, len(places)))

    def get_command(self, ctx: Context, cmd_name: str) -> Command | None:
        """Give a command; for a name that there is not, all are imported, to see what was meant."""
        known = HOMES.get(cmd_name)
        self._import(known or [name for names in HOMES.values() for name in names])
        return super().get_command(ctx, cmd_name)

    def _import(self, modules: Iterable[str]) -> None:
        from runtime.cli.app import app

        missing = [f"runtime.cli.{module}" for module in modules]
        missing = [module for module in missing if module not in sys.modules]
        for module in missing:
            import_module(module)
        if missing:
            self.commands = typer.main.get_group(app).commands
