from __future__ import annotations

import pytest
from talking import ask, live

from icarus_lite import Action, Outcome, Percept
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language import parse_domain
from icarus_lite.symbols import Belief
from runtime.repl import CommandError, Session
from runtime.repl.supposing import Edit, Supposition


@pytest.fixture
def session() -> Session:
    """Stand where the cover is in the hand."""
    session = live()
    ask(session, "step 2")
    return session


def test_assuming_percepts_attachments_and_effects(session: Session) -> None:
    text = ask(session, "assume (object case ^seen no)")
    assert text.splitlines() == [
        "assumed (object case)",
        "  - (in-reachable-pose hand1 case)",
        "  + (hidden case)",
    ]
    assert "+ (attached case hand1)" in ask(session, "assume (attached case hand1)")
    assert ask(session, "(attached ?x hand1)").count("\n(attached") == 2
    assert ask(session, "assume (object new ^type bearing)").endswith("+ (graspable new)")
    assert "supposed: assumed (object new)" in ask(session, "where")


def test_retracting(session: Session) -> None:
    text = ask(session, "retract (holding hand1 hubcover)")
    assert "+ (free hand1)" in text
    assert "+ (attached hubcover hand1)" not in text
    assert "- (attached hubcover hand1)" in ask(session, "retract (attached hubcover hand1)")
    assert "- (fits hubcover case)" in ask(session, "retract (object case)")


def test_what_if_plans_for_the_supposed_state(session: Session) -> None:
    with pytest.raises(CommandError, match="what if what"):
        ask(session, "what-if")
    ask(session, "retract (holding hand1 hubcover)", "retract (attached hubcover hand1)")
    text = ask(session, "what-if")
    assert text.splitlines()[-3:] == [
        "then the plan would be:",
        "  1  (pick-up hand1 hubcover)",
        "  2  (insert hubcover case)",
    ]


def test_what_if_an_action_succeeded(session: Session) -> None:
    text = ask(session, "what-if (insert hubcover case)")
    assert "+ (attached hubcover case)" in text
    assert text.endswith("then the goals would be achieved")
    assert ask(session, "what-if (place-down hand1 hubcover)").endswith("(insert hubcover case)")


def test_the_record_stays_untouched(session: Session) -> None:
    before = ask(session, "beliefs")
    ask(session, "assume (object case ^seen no)", "retract (attached hubcover hand1)")
    assert ask(session, "beliefs").splitlines()[1:] != before.splitlines()
    assert ask(session, "forget") == "2 suppositions dropped; the record was never touched"
    assert ask(session, "beliefs") == before
    assert ask(session, "step").startswith("cycle 2\n  (insert hubcover case) succeeded")


def test_the_last_word_on_a_fact_counts(session: Session) -> None:
    ask(session, "assume (object case ^seen no)", "assume (object case ^seen yes)")
    assert ask(session, "what-if").splitlines()[1] == "  nothing else would be believed"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("assume", "assume what"),
        ("assume (free hand1)", "is concluded, by the concept `free`; assume what it follows"),
        ("retract (fits hubcover case)", "retract what it rests on: (object hubcover)"),
        ("assume (holding hand1 ?x)", "has variables"),
        ("retract (holding hand1 case)", "does not hold in cycle 1 anyway"),
        ("assume (wobbly hand1)", "the domain knows no `wobbly`"),
        ("assume (attached case)", "takes 2 arguments"),
        ("what-if (fly away)", "`fly` is no skill; the skills are"),
        ("what-if (insert ?x case)", "has variables"),
    ],
)
def test_what_cannot_be_supposed(session: Session, line: str, message: str) -> None:
    with pytest.raises(CommandError) as raised:
        ask(session, line)
    assert message in str(raised.value)


def test_a_circle_is_refused_with_a_note(session: Session) -> None:
    text = ask(session, "assume (attached hand1 hubcover)")
    assert "refused: (assumed) would attach hand1 to hubcover" in text


def test_what_is_supposed_of_a_persisting_belief_has_the_values_that_were_said() -> None:
    domain, problems = parse_domain(
        "(percepts (block)) (concepts ((blue ?b) :elements ((painted ?b ^colour blue))))"
        "(skills ((redden ?b) :elements ((block ?b)) :actions ((*paint ?b))"
        " :effects ((painted ?b ^colour red))))"
    )
    assert domain is not None, problems
    engine, seen = InferenceEngine(domain), [Percept("block", "b")]
    memory = engine.step(engine.step(Memory(), seen), seen, [Outcome(Action("redden", ("b",)))])
    blue = Edit(Belief("painted", ("b",), {"colour": "blue"}), assumed=True)
    supposed = Supposition((blue,)).applied(memory, engine)
    assert Belief("blue", ("b",)) in supposed.state
