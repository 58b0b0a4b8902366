"""Networks in an evaluation: beside other models, on any number of cores, with any weights."""

from __future__ import annotations

import json
import sys

import pytest
from command_line import icarus

from aapa.lacater import PerceptionKind
from runtime.cater.evaluate import How, cater_domain, evaluate
from runtime.cater.evaluation import Job, evaluate_videos
from runtime.cater.progress_file import job_digest
from runtime.cater.report import report_of

torch = pytest.importorskip("torch")
pytest.importorskip("safetensors")

from aapa.neural.checkpoints import Guidance, Meta, save_checkpoint  # noqa: E402
from aapa.neural.models import build_network  # noqa: E402


@pytest.fixture
def weights(tmp_path):
    """Writes weights of a small network that nobody has trained."""

    def make(seed=1, guidance=None):
        path = tmp_path / f"{seed}-{guidance is None}.safetensors"
        sizes = {"who_hidden": 8, "where_hidden": 8}
        with torch.random.fork_rng():
            torch.manual_seed(seed)
            network = build_network("opnet-aa", sizes)
        save_checkpoint(path, network, Meta("opnet-aa", sizes, guidance))
        return path

    return make


def job_for(folder, **files):
    return Job(
        folder, cater_domain(), ("last-seen", *files), PerceptionKind.PP, tuple(files.items())
    )


def run(job, processes=1):
    return evaluate(job, How(processes=processes), lambda _d, _n: None, lambda _t: None)


def test_the_result_does_not_depend_on_the_number_of_workers(tmp_path, dataset, weights):
    files = {"mine": weights(), "guided": weights(guidance=Guidance(100.0, "product"))}
    job = job_for(dataset(tmp_path / "data", 11), **files)
    alone = run(job).to_json()
    assert run(job, 2).to_json() == alone
    rows = {row["model"]: row for row in alone["rows"]}
    assert list(rows) == ["last-seen", "mine", "guided"]
    # Same weights, but one of them is told what to look at.
    assert rows["mine"]["ml2"] != rows["guided"]["ml2"]
    assert rows["guided"]["parameters"]["mode"] == "product"


def test_it_does_not_depend_on_which_videos_come_together_either(tmp_path, dataset, weights):
    job = job_for(dataset(tmp_path / "data", 5), mine=weights())
    names = [f"CLEVR_new_{n:06d}" for n in range(5)]
    together = evaluate_videos(job, names)
    apart = [result for name in names for result in evaluate_videos(job, [name])]
    assert report_of(job, together).to_json() == report_of(job, apart).to_json()


def test_a_video_that_cannot_be_evaluated_does_not_shift_the_others(tmp_path, dataset, weights):
    folder = dataset(tmp_path / "data", 3)
    job = job_for(folder, mine=weights())
    names = [f"CLEVR_new_{n:06d}" for n in range(3)]
    whole = evaluate_videos(job, names)
    (folder / "perfect_perception" / "CLEVR_new_000001.pkl").write_bytes(b"")
    found = evaluate_videos(job, names)
    assert [bool(result.skipped) for result in found] == [False, True, False]
    # As text, for what has no frame is NaN, which equals nothing.
    assert repr([found[0].scores, found[2].scores]) == repr([whole[0].scores, whole[2].scores])


def test_other_weights_are_another_job(tmp_path, dataset, weights):
    folder, path = dataset(tmp_path / "data", 1), weights(seed=1)
    before = job_digest(job_for(folder, mine=path))
    assert job_digest(job_for(folder, mine=path)) == before
    path.write_bytes(weights(seed=2).read_bytes())
    assert job_digest(job_for(folder, mine=path)) != before


def test_weights_of_one_s_own_from_the_command_line(tmp_path, dataset, weights):
    status, out, err = icarus(
        "cater", "evaluate", dataset(tmp_path / "data", 2), "--models", "aapa-6500,mine",
        "--weights", f"mine={weights()}", "--jobs", 1, "--json",
    )  # fmt: skip
    assert (status, err) == (0, "")
    document = json.loads(out)
    assert [row["model"] for row in document["rows"]] == ["aapa-6500", "mine"]
    assert list(document["videos_per_second"]) == ["aapa-6500", "mine"]
    assert all(speed > 0 for speed in document["videos_per_second"].values())


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--models", "mine", "--weights", "mine"], "it has to be NAME=FILE"),
        (["--models", "mine", "--weights", "mine=nowhere"], "mine has no weights: there is no"),
        (["--models", "opnet", "--weights", "mine=x"], "weights for 'mine', which is not among"),
        (
            ["--models", "mine", "--weights", "mine=a", "--weights", "mine=b"],
            "--weights names mine twice",
        ),
    ],
)
def test_bad_weights_end_with_2_and_the_reason(tmp_path, dataset, options, text):
    status, out, err = icarus("cater", "evaluate", dataset(tmp_path, 1), *options)
    assert (status, out) == (2, "")
    assert text in err
    assert len(err.strip().splitlines()) == 1


def test_without_pytorch_it_ends_with_2_and_names_the_extra(tmp_path, dataset, monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.setattr("aapa.neural.extra.find_spec", lambda _name: None)
    status, out, err = icarus("cater", "evaluate", dataset(tmp_path, 1), "--models", "opnet")
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert "pip install 'icarus-lite[neural]'" in err
