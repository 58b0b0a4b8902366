"""Whose skills are whose: every agent that is asked for something is known, and can do something.

Agents are named in the form `(agents human arm-2)`; without that form, a task names those that
take part in it, and its word is taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from icarus_lite.language.checking.report import Report
from icarus_lite.language.syntax import Constant, Domain, SkillClause, Variable
from icarus_lite.language.wording import listing

_IN_SENTENCE = re.compile(r"\?[\w-]+")


def known_agents(domain: Domain) -> tuple[str, ...]:
    """Give the names of the other agents, in the order in which they are first named."""
    if domain.agents:
        return domain.agents
    return tuple(dict.fromkeys(agent for task in domain.tasks for agent in task.agents))


def variables_of_request(text: str) -> list[str]:
    """Give the variables that are to be filled in in the sentence of a request."""
    return _IN_SENTENCE.findall(text)


def check_agents(domain: Domain, report: Report) -> None:
    """Check that tasks name known agents, and note agents that no skill belongs to."""
    known = known_agents(domain)
    owners = [clause.agent for clause in domain.skills if clause.agent is not None]
    if any(isinstance(owner, Variable) for owner in owners):
        idle = set[str]()
    else:
        idle = set(known).difference(str(owner) for owner in owners)
    for task in domain.tasks:
        for agent in task.agents:
            if agent not in known:
                message = f"the task `{task.name}` names the agent `{agent}`, whom nothing declares"
                report.error(task.span, "ICR048", message, _advice(agent, known, report))
            elif agent in idle:
                message = f"the agent `{agent}` of the task `{task.name}` has no skill"
                hint = f"only what others can do is planned; give it one: :agent {agent}"
                report.note(task.span, "ICR049", message, hint)


def check_owner(clause: SkillClause, known: Iterable[str], report: Report) -> None:
    """Check to whom a skill belongs, and what that agent is told."""
    name, owner = clause.head.predicate, clause.agent
    if owner is None:
        if clause.request is not None or not clause.is_asked:
            place = clause.span if clause.request is None else clause.request.span
            message = f"the skill `{name}` has a `:request`, but nobody is asked"
            hint = "say whose skill it is, such as :agent human; or remove the request"
            report.warning(place, "ICR049", message, hint)
        return
    if clause.subskills:
        message = f"the skill `{name}` of another agent has :subskills"
        hint = "say in :effects what it brings about: how is that agent's own matter"
        report.error(report.name_of(clause.head), "ICR022", message, hint)
    if isinstance(owner, Variable):
        if owner.name not in clause.head.variables:
            message = f"{owner} in :agent of `{name}` is not an argument of it"
            hint = f"write it in the head, so that each step says who does it: ({name} {owner} …)"
            report.error(owner.span, "ICR012", message, hint)
    elif str(owner.value) not in known:
        message = f"nothing declares the agent `{owner}`"
        report.error(owner.span, "ICR048", message, _advice(str(owner.value), known, report))
    _check_sentence(clause, clause.request, report)


def _check_sentence(clause: SkillClause, request: Constant | None, report: Report) -> None:
    if request is None:
        return
    positive = {v for c in clause.elements if not c.negated for v in c.atom.variables}
    bound = positive | set(clause.head.variables)
    for variable in variables_of_request(str(request.value)):
        if variable not in bound:
            message = f"{variable} in :request of `{clause.head.predicate}` is never bound"
            meant = report.closest(variable, bound)
            hint = f"did you mean {meant}?" if meant else "name an argument of the skill"
            report.error(request.span, "ICR012", message, hint)


def _advice(agent: str, known: Iterable[str], report: Report) -> str:
    meant = report.closest(agent, known)
    if meant:
        return f"did you mean `{meant}`?"
    others = listing(f"`{each}`" for each in known)
    return f"the agents are {others}" if others else f"say who works here: (agents {agent})"
