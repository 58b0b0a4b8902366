"""One cycle by hand: percepts in, a decision out, and the reason for a belief.

Run it from the project's folder: python examples/01_one_cycle_by_hand.py
"""

from icarus_lite import Agent, Outcome, Percept, load_domain

agent = Agent(load_domain("domains/gearbox.icr"), goals=["(attached hubcover case)"])
percepts = [
    Percept("hand", "hand1", {"reach": 0.85}),
    Percept("object", "hubcover", {"type": "hubcover", "x": 0.4, "y": 0.1, "z": 0, "seen": "yes"}),
    Percept("object", "case", {"type": "case", "x": 0.4, "y": -0.1, "z": 0, "seen": "yes"}),
]
decision = agent.cycle(percepts)
print("decided:", decision.action, "because", decision.reason)
assert decision.action is not None
decision = agent.cycle(percepts, Outcome(decision.action))
print("then:", decision.action)
print(agent.why("(attached hubcover hand1)"))
