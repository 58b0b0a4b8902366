"""Forms and fields that few domains have: percept subtypes, agents, long-term goals, breaks."""

from __future__ import annotations

import pytest

from icarus_lite.language import (
    check_domain,
    format_text,
    parse_atom,
    parse_conditions,
    parse_domain,
)
from icarus_lite.language.breakpoint import Breakpoint, Moment
from icarus_lite.language.keywords import MOMENTS
from icarus_lite.language.syntax import Condition, LongTermGoal, Task


def read(text):
    domain, found = parse_domain(text, "d.icr")
    assert domain is not None, found
    return domain, [each.code for each in found]


def test_long_term_goals():
    text = """(long-term-goal tidy :goal ((clean ?t) (not (wet ?t))) :relevance (table ?t)
              :priority 2.5)
              (long-term-goal rest :goal (asleep me))"""
    domain, codes = read(text)
    tidy, rest = domain.long_term_goals
    assert tidy == LongTermGoal(
        "tidy",
        parse_conditions("((clean ?t) (not (wet ?t)))"),
        parse_conditions("(table ?t)"),
        2.5,
    )
    assert (rest.relevance, rest.priority) == ((), 0.0)
    assert codes == []


def test_a_long_term_goal_may_be_kept_up_and_have_a_priority_that_is_perceived():
    text = """(percepts (table ^dirt))
    (skills ((wipe ?t) :elements ((table ?t)) :actions ((*wipe ?t)) :effects ((clean ?t))))
    (long-term-goal tidy :goal ((clean ?t)) :relevance ((table ?t ^dirt ?dirt)) :priority ?dirt
     :maintain yes)
    (long-term-goal rest :goal ((clean bench)) :maintain no)"""
    domain, codes = read(text)
    tidy, rest = domain.long_term_goals
    assert (str(tidy.priority), tidy.maintain, rest.maintain) == ("?dirt", True, False)
    assert codes == []
    assert check_domain(domain) == ()
    assert read(format_text(text))[0] == domain
    unbound, _ = read(text.replace(":priority ?dirt", ":priority ?dirty"))
    found = [(each.code, each.hint) for each in check_domain(unbound)]
    assert found == [("ICR012", "did you mean ?dirt?")]
    twice, _ = read(text.replace("rest", "tidy"))
    assert [each.code for each in check_domain(twice)] == ["ICR011"]


def test_whether_a_goal_is_kept_up_is_yes_or_no():
    domain, found = parse_domain("(long-term-goal g :goal (a) :maintain always)", "d.icr")
    assert domain is None
    assert [(each.code, each.message) for each in found] == [
        ("ICR009", "`:maintain` takes yes or no, not `always`")
    ]


AGENTS = """(agents human arm-2)
(percepts (base) (human))
(skills
  ((hold ?base)
   :agent human
   :elements ((base ?base) (not (held ?base)))
   :effects ((held ?base))
   :request "please hold ?base"
   :cost 3
   :timeout 30)
  ((inspect ?who ?base)
   :agent ?who
   :elements ((human ?who) (base ?base))
   :effects ((inspected ?base))
   :request no)
  ((glue ?base)
   :elements ((held ?base) (inspected ?base))
   :actions ((*glue ?base))
   :effects ((glued ?base))))
(task 1 :agents (human) :goal ((glued base1)))
"""


def test_skills_of_other_agents():
    domain, codes = read(AGENTS)
    hold, inspect, glue = domain.skills
    assert domain.agents == ("human", "arm-2")
    assert (str(hold.agent), str(hold.request), hold.is_asked, hold.cost, hold.timeout_s) == (
        "human",
        '"please hold ?base"',
        True,
        3,
        30.0,
    )
    assert (str(inspect.agent), inspect.request, inspect.is_asked, inspect.cost) == (
        "?who",
        None,
        False,
        None,
    )
    assert (glue.agent, glue.is_asked, glue.cost) == (None, True, None)
    assert [skill.is_primitive for skill in domain.skills] == [True, True, True]
    assert codes == []
    assert check_domain(domain) == ()
    assert read(format_text(AGENTS))[0] == domain


@pytest.mark.parametrize(
    ("right", "wrong", "code", "message"),
    [
        (":agent human", ":agent humen", "ICR048", "nothing declares the agent `humen`"),
        (":agent ?who", ":agent ?base2", "ICR012", "?base2 in :agent of `inspect` is not an"),
        ('hold ?base"', 'hold ?bass."', "ICR012", "?bass in :request of `hold` is never bound"),
        (":agents (human)", ":agents (hum)", "ICR048", "the task `1` names the agent `hum`"),
        (
            ":agent human",
            ":agent human :subskills ((glue ?base))",
            "ICR022",
            "the skill `hold` of another agent has :subskills",
        ),
        (
            ":actions ((*glue ?base))",
            ":actions ((*glue ?base)) :request no",
            "ICR049",
            "the skill `glue` has a `:request`, but nobody is asked",
        ),
        (":actions ((*glue ?base))", "", "ICR022", "the skill `glue` has nothing to do"),
    ],
)
def test_what_can_be_wrong_with_agents(right, wrong, code, message):
    domain, _ = read(AGENTS.replace(right, wrong, 1))
    found = check_domain(domain)
    assert [each.code for each in found] == [code]
    assert found[0].message.startswith(message)


