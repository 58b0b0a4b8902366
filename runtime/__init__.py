"""The body and the loop: drivers, the cell, the command line."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from runtime.cell import Cell
    from runtime.run import RunOptions, RunResult, run_task
    from runtime.workplace import connect

__all__ = ["Cell", "RunOptions", "RunResult", "connect", "run_task"]

_HOMES = {
    "Cell": "runtime.cell",
    "RunOptions": "runtime.run",
    "RunResult": "runtime.run",
    "connect": "runtime.workplace",
    "run_task": "runtime.run",
}


def __getattr__(name: str) -> object:
    """Import a public name when it is first used: MuJoCo and scipy cost more than `check` takes."""
    if name not in _HOMES:
        message = f"module 'runtime' has no attribute {name!r}"
        raise AttributeError(message)
    from importlib import import_module  # noqa: PLC0415 - as above

    return getattr(import_module(_HOMES[name]), name)
