"""What is made late is what the standard library makes at once."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import subprocess
import sys
from typing import Any, ClassVar

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.records import late

BOTH = (dataclasses, late)


def point(library: Any, **options: Any) -> Any:
    class Point:
        """A class with all that a field may be."""

        KIND: ClassVar[str] = "point"
        x: int
        y: float = 0.5
        near: list[int] = library.field(default_factory=list)
        where: str = library.field(default="", compare=False)
        seen: dict[str, int] = library.field(
            default_factory=dict, init=False, repr=False, compare=False
        )

        def doubled(self) -> int:
            return self.x * 2

    return library.dataclass(**options)(Point)


def derived(library: Any, **options: Any) -> Any:
    class Part(point(library, **options)):
        """A class that adds a field, and gives an inherited one another default."""

        y: float = 2.5
        name: str = "part"

    return library.dataclass(**options)(Part)


OPTIONS = [
    {"frozen": frozen, "slots": slots, "eq": eq}
    for frozen in (False, True)
    for slots in (False, True)
    for eq in (False, True)
]
every_way = pytest.mark.parametrize("options", OPTIONS, ids=lambda each: str([*each.values()]))
either = pytest.mark.parametrize("make", [point, derived])
arguments = st.fixed_dictionaries(
    {"x": st.integers(0, 2)},
    optional={
        "y": st.sampled_from([0.5, 1.5]),
        "near": st.lists(st.integers(0, 1), max_size=1),
        "where": st.sampled_from(["", "here"]),
    },
)


def outcome(function: Any, *args: Any, **kwargs: Any) -> Any:
    """Give what a function gives, or what it raises, in words."""
    try:
        return function(*args, **kwargs)
    except Exception as error:  # noqa: BLE001 - it is what is compared
        return type(error).__name__, str(error)


@every_way
@either
@settings(max_examples=25)
@given(one=arguments, other=arguments)
def test_instances_are_alike(make, options, one, other):
    kinds = [make(library, **options) for library in BOTH]
    values = [(kind(**one), kind(**other)) for kind in kinds]
    standard, ours = (
        (
            repr(a),
            a == b,
            a != b,
            a == "something else",
            outcome(lambda a=a, b=b: hash(a) == hash(b)) if options["eq"] else None,
            a.doubled(),
            {name: getattr(a, name) for name in ("x", "y", "near", "where", "seen")},
            dataclasses.asdict(a),
            dataclasses.astuple(a),
            repr(dataclasses.replace(a, x=9)),
            copy.deepcopy(a) == a if options["eq"] else None,
        )
        for a, b in values
    )
    assert ours == standard
    assert repr(late.replace(values[1][0], x=9)) == standard[-2]


@every_way
@either
def test_classes_are_alike(make, options):
    standard, ours = (
        (
            kind.__name__,
            kind.__qualname__,
            kind.__doc__,
            kind.__match_args__,
            [kind.__dict__.get("__slots__"), kind.KIND],
            str(inspect.signature(kind)).replace("<factory>", "<made anew>"),
            kind.__init__.__qualname__,
            dataclasses.is_dataclass(kind),
            [(f.name, f.type, f.init, f.repr, f.compare) for f in dataclasses.fields(kind)],
            kind.__dataclass_params__.frozen,
            kind.__hash__ is None,
        )
        for kind in (make(library, **options) for library in BOTH)
    )
    assert ours == standard


@every_way
@pytest.mark.parametrize(
    "do",
    [
        lambda kind: kind(),
        lambda kind: kind(1, 2, 3, 4, 5),
        lambda kind: kind(1, wrong=2),
        lambda kind: setattr(kind(1), "x", 2),
        lambda kind: delattr(kind(1), "x"),
        lambda kind: setattr(kind(1), "z", 2),
        lambda kind: kind(1) < kind(2),
    ],
)
def test_mistakes_are_told_alike(options, do):
    standard, ours = (outcome(do, point(library, **options)) for library in BOTH)
    if options["frozen"] and options["slots"] and standard and standard[0] == "TypeError":
        # The standard library speaks of `super` here: its slotted class is not the one it froze.
        assert ours is None or ours[0] in {"TypeError", "AttributeError", "FrozenInstanceError"}
    else:
        assert ours == standard


@pytest.mark.parametrize("library", BOTH)
def test_what_is_no_data_class_is_refused(library):
    class Unordered:
        x: int = 1
        y: int

    class Shared:
        x: list[int] = []  # noqa: RUF012 - it is refused

    with pytest.raises(TypeError, match="non-default argument 'y' follows default argument"):
        library.dataclass(Unordered)(1, 2)
    with pytest.raises(ValueError, match="mutable default <class 'list'> for field x"):
        library.dataclass(Shared)
    with pytest.raises(ValueError, match="cannot specify both default and default_factory"):
        library.field(default=1, default_factory=list)


@pytest.mark.parametrize("library", BOTH)
def test_own_methods_are_kept(library):
    @library.dataclass(frozen=True, slots=True)
    class Own:  # noqa: PLW1641 - it is hashed all the same
        x: int

        def __eq__(self, other):
            return isinstance(other, Own)

        def __repr__(self):
            return "mine"

    assert Own(1) == Own(2)
    assert repr(Own(1)) == "mine"
    assert hash(Own(1)) == hash(Own(1))


@pytest.mark.parametrize("library", BOTH)
def test_what_follows_init_is_called(library):
    called = []

    @library.dataclass(frozen=True, slots=True)
    class Checked:
        x: int

        def __post_init__(self):
            called.append(self.x)

    Checked(3)
    assert called == [3]


@every_way
@pytest.mark.parametrize(
    "do",
    [
        lambda kind: kind(1),
        lambda kind: kind(1, 2.5, [3], "there"),
        lambda kind: kind(y=4, x=1),
        lambda kind: kind(1, where="there"),
        lambda kind: kind(),
        lambda kind: kind(y=1),
        lambda kind: kind(1, x=1),
        lambda kind: kind(1, 2, 3, 4, 5),
        lambda kind: kind(1, seen={}),
    ],
)
def test_the_hundredth_instance_is_made_like_the_first(options, do):
    def shown(library):
        return outcome(lambda made: repr(do(made)), kind if library is late else standard)

    kind, standard = point(late, **options), point(dataclasses, **options)
    assert {shown(late) for _ in range(100)} == {shown(dataclasses)}


def test_what_is_made_anew_is_never_shared():
    kind = point(late)
    lists = [kind(1).near for _ in range(100)]
    assert len({*map(id, lists)}) == 100


def test_a_standard_data_class_may_inherit():
    base = point(late, frozen=True, slots=True)

    @dataclasses.dataclass(frozen=True, slots=True)
    class Further(base):
        z: int = 7

    assert repr(Further(1)).endswith("Further(x=1, y=0.5, near=[], where='', z=7)")
    assert Further(1, z=8) != Further(1)


def test_a_derived_class_calls_the_init_it_inherits():
    class Named(point(late)):
        def __init__(self, name):
            super().__init__(4, near=[1])
            self.name = name

    made = Named("it")
    assert (made.x, made.near, made.name) == (4, [1], "it")


def test_what_has_no_slots_keeps_what_is_cached_beside():
    kind = point(late, frozen=True)
    one = kind(1)
    one.__dict__["cached"] = 3
    assert one.cached == 3
    assert one == kind(1)


@late.dataclass(frozen=True, slots=True)
class Kept:
    """It has to be found by its name."""

    x: int
    y: str = "y"


def test_instances_are_pickled():
    assert pickle.loads(pickle.dumps(Kept(1, "z"))) == Kept(1, "z")


def test_recursion_is_shown_short():
    @late.dataclass(slots=True)
    class Loop:
        own: object = None

    one = Loop()
    one.own = one
    assert repr(one).endswith("Loop(own=...)")


def test_planning_starts_without_what_is_made_late():
    """It is what all this is for."""
    code = (
        "import sys, icarus_lite.planning.search, icarus_lite.language.pddl.importer;"
        "print({'dataclasses', 'enum', 'inspect', 'json', 're', 'typing'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
