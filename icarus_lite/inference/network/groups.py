"""Which pair rules are followed together: those that see the objects of one percept type."""

from __future__ import annotations

from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.design import Design
from icarus_lite.inference.network.generation.module import is_filtered
from icarus_lite.inference.network.relations import Pairs, View


def groups_of(design: Design) -> tuple[kernels.GroupProgram, ...]:
    """Compile for each percept type the rules about pairs of its objects with any others.

    A rule that leaves objects of the type out sees objects of its own, and follows by itself.
    """
    members: dict[str, list[kernels.Member]] = {}
    for relation in design.relations:
        if isinstance(relation, Pairs):
            left, right = label_of(relation.left), label_of(relation.right)
            member = kernels.Member(relation.name, relation.kernel, left, right)
            for label, view in {left: relation.left, right: relation.right}.items():
                if not is_filtered(view):
                    members.setdefault(label, []).append(member)
    groups = [kernels.compile_group(type_, own) for type_, own in members.items()]
    return tuple(group for group in groups if group is not None)


def label_of(view: View) -> str:
    """Name the objects that a side of a rule sees: by their type, or by all that is asked.

    Views that differ in anything have objects of their own, so they must not share a name.
    """
    if not is_filtered(view):
        return view.type
    tests = [*map(str, view.tests)]
    return f"{view.type} {view.cells} {view.required} {view.constants} {tests} {view.variables}"
