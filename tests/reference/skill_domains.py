"""Random domains in which skills meet everything that makes their effects hard to foresee.

Concepts over percepts, effects and attachments, recursive ones and ones with values among them;
negated conditions with local variables; effects on what concepts derive; removals by pattern;
attributes that have one value at a time, asserted anew with others; attachments that may circle.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass

from icarus_lite.inference import Assertion, InferenceEngine, Memory
from icarus_lite.inference.engine import BeliefState
from icarus_lite.language.checking.checker import check_domain
from icarus_lite.language.diagnostics import Severity
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.symbols import Action, Belief, Percept

OBJECTS = ("a", "b", "c", "d")
VARIABLES = ("?x", "?y", "?z")
ASSERTED = {"p": 1, "q": 2, "r": 1}
CONCEPTS = {"k1": 1, "k2": 2, "k3": 1}


@dataclass(frozen=True)
class Start:
    """A domain and what is believed in it at first."""

    text: str
    engine: InferenceEngine
    memory: Memory


class SkillDomain:
    """Draws one domain.

    Args:
        rng: Where chance comes from.
        valued: How likely there is a concept with a value, which may be recursive.
        anew: Whether every skill asserts a value, so that most are asserted again and again.
    """

    def __init__(self, rng: random.Random, valued: float = 0.3, *, anew: bool = False) -> None:
        self._rng = rng
        self._attaching = rng.random() < 0.5
        self._asserted = dict(ASSERTED) | ({"val": 1} if anew or rng.random() < 0.4 else {})
        self._anew = anew
        self._concepts = dict(list(CONCEPTS.items())[: rng.randint(0, 3)])
        self._valued = rng.random() < valued
        self._readable = {"thing": 1, "link": 1} | self._asserted
        self._readable |= {"attached": 2} if self._attaching else {}

    def draw(self) -> Start:
        """Give the domain, with percepts and facts to begin with."""
        rng = self._rng
        concepts = self._draw_concepts()
        skills, rules = self._draw_skills()
        attachments = f"(attachments {' '.join(rules)})" if rules else ""
        text = f"""(percepts (thing ^size ^kind) (link ^from ^to))
            (concepts {" ".join(concepts)})
            (skills {" ".join(skills)})
            {attachments}"""
        percepts = [
            Percept("thing", name, {"size": rng.choice((1, 2)), "kind": rng.choice("rb")})
            for name in OBJECTS[: rng.randint(2, 4)]
        ]
        percepts += [
            Percept("link", f"l{n}", {"from": rng.choice(OBJECTS), "to": rng.choice(OBJECTS)})
            for n in range(rng.randint(0, 3))
        ]
        domain, problems = parse_domain(text)
        assert domain is not None, (text, problems)
        wrong = [
            each
            for each in check_domain(domain)
            if each.severity is Severity.ERROR and each.code != "ICR013"  # given, not asserted
        ]
        assert not wrong, (text, wrong)
        engine = InferenceEngine(domain)
        given = Memory(BeliefState(), dict.fromkeys(self._given(), Assertion(Action("given"), 0)))
        return Start(text, engine, engine.step(given, percepts))

    def _given(self) -> list[Belief]:
        rng, found = self._rng, []
        for name, arity in self._asserted.items():
            for _ in range(rng.randint(0, 2)):
                args = tuple(rng.choice(OBJECTS) for _ in range(arity))
                found.append(Belief(name, args, {"v": rng.choice((1, 2))} if name == "val" else {}))
        for name, arity in self._concepts.items():
            if rng.random() < 0.2:
                found.append(Belief(name, tuple(rng.choice(OBJECTS) for _ in range(arity))))
        return found

    def _draw_concepts(self) -> list[str]:
        rng, clauses, below = self._rng, list[str](), dict[str, int]()
        for name, arity in self._concepts.items():
            for _ in range(rng.randint(1, 2)):
                variables = VARIABLES[: max(arity, rng.randint(1, 3))]
                body = [f"(thing {variable})" for variable in variables]
                pool = [*self._readable, *([name] * 2 if rng.random() < 0.4 else [])]
                body += [
                    self._literal(rng.choice(pool), variables) for _ in range(rng.randint(0, 2))
                ]
                refused = [*self._asserted, *below, *(["attached"] if self._attaching else [])]
                body += self._denials(refused, variables)
                head = " ".join(variables[:arity])
                clauses.append(
                    f"(({name} {head}) :elements ({' '.join(body)}) {self._test(variables, 0.2)})"
                )
            below[name] = self._readable[name] = arity
        if self._attaching and rng.random() < 0.15:  # seen as well as done
            seen = rng.choice(("(q ?x ?y)", "(thing ?y ^size 2) (thing ?x ^size 1)"))
            clauses.append(f"((attached ?x ?y) :elements ((thing ?x) (thing ?y) {seen}))")
        return clauses + (self._valued_concept() if self._valued else [])

    def _valued_concept(self) -> list[str]:
        rng, clauses = self._rng, []
        for _ in range(rng.randint(1, 2)):
            # A value that is not a number would be an error of the domain, not of its semantics.
            source = rng.choice(("(thing ?x ^size ?s)", "(q ?x ?y) (thing ?y ^size ?s)"))
            body = f"{source} {self._literal(rng.choice([*self._readable]), ('?x',))}"
            clauses.append(
                f"((b1 ?x ^w ?w) :elements ({body}) :binds ((?w (+ ?s {rng.randint(0, 2)}))))"
            )
        if rng.random() < 0.5:
            clauses.append(
                "((b1 ?x ^w ?w) :elements ((thing ?x) (q ?x ?y) (b1 ?y ^w ?s))"
                " :tests ((< ?s 4)) :binds ((?w (+ ?s 1))))"
            )
        self._readable["b1"] = 1
        return clauses

    def _draw_skills(self) -> tuple[list[str], list[str]]:
        rng, skills, heads = self._rng, list[str](), list[tuple[str, tuple[str, ...]]]()
        targets = dict(self._asserted)
        if rng.random() < 0.6:
            targets |= self._concepts
        if self._attaching and rng.random() < 0.5:
            targets["attached"] = 2
        if self._valued and rng.random() < 0.4:
            targets["b1"] = 1
        for number in range(rng.randint(2, 4)):
            variables = VARIABLES[: rng.randint(1, 3)]
            body = [f"(thing {variable})" for variable in variables]
            pool = [*self._readable]
            body += [self._literal(rng.choice(pool), variables) for _ in range(rng.randint(0, 2))]
            body += self._denials(pool, variables)
            values: tuple[object, ...] = (1, 2, 3, "?x")
            if "val" in targets and rng.random() < 0.5:  # a value to be asserted
                values = (1, "?n", "?n")
                body.append(
                    rng.choice((f"(thing {variables[0]} ^size ?n)", f"(val {variables[-1]} ^v ?n)"))
                )
            effects = [self._effect(targets, variables, values) for _ in range(rng.randint(1, 4))]
            if self._anew:
                effects.append(f"(val {self._term(variables)} ^v {rng.choice(values)})")
            head = f"(s{number} {' '.join(variables)})"
            skills.append(
                f"({head} :elements ({' '.join(body)}) {self._test(variables, 0.4)}"
                f" :actions ((*do {variables[0]})) :effects ({' '.join(effects)}))"
            )
            if self._attaching and len(variables) > 1 and rng.random() < 0.8:
                heads.append((head, variables))
        rules = []
        for head, variables in heads:
            other, theirs = rng.choice(heads)
            until = f":until ({other[1:3]} {' '.join(rng.sample(VARIABLES, len(theirs)))})"
            until = until if rng.random() < 0.7 else ""
            rules.append(f"({head} {until} :child {variables[0]} :parent {variables[1]})")
        return skills, rules

    def _term(self, variables: tuple[str, ...]) -> str:
        return self._rng.choice(variables if self._rng.random() < 0.85 else OBJECTS)

    def _literal(self, name: str, variables: tuple[str, ...]) -> str:
        rng = self._rng
        if name == "thing":
            return f"(thing {self._term(variables)}{rng.choice(('', ' ^size ?s', ' ^kind r'))})"
        if name == "link":
            return f"(link ?l ^from {self._term(variables)} ^to {self._term(variables)})"
        more = {"val": ("", " ^v ?v", " ^v 1"), "b1": ("", " ^w ?u", " ^w 2")}.get(name, ("",))
        args = " ".join(self._term(variables) for _ in range(self._readable_arity(name)))
        return f"({name} {args}{rng.choice(more)})"

    def _readable_arity(self, name: str) -> int:
        return (self._readable | self._concepts | {"attached": 2})[name]

    def _denials(self, names: list[str], variables: tuple[str, ...]) -> list[str]:
        rng, found = self._rng, []
        for _ in range(rng.choice((0, 0, 1, 1, 2))):
            name = rng.choice(names)
            if name in ("thing", "link"):
                continue
            args = [
                self._term(variables) if rng.random() < 0.6 else rng.choice(("?any", "?other"))
                for _ in range(self._readable_arity(name))
            ]
            found.append(f"(not ({name} {' '.join(args)}))")
        return found

    def _effect(
        self, targets: dict[str, int], variables: tuple[str, ...], valued: Sequence[object]
    ) -> str:
        rng = self._rng
        name = rng.choice([*targets])
        args = [self._term(variables) for _ in range(targets[name])]
        if rng.random() < 0.55:
            values = {"val": f" ^v {rng.choice(valued)}", "b1": f" ^w {rng.choice((1, 2))}"}
            return f"({name} {' '.join(args)}{values.get(name, '')})"
        args = [arg if rng.random() < 0.7 else "?_any" for arg in args]
        value = f" ^v {rng.choice((1, 2))}" if name == "val" and rng.random() < 0.3 else ""
        return f"(not ({name} {' '.join(args)}{value}))"

    def _test(self, variables: tuple[str, ...], chance: float) -> str:
        if len(variables) > 1 and self._rng.random() < chance:
            return f":tests ((/= {variables[0]} {variables[1]}))"
        return ""