@pytest.mark.parametrize(
    ("right", "wrong", "code", "message"),
    [
        ("(agents human arm-2)", "(agents human human)", "ICR011", "the agent `human` is named"),
        (":request no", ":request perhaps", "ICR009", "`:request` takes a string or no"),
        (":cost 3", ":cost 0", "ICR010", "a cost of 0 cannot be counted with"),
        (":cost 3", ":cost 1.5", "ICR010", "a cost of 1.5 cannot be counted with"),
        (":agent human", ":agent (human)", "ICR009", "expected a variable or a name"),
    ],
)
def test_what_cannot_be_read_of_agents(right, wrong, code, message):
    domain, found = parse_domain(AGENTS.replace(right, wrong, 1), "d.icr")
    assert domain is None
    assert found[0].code == code
    assert found[0].message.startswith(message)


def test_breakpoints_are_beliefs_or_skills():
    text = """(percepts (hand ^x))
    (skills ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :effects ((at ?h))))
    (break (at ?h) (not (hand ?any)) (go h1))"""
    domain, codes = read(text)
    believed = parse_conditions("((at ?h) (not (hand ?any)))")
    assert domain.breakpoints == (
        *(Breakpoint(each, Moment.GAIN) for each in believed),
        Breakpoint(Condition(parse_atom("(go h1)")), Moment.START),
    )
    assert codes == []
    assert check_domain(domain) == ()
    wrong, _ = read(text.replace("(go h1)", "(go h1 h2) (aat ?h)"))
    assert [each.code for each in check_domain(wrong)] == ["ICR014", "ICR013"]


CLAUSES = """(percepts (hand ^x))
(concepts ((left ?h) :elements ((hand ?h ^x 1)) :break on-loss)
          ((right ?h) :elements ((hand ?h ^x 2)) :break (on-gain on-loss)))
(skills ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :effects ((at ?h))
         :break (on-success on-failure) :timeout 3))
"""


def test_a_clause_says_when_to_stop_at_its_head():
    domain, codes = read(CLAUSES)
    assert [(str(stop.condition), stop.moment) for stop in domain.breakpoints] == [
        ("(left ?h)", Moment.LOSS),
        ("(right ?h)", Moment.GAIN),
        ("(right ?h)", Moment.LOSS),
        ("(go ?h)", Moment.SUCCESS),
        ("(go ?h)", Moment.FAILURE),
    ]
    assert codes == []
    assert check_domain(domain) == ()
    assert read(format_text(CLAUSES))[0] == domain


def test_every_moment_has_a_keyword_and_every_keyword_a_moment():
    words = [name for moments in MOMENTS.values() for name in moments]
    assert words == [moment.value for moment in Moment]


def test_a_moment_must_be_one_of_the_concept_or_skill():
    domain, found = parse_domain(CLAUSES.replace("on-loss)", "on-lost)").replace("on-f", "on-"))
    assert domain is None
    assert [(each.code, each.message, each.hint) for each in found] == [
        (
            "ICR046",
            "`on-lost` is no moment at which to stop at a concept",
            "did you mean `on-loss`? the moments of a concept are on-gain and on-loss",
        )
    ] * 2 + [
        (
            "ICR046",
            "`on-ailure` is no moment at which to stop at a skill",
            (
                "did you mean `on-failure`? the moments of a skill are on-start, on-success and "
                "on-failure"
            ),
        )
    ]


def test_an_older_clause_may_stop_as_well():
    older = CLAUSES.replace("(concepts", "(create-concepts").replace("(skills", "(create-skills")
    assert read(older)[0] == read(CLAUSES)[0]


def test_a_head_is_checked_once_however_often_a_run_stops_at_it():
    wrong = CLAUSES.replace("((right ?h)", "((left ?h ?h)")
    assert [each.code for each in check_domain(read(wrong)[0])] == ["ICR014"]


def test_the_agents_of_a_task():
    domain, codes = read("(task 1 :agents (human arm-2) :robot ur5 :goal (a))")
    assert domain.tasks == (Task("1", "", "ur5", parse_conditions("(a)"), ("human", "arm-2")),)
    assert codes == []
    assert read("(task 1 :agents () :goal (a))")[1] == []
    idle = [each.code for each in check_domain(domain) if "agent" in each.message]
    assert idle == ["ICR049", "ICR049"]


def test_a_breakpoint_at_what_is_never_known_is_no_error_of_the_reader():
    _, found = parse_domain("(break (a))", "d.icr")
    assert found == ()


def test_older_problems_are_tasks():
    domain, codes = read("(create-problems ((on a b) (on b c)) ((on c a)) ())")
    assert [(task.name, len(task.goals)) for task in domain.tasks] == [
        ("problem-1", 2),
        ("problem-2", 1),
        ("problem-3", 0),
    ]
    assert codes == ["ICR028"]
    assert "ICR021" in [each.code for each in check_domain(domain)]


def test_the_older_action_and_attributes_mean_the_same_as_the_modern_fields():
    older = """(skills ((go ?h) :action (*go ?h fast)))
    (concepts ((wide ?b ^w ?w) :elements ((b ?b ^l ?l)) :attributes ((?w (+ ?l 1)))))"""
    modern = older.replace(":action (*go ?h fast)", ":actions ((*go ?h fast))")
    domain, codes = read(older)
    assert domain == read(modern.replace(":attributes", ":binds"))[0]
    assert domain.skills[0].actions == (parse_atom("(go ?h fast)"),)
    assert codes == ["ICR028", "ICR028"]
