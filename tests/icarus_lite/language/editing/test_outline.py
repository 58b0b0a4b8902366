from __future__ import annotations

from icarus_lite.language.editing import EntryKind, occurrences, outline


def test_forms_with_what_they_define():
    text = """\
(domain d "About.")
(percepts (object ^x) (part :is object ^grip))
(concepts ((near ?a ?b) :elements ((object ?a) (object ?b))) ((near ?a ?a)))
(attachments ((grasp ?o) :child ?o))
(task 1.1 "Do it" :goal ((near a b)))
(test "it holds")
(include "x.icr")
"""
    found = outline(occurrences(text))
    assert [(each.kind.value, each.name, each.detail) for each in found] == [
        ("domain", "d", "About."),
        ("form", "percepts", ""),
        ("form", "concepts", ""),
        ("form", "attachments", ""),
        ("task", "1.1", "Do it"),
        ("test", "it holds", ""),
        ("form", "include", ""),
    ]
    assert [(each.name, each.detail) for each in found[1].children] == [
        ("object", "^x"),
        ("part", "^grip"),
    ]
    assert [(each.kind, each.detail) for each in found[2].children] == [
        (EntryKind.CONCEPT, "?a ?b"),
        (EntryKind.CONCEPT, "?a ?a"),
    ]
    assert [each.name for each in found[3].children] == ["grasp"]


def test_entries_lie_inside_one_another(shipped):
    for entry in outline(occurrences(shipped)):
        for each in (entry, *entry.children):
            assert each.start <= each.name_start < each.name_stop <= each.stop
            assert shipped[each.start] == "("
            assert shipped[each.stop - 1] == ")"
            assert entry.start <= each.start < each.stop <= entry.stop


def test_a_form_without_a_name_yet_is_listed_by_its_keyword():
    (entry,) = outline(occurrences("(task"))
    assert (entry.kind, entry.name, entry.stop) == (EntryKind.TASK, "task", 5)


def test_a_text_without_forms_has_no_outline():
    assert outline(occurrences("")) == ()
    assert outline(occurrences("; only a comment")) == ()
