"""`icarus cater generate`, `icarus cater show`."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.cater import DatasetFolder, cater
from runtime.errors import UsageError

if TYPE_CHECKING:
    from PIL.Image import Image

    from aapa.lacater import Perception, Video
    from aapa.lacater.camera import FloorCamera
    from aapa.lacater.generator.preview.annotation import Track


@cater.command(
    epilog="Example: icarus cater generate --videos 1000 --seed 1 --out data/generated",
)
def generate(
    *,
    videos: Annotated[int, typer.Option(min=1, max=1_000_000, help="How many there are to be.")],
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same videos.")],
    out: Annotated[Path, typer.Option(help="The folder; one begun before is gone on with.")],
    jobs: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Processes; all cores if left out.")
    ] = None,
    noise: Annotated[
        Path | None,
        typer.Option(help="YAML: what the detector is like, in the words of DetectorNoise."),
    ] = None,
) -> None:
    """Make up videos after CATER: labels, scenes, frame lists, noisy and perfect detections.

    There are no pictures: `icarus cater show` draws some. If it is interrupted, the same command
    goes on where it stopped. The files do not depend on how many processes work on them.
    """
    from rich.console import Console

    from aapa.lacater.generator import DetectorNoise, Recipe, generate_dataset, read_noise
    from runtime.cater.progress_bar import ProgressBar
    from runtime.cater.workers import usable_cores

    recipe = Recipe(seed, DetectorNoise() if noise is None else read_noise(noise))
    with ProgressBar(Console(stderr=True)) as bar:
        generate_dataset(out, recipe, videos, jobs or usable_cores(), bar.show)
    typer.echo(f"{videos} videos of seed {seed} are in {out}")


@cater.command(
    epilog="Example: icarus cater show data/generated 18 --model aapa-10000 --out video.gif",
)
def show(
    *,
    folder: DatasetFolder,
    video: Annotated[str, typer.Argument(help="A video's name, or its number.")],
    out: Annotated[Path | None, typer.Option(help="A .gif or .mp4; VIDEO.gif if left out.")] = None,
    model: Annotated[
        str | None, typer.Option(help="Draw where this model has the snitch, too.")
    ] = None,
    perception: Annotated[
        str, typer.Option(help="What the model sees; od: the detector's boxes; pp: perfect ones.")
    ] = "od",
    detections: Annotated[
        bool, typer.Option("--detections", help="Draw the detections, dashed.")
    ] = False,
    scale: Annotated[int, typer.Option(min=1, max=6, help="Pixels drawn for each px.")] = 2,
) -> None:
    """Draw a video from its scene file, with the labels, as a GIF or an MP4.

    Each box has the colour of its object's label; the snitch's is thick. The strip below is the
    snitch's label over the whole video.
    """
    try:
        import PIL  # noqa: F401 - asked for before anything is done
    except ImportError as error:
        raise UsageError(
            "`icarus cater show` needs Pillow: pip install 'icarus-lite[preview]'"
        ) from error
    from rich.console import Console

    from aapa.lacater import Dataset, PerceptionKind
    from aapa.lacater.generator.preview.annotation import Annotator
    from aapa.lacater.generator.preview.film import GIF_STEP, write_film
    from aapa.lacater.generator.preview.painting import Painter
    from aapa.lacater.generator.preview.reconstruction import reconstructed
    from runtime.cater.progress_bar import ProgressBar

    if perception not in tuple(PerceptionKind):
        raise UsageError(f"--perception is {perception!r}; it has to be od or pp")
    dataset = Dataset(folder)
    name = _named(video, dataset.videos)
    path = out or Path(f"{name}.gif")
    step = GIF_STEP if path.suffix.lower() == ".gif" else 1
    shown = dataset.video(name)
    if shown.scene is None:
        raise UsageError(f"{folder} has no scenes/, from which {name} could be drawn")
    seen = None
    if detections or model is not None:
        seen = dataset.perception(shown, PerceptionKind(perception))
    track = (
        None
        if model is None or seen is None
        else _track(model, shown, seen, dataset.camera(shown.scene))
    )
    annotator = Annotator(shown, scale, seen if detections else None, track)
    painter = Painter(reconstructed(shown.scene, shown.labels.frames), scale)
    frames = range(0, shown.labels.frames, step)

    def pictures() -> Iterator[Image]:
        for done, frame in enumerate(frames, start=1):
            yield annotator.annotate(painter.paint(frame), frame)
            bar.show(done, len(frames))

    with ProgressBar(Console(stderr=True)) as bar:
        write_film(path, pictures(), step)
    typer.echo(f"{path}: {name}, {len(frames)} pictures")


def _named(video: str, videos: Sequence[str]) -> str:
    """Give the video that is meant by a name or a number. Raises UsageError."""
    from aapa.lacater.generator import video_name

    name = video_name(int(video)) if video.isdecimal() and len(video) <= 6 else video
    if name in videos:
        return name
    near = difflib.get_close_matches(name, videos, n=1)
    hint = f"; did you mean {near[0]}?" if near else f"; the first is {videos[0]}"
    raise UsageError(f"there is no video {name}{hint}")


def _track(name: str, video: Video, seen: Perception, camera: FloorCamera | None) -> Track:
    """Run a model on a video. Raises AnchoringError where there is no such model."""
    import numpy as np

    from aapa.lacater.generator.preview.annotation import Track
    from aapa.lacater.metric import iou
    from aapa.lacater.models import model_named
    from icarus_lite import load_domain
    from runtime.cater.attachments import AttachmentEngine, timed_actions
    from runtime.cater.evaluate import cater_domain
    from runtime.cater.evaluation import cast_of, frames_of, run_model

    model = model_named(name)
    snitch = video.labels.snitch
    assert video.scene is not None
    assert snitch is not None
    engine = AttachmentEngine(load_domain(cater_domain()))
    reports = engine.reports(timed_actions(video.scene), seen.frames)
    boxes = run_model(model, frames_of(seen, reports, camera), cast_of(video.scene))
    known = np.isfinite(boxes).all(axis=1)
    agreement = np.zeros(len(boxes))
    agreement[known] = iou(boxes[known], snitch[known].astype(np.float64))
    return Track(model.name, boxes, agreement)
