"""What a person may want to read of a training: its curve as a table, its recipe as JSON."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from aapa.errors import DatasetError
from aapa.neural.checkpoints import Meta
from aapa.neural.training.arrays import LABELS
from aapa.neural.training.state import Point, Scores


def write_curve(path: Path, curve: Sequence[Point]) -> None:
    """Write the curve, a line an epoch. Raises DatasetError where that cannot be done."""
    _write(path, curve_table(curve))


def write_recipe(path: Path, meta: Meta) -> None:
    """Write what a network's file says of it. Raises DatasetError where that cannot be done."""
    _write(path, json.dumps(asdict(meta), indent=1) + "\n")


def curve_table(curve: Sequence[Point]) -> str:
    """Give the curve as CSV; scores in %."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    kinds = next((list(point.scores) for point in curve if point.scores), [])
    nothing: Scores = (None,) * (1 + len(LABELS))
    columns = [f"{kind}_{task}" for kind in kinds for task in ("overall", *LABELS)]
    rows.writerow(["epoch", "updates", "loss", "rate", *columns, "cpu_s"])
    for point in curve:
        numbers = [
            "" if value is None else f"{value:.2f}"
            for kind in kinds
            for value in point.scores.get(kind, nothing)
        ]
        rows.writerow(
            [
                point.epoch,
                point.updates,
                f"{point.loss:.6f}",
                f"{point.rate:.3g}",
                *numbers,
                f"{point.seconds:.0f}",
            ]
        )
    return text.getvalue()


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise DatasetError(f"cannot be written: {error.strerror}", path=str(path)) from error
