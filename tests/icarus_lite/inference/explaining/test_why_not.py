"""What is said of a belief that is not held, and of a skill that does not start."""

from __future__ import annotations

import pytest

from icarus_lite import Action, Agent, Belief, DomainError, FrameError, Outcome, Percept, Status
from icarus_lite.inference import Context, InferenceEngine, Memory, why_not
from icarus_lite.inference.explaining import (
    Blocked,
    Difference,
    FailedTest,
    Missing,
    Period,
    Unasked,
)
from icarus_lite.language import parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand ^reach) (object ^type ^x ^seen) (part :is object))
(concepts
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((near ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 0.1)))
  ((reachable ?h ?o) :elements ((hand ?h ^reach ?r) (object ?o ^seen yes ^x ?x))
                     :tests ((< ?x ?r)))
  ((graspable ?o) :elements ((object ?o ^type plug)))
  ((graspable nut) :elements ((object nut)))
  ((gap ?a ?b ^size ?d) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                        :binds ((?d (- ?xb ?xa))))
  ((middling ?o) :elements ((object ?o ^x ?x)) :tests ((and (< 0 ?x) (or (< ?x 0.2) (> ?x 2)))))
  ((shapely ?o) :elements ((object ?o ^x ?x)) :tests ((fits ?x)))
  ((upright ?o) :elements ((object ?o) (not (not-upright ?o)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (graspable ?o) (reachable ?h ?o))
                   :while ((hand ?h ^reach 0.5))
                   :actions ((*grasp ?h ?o)) :effects ((holding ?h ?o)))
  ((drop ?h) :elements ((hand ?h)) :actions ((*open ?h)) :effects ((not (holding ?h ?any)))) ; noqa
  ((straighten ?o) :elements ((object ?o)) :actions ((*turn ?o))
                   :effects ((upright ?o) (not (not-upright ?o)))))
