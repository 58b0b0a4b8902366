"""Commands are imported when they are called, and none is missing."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import import_module

import pytest
import typer

from runtime.cli.app import app
from runtime.cli.on_demand import HOMES


def test_every_command_has_its_modules_in_the_table() -> None:
    for name, modules in HOMES.items():
        for module in modules:
            import_module(f"runtime.cli.{module}")
        assert name in typer.main.get_group(app).commands
    assert set(typer.main.get_group(app).commands) == set(HOMES)


@pytest.mark.parametrize(
    ("args", "unneeded"),
    [
        (["--version"], {"numpy", "lark", "pydantic", "rich", "runtime.cli.running"}),
        (["check", "--help"], {"numpy", "lark", "pydantic", "runtime.cli.running"}),
        (["check", "domains/hanoi.icr"], {"numpy", "pydantic", "aapa", "icarus_lite.planning"}),
        (["fmt", "--check", "domains/hanoi.icr"], {"numpy", "pydantic", "aapa"}),
        (["plan", "domains/blocks.icr", "--task", "sussman"], {"numpy", "pydantic", "aapa"}),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, list) else "",
)
def test_a_command_imports_nothing_slow_that_it_does_not_need(
    args: list[str], unneeded: set[str]
) -> None:
    code = (
        "import json, sys\n"
        f"sys.argv[1:] = {args!r}\n"
        "from runtime.cli import main\n"
        "try:\n"
        "    main()\n"
        "except SystemExit as ended:\n"
        f"    found = sorted({unneeded!r} & set(sys.modules))\n"
        "    print(json.dumps([ended.code, found]), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(done.stderr.splitlines()[-1]) == [0, []]


def test_help_lists_all_commands_in_the_order_of_the_table() -> None:
    command = [sys.executable, "-m", "runtime.cli", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    listed = done.stdout.partition("Commands:\n")[2].splitlines()
    assert [line.split()[0] for line in listed if line.strip()] == list(HOMES)


def test_a_name_that_is_nearly_right_is_recognised() -> None:
    command = [sys.executable, "-m", "runtime.cli", "chek"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Did you mean 'check'?" in done.stderr
