"""How far a training is, on standard error."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from aapa.neural.training.state import Point
    from aapa.neural.training.state import Progress as TrainingProgress
    from aapa.neural.training.trainer import Trainer


class TrainingBar:
    """Shows updates, loss and time, and a line an epoch; the bar is silent off a terminal.

    Args:
        console: Where to draw, usually standard error.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.completed:.0f}/{task.total:.0f}"),
            TimeElapsedColumn(),
            TimeRemainingColumn(),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task("videos read", total=1)
        self._epoch_updates = 0

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._bar.stop()

    def prepared(self, done: int, total: int) -> None:
        """Draw how many videos have been read."""
        self._bar.update(self._task, description="videos read", completed=done, total=total)

    def began(self, trainer: Trainer) -> None:
        """Begin to draw updates."""
        choice = trainer.training.hyperparameters
        self._epoch_updates = trainer.updates // choice.epochs
        self._bar.update(self._task, description="updates", completed=0, total=trainer.updates)

    def updated(self, progress: TrainingProgress) -> None:
        """Draw one update more, and the epoch's loss so far."""
        self._bar.update(
            self._task,
            description=f"epoch {progress.epoch}, loss {progress.losses / progress.batch:.4f}",
            completed=progress.epoch * self._epoch_updates + progress.batch,
        )

    def scored(self, point: Point) -> None:
        """Print an epoch's line above the bar."""
        scores = ", ".join(f"{kind} {numbers[0]:.2f}" for kind, numbers in point.scores.items())
        self._console.print(
            f"epoch {point.epoch}: loss {point.loss:.5f}, dev mIoU {scores} %",
            highlight=False,
            soft_wrap=True,
        )
