"""Trains the correction of `aapa-refined` on generated videos, and says what it gains on others.

    python benchmarks/train_refined.py [--videos 2000] [--dev-videos 300] [--epochs 14]
        [--cache build/refined] [--out aapa/lacater/models/refined/weights.npz]

Needs PyTorch: pip install 'icarus-lite[neural]'. Videos of seed 40000 are learned from, videos of
seed 50000 tell when to stop; neither seed is evaluated on anywhere. Each video is seen twice: with
perfect perception, and with the detector, whose noise is the usual one in half of the videos and
drawn anew in the others, so that the correction does not rely on one kind of noise.
"""

from __future__ import annotations

import argparse
import json
import random
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from aapa.lacater.generator import DetectorNoise
from aapa.lacater.generator.video import generate_video
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS, first_sighting, score_video, table_row
from aapa.lacater.models.plus import BeyondAapa, Ideas
from aapa.lacater.models.refined.evidence import WIDTH_OF_EVIDENCE, Evidence
from aapa.lacater.models.refined.recurrent import Weights, write_weights
from aapa.lacater.models.refined.tracker import MOST_PX, corrected
from aapa.lacater.video import FRAMES, FrameMasks
from icarus_lite import load_domain
from runtime.cater.attachments import AttachmentEngine, timed_actions
from runtime.cater.evaluate import cater_domain
from runtime.cater.evaluation import cast_of, frames_of

TRAIN_SEED, DEV_SEED = 40_000, 50_000
HIDDEN = 64
BATCH = 32
RATE = 3e-3
KINDS = (PerceptionKind.PP, PerceptionKind.OD)
LABELS = ("visible", "occluded", "contained", "carried")
WEIGHT = (1.0, 4.0, 1.5, 4.0)
"""What a frame of each label counts for; the rare ones would hardly be noticed otherwise."""

Array = NDArray[np.float32]


def gathered(seed: int, videos: int, *, varied: bool, cache: Path) -> dict[str, NDArray]:
    """Give what is known and what is true of every frame, two sequences a video.

    Args:
        seed: Of the generator.
        videos: How many.
        varied: Draw the detector's noise anew in every other video.
        cache: Where it is kept.
    """
    path = cache / f"{seed}-{videos}.npz"
    if path.is_file():
        with np.load(path) as file:
            return {name: file[name] for name in file.files}
    engine = AttachmentEngine(load_domain(cater_domain()))
    rows = []
    for number in range(videos):
        noise = _noise(number) if varied and number % 2 else DetectorNoise()
        made = generate_video(seed, number, noise)
        scene = made.video.scene
        reports = engine.reports(timed_actions(scene), FRAMES)
        for kind in KINDS:
            perception = made.perceptions[kind]
            start = first_sighting(perception)
            if start is None:
                continue
            tracker, evidence = BeyondAapa(Ideas(), cast_of(scene)), Evidence()
            known = np.zeros((FRAMES, WIDTH_OF_EVIDENCE), dtype=np.float32)
            boxes = np.zeros((FRAMES, 4), dtype=np.float32)
            for frame in frames_of(perception, reports):
                tracker.observe(frame)
                insight = tracker.insight
                if insight.box is not None:
                    known[frame.number] = evidence.numbers(insight, frame.number)
                    boxes[frame.number] = insight.box
            masks = made.video.masks
            label = np.select([getattr(masks, name) for name in LABELS], range(4), -1)
            label[:start] = -1
            rows.append((known, boxes, made.video.labels.snitch, label, KINDS.index(kind), start))
        if number % 100 == 99:
            print(f"seed {seed}: {number + 1} of {videos} videos", flush=True)
    names = ("known", "boxes", "true", "label", "kind", "start")
    columns = zip(*rows, strict=True)
    arrays = {name: np.array(column) for name, column in zip(names, columns, strict=True)}
    cache.mkdir(parents=True, exist_ok=True)
    np.savez(path, **arrays)
    return arrays


def _noise(number: int) -> DetectorNoise:
    chance = random.Random(f"noise {number}")  # noqa: S311 - an experiment, no secret
    return replace(
        DetectorNoise(),
        jitter_px=chance.uniform(0.3, 1.0),
        lasting=chance.uniform(0.1, 0.9),
        hidden_jitter=chance.uniform(0.0, 2.0),
        miss_rate=chance.uniform(0.0, 0.04),
        half_seen=chance.uniform(0.15, 0.5),
        false_snitches=chance.uniform(0.0, 0.001),
    )


class Correction(torch.nn.Module):
    """The network of `aapa.lacater.models.refined.recurrent`, to be trained."""

    def __init__(self) -> None:
        super().__init__()
        self.gru = torch.nn.GRU(WIDTH_OF_EVIDENCE, HIDDEN, batch_first=True)
        self.out = torch.nn.Linear(HIDDEN + WIDTH_OF_EVIDENCE, 4)
        # At first it changes nothing.
        torch.nn.init.zeros_(self.out.weight)
        torch.nn.init.zeros_(self.out.bias)

    def forward(self, known: torch.Tensor) -> torch.Tensor:
        """Give (videos, frames, 4) px by which the edges are off."""
        hidden, _ = self.gru(known)
        return self.out(torch.cat([hidden, known], dim=2)).clamp(-MOST_PX, MOST_PX)

    def weights(self) -> Weights:
        """Give what was learned."""
        parts = (
            self.gru.weight_ih_l0,
            self.gru.bias_ih_l0,
            self.gru.weight_hh_l0,
            self.gru.bias_hh_l0,
            self.out.weight,
            self.out.bias,
        )
        return Weights(*(part.detach().numpy().astype(np.float64) for part in parts))


