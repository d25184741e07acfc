# mypy: ignore-errors
"""Errors name the argument, what it is and what is expected; attributes that cannot be set say what to do instead."""

from __future__ import annotations

import inspect
import re
from typing import Any, Callable

import numpy as np
import pytest
from conftest import cloth_scene

import pliant

CALLS: dict[str, tuple[Callable[[Any], Any], str]] = {
    "a step of text": (lambda w: w.step("long"), "dt is 'long', a str; pass a number"),
    "frames of text": (lambda w: w.run("all"), "World.run(): frames is 'all', a str; pass a whole number or None"),
    "a fraction of frames": (lambda w: w.run(2.5), "World.run(): frames is 2.5, a float; pass a whole number or None"),
    "far too many frames": (
        lambda w: w.run(2**40),
        "World.run(): frames is 1099511627776, an int; pass a whole number or None of at most 32 bits",
    ),
    "more arguments": (lambda w: w.run(1, 2, 3), "World.run() takes frames, and was given 2 arguments more"),
    "another argument": (lambda w: w.run(frame=3), "World.run() has no argument 'frame'; did you mean 'frames'?"),
    "a strange argument": (lambda w: w.run(xyzzy=3), "World.run() has no argument 'xyzzy'; it takes frames"),
    "twice": (lambda w: w.run(1, frames=2), "World.run() was given 'frames' twice"),
    "no argument": (lambda w: w.restore(), "World.restore() needs 'state'; it takes state"),
    "no State": (lambda w: w.restore(3), "World.restore(): state is 3, an int; pass a State"),
    "None for a State": (lambda w: w.restore(None), "World.restore(): state is None; pass a State"),
    "a name of a number": (lambda w: w[3], "World[...]: name is 3, an int; pass a str"),
    "threads of text": (
        lambda w: pliant.World(cloth_scene(), threads="all"),
        "World(): threads is 'all', a str; pass a whole number or None",
    ),
    "no scene": (lambda w: pliant.World(), "World() needs 'scene'; it takes scene, threads, forces"),
    "a switch of a number": (
        lambda w: w.record_contact_events(3),
        "World.record_contact_events(): on is 3, an int; pass True or False",
    ),
    "a grid of text": (lambda w: pliant.grid_mesh("a", 2, 1, 1), "grid_mesh(): columns is 'a', a str; pass a whole number"),
    "half a grid": (lambda w: pliant.grid_mesh(2), "grid_mesh() needs 'rows'; it takes columns, rows, width, depth"),
    "a body of None": (lambda w: w["cloth"].pose(None), "Object.pose(): body is None; pass the name of a body, or its index"),
    "a joint of an array": (
        lambda w: w["cloth"].joint_load(np.zeros(3)),
        "joint is an ndarray; pass the name of a joint, or its index",
    ),
    "a target of text": (lambda w: w["cloth"].set_motor("hinge", "far"), "target is 'far', a str; pass a number"),
    "a path of a number": (lambda w: w.save(3), "path is 3, an int; pass a str or os.PathLike"),
    "removing a number": (
        lambda w: w.remove(3),
        "thing is 3, an int; pass an Object, a Collider, a MeshCollider, or the name of an object",
    ),
    "a force of a number": (
        lambda w: pliant.World(cloth_scene(), forces=3),
        "a force is 3, an int; pass a function of pliant.ForceArrays",
    ),
}  # fmt: skip


@pytest.mark.parametrize("call", CALLS)
def test_calls(world: pliant.World, call: str) -> None:
    wrong, message = CALLS[call]
    with pytest.raises(TypeError) as caught:
        wrong(world)
    assert str(caught.value) == message


ATTRIBUTES: dict[str, tuple[Callable[[Any], Any], str, str]] = {
    "gravity of a Scene": (lambda w: cloth_scene(), "gravity", "write scene['gravity'] = ..."),
    "a typo of a Scene": (lambda w: cloth_scene(), "gravty", "write scene['NAME'] = ..."),
    "gravity of a World": (lambda w: w, "gravity", "change the Scene before"),
    "time of a World": (lambda w: w, "time", "can only be read; restore()"),
    "step of a World": (lambda w: w, "step", "is a function"),
    "positions": (lambda w: w["cloth"], "positions", "is a function; change it by its functions, or by World.edit()"),
    "velocities": (lambda w: w["cloth"], "velocities", "call set_velocities()"),
    "targets": (lambda w: w["cloth"], "targets", "call set_targets()"),
    "the name": (lambda w: w["cloth"], "name", "can only be read"),
    "the place of a ball": (lambda w: w.collider("ball"), "pose", "call set_pose()"),
    "the place of a board": (lambda w: w.mesh_collider("board"), "positions", "call set_positions()"),
    "time of a State": (lambda w: w.state(), "time", "can only be read"),
    "a Report": (lambda w: w.step(), "ok", "can only be read"),
    "a Batch": (lambda w: pliant.Batch(cloth_scene(), 2), "gravity", "change the scene before the Batch is made"),
    "of a Batch": (lambda w: pliant.Batch(cloth_scene(), 2)["cloth"], "forces", "call set_forces()"),
    "an Edit": (lambda w: w.edit("cloth"), "masses", "call set_masses()"),
}  # fmt: skip


