from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.inference import Withdrawal
from icarus_lite.inference.explaining import Chronicle, Period, what_ended
from icarus_lite.language import parse_atom, parse_domain
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.symbols import Action, Belief

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand) (object))
(concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h) (object ?o)) :actions ((*grasp ?h ?o))
                   :effects ((holding ?h ?o) (not (free ?h))))
  ((drop ?h) :elements ((hand ?h)) :actions ((*open ?h)) :effects ((not (holding ?h ?any)))) ; noqa
  ((glue ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*glue ?a ?b))
                :effects ((attached ?a ?b))))
(attachments
  ((pick-up ?h ?o) :until (drop ?h) :child ?o :parent ?h)
  ((insert ?o ?into) :until (take-out ?o ?into) :child ?o :parent ?into))
""")
assert DOMAIN is not None, PROBLEMS

HOLDING = Belief("holding", ("h", "o"))
ATTACHED = Belief("attached", ("o", "h"))


def ended(belief: Belief, *outcomes: Outcome, present: tuple[str, ...] = ("h", "o")) -> str:
    """Say what ended a belief held in cycles 0 and 1, by what was reported in cycle 2."""
    chronicle = Chronicle()
    chronicle.record(0, [belief], [], present=("h", "o"))
    chronicle.record(1, [], [], present=("h", "o"))
    chronicle.record(2, [], [belief], outcomes, present)
    (period,) = chronicle.periods(belief)
    assert period == Period(0, 1)
    return what_ended(belief, period, chronicle, DOMAIN)


def done(name: str, *args: str, status: Status = Status.SUCCEEDED) -> Outcome:
    return Outcome(Action(name, args), status)


def test_a_removing_effect_is_blamed_free_variables_and_all() -> None:
    assert ended(HOLDING, done("drop", "h")) == "(drop h) removed it, reported in cycle 2"


def test_an_action_that_failed_or_is_about_others_is_not_blamed() -> None:
    assert ended(HOLDING, done("drop", "h", status=Status.FAILED), done("drop", "g")) == ""


def test_a_detach_ends_an_attachment() -> None:
    assert ended(ATTACHED, done("drop", "h")) == "(drop h) detached it, reported in cycle 2"


def test_a_new_parent_ends_the_old_attachment() -> None:
    assert ended(ATTACHED, done("insert", "o", "case")) == (
        "(insert o case) attached it to case instead, reported in cycle 2"
    )
    assert ended(ATTACHED, done("glue", "o", "b")) == (
        "(glue o b) attached it elsewhere, reported in cycle 2"
    )
    assert ended(ATTACHED, done("glue", "a", "b"), done("insert", "a", "case")) == ""


def test_a_vanished_object_takes_what_is_asserted_of_it_along() -> None:
    assert ended(HOLDING, present=("h",)) == "o was no longer perceived in cycle 2"


def test_no_action_is_blamed_for_what_concepts_define() -> None:
    assert ended(Belief("free", ("h",)), done("pick-up", "h", "o")) == ""


def test_what_lasts_has_not_ended() -> None:
    chronicle = Chronicle()
    chronicle.record(0, [HOLDING], [])
    (period,) = chronicle.periods(HOLDING)
    assert (str(period), what_ended(HOLDING, period, chronicle, DOMAIN)) == ("from cycle 0 on", "")


def test_periods_read_as_they_are() -> None:
    assert [str(Period(3, 3)), str(Period(3, 5))] == ["in cycle 3", "in cycles 3 to 5"]


def test_a_belief_from_before_the_record_is_taken_to_be_from_its_beginning() -> None:
    chronicle = Chronicle()
    chronicle.record(4, [], [])
    chronicle.record(5, [], [HOLDING])
    assert chronicle.periods(HOLDING) == (Period(4, 4),)


def test_reports_are_latest_first() -> None:
    chronicle = Chronicle()
    chronicle.record(0, [], [], [done("drop", "a")])
    chronicle.record(3, [], [], [done("drop", "b"), done("drop", "c")])
    assert [(cycle, str(o.action)) for cycle, o in chronicle.reports()] == [
        (3, "(drop c)"),
        (3, "(drop b)"),
        (0, "(drop a)"),
    ]
    assert chronicle.outcomes(1) == ()


def test_when_an_object_was_perceived_last() -> None:
    chronicle = Chronicle()
    for cycle, present in enumerate([("a", "b"), ("a",), ("a", "b"), ()]):
        chronicle.record(cycle, [], [], present=present)
    assert [chronicle.last_perceived(name) for name in "abc"] == [2, 2, None]
    assert [chronicle.gone(cycle) for cycle in range(4)] == [
        frozenset(),
        frozenset("b"),
        frozenset(),
        frozenset("ab"),
    ]


BELIEFS = [Belief("p", (name,)) for name in "abc"]


@given(st.lists(st.frozensets(st.sampled_from(BELIEFS)), max_size=12))
def test_periods_are_the_cycles_in_which_it_was_held(history: list[frozenset[Belief]]) -> None:
    chronicle, before = Chronicle(), frozenset[Belief]()
    for cycle, held in enumerate(history):
        chronicle.record(cycle, held - before, before - held)
        before = held
    for belief in BELIEFS:
        told = {
            cycle
            for period in chronicle.periods(belief)
            for cycle in range(
                period.first, (len(history) - 1 if period.last is None else period.last) + 1
            )
        }
        assert told == {cycle for cycle, held in enumerate(history) if belief in held}
    asked = dict(chronicle.matching(parse_atom("(p ?x)")))
    assert set(asked) == set[Belief]().union(*history)


def test_what_was_over_long_ago_is_forgotten() -> None:
    short, whole = Chronicle(changes_kept=10), Chronicle()
    p, q, r = (Belief("p", (name,)) for name in "abc")
    held = frozenset[Belief]()
    for cycle in range(60):
        now = frozenset([r, p] if cycle % 2 else [r, *([q] if cycle < 3 else [])])
        outcomes = [Outcome(Action("push", (cycle,)))] if cycle % 3 == 0 else []
        for each in (short, whole):
            each.record(cycle, sorted(now - held, key=str), held - now, outcomes, ["a"])
        held = now
    assert short.first > 40
    assert short.periods(r) == whole.periods(r) == (Period(0),)
    assert short.periods(q) == ()
    assert short.periods(p) == tuple(
        each for each in whole.periods(p) if (each.last or 60) >= short.first - 1
    )
    assert [cycle for cycle, _ in short.reports()] == [
        cycle for cycle, _ in whole.reports() if cycle >= short.first
    ]
    assert [belief for belief, _ in short.matching(parse_atom("(p ?x)"))] == [r, p]


def test_a_contradiction_is_blamed_before_any_action() -> None:
    withdrawal = Withdrawal(HOLDING, ("(hand h ^empty yes)", "(not (moves o))"), 2)
    chronicle = Chronicle()
    chronicle.record(0, [HOLDING, ATTACHED], [])
    chronicle.record(1, [], [HOLDING, ATTACHED], [done("drop", "h")], withdrawn=[withdrawal])
    period = Period(0, 0)
    assert what_ended(HOLDING, period, chronicle, DOMAIN) == (
        "withdrawn in cycle 1, because (hand h ^empty yes) and (not (moves o)) held for 2 cycles"
    )
    assert what_ended(ATTACHED, period, chronicle, DOMAIN).startswith("(drop h) detached it")
    assert list(chronicle.withdrawals()) == [(1, withdrawal)]


def test_what_was_withdrawn_is_forgotten_with_its_cycle() -> None:
    chronicle = Chronicle(changes_kept=4)
    for cycle in range(0, 20, 2):
        belief = Belief("holding", ("h", f"o{cycle}"))
        chronicle.record(cycle, [belief], [])
        chronicle.record(cycle + 1, [], [belief], withdrawn=[Withdrawal(belief, ("(p)",))])
    kept = [cycle for cycle, _ in chronicle.withdrawals()]
    assert kept == [17, 19]
    assert chronicle.first == 16
    assert chronicle.periods(Belief("holding", ("h", "o16"))) == (Period(16, 16),)
    assert chronicle.periods(Belief("holding", ("h", "o14"))) == ()