def loss_of(boxes: torch.Tensor, true: torch.Tensor, counts: torch.Tensor) -> torch.Tensor:
    """Give one minus the intersection over union, and a little for the distance of the edges."""
    low = torch.maximum(boxes[..., :2], true[..., :2])
    high = torch.minimum(boxes[..., 2:], true[..., 2:])
    shared = (high - low + 1).clamp(min=0).prod(-1)
    first = (boxes[..., 2:] - boxes[..., :2] + 1).clamp(min=1).prod(-1)
    second = (true[..., 2:] - true[..., :2] + 1).prod(-1)
    overlap = shared / (first + second - shared)
    edges = torch.nn.functional.smooth_l1_loss(boxes, true, reduction="none").mean(-1)
    return ((1 - overlap + 0.02 * edges) * counts).sum() / counts.sum()


def rows_of(data: dict[str, NDArray], offs: Array | None) -> dict[str, dict[str, list[float]]]:
    """Give mIoU in % and mL2 in px by kind of perception, in the order of the tasks."""
    found = {}
    for index, kind in enumerate(KINDS):
        scores = []
        for video in np.flatnonzero(data["kind"] == index):
            boxes = data["boxes"][video].astype(np.float64)
            moves = np.zeros((FRAMES, 4)) if offs is None else offs[video].astype(np.float64)
            answers = np.array(
                [
                    corrected(tuple(box), move)
                    for box, move in zip(boxes.tolist(), moves.tolist(), strict=True)
                ],
                dtype=np.float64,
            )
            label, true = data["label"][video], data["true"][video].astype(np.float64)
            visible, _, contained, carried = (label == number for number in range(4))
            masks = FrameMasks(contained | carried, contained, carried, visible, visible, visible)
            scores.append(score_video(answers, true, masks, int(data["start"][video])))
        miou, ml2 = table_row(scores)
        found[kind.name] = {
            "miou": [round(miou[task].mean, 3) for task in TASKS],
            "ml2": [round(ml2[task].mean, 3) for task in TASKS],
        }
    return found


def counted(label: NDArray[np.int64]) -> Array:
    """Give what each frame counts for."""
    return np.select([label == n for n in range(4)], WEIGHT, 0.0).astype(np.float32)


def main() -> int:
    """Train, and write the weights that do best on the dev videos."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--videos", type=int, default=2000)
    parser.add_argument("--dev-videos", type=int, default=300)
    parser.add_argument("--epochs", type=int, default=14)
    parser.add_argument("--cache", type=Path, default=Path("build/refined"))
    parser.add_argument("--out", type=Path, default=Path("aapa/lacater/models/refined/weights.npz"))
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    torch.manual_seed(1)
    train = gathered(TRAIN_SEED, arguments.videos, varied=True, cache=arguments.cache)
    dev = gathered(DEV_SEED, arguments.dev_videos, varied=False, cache=arguments.cache)
    before = rows_of(dev, None)
    print("aapa-plus", json.dumps(before), flush=True)
    known, boxes = torch.from_numpy(train["known"]), torch.from_numpy(train["boxes"])
    true = torch.from_numpy(train["true"].astype(np.float32))
    counts = torch.from_numpy(counted(train["label"]))
    dev_known = torch.from_numpy(dev["known"])
    network = Correction()
    optimiser = torch.optim.Adam(network.parameters(), lr=RATE)
    steps = arguments.epochs * -(-len(known) // BATCH)
    # From full speed down to nothing at the end.
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, steps)
    begun, best = time.process_time(), -1.0
    curve = []
    for epoch in range(1, arguments.epochs + 1):
        order, total = torch.randperm(len(known)), 0.0
        for chosen in order.split(BATCH):
            optimiser.zero_grad()
            offs = network(known[chosen])
            loss = loss_of(boxes[chosen] + offs, true[chosen], counts[chosen])
            loss.backward()
            torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
            optimiser.step()
            schedule.step()
            total += float(loss.detach()) * len(chosen)
        with torch.no_grad():
            offs = torch.cat([network(part) for part in dev_known.split(100)]).numpy()
        rows = rows_of(dev, offs)
        score = sum(sum(rows[kind.name]["miou"]) for kind in KINDS)
        note = {
            "epoch": epoch,
            "s": round(time.process_time() - begun),
            "loss": round(total / len(known), 5),
        } | rows
        curve.append(note)
        print(json.dumps(note), flush=True)
        if score > best:
            best = score
            write_weights(arguments.out, network.weights())
    recipe = {
        "train": {"seed": TRAIN_SEED, "videos": arguments.videos},
        "dev": {"seed": DEV_SEED, "videos": arguments.dev_videos},
        "hidden": HIDDEN, "batch": BATCH, "rate": RATE,
        "frame_weights": dict(zip(LABELS, WEIGHT, strict=True)),
        "processor_minutes": round((time.process_time() - begun) / 60, 1),
        "aapa-plus": before, "curve": curve,
    }  # fmt: skip
    arguments.out.with_suffix(".json").write_text(json.dumps(recipe, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
