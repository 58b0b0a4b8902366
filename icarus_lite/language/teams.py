"""A domain as one of its agents has it: which skills are its own, and whom it can ask."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from icarus_lite.language.checking.agents import known_agents, variables_of_request
from icarus_lite.language.syntax import Call, Constant, Domain, SkillClause, Variable
from icarus_lite.records import replace
from icarus_lite.symbols import Value

OWN_COST = 1
"""What a skill of one's own counts for in a plan."""

COST_OF_ASKING = 10
"""What a skill of another agent counts for in a plan: as much as ten of one's own."""


def domain_of(
    domain: Domain, me: str | None = None, others: Collection[str] | None = None
) -> Domain:
    """Give the domain as one agent has it.

    Args:
        domain: A checked domain.
        me: The agent's name, where the domain gives skills to it by name (`:agent arm-1`); these
            are its own, beside those that belong to nobody.
        others: Who else takes part; None for every agent that the domain names. Skills of those
            who do not are left out.

    Returns:
        A domain whose skills with an `agent` are those of others.
    """
    present = set(known_agents(domain) if others is None else others)
    skills = tuple(_skills(domain, me, present))
    return domain if skills == domain.skills else replace(domain, skills=skills)


def _skills(domain: Domain, me: str | None, present: Collection[str]) -> Iterator[SkillClause]:
    for clause in domain.skills:
        owner = clause.agent
        if owner is None or (isinstance(owner, Variable) and me is None):
            yield clause
        elif isinstance(owner, Variable):
            another = Call("/=", (owner, Constant(me or "")))
            yield clause if clause.actions else replace(clause, tests=(*clause.tests, another))
        elif owner.value == me:
            yield replace(clause, agent=None)
        elif owner.value in present:
            yield clause


def cost_of(clause: SkillClause) -> int:
    """Give what a skill counts for in a plan."""
    if clause.cost is not None:
        return clause.cost
    return OWN_COST if clause.agent is None else COST_OF_ASKING


def performer(clause: SkillClause, bindings: Mapping[str, Value]) -> str | None:
    """Give the other agent that carries an instance of a skill out; None if it is one's own."""
    owner = clause.agent
    if owner is None:
        return None
    return str(bindings[owner.name] if isinstance(owner, Variable) else owner.value)


def sentence(clause: SkillClause, bindings: Mapping[str, Value]) -> str:
    """Give what another agent is told when it is to carry an instance of a skill out.

    Example:
        A skill `(hold ?base)` of `human` without a `:request` gives "please hold base1".
    """
    if clause.request is not None:
        text = str(clause.request.value)
        for variable in sorted(set(variables_of_request(text)), key=len, reverse=True):
            text = text.replace(variable, str(bindings.get(variable, variable)))
        return text
    owner = clause.agent
    args = [
        str(bindings.get(term.name, term)) if isinstance(term, Variable) else str(term.value)
        for term in clause.head.args
        if term != owner
    ]
    return " ".join(["please", clause.head.predicate.replace("-", " "), *args])
