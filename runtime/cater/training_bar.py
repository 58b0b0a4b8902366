"""How far a training is, on standard error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Console

from runtime.cater.progress_bar import ProgressBar

if TYPE_CHECKING:
    from aapa.neural.training.state import Point, Progress
    from aapa.neural.training.trainer import Trainer


class TrainingBar(ProgressBar):
    """Shows updates, loss and time, and a line an epoch; the bar is silent off a terminal.

    Args:
        console: Where to draw, usually standard error.
    """

    def __init__(self, console: Console) -> None:
        super().__init__(console)
        self._updates = self._epoch_updates = 0

    def prepared(self, done: int, total: int) -> None:
        """Draw how many videos have been read."""
        self.show(done, total, "videos read")

    def began(self, trainer: Trainer) -> None:
        """Begin to draw updates."""
        self._updates = trainer.updates
        self._epoch_updates = trainer.updates // trainer.training.hyperparameters.epochs
        self.show(0, self._updates, "updates")

    def updated(self, progress: Progress) -> None:
        """Draw one update more, and the epoch's loss so far."""
        self.show(
            progress.epoch * self._epoch_updates + progress.batch,
            self._updates,
            f"epoch {progress.epoch}, loss {progress.losses / progress.batch:.4f}",
        )

    def scored(self, point: Point) -> None:
        """Print an epoch's line above the bar."""
        scores = ", ".join(f"{kind} {numbers[0]:.2f}" for kind, numbers in point.scores.items())
        self.note(f"epoch {point.epoch}: loss {point.loss:.5f}, dev mIoU {scores} %")
