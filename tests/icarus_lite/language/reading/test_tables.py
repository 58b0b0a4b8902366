"""The parser's tables: of the grammar as it is, and the same parser as the grammar makes."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import lark
import pytest
from lark.exceptions import UnexpectedInput

from icarus_lite.language.reading import parsing, tables
from icarus_lite.language.reading.tables import build, grammar_text, load

DOMAINS = sorted(Path(__file__).parents[4].glob("domains/*.icr"))
BROKEN = [
    "(domain d)\n(concepts ((near ?a ?b) :elements ((object ?a ^x)))",
    "(concepts ((a ?x) :elemnts ((b ?x))))",
    "(skills ((go ?x) :tests ((< 1)) :effects (not)))",
    "(domain",
    ")",
]


def test_the_tables_were_made_of_this_grammar_by_this_version_of_lark() -> None:
    file = resources.files("icarus_lite.language.reading").joinpath("grammar.json")
    made = json.loads(file.read_text(encoding="utf-8"))
    how = "make them anew: python -m icarus_lite.language.reading.tables"
    assert made["grammar"] == grammar_text(), how
    assert made["lark"] == lark.__version__, how


@pytest.mark.parametrize("domain", DOMAINS, ids=lambda path: path.name)
def test_parsers_with_and_without_tables_read_the_same(domain: Path) -> None:
    loaded, built = _parsers()
    text = domain.read_text(encoding="utf-8")
    assert loaded.parse(text, start="file") == built.parse(text, start="file")


@pytest.mark.parametrize("text", BROKEN)
def test_they_stumble_at_the_same_place_and_expect_the_same(text: str) -> None:
    found = []
    for parser in _parsers():
        with pytest.raises(UnexpectedInput) as stumbled:
            parser.parse(text, start="file")
        error = stumbled.value
        accepts = sorted(error.interactive_parser.accepts())  # type: ignore[attr-defined] # it has
        found.append((type(error), error.line, error.column, accepts))
    assert found[0] == found[1]


def test_tables_of_another_grammar_are_not_used() -> None:
    assert load(grammar_text() + "\n// changed", parsing._Parts()) is None


def test_tables_of_another_version_of_lark_are_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tables.lark, "__version__", "0.0.0")
    assert load(grammar_text(), parsing._Parts()) is None


def test_without_tables_the_parser_is_built(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(tables, "_HERE", tmp_path)
    assert load("grammar", parsing._Parts()) is None


def test_the_file_is_what_the_module_writes() -> None:
    made = json.loads(tables.tables(grammar_text()))
    file = resources.files("icarus_lite.language.reading").joinpath("grammar.json")
    kept = json.loads(file.read_text(encoding="utf-8"))
    assert made.keys() == kept.keys()
    assert len(made["data"]["parser"]["parser"]["states"]) == len(
        kept["data"]["parser"]["parser"]["states"]
    )


def _parsers() -> tuple[lark.Lark, lark.Lark]:
    loaded = load(grammar_text(), parsing._Parts())
    assert loaded is not None
    return loaded, build(grammar_text(), parsing._Parts())