(attachments ((pick-up ?h ?o) :until (drop ?h) :child ?o :parent ?h))
(task tidy :goal ((upright plug)) :init ((not-upright case)))
""")


def fits(x: float) -> bool:
    return x > 5


HAND = Percept("hand", "h", {"reach": 0.8})
PLUG = Percept("object", "plug", {"type": "plug", "x": 0.5, "seen": "yes"})
CASE = Percept("object", "case", {"type": "case", "x": 0.75, "seen": "no"})
SCREW = Percept("part", "screw", {"x": 0.9})
SCENE = (HAND, PLUG, CASE, SCREW)
PICK = Outcome(Action("pick-up", ("h", "plug")))


@pytest.fixture
def agent() -> Agent:
    assert DOMAIN is not None, PROBLEMS
    agent = Agent(DOMAIN, functions={"fits": fits})
    agent.cycle(SCENE)
    return agent


def lines(agent: Agent, asked: str) -> list[str]:
    return [line.strip() for line in str(agent.why_not(asked)).splitlines()[1:]]


class TestBeliefs:
    def test_the_sides_of_the_test_that_fails(self, agent: Agent) -> None:
        answer = agent.why_not("(reachable h screw)")
        (verdict,) = answer.clauses
        assert isinstance(verdict.reason, Missing)
        assert verdict.reason.differences == (Difference("seen", "yes", None),)
        (reason,) = [each.reason for each in agent.why_not("(near plug case)").clauses]
        assert isinstance(reason, FailedTest)
        assert reason.sides == (0.25, 0.1)
        assert str(reason) == "(< (abs (- 0.5 0.75)) 0.1) fails: 0.25 is not less than 0.1"

    def test_the_part_of_an_and_that_decides(self, agent: Agent) -> None:
        (reason,) = [each.reason for each in agent.why_not("(middling plug)").clauses]
        assert isinstance(reason, FailedTest)
        assert str(reason.deciding) == "(or (< 0.5 0.2) (> 0.5 2))"
        assert str(reason).endswith("fails: none of its parts holds")

    def test_a_python_function_is_shown_with_what_it_was_asked(self, agent: Agent) -> None:
        assert lines(agent, "(shapely plug)")[-1] == "(fits 0.5) fails: (fits 0.5) is false"

    def test_the_attribute_that_differs(self, agent: Agent) -> None:
        assert lines(agent, "(reachable h case)") == [
            "line 7, (reachable h case): 2 of 3 conditions hold",
            "nothing matches (object case ^seen yes ^x 0.75): case has ^seen no, not yes",
        ]

    def test_the_belief_that_blocks_a_not_and_why_it_is_held(self, agent: Agent) -> None:
        agent.cycle(SCENE, PICK)
        (verdict,) = agent.why_not("(free h)").clauses
        assert isinstance(verdict.reason, Blocked)
        (blocker,) = verdict.reason.blockers
        assert (blocker.belief, verdict.reason.more) == (Belief("holding", ("h", "plug")), 0)
        assert blocker.because == "because (pick-up h plug) succeeded, reported in cycle 1"

    def test_a_variable_takes_what_comes_closest(self, agent: Agent) -> None:
        (verdict,) = agent.why_not("(near ?which case)").clauses
        assert str(verdict.head) == "(near screw case)"
        assert isinstance(verdict.reason, FailedTest)

    def test_a_variable_asked_for_twice_must_agree(self, agent: Agent) -> None:
        (verdict,) = agent.why_not("(near ?x ?x)").clauses
        assert str(verdict.reason) == "(/= case case) fails: case is the same as case"

    def test_a_missing_belief_is_followed_down(self, agent: Agent) -> None:
        agent.cycle((HAND, CASE))
        deeper = [each.deeper for each in agent.why_not("(pick-up h case)").clauses]
        assert [str(each.asked) for each in deeper if each] == ["(graspable case)"]

    def test_a_head_with_another_constant_cannot_stand_for_it(self, agent: Agent) -> None:
        first, second = agent.why_not("(graspable case)").clauses
        assert (first.fits, second.fits) == (True, False)
        assert str(second) == "line 10, (graspable nut): its head cannot stand for this"

    def test_a_computed_attribute_that_differs_is_a_test_that_fails(self, agent: Agent) -> None:
        (verdict,) = agent.why_not("(gap plug case ^size 3)").clauses
        assert str(verdict.reason) == "(= (- 0.75 0.5) 3) fails: 0.25 is not 3"

    def test_an_attribute_that_another_clause_decides(self) -> None:
        domain, _ = parse_domain(
            "(percepts (o)) (concepts ((size ?o ^is 2) :elements ((o ?o)))"
            " ((size ?o ^is 1) :elements ((o ?o))))"
        )
        assert domain is not None
        agent = Agent(domain)
        agent.cycle([Percept("o", "a")])
        answer = agent.why_not("(size a ^is 1)")
        assert str(answer.reason) == "nothing matches (size a ^is 1): a has ^is 2, not 1"
        first, second = answer.clauses
        assert not first.fits
        assert str(second).endswith("; what else it follows from decides its attributes")

    def test_what_nothing_binds_cannot_be_asked(self) -> None:
        text = """(percepts (o ^x)) (concepts
          ((p ?a) :elements ((q ?a) (not (r ?a)))) ((q ?a) :elements ((o ?a))) ((r ?a) :elements
          ((o ?a ^x 1))))"""
        domain, _ = parse_domain(text)
        assert domain is not None
        agent = Agent(domain)
        agent.cycle([])
        (verdict,) = agent.why_not("(p ?a)").clauses
        assert verdict.attempt is not None
        assert isinstance(verdict.reason, Missing)
        unasked = verdict.attempt.checked[1]
        assert str(Unasked(unasked.bound)).endswith("cannot be asked: nothing binds its variables")

    def test_what_is_believed_is_said_to_be_and_why(self, agent: Agent) -> None:
        answer = agent.why_not("(graspable ?x)")
        assert answer.holds
        assert str(answer).splitlines() == [
            "(graspable ?x) is believed in cycle 0",
            "  (graspable plug)  by its definition (line 9)",
        ]

    def test_a_negated_literal_asks_what_is_in_its_way(self, agent: Agent) -> None:
        assert agent.why_not("(not (near ?a ?b))").holds
        answer = agent.why_not("(not (object ?any ^seen ?_s))")
        assert isinstance(answer.reason, Blocked)
        assert [str(b.belief) for b in answer.reason.blockers] == ["(object case)", "(object plug)"]
        assert "are perceived" in str(answer)

    def test_the_text_may_be_a_belief(self, agent: Agent) -> None:
        assert not agent.why_not(Belief("free", ("g",))).holds


class TestPercepts:
    def test_another_type(self, agent: Agent) -> None:
        assert lines(agent, "(hand plug)") == [
            "nothing matches (hand plug): plug is perceived as `object`"
        ]

    def test_a_subtype_counts_as_its_supertype(self, agent: Agent) -> None:
        assert agent.why_not("(object screw)").holds
        assert not agent.why_not("(part plug)").holds

    def test_an_attribute_that_is_missing(self, agent: Agent) -> None:
        assert lines(agent, "(object screw ^type nut)") == [
            "nothing matches (object screw ^type nut): screw has no ^type"
        ]

    def test_one_that_was_never_perceived(self, agent: Agent) -> None:
        assert lines(agent, "(object plugg)") == [
            (
                "nothing matches (object plugg): nothing named plugg has ever been perceived; "
                "did you mean plug?"
            )
        ]

    def test_one_that_is_no_longer_perceived(self, agent: Agent) -> None:
        agent.cycle((HAND, CASE))
        agent.cycle((HAND, CASE))
        assert lines(agent, "(object plug)") == [
            "nothing matches (object plug): plug is no longer perceived; it last was in cycle 0"
        ]

    def test_none_at_all(self, agent: Agent) -> None:
        agent.cycle((PLUG,))
        assert lines(agent, "(hand ?h)") == ["nothing matches (hand ?h): no `hand` is perceived"]

    def test_none_like_it_but_others(self, agent: Agent) -> None:
        assert lines(agent, "(object ?o ^type nut)")[0].startswith(
            "nothing matches (object ?o ^type nut); nearest: (object case ^type case"
        )


class TestImpossible:
    @pytest.mark.parametrize(
        ("asked", "reason"),
        [
            (
                "(frea h)",
                "no percept, concept, effect or skill is called `frea`; did you mean `free`?",
            ),
            ("(near plug)", "`near` takes 2 arguments, not 1"),
            ("(free h h)", "`free` takes 1 argument, not 2"),
            (
                "(object plug ^tipe plug)",
                "`object` never has an attribute ^tipe; did you mean ^type?",
            ),
            ("(pick-up h)", "the skill `pick-up` takes 2 arguments, not 1"),
        ],
    )
    def test_a_slip_of_the_pen(self, agent: Agent, asked: str, reason: str) -> None:
        assert lines(agent, asked) == [reason]

    def test_no_clause_and_no_effect_fits(self) -> None:
        domain, _ = parse_domain("(percepts (o)) (concepts ((color ?o red) :elements ((o ?o))))")
        assert domain is not None
        state = InferenceEngine(domain).step(Memory(), [Percept("o", "a")]).state
        answer = why_not("(color a blue)", Context(domain, state))
        assert answer.impossible == (
            (
                "no concept and no effect ever makes (color a blue) true: their constants differ "
                "from it"
            ),
        )

    def test_nothing_attaches_anything(self) -> None:
        domain, _ = parse_domain("(percepts (o)) (concepts ((p ?o) :elements ((o ?o))))")
        assert domain is not None
        answer = why_not("(attached a b)", Context(domain, Memory().state))
        assert answer.impossible == ("no action ever attaches anything",)
        assert str(answer).startswith("(attached a b) can never be believed")


class TestAsserted:
    def test_who_would_assert_it(self, agent: Agent) -> None:
        assert lines(agent, "(holding h ?what)") == [
            "the success of (pick-up h ?o) (line 17) would assert it"
        ]
        assert lines(agent, "(attached plug h)") == [
            "the success of (pick-up h plug) (line 23) would assert it"
        ]

    def test_what_was_tried(self, agent: Agent) -> None:
        agent.cycle(SCENE, Outcome(PICK.action, Status.FAILED, "it slipped"))
        assert lines(agent, "(holding h plug)")[-1] == (
            "(pick-up h plug) was reported as failed in cycle 1: it slipped"
        )
        agent.cycle(SCENE, Outcome(PICK.action, Status.RUNNING))
        assert lines(agent, "(holding h plug)")[-1] == (
            "(pick-up h plug) was still running in cycle 2"
        )
        assert lines(agent, "(holding h case)")[-1].startswith("the success of")

    def test_when_it_was_believed_and_what_ended_it(self, agent: Agent) -> None:
        agent.cycle(SCENE, PICK)
        agent.cycle(SCENE)
        agent.cycle(SCENE, Outcome(Action("drop", ("h",))))
        answer = agent.why_not("(holding h ?any)")
        (past,) = answer.past
        assert past.periods == (Period(1, 2),)
        assert str(past) == (
            "(holding h plug) was believed in cycles 1 to 2; "
            "(drop h) removed it, reported in cycle 3"
        )
        assert lines(agent, "(attached plug h)")[-1] == (
            "(attached plug h) was believed in cycles 1 to 2; "
            "(drop h) detached it, reported in cycle 3"
        )

    def test_it_ended_with_its_object(self, agent: Agent) -> None:
        agent.cycle(SCENE, PICK)
        agent.cycle((HAND,))
        assert lines(agent, "(holding h plug)") == [
            "plug is no longer perceived; it last was in cycle 1",
            "the success of (pick-up h plug) (line 17) would assert it",
            "(holding h plug) was believed in cycle 1; plug was no longer perceived in cycle 2",
        ]

    def test_of_many_periods_the_last_ones_are_told(self, agent: Agent) -> None:
        for _ in range(5):
            agent.cycle(SCENE, PICK)
            agent.cycle(SCENE, Outcome(Action("drop", ("h",))))
        (past,) = agent.why_not("(holding h plug)").past
        assert "5 times, last in cycle 5, in cycle 7, in cycle 9; (drop h)" in str(past)

    def test_an_effect_on_a_concept_is_only_expected(self) -> None:
        assert DOMAIN is not None
        engine = InferenceEngine(DOMAIN, {"fits": fits})
        memory = engine.step(
            Memory(asserted={Belief("not-upright", ("case",)): None}),
            SCENE,  # type: ignore[dict-item]
        )
        answer = why_not("(upright case)", Context(DOMAIN, memory.state))
        assert str(answer.sources[0]) == (
            "(straighten case) (line 21) is expected to bring it about, but perception decides"
        )


class TestSkills:
    def test_the_first_condition_that_fails(self, agent: Agent) -> None:
        answer = agent.why_not("(pick-up h case)")
        assert answer.is_skill
        assert not answer.holds
        (verdict,) = answer.clauses
        assert str(verdict.reason) == "nothing matches (graspable case); nearest: (graspable plug)"

    def test_one_that_can_start_says_so_and_what_would_break_it(self, agent: Agent) -> None:
        answer = agent.why_not("(pick-up h plug)")
        assert answer.holds
        assert str(answer).splitlines() == [
            "(pick-up h plug) can start in cycle 0",
            "  line 17, (pick-up h plug): all its conditions hold",
            (
                "    by its :while it would be broken off: nothing matches (hand h ^reach 0.5): "
                "h has ^reach 0.8, not 0.5"
            ),
        ]

    def test_effects_that_are_so_already(self, agent: Agent) -> None:
        (verdict,) = agent.why_not("(drop h)").clauses
        assert verdict.readiness is not None
        assert verdict.readiness.is_idle
        assert str(verdict.readiness) == (
            "it would change nothing: (not (holding h ?any)) and (not (attached ?o h)) are so "
            "already"
        )

    def test_some_effects_that_are_so_already(self, agent: Agent) -> None:
        (verdict,) = agent.why_not("(straighten plug)").clauses
        assert verdict.readiness is not None
        assert str(verdict.readiness).startswith("it would change nothing: (upright plug)")
        agent.cycle(SCENE, PICK)
        (verdict,) = agent.why_not("(drop h)").clauses
        assert verdict.readiness is not None
        assert str(verdict.readiness) == "none of its effects is so yet"

    def test_how_it_fared(self, agent: Agent) -> None:
        agent.cycle(SCENE, Outcome(PICK.action, Status.FAILED, "it slipped"))
        assert lines(agent, "(pick-up h ?o)")[-1].endswith("failed in cycle 1: it slipped")

    def test_an_object_nobody_has_seen(self, agent: Agent) -> None:
        assert "nothing named g has ever been perceived" in lines(agent, "(pick-up g plug)")


class TestBadInput:
    def test_more_than_one_literal(self, agent: Agent) -> None:
        with pytest.raises(FrameError, match="expected one literal"):
            agent.why_not("((free h) (free g))")

    def test_what_does_not_parse(self, agent: Agent) -> None:
        with pytest.raises(DomainError, match="<goal>:1"):
            agent.why_not("(free h")


def test_the_same_question_gets_the_same_answer(agent: Agent) -> None:
    assert agent.why_not("(near ?a ?b)") == agent.why_not("(near ?a ?b)")


def test_the_order_of_the_percepts_does_not_matter() -> None:
    assert DOMAIN is not None
    engine = InferenceEngine(DOMAIN, {"fits": fits})
    answers = set()
    for scene in (SCENE, tuple(reversed(SCENE))):
        context = Context(DOMAIN, engine.step(Memory(), scene).state, engine.evaluator)
        asked = ["(near ?a ?b)", "(reachable ?h case)", "(pick-up h ?o)", "(object ?x ^type ?x)"]
        answers.add("\n".join(str(why_not(each, context)) for each in asked))
    assert len(answers) == 1


def test_following_missing_beliefs_down_comes_to_an_end() -> None:
    domain, _ = parse_domain(
        "(percepts (o ^up)) (concepts ((on ?a ?b) :elements ((o ?a ^up ?b)))"
        " ((above ?a ?b) :elements ((on ?a ?b)))"
        " ((above ?a ?c) :elements ((on ?a ?b) (above ?b ?c))))"
    )
    assert domain is not None
    percepts = [Percept("o", f"o{n}", {"up": f"o{n + 1}"}) for n in range(9)]
    state = InferenceEngine(domain).step(Memory(), percepts).state
    answer = why_not("(above o0 floor)", Context(domain, state), depth=3)
    deep, verdicts = 0, answer.clauses
    while verdicts and verdicts[-1].deeper is not None:
        deep, verdicts = deep + 1, verdicts[-1].deeper.clauses
    assert deep == 3
