"""The generated code of a group for a few objects that have moved.

Where rules bound the distance of a pair, the objects near a mover are looked up once, and all these
rules are asked about them only; the other rules are asked about all objects.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.kernels.group_members import Bound, GroupNames
from icarus_lite.inference.network.kernels.python_source import PythonWriter
from icarus_lite.language.syntax import Expression, Variable

_OTHER = {"left": "right", "right": "left"}


def _inside(place: int, name: str) -> str:
    return f"low_{place} <= {name}[other] <= high_{place}"


def _partners(number: int, word: str) -> str:
    return f"partners_{number}_{word}"


def write_few(
    type_: str, names: GroupNames, box: Sequence[Bound], boxed: frozenset[int]
) -> list[str]:
    """Write the function that follows a few objects.

    Args:
        type_: The type of the objects that move.
        names: The identifiers of the group.
        box: The attributes that bound where partners are.
        boxed: The members they bound.
    """
    writer = _Few(type_, names, box, boxed)
    writer.write()
    return writer.lines


class _Few:
    def __init__(
        self, type_: str, names: GroupNames, box: Sequence[Bound], boxed: frozenset[int]
    ) -> None:
        self.lines: list[str] = []
        self._type, self._names, self._members = type_, names, names.members
        self._box, self._boxed = box, boxed

    def write(self) -> None:
        """Write it."""
        add = self.lines.append
        add("def follow(slots, keys):")
        add('    """Give what a few moved objects change, by rule: the pairs gained and lost."""')
        add("    found = {}")
        self._derive_few()
        rows = [
            (number, word)
            for number, member in enumerate(self._members)
            if member.order is None
            for word, type_ in (("left", member.left), ("right", member.right))
            if type_ == self._type and not (member.mirrored and word == "right")
        ]
        if rows:
            if any(row[0] in self._boxed for row in rows):
                add(f"    {', '.join(f'reach_{n}' for n in range(len(self._box)))}, = reach")
            add("    for slot in slots:")
            self._own(rows)
            boxed = [row for row in rows if row[0] in self._boxed]
            if boxed:
                self._among()
                self._near(boxed)
            for row in rows:
                if row not in boxed:
                    self._all_partners(*row)
            for number, word in rows:
                self._compare(number, word)
        self.lines += ["    return found", "", ""]

    def _derive_few(self) -> None:
        lines = []
        for number, member in enumerate(self._members):
            for word, side, plan, type_ in member.sides():
                if type_ != self._type or (member.mirrored and word == "right"):
                    continue
                names: dict[Expression, str] = {
                    Variable(variable): f"{self._names.column(type_, attribute)}[slot]"
                    for variable, attribute in side.attributes
                }
                for place, term in enumerate(plan.inputs.derived):
                    text = PythonWriter(names, member.kernel.limit).number(term)
                    lines.append(
                        f"        {self._names.derived(number, word, place)}[slot] = {text}"
                    )
        if self._box:
            first = self._names.column(self._type, self._box[0].attribute)
            lines += ["        if keys is not None:", f"            keys.set(slot, {first}[slot])"]
        if lines:
            self.lines += ["    for slot in slots:", *lines]

    def _own(self, rows: Sequence[tuple[int, str]]) -> None:
        """Write what is read of the mover itself."""
        names = dict.fromkeys(name for row in rows for _, name in self._names.terms(*row))
        names |= dict.fromkeys(
            self._names.column(self._type, bound.attribute) for bound in self._box
        )
        self.lines += [f"        own_{name} = {name}[slot]" for name in names]

    def _among(self) -> None:
        """Write which objects may be near the mover: all of them, or those that keys show."""
        add = self.lines.append
        names = self._places()
        for place, name in enumerate(names):
            own, reach = f"own_{name}", f"reach_{place}"
            add(f"        low_{place}, high_{place} = {own} - {reach}, {own} + {reach}")
        add("        if keys is None:")
        add(f"            among = range(len({names[0]}))")
        add("        else:")
        add("            begin = bisect_left(keys.ranked, low_0)")
        add("            end = bisect_right(keys.ranked, high_0)")
        which = "keys.slots[begin:end]"
        if len(names) == 2:
            which = f"[other for other in {which} if {_inside(1, names[1])}]"
        add(f"            among = sorted({which})")

    def _places(self) -> list[str]:
        """Name the lists of where objects are."""
        return [self._names.column(self._type, bound.attribute) for bound in self._box]

    def _all_apart(self) -> bool:
        return all(self._members[number].kernel.plan.distinct for number in self._boxed)

    def _near(self, rows: Sequence[tuple[int, str]]) -> None:
        """Write one loop over what is near the mover, in which all bounded rules are asked."""
        add, apart = self.lines.append, not self._all_apart()
        self.lines += [f"        {_partners(*row)} = []" for row in rows]
        add("        for other in among:")
        inside = " and ".join(_inside(n, name) for n, name in enumerate(self._places()))
        add(f"            if not ({inside}){'' if apart else ' or other == slot'}:")
        add("                continue")
        for number, word in rows:
            self._ask(number, word, apart=apart)

    def _all_partners(self, number: int, word: str) -> None:
        """Write the search for the partners of a mover among all objects of the other side."""
        (_, first), *_ = self._names.terms(number, _OTHER[word])
        self.lines += [
            f"        {_partners(number, word)} = []",
            f"        for other in range(len({first})):",
        ]
        self._ask(number, word, apart=True)

    def _ask(self, number: int, word: str, *, apart: bool) -> None:
        """Write the question whether another object is a partner of the mover."""
        member, others = self._members[number], self._names.terms(number, _OTHER[word])
        names: dict[Expression, str] = {term: f"{name}[other]" for term, name in others}
        names |= {term: f"own_{name}" for term, name in self._names.terms(number, word)}
        condition = PythonWriter(names, member.kernel.limit).condition(member.kernel.paired)
        if apart and member.kernel.plan.distinct and member.left == member.right:
            condition = f"other != slot and {condition}"
        self.lines += [
            f"            # {member.name}, the mover on the {word}",
            f"            if {condition}:",
            f"                {_partners(number, word)}.append(other)",
        ]

    def _compare(self, number: int, word: str) -> None:
        """Write the comparison of the partners of a mover with those it had before."""
        member, add, now = self._members[number], self.lines.append, _partners(number, word)
        rows = f"{word}_rows_{number}"
        add(f"        before = {rows}[slot]")
        add("        if before is None:")
        add(f"            before = {rows}[slot] = of_{word}_{number}(slot)")
        add(f"        if {now} != before:")
        how = "mirrored" if member.mirrored else f"on_{word}"
        add(f"            note_{how}(found, {number}, slot, slots, {now}, before)")
