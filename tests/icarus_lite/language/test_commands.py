from __future__ import annotations

from icarus_lite.language import check_commands, parse_domain, render

TEXT = """(percepts (object))
(skills
  ((lift ?o) :elements ((object ?o)) :actions ((*grap ?o)) :effects ((up ?o)))
  ((weld ?o) :elements ((object ?o)) :actions ((*weld ?o)) :effects ((hot ?o))))"""

SAID = """\
d.icr:3:50: error[ICR035]: no driver offers the command `*grap`
    3 |   ((lift ?o) :elements ((object ?o)) :actions ((*grap ?o)) :effects ((up ?o)))
      |                                                  ^^^^
   hint: did you mean `*grasp`?
d.icr:4:50: error[ICR035]: no driver offers the command `*weld`
    4 |   ((weld ?o) :elements ((object ?o)) :actions ((*weld ?o)) :effects ((hot ?o))))
      |                                                  ^^^^
   hint: it offers `*grasp` and `*place`"""


def test_what_no_driver_offers_is_shown_at_its_place():
    domain, _ = parse_domain(TEXT, "d.icr")
    found = check_commands(domain, {"grasp", "place"})
    assert "\n".join(render(d, domain.source) for d in found) == SAID


def test_nothing_is_said_of_what_is_offered():
    domain, _ = parse_domain(TEXT)
    assert check_commands(domain, {"grap", "weld"}) == ()


def test_what_another_agent_does_needs_no_driver_of_ours():
    text = """(agents arm-2) (percepts (part))
    (skills ((weld ?p) :agent arm-2 :elements ((part ?p)) :actions ((*weld ?p)) :effects ((ok ?p))))
    (task 1 :goal ((ok p1)))"""
    domain, found = parse_domain(text)
    assert domain is not None, found
    assert check_commands(domain, {"grasp"}) == ()
