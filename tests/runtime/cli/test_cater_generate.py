"""`icarus cater generate` and `icarus cater show` as a person calls them."""

from __future__ import annotations

import builtins
import io
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest
from PIL import Image

from runtime.cli import main


@dataclass(frozen=True)
class Done:
    """What a call left: its status and its two streams."""

    status: int
    out: str
    err: str


def icarus(*args: str | Path | int) -> Done:
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", "cater", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return Done(int(ended.value.code or 0), out.getvalue(), err.getvalue())


@pytest.fixture(scope="module")
def data(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("data") / "made"
    done = icarus("generate", "--videos", 2, "--seed", 3, "--out", folder, "--jobs", 1)
    assert (done.status, done.err) == (0, "")
    assert done.out == f"2 videos of seed 3 are in {folder}\n"
    return folder


@pytest.mark.parametrize("command", ["generate", "show"])
def test_help_has_an_example(command):
    done = icarus(command, "--help")
    assert done.status == 0
    assert f"Example: icarus cater {command}" in done.out


def test_generate_goes_on_with_more_videos(data):
    assert icarus("generate", "--videos", 3, "--seed", 3, "--out", data, "--jobs", 1).status == 0
    assert len(list((data / "labels").iterdir())) == 3


def test_generate_takes_other_noise(tmp_path):
    noise = tmp_path / "noise.yaml"
    noise.write_text("jitter_px: 0\n")
    out = tmp_path / "data"
    done = icarus("generate", "--videos", 1, "--seed", 3, "--out", out, "--noise", noise)
    assert done.status == 0
    assert '"jitter_px": 0' in (out / "generator.json").read_text()


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("--videos", 0, "--seed", 1, "--out", "x"), "--videos"),
        (("--videos", 1, "--seed", -1, "--out", "x"), "--seed"),
        (("--videos", 1, "--seed", "one", "--out", "x"), "--seed"),
        (("--videos", 1_000_001, "--seed", 1, "--out", "x"), "--videos"),
        (("--videos", 1, "--seed", 1, "--out", "x", "--jobs", 0), "--jobs"),
        (("--videos", 1, "--seed", 1), "--out"),
        (("--videos", 1, "--seed", 1, "--out", "x", "--noise", "none.yaml"), "none.yaml: cannot"),
    ],
)
def test_wrong_usage_of_generate_is_status_2(arguments, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = icarus("generate", *arguments)
    assert (done.status, done.out) == (2, "")
    assert text in done.err
    assert "Traceback" not in done.err
    assert not (tmp_path / "x").exists()


def test_generate_refuses_a_folder_of_another_seed(data):
    done = icarus("generate", "--videos", 2, "--seed", 4, "--out", data)
    assert done.status == 2
    assert "its videos have seed 3, not 4" in done.err


def test_show_draws_a_video_with_a_model(data, tmp_path):
    film = tmp_path / "film.gif"
    done = icarus(
        "show", data, 1, "--out", film, "--scale", 1, "--model", "aapa-10000", "--detections"
    )
    assert (done.status, done.out) == (0, f"{film}: CLEVR_new_000001, 150 pictures\n")
    with Image.open(film) as opened:
        assert opened.n_frames == 150


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((9,), "there is no video CLEVR_new_000009; did you mean CLEVR_new_00000"),
        (("CLEVR_new_00001",), "did you mean CLEVR_new_000001"),
        ((1, "--out", "film.avi"), "a film ends with .gif or .mp4"),
        ((1, "--model", "apa-10"), "there is no model 'apa-10'"),
        ((1, "--perception", "eyes"), "it has to be od or pp"),
        ((1, "--scale", 0), "--scale"),
    ],
)
def test_wrong_usage_of_show_is_status_2(arguments, text, data, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = icarus("show", data, *arguments)
    assert (done.status, done.out) == (2, "")
    assert text in done.err
    assert list(tmp_path.iterdir()) == []


def test_show_of_a_folder_without_data_is_status_2(tmp_path):
    done = icarus("show", tmp_path, 1)
    assert done.status == 2
    assert "there is no folder labels/" in done.err


def test_show_without_pillow_names_the_extra(data, monkeypatch):
    importing = builtins.__import__

    def without_pillow(name, *args, **kwargs):
        if name.split(".")[0] == "PIL":
            raise ImportError(name)
        return importing(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without_pillow)
    done = icarus("show", data, 1)
    assert done.status == 2
    assert "pip install 'icarus-lite[preview]'" in done.err
