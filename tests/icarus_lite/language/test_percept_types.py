from __future__ import annotations

from icarus_lite.language import check_domain, parse_domain
from icarus_lite.language.percept_types import MAX_LINEAGE, inherited_attributes, lineages
from icarus_lite.language.syntax import PerceptType


def types(text):
    return parse_domain(f"(percepts {text})")[0].percepts


def codes(text):
    domain, _ = parse_domain(text, "d.icr")
    return [each.code for each in check_domain(domain)]


def test_a_subtype_names_its_supertype():
    assert types("(object ^x) (part :is object ^grip)") == (
        PerceptType("object", ("x",)),
        PerceptType("part", ("grip",), "object"),
    )


def test_the_lineage_of_a_type_begins_with_itself():
    chains = lineages(types("(screw :is part) (part :is object) (object) (hand)"))
    assert chains == {
        "screw": ("screw", "part", "object"),
        "part": ("part", "object"),
        "object": ("object",),
        "hand": ("hand",),
    }


def test_a_lineage_ends_where_it_cannot_go_on():
    assert lineages(types("(a :is b) (b :is a) (c :is d) (e :is e)")) == {
        "a": ("a", "b"),
        "b": ("b", "a"),
        "c": ("c",),
        "e": ("e",),
    }


def test_a_subtype_has_the_attributes_of_all_above_it():
    attributes = inherited_attributes(
        types("(object ^x) (part :is object ^grip) (screw :is part ^m)")
    )
    assert attributes["screw"] == ("x", "grip", "m")
    assert attributes["object"] == ("x",)


def test_patterns_may_use_inherited_attributes_and_no_others():
    percepts = "(percepts (object ^x) (part :is object ^grip))"
    assert codes(f"{percepts} (goals (part p ^x 1 ^grip 2))") == []
    assert codes(f"{percepts} (goals (object p ^grip 2))") == ["ICR015"]
    assert codes(f'{percepts} (test "t" :percepts ((part p ^x 1)) :expect ((object p)))') == []


def test_the_kind_of_an_inherited_attribute_is_known_for_all_subtypes():
    text = """(percepts (object ^colour) (part :is object))
    (concepts ((red ?o) :elements ((object ?o ^colour red)))
      ((bright ?o) :elements ((part ?o ^colour ?c)) :tests ((> ?c 3))))"""
    assert codes(text) == ["ICR044"]


def test_a_lineage_has_a_greatest_length():
    def chain(length):
        links = "".join(f" (t{n} :is t{n + 1})" for n in range(length - 1))
        return f"(percepts{links} (t{length - 1})) (goals (t0 x))"

    assert codes(chain(MAX_LINEAGE)) == []
    assert codes(chain(MAX_LINEAGE + 1)) == ["ICR039"]
    assert set(codes(chain(2000))) == {"ICR039"}
