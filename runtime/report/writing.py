"""A report on disk: the page and the story."""

from __future__ import annotations

from pathlib import Path

from icarus_lite.trace import Recording
from runtime.errors import UsageError
from runtime.report.contents import contents
from runtime.report.page import page


def write_report(recording: Recording, folder: Path) -> tuple[Path, Path]:
    """Write `index.html` and `story.txt`.

    Args:
        recording: The run.
        folder: Where to; it is made if it is missing. Files of these names are replaced.

    Returns:
        The two files.

    Raises:
        TraceError: a line of the trace cannot be read.
        UsageError: the folder cannot be written.
    """
    gathered = contents(recording)
    story = gathered["story"]
    text = "\n".join(map(str, story if isinstance(story, list) else ())) + "\n"
    page_file, story_file = folder / "index.html", folder / "story.txt"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        page_file.write_text(page(gathered), encoding="utf-8")
        story_file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{folder}: cannot be written: {error.strerror}") from error
    return page_file, story_file
