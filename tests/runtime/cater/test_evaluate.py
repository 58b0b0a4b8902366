"""The whole evaluation, on videos whose scores can be worked out by hand."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from aapa import AnchoringError
from aapa.errors import DatasetError
from aapa.lacater import PerceptionKind
from icarus_lite import DomainError
from runtime.cater import evaluation
from runtime.cater.evaluate import How, cater_domain, evaluate
from runtime.cater.evaluation import Job, evaluate_videos
from runtime.cater.progress_file import ProgressFile, job_digest
from runtime.cater.report import report_of
from runtime.cater.workers import _batches
from runtime.errors import UsageError

MODELS = ("last-seen", "pa-6500", "aapa-6500")


def job_for(folder, models=MODELS, perception=PerceptionKind.PP):
    return Job(folder, cater_domain(), models, perception)


def run(job, how=None, notes=None):
    seen = []
    report = evaluate(
        job,
        how or How(processes=1),
        lambda done, total: seen.append((done, total)),
        (notes if notes is not None else []).append,
    )
    return report, seen


def test_the_table_is_what_the_boxes_say(tmp_path, dataset):
    report, seen = run(job_for(dataset(tmp_path, 2)))
    assert report.videos == 2
    rows = {row.model: row for row in report.rows}
    aapa, last = rows["aapa-6500"], rows["last-seen"]
    # The snitch lies still until frame 20, then goes 1 and 2 px a frame with the cone.
    assert [aapa.miou[task].mean for task in ("visible", "contained", "carried")] == [100] * 3
    assert aapa.ml2["overall"].mean == 0
    # Carried are frames 20 to 30, in which the last seen box is 0, 1 … 10 steps behind.
    assert last.ml2["carried"].mean == pytest.approx((5 + 10) / 2)
    assert last.ml2["carried"].sem == pytest.approx(5 / 2)
    ious = [np.mean([(21 - s) / (21 + s) for s in range(0, 11 * step, step)]) for step in (1, 2)]
    assert last.miou["carried"].mean == pytest.approx(100 * np.mean(ious))
    assert rows["pa-6500"].miou["carried"].mean == last.miou["carried"].mean
    assert last.miou["occluded"].videos == 0
    assert seen[0] == (0, 2)
    assert seen[-1] == (2, 2)


def test_scores_against_the_boxes_before_rounding_stand_beside(tmp_path, dataset):
    report, _ = run(job_for(dataset(tmp_path, 2)))
    [aapa] = [row for row in report.rows if row.model == "aapa-6500"]
    # A box of 20 x 20 px, off by a quarter px both ways.
    shared = 19.75**2
    assert aapa.miou_exact["contained"].mean == pytest.approx(100 * shared / (800 - shared))


def test_the_json_document_follows_the_contract(tmp_path, dataset):
    document = run(job_for(dataset(tmp_path, 2)))[0].to_json()
    assert (document["videos"], document["perception"], document["skipped"]) == (2, "pp", [])
    assert [row["model"] for row in document["rows"]] == list(MODELS)
    for row in document["rows"]:
        for table in ("miou", "ml2"):
            assert list(row[table]) == ["visible", "occluded", "contained", "carried", "overall"]
        assert row["miou"]["occluded"] == [None, None]
    json.dumps(document, allow_nan=False)


def test_the_result_does_not_depend_on_the_number_of_workers(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 9), ("last-seen", "aapa-6500", "aapa-plus", "aapa-plus-camera"))
    (tmp_path / "camera.yaml").write_text("height: 5.3\npitch_deg: 28\n", encoding="utf-8")
    alone = run(job, How(processes=1))[0].to_json()
    assert run(job, How(processes=2))[0].to_json() == alone


def test_the_result_does_not_depend_on_the_order_of_the_videos(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 5), ("last-seen",))
    names = [f"CLEVR_new_{n:06d}" for n in range(5)]
    results = evaluate_videos(job, names)
    backwards = report_of(job, results[::-1])
    assert backwards.to_json() == report_of(job, results).to_json()


def test_a_cluster_gives_the_same_result(tmp_path, dataset):
    distributed = pytest.importorskip("distributed")
    job = job_for(dataset(tmp_path, 6), ("last-seen", "aapa-6500"))
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        there = run(job, How(scheduler=cluster.scheduler_address))[0].to_json()
    assert there == run(job)[0].to_json()


def test_where_there_is_no_scheduler_the_text_says_so(tmp_path, dataset, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("runtime.cater.workers._CONNECT_TIMEOUT_S", 0.5)
    job = job_for(dataset(tmp_path, 1))
    with pytest.raises(UsageError, match=r"no Dask scheduler at tcp://127\.0\.0\.1:1 "):
        run(job, How(scheduler="tcp://127.0.0.1:1"))


def test_without_dask_the_text_names_the_extra(tmp_path, dataset, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(UsageError, match=r"pip install 'icarus-lite\[cluster\]'"):
        run(job_for(dataset(tmp_path, 1)), How(scheduler="tcp://127.0.0.1:1"))


class Stopped(Exception):  # noqa: N818 - what the person does
    """The person has pressed Ctrl-C."""


def test_what_was_interrupted_goes_on_where_it_stopped(tmp_path, dataset, monkeypatch):
    job = job_for(dataset(tmp_path, 12), ("last-seen", "aapa-6500"))
    whole = run(job)[0].to_json()

    def stop(done, _total):
        if done >= 4:
            raise Stopped

    with pytest.raises(Stopped):
        evaluate(job, How(processes=1), stop, lambda _: None)
    [kept] = tmp_path.glob(".icarus-evaluation-*.jsonl")
    before = len(kept.read_text().splitlines()) - 1
    assert 4 <= before < 12
    # The next run is cut off while it writes a line.
    kept.write_text(kept.read_text()[:-30])
    evaluated = []
    real = evaluation.Evaluator.evaluate
    monkeypatch.setattr(
        evaluation.Evaluator,
        "evaluate",
        lambda self, name: (evaluated.append(name), real(self, name))[1],
    )
    notes = []
    assert run(job, notes=notes)[0].to_json() == whole
    assert len(evaluated) == 12 - (before - 1)
    assert notes == [f"{before - 1} of 12 videos were evaluated before; going on from there"]
    assert not kept.exists()


def interrupted(job, at=4):
    def stop(done, _total):
        if done >= at:
            raise Stopped

    with pytest.raises(Stopped):
        evaluate(job, How(processes=1), stop, lambda _: None)


def test_fresh_begins_anew(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 12), ("last-seen",))
    interrupted(job)
    notes = []
    run(job, How(processes=1, fresh=True), notes)
    assert notes == []


def test_a_video_that_has_changed_is_evaluated_again(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 12), ("last-seen",))
    interrupted(job)
    [kept] = tmp_path.glob(".icarus-evaluation-*.jsonl")
    first = json.loads(kept.read_text().splitlines()[1])["video"]
    (tmp_path / "perfect_perception" / f"{first}.pkl").write_bytes(b"damaged")
    report, _ = run(job)
    assert list(report.skipped) == [first]


def test_with_another_calibration_it_is_evaluated_anew(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 12), ("last-seen",))
    calibration = tmp_path / "camera.yaml"
    calibration.write_text("height: 5.3\npitch_deg: 28\n", encoding="utf-8")
    interrupted(job)
    calibration.write_text("height: 5.31\npitch_deg: 28\n", encoding="utf-8")
    notes = []
    run(job, notes=notes)
    assert notes == []


def test_a_wrong_calibration_ends_the_evaluation(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 1), ("last-seen",))
    (tmp_path / "camera.yaml").write_text("height: 5.3\n", encoding="utf-8")
    with pytest.raises(DatasetError, match=r"camera\.yaml: pitch_deg is missing"):
        run(job)


def test_a_model_that_needs_the_camera_says_so(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 1), ("aapa-plus-camera",))
    with pytest.raises(AnchoringError, match=r"has to know where the camera stands"):
        run(job)


def test_results_of_another_domain_are_not_taken(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 12), ("aapa-6500",))
    interrupted(job)
    other = tmp_path / "other.icr"
    other.write_text("(domain other) (percepts (object ^x))")
    notes = []
    report, _ = run(replace(job, domain=other), notes=notes)
    assert notes == []
    # Without attachments, the cone goes without the snitch.
    assert report.rows[0].miou["carried"].mean < 90


def test_the_digest_of_a_job_tells_models_perception_and_folder(tmp_path, dataset):
    job = job_for(dataset(tmp_path / "a", 1))
    others = [
        replace(job, models=("last-seen",)),
        replace(job, perception=PerceptionKind.OD),
        replace(job, root=dataset(tmp_path / "b", 1)),
    ]
    assert len({job_digest(each) for each in (job, *others)}) == 4
    assert job_digest(job) == job_digest(job_for(tmp_path / "a"))


def test_a_file_of_something_else_is_begun_anew(tmp_path, dataset):
    job = job_for(dataset(tmp_path / "data", 1))
    path = tmp_path / "kept.jsonl"
    path.write_text("[1, 2]\nnothing\n")
    kept = ProgressFile(path, job)
    assert kept.done == {}
    kept.close(finished=False)
    assert len(path.read_text().splitlines()) == 1


def test_a_file_that_cannot_be_written_is_an_error_where_it_was_named(tmp_path, dataset):
    job = job_for(dataset(tmp_path, 1), ("last-seen",))
    with pytest.raises(UsageError, match="cannot be written"):
        run(job, How(processes=1, progress_path=tmp_path / "no" / "such" / "folder.jsonl"))


def test_a_data_set_that_cannot_be_written_to_is_evaluated_all_the_same(
    tmp_path, dataset, monkeypatch
):
    job = job_for(dataset(tmp_path, 1), ("last-seen",))

    def refuse(*_args):
        raise UsageError("data: cannot be written: Read-only file system")

    monkeypatch.setattr(ProgressFile, "__init__", refuse)
    notes = []
    assert run(job, notes=notes)[0].videos == 1
    assert "begins anew" in notes[0]


def spoil(root, number, kind, content):
    path = root / kind.folder / f"CLEVR_new_{number:06d}.pkl"
    path.write_bytes(content)


def test_videos_that_cannot_be_evaluated_are_counted_with_the_reason(tmp_path, dataset):
    root = dataset(tmp_path, 8)
    kind = PerceptionKind.OD
    spoil(root, 1, kind, b"\x80\x04]")
    spoil(root, 2, kind, pickle.dumps(print))
    nothing = {"bb": [np.zeros((0, 4))] * 40, "labels": [np.zeros(0)] * 40}
    spoil(root, 3, kind, pickle.dumps(nothing))
    inverted = {"bb": [np.array([[9, 9, 1, 1]])] * 40, "labels": [np.array([140])] * 40}
    spoil(root, 4, kind, pickle.dumps(inverted))
    labels = root / "labels" / "CLEVR_new_000005_bb.json"
    entry = json.loads(labels.read_text())
    del entry["small_gold_spl_metal_Spl_0"]
    labels.write_text(json.dumps(entry))
    scene = root / "scenes" / "CLEVR_new_000006.json"
    scene.write_text(scene.read_text().replace('"_contain", "Spl_0"', '"_contain", "Cone_9"'))
    report, _ = run(job_for(root, ("aapa-6500",), kind))
    assert report.videos == 2
    reasons = list(report.skipped.values())
    expected = [
        "is no whole pickle",
        "asks for builtins.print",
        "the snitch is never detected",
        "frame 0: has the inverted box [9, 9, 1, 1]",
        "the video has no snitch",
        "_contain names 'Cone_9'; there is no such object in the scene",
    ]
    for reason, text in zip(reasons, expected, strict=True):
        assert text in reason
    # The two left are scored as if nothing else were there.
    clean, _ = run(job_for(dataset(tmp_path / "clean", 8), ("aapa-6500",), kind))
    assert report.rows[0].miou["overall"].mean == clean.rows[0].miou["overall"].mean == 100
    assert len(report.to_json()["skipped"]) == 6
    assert report.skipped_lines()[0] == "6 of 8 videos were skipped:"
    assert report.skipped_lines()[3] == "  CLEVR_new_000003: the snitch is never detected"


def test_a_data_set_of_which_nothing_can_be_evaluated_is_an_error(tmp_path, dataset):
    root = dataset(tmp_path, 2)
    for number in range(2):
        spoil(root, number, PerceptionKind.OD, b"")
    with pytest.raises(
        DatasetError, match=r"not one of 2 videos can be evaluated; the first: .*pkl"
    ):
        run(job_for(root, perception=PerceptionKind.OD))


def test_without_scenes_there_are_no_actions_and_the_video_is_skipped(tmp_path, dataset):
    root = dataset(tmp_path, 1)
    (root / "scenes").rename(root / "elsewhere")
    with pytest.raises(DatasetError, match="no scene file, and so no actions are known"):
        run(job_for(root))


def test_thousands_of_detections_in_one_frame_are_no_obstacle(tmp_path, dataset):
    root = dataset(tmp_path, 1)
    path = root / PerceptionKind.OD.folder / "CLEVR_new_000000.pkl"
    with path.open("rb") as stream:
        content = pickle.load(stream)
    chance = np.random.default_rng(3)
    corners = chance.integers(0, 200, (3000, 2))
    crowd = np.concatenate([corners, corners + 10], axis=1)
    for frame in (3, 4):
        content["bb"][frame] = np.concatenate([content["bb"][frame], crowd])
        content["labels"][frame] = np.concatenate(
            [content["labels"][frame], chance.integers(0, 40, 3000)]
        )
    path.write_bytes(pickle.dumps(content))
    report, _ = run(job_for(root, ("aapa-6500",), PerceptionKind.OD))
    assert report.rows[0].miou["overall"].mean == 100


def test_a_model_that_fails_is_an_error_that_names_model_and_video(tmp_path, dataset, monkeypatch):
    class Lost:
        def observe(self, _frame):
            return None

    monkeypatch.setattr("aapa.lacater.models.catalogue.LastSeen", Lost)
    with pytest.raises(
        AnchoringError, match="model last-seen, video CLEVR_new_000000: frame 0 has no proper box"
    ):
        run(job_for(dataset(tmp_path, 1), ("last-seen",)))


@pytest.mark.parametrize(
    ("change", "error", "text"),
    [
        ({"models": ("nothing",)}, AnchoringError, "there is no model 'nothing'"),
        ({"models": ()}, AnchoringError, "no model is named"),
        ({"domain": None}, DomainError, "nowhere"),
    ],
)
def test_a_job_that_cannot_be_is_refused_before_any_video(tmp_path, dataset, change, error, text):
    job = job_for(dataset(tmp_path, 1))
    if "domain" in change:
        change = {"domain": tmp_path / "nowhere.icr"}
    with pytest.raises(error, match=text):
        run(replace(job, **change))


@pytest.mark.parametrize(("videos", "workers"), [(0, 1), (1, 8), (7, 2), (100, 3), (5000, 4)])
def test_batches_hold_every_video_once(videos, workers):
    names = [str(n) for n in range(videos)]
    batches = _batches(names, workers)
    assert [name for batch in batches for name in batch] == names
    assert all(1 <= len(batch) <= 8 for batch in batches)
