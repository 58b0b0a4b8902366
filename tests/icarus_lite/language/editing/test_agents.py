"""What an editor knows of agents: where they are named and used, and what may be written."""

from __future__ import annotations

import pytest
from pygments.token import Name

from icarus_lite.language.editing import File, Index, Role, complete, describe, rename, renameable
from icarus_lite.language.editing.occurrences import occurrences
from icarus_lite.language.highlighting import IcarusLexer

TEXT = """\
(agents human arm-2)
(percepts (base))
(skills
  ((hold ?base) :agent human :elements ((base ?base)) :effects ((held ?base)) :request no)
  ((pass ?who ?base) :agent ?who :elements ((held ?base)) :effects ((passed ?base))))
(task 1 :agents (human arm-2) :goal ((held base1)))
"""


def test_an_agent_is_named_once_and_used_in_skills_and_tasks():
    words = [word for word in occurrences(TEXT) if word.role is Role.AGENT]
    assert [(word.name, word.place.form, word.defines) for word in words] == [
        ("human", "agents", True),
        ("arm-2", "agents", True),
        ("human", "skills", False),
        ("human", "task", False),
        ("arm-2", "task", False),
    ]
    who = [word for word in occurrences(TEXT) if word.name == "?who"]
    assert {word.role for word in who} == {Role.VARIABLE}


def test_an_agent_is_renamed_everywhere(reading):
    index, text = reading(TEXT), TEXT
    thing = renameable(index, "it", index.at("it", TEXT.index("human")))
    for located, new in reversed(rename(index, thing, "ann")):
        word = located.occurrence
        text = text[: word.start] + new + text[word.stop :]
    assert text == TEXT.replace("human", "ann")


def test_an_agent_is_described_by_who_asks_it(reading):
    index = reading(TEXT)
    said = describe(index, "it", index.at("it", TEXT.index("human")))
    assert said == "**`human`** · another agent\n\nUsed by `hold` and task `1`."


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(skills ((grip ?b) :agent |", ["?b", "human", "arm-2"]),
        ("(skills ((grip ?b) :agent hu|", ["human", "arm-2"]),
        ("(task 2 :agents (arm-2 |", ["human"]),
        ("(skills ((grip ?b) :request |", ["no"]),
        ("(long-term-goal g :goal ((held b)) :maintain |", ["yes", "no"]),
        ("(agents |", []),
    ],
)
def test_what_may_be_written_is_proposed(text, expected):
    text = TEXT + text
    offset = text.index("|")
    found = complete(Index([File.read("it", text[:offset])]), "it", offset)
    assert [each.text for each in found.proposals] == expected


def test_agents_have_a_colour_of_their_own():
    tokens = list(IcarusLexer().get_tokens(TEXT))
    assert [text for kind, text in tokens if kind is Name.Namespace] == [
        "human",
        "arm-2",
        "human",
        "1",
        "human",
        "arm-2",
    ]
