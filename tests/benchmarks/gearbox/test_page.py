from __future__ import annotations

import random
import re
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest
from gearbox import figures, tables
from gearbox.faults import KINDS
from gearbox.page import page, usual_clock, write_page
from gearbox.rows import Ending, Episode, Row, Trace
from gearbox.trials import NO_FAULT, TASKS, Trial


def row(trial, ending=Ending.ACHIEVED, **more):
    good = ending in (Ending.ACHIEVED, Ending.RECOVERED)
    known = {
        "achieved": good or ending is Ending.FALSE,
        "true": good or ending is Ending.UNAWARE,
        "reason": "all goals are believed" if good else "hubcover is lost after 12 cycles",
        "cycles": 150,
        "wall_s": 3.0,
    }
    return Row(trial, ending, **{**known, **more})


@pytest.fixture(scope="module")
def many():
    rng = random.Random(7)
    rows = []
    for seed in range(4):
        for task in TASKS:
            rows.append(row(Trial(task, seed)))
            rows.append(row(Trial(task, seed, attachments=False), Ending.FAILED))
            for fault in KINDS:
                if fault != NO_FAULT:
                    ending = rng.choice([Ending.ACHIEVED, Ending.RECOVERED, Ending.FAILED])
                    rows.append(row(Trial(task, seed, fault=fault), ending, struck=(fault,)))
    rows += [row(Trial(task, 0, clock=1.0), wall_s=20.0) for task in TASKS]
    return rows


def text_of(rows):
    return "\n".join(page(rows, "images/"))


def test_the_page_counts_what_is_in_the_rows(many):
    text = text_of(many)
    assert "**With attachments, nothing goes wrong: 24 of 24 (86-100 %) done**" in text
    assert "**Without attachments, nothing goes wrong: 0 of 24 (0-14 %) done**" in text
    hit = 6 * 4 * (len(KINDS) - 1)
    assert f"**With faults: {hit} of {hit} (99-100 %) ended as achieved, recovered" in text
    assert "**Unsafe motions: 0.**" in text
    assert f"**Traces damaged: 0 of {len(many)}.**" in text
    assert "* 24 times: hubcover is lost after … cycles" in text
    assert "There is none.\n\n## To repeat it" in text
    for task in TASKS.values():
        assert task.words in text
    for fault, kind in KINDS.items():
        assert fault == NO_FAULT or f"| `{fault}` | {kind.words} | 24 | 24 |" in text


def test_a_run_that_ended_badly_is_named(many):
    trial = Trial("1.4", 2, fault="jam")
    bad = [
        (Ending.FALSE, {}),
        (Ending.MISNAMED, {}),
        (Ending.ACHIEVED, {"false_at_end": ("(held case)",)}),
        (Ending.BROKEN, {"reason": "Traceback\n  somewhere\nKeyError: 'plug'"}),
        (Ending.ACHIEVED, {"unsafe": ("pressed with 170 N",)}),
        (Ending.ACHIEVED, {"trace": Trace(12, "cycle 3, removed: recorded [], replayed [1]")}),
    ]
    for ending, more in bad:
        said = text_of([*many, row(trial, ending, **more)]).split("## Every run that ended")[1]
        said = said.split("## To repeat it")[0]
        assert said.count("\n* ") == 1
        assert f"`{trial.key}`" in said
    assert "broken: KeyError: 'plug'" in text_of([row(trial, Ending.BROKEN, **bad[3][1])])


def test_runs_at_several_clocks_are_compared_on_the_same_seeds(many):
    assert usual_clock(many) == 10.0
    found = tables.clocks_table(many)
    assert [line.split(" | ")[:2] for line in found[2:]] == [["| 1", "6"], ["| 10", "6"]]
    assert tables.clocks_table([each for each in many if each.trial.clock == 10.0]) == []


def test_false_beliefs_are_grouped_the_longest_first():
    short = Episode("(attached plug hand1)", 3, 1, 0.5, "(insert plug case)")
    longer = Episode("(holding hand1 plug)", 3, 9, 4.0, "", outlived=True)
    rows = [row(Trial("1.4", seed), episodes=(short, longer)) for seed in range(3)]
    _, _, first, second = tables.episodes_table(rows)
    assert first == "| `(holding hand1 plug)` | with nothing under way | 3 | 3 | 4.00 | 4.00 |"
    assert second.startswith("| `(attached plug hand1)` | during `(insert plug case)` | 3 | 0 |")


def test_it_is_told_how_far_the_arm_went_on():
    rows = [
        row(Trial("1.1", seed, fault="drop_rtde"), travels=(("link_lost", 0.1 * seed),))
        for seed in range(5)
    ]
    rows.append(row(Trial("1.1", 0, clock=1.0), travels=(("noticed", 0.02),)))
    assert tables.travels_table(rows)[2:] == [
        "| after the run had noticed it | 1 | 1 | 0.020 | 0.020 | 0.020 |",
        "| after a link was lost | 10 | 5 | 0.200 | 0.400 | 0.400 |",
    ]
    assert "### How far the arm went on" in text_of(rows)


def test_the_figures_are_drawings_as_long_as_their_shares():
    rows = [row(Trial("1.1", seed)) for seed in range(3)]
    rows += [row(Trial("1.1", seed), Ending.FAILED) for seed in (3,)]
    drawn = ET.fromstring(figures.endings([("none", rows), ("jam", [])]))
    widths = {
        bar.get("fill"): float(bar.get("width"))
        for bar in drawn.iter("{http://www.w3.org/2000/svg}rect")
        if bar.get("height") == "18"
    }
    achieved = widths[figures.COLOURS[Ending.ACHIEVED]]
    assert achieved == pytest.approx(3 * widths[figures.COLOURS[Ending.FAILED]])
    assert len(widths) == 2


def test_the_page_is_written_with_its_figures(many, tmp_path):
    write_page(many, tmp_path / "results" / "gearbox.md", tmp_path / "images")
    text = (tmp_path / "results" / "gearbox.md").read_text()
    shown = re.findall(r"!\[[^]]*\]\(([^)]*)\)", text)
    assert shown == ["../images/gearbox-tasks.svg", "../images/gearbox-faults.svg"]
    for name in shown:
        drawing = (tmp_path / "results" / name).resolve()
        ET.fromstring(drawing.read_text())


def test_the_page_can_be_made_of_any_rows_there_are(many):
    assert "0 runs" in text_of([])
    assert "## Something goes wrong" not in text_of([r for r in many if r.trial.fault == NO_FAULT])
    assert "## Nothing goes wrong" not in text_of([r for r in many if r.trial.fault == "jam"])


def test_rows_of_different_code_are_told(many):
    mixed = [replace(each, code="one") for each in many[:-1]] + [replace(many[-1], code="other")]
    assert f"by 2 states of the code ({len(many) - 1}, 1 runs)" in text_of(mixed)