@pytest.mark.parametrize("what", ATTRIBUTES)
def test_attributes(world: pliant.World, what: str) -> None:
    of, name, instead = ATTRIBUTES[what]
    with pytest.raises(AttributeError) as caught:
        setattr(of(world), name, 1)
    assert name in str(caught.value) and instead in str(caught.value)


MADE_BY = {
    pliant.Object: 'world["NAME"]',
    pliant.Collider: 'world.collider("NAME")',
    pliant.MeshCollider: 'world.mesh_collider("NAME")',
    pliant.BatchObject: 'batch["NAME"]',
    pliant.State: "World.state()",
    pliant.Report: "World.step()",
    pliant.Writer: "World.writer()",
    pliant.Edit: "World.edit()",
    pliant.Gauges: "World.gauges()",
}


@pytest.mark.parametrize("kind", MADE_BY)
def test_classes_that_cannot_be_called(kind: type) -> None:
    for given in ((), (1,), ("a", "b")):
        with pytest.raises(TypeError) as caught:
            kind(*given)
        assert f"{kind.__name__} cannot be made by a call; {MADE_BY[kind]} returns one" in str(caught.value)


def test_attributes_of_ones_own_classes() -> None:
    class Mine(pliant.World):
        pass

    class MyScene(pliant.Scene):
        pass

    mine, scene = Mine(cloth_scene()), MyScene()
    mine.note = scene.note = "anything"
    assert (mine.note, scene.note) == ("anything", "anything")
    with pytest.raises(AttributeError, match="time"):
        mine.time = 3
    with pytest.raises(AttributeError, match="gravity"):
        scene.gravity = (0, 0, 0)
    scene.folder = "here"
    assert pliant.Scene(scene).folder == "here"


class Strange:
    """No array, number or str."""


WORDS = re.compile(r"::|\bstd\b|\bspan\b|vector<|incompatible function|nanobind|bad_cast|NoneType|pliant\._")
VALUES: list[Any] = [None, Strange(), "text", -1, 2**70, np.nan, [None], {"a": 1}, b"x", 1j, np.zeros((2, 2, 2)), [[1], [2, 3]]]


def things() -> dict[str, Any]:
    scene = cloth_scene()
    world, batch = pliant.World(scene, threads=1), pliant.Batch(scene, 2)
    report = world.step()
    parts = [world["cloth"], world.collider("ball"), world.mesh_collider("board"), world.edit("cloth"), world.state()]
    return {type(one).__name__: one for one in [world, report, batch, batch["cloth"], *parts]}


FUNCTIONS = [
    (kind, name)
    for kind, thing in things().items()
    for name in dir(type(thing))
    if (not name.startswith("_") or name == "__getitem__")
    and callable(getattr(type(thing), name))
    and name not in ("stop", "save", "writer", "add", "add_collider", "describe", "frames")
]


@pytest.mark.parametrize("kind", sorted({kind for kind, _ in FUNCTIONS}))
def test_no_message_has_words_of_another_language(kind: str) -> None:
    """Every function is given values of all kinds, one, two or three of them."""
    messages = []
    for name in [name for of, name in FUNCTIONS if of == kind]:
        for value in VALUES:
            for given in ([value], [value] * 2, [0, value], [value] * 3):
                thing = things_of_kind[kind] if name not in ("apply",) else things()[kind]
                try:
                    getattr(thing, name)(*given)
                except (ValueError, TypeError, KeyError, IndexError, OverflowError) as error:
                    messages.append((name, given, str(error)))
    assert len(messages) > 5
    for name, given, text in messages:
        assert text and WORDS.search(text) is None, f"{kind}.{name}({given}): {text}"


things_of_kind = things()


def test_signatures_are_those_that_messages_use() -> None:
    """What explains a call reads the signature of each function; all can be read."""
    from pliant import _calls, _pliant

    seen = 0
    for thing in vars(_pliant).values():
        functions = [thing, *(vars(thing).values() if inspect.isclass(thing) else [])]
        for function in functions:
            if type(function).__name__ in ("nb_func", "nb_method"):
                assert "was given arguments of wrong types; see" not in _calls.explain(function, [], {"x": 1})
                seen += 1
    assert seen > 100
