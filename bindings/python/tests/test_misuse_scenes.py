# mypy: ignore-errors
"""Scenes and forces that are wrong raise, and never crash."""

from __future__ import annotations

import math
import os
import pathlib
import threading
from typing import Any, Callable

import numpy as np
import pytest
from conftest import ROOT, cloth_scene
from test_misuse import PLACE, RAISES, N, Strange, unchanged

import pliant

def deep() -> Any:
    value: Any = 1
    for _ in range(500):
        value = [value]
    return value


def endless() -> Any:
    value: dict[str, Any] = {}
    value["objects"] = [value]
    return value


ROPE = {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 4}}

SCENES: dict[str, Callable[[pathlib.Path], Any]] = {
    "None": lambda p: pliant.World(None),
    "a number": lambda p: pliant.World(3),
    "a list": lambda p: pliant.World([]),
    "bytes": lambda p: pliant.World(b"scene.json"),
    "no file": lambda p: pliant.World(p / "no.json"),
    "a folder": lambda p: pliant.World(p),
    "text that is no file": lambda p: pliant.World("{}"),
    "a member that is unknown": lambda p: pliant.World({"object": []}),
    "objects of no list": lambda p: pliant.World({"objects": {}}),
    "objects of numbers": lambda p: pliant.World({"objects": [1]}),
    "an empty object": lambda p: pliant.World({"objects": [{}]}),
    "a key of no str": lambda p: pliant.World({"objects": [], 3: 4}),
    "nan": lambda p: pliant.World(pliant.Scene(frame_time=math.nan)),
    "infinity": lambda p: pliant.World(pliant.Scene(gravity=(0, -math.inf, 0))),
    "an array of nan": lambda p: pliant.World(pliant.Scene(gravity=np.full(3, np.nan))),
    "an array of text": lambda p: pliant.World(pliant.Scene(gravity=np.array(["a"]))),
    "a set": lambda p: pliant.World(pliant.Scene(gravity={1, 2, 3})),
    "an object of ours": lambda p: pliant.World(pliant.Scene(gravity=Strange())),
    "a function": lambda p: pliant.World(pliant.Scene(gravity=len)),
    "bytes in it": lambda p: pliant.World(pliant.Scene(gravity=b"abc")),
    "a frame time of zero": lambda p: pliant.World(pliant.Scene(frame_time=0)),
    "a frame time of text": lambda p: pliant.World(pliant.Scene(frame_time="1/60")),
    "gravity of two numbers": lambda p: pliant.World(pliant.Scene(gravity=(0, 1))),
    "nested too deeply": lambda p: pliant.World(pliant.Scene(gravity=deep())),
    "a dict in itself": lambda p: pliant.World(endless()),
    "a description of a list": lambda p: pliant.Scene([1, 2]),
    "a description of text": lambda p: pliant.Scene("{}"),
    "a folder of a number": lambda p: pliant.Scene(folder=3),
    "reading a number": lambda p: pliant.Scene.read(3),
    "reading what is not there": lambda p: pliant.Scene.read(p / "no.json"),
    "parsing a number": lambda p: pliant.Scene.parse(3),
    "parsing nothing": lambda p: pliant.Scene.parse(""),
    "parsing half": lambda p: pliant.Scene.parse('{"objects": ['),
    "parsing a key twice": lambda p: pliant.Scene.parse('{"objects": [], "objects": []}'),
    "parsing nan": lambda p: pliant.Scene.parse('{"objects": [], "frame_time": NaN}'),
    "adding nothing": lambda p: pliant.Scene().add(),
    "adding two": lambda p: pliant.Scene().add(rope=ROPE, cloth={}),
    "adding by position": lambda p: pliant.Scene().add("rope"),
    "a name of a number": lambda p: pliant.Scene().add(name=3, rope=ROPE),
    "adding to what is no list": lambda p: pliant.Scene(objects={}).add(rope=ROPE),
    "adding a collider without a shape": lambda p: pliant.Scene().add_collider(),
    "a pin that is not there": lambda p: pliant.World({"objects": [{"rope": ROPE, "pins": [{"particles": [4]}]}]}),
    "an array that is not there": lambda p: pliant.World({"objects": [{"cloth": {"mesh": {"array": "a"}}}]}),
    "an array of three": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE, PLACE, PLACE)}}]}),
    "triangles of fractions": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE, PLACE)}}]}),
    "triangles of four": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE, [[0, 1, 2, 3]])}}]}),
    "triangles below zero": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE, [[0, 1, -1]])}}]}),
    "triangles out of range": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE, [[0, 1, N]])}}]}),
    "a mesh of None": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (None, None)}}]}),
    "a mesh of text": lambda p: pliant.World({"objects": [{"cloth": {"mesh": ("ab", "cd")}}]}),
    "vertices of two": lambda p: pliant.World({"objects": [{"cloth": {"mesh": (PLACE[:, :2], [[0, 1, 2]])}}]}),
    "tetrahedra of three": lambda p: pliant.World({"objects": [{"soft_body": {"tetrahedra": (PLACE, [[0, 1, 2]])}}]}),
    "points of two": lambda p: pliant.World({"objects": [{"particles": {"positions": np.zeros((3, 2)), "masses": 1}}]}),
    "names of arrays": lambda p: pliant.World(pliant.Scene(arrays={3: (PLACE, [[0, 1, 2]])})),
    "threads below zero": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, threads=-1),
    "a million threads": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, threads=10**6),
    "threads of text": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, threads="two"),
    "forces of a number": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, forces=3),
    "forces on nothing": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, forces={"shirt": print}),
    "forces by number": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, forces={0: print}),
    "forces of None": lambda p: pliant.World({"objects": [{"rope": ROPE}]}, forces={"rope": None}),
    "a pointer without a slash": lambda p: pliant.Scene().assign("settings", 1),
    "a pointer of a number": lambda p: pliant.Scene().assign(3, 1),
    "a pointer into a number": lambda p: pliant.Scene(frame_time=1).assign("/frame_time/x", 1),
    "a pointer past a list": lambda p: pliant.Scene(objects=[]).assign("/objects/0/name", 1),
    "a lookup of nothing": lambda p: pliant.Scene().lookup("/settings/substeps"),
    "checking for nan": lambda p: cloth_scene().check(math.nan),
    "checking for less than nothing": lambda p: cloth_scene().check(-1),
    "checking what is wrong": lambda p: pliant.Scene(objects=[{}]).check(),
    "a grid of one": lambda p: pliant.grid_mesh(1, 2, 1, 1),
    "a grid of nan": lambda p: pliant.grid_mesh(2, 2, math.nan, 1),
    "a grid of text": lambda p: pliant.grid_mesh("2", 2, 1, 1),
    "a sphere of 99": lambda p: pliant.sphere_mesh(99),
    "a mesh that is not there": lambda p: pliant.read_mesh(str(p / "no.obj")),
    "a mesh of a number": lambda p: pliant.read_mesh(3),
    "a mesh of another suffix": lambda p: pliant.write_mesh(str(p / "a.xyz"), pliant.grid_mesh(2, 2, 1, 1)),
    "a mesh that is none": lambda p: pliant.write_mesh(str(p / "a.obj"), 3),
    "a mesh of one array": lambda p: pliant.write_mesh(str(p / "a.obj"), (PLACE,)),
}  # fmt: skip


@pytest.mark.parametrize("bad", SCENES)
def test_scenes(tmp_path: pathlib.Path, bad: str) -> None:
    with pytest.raises((*RAISES, RecursionError)) as caught:
        SCENES[bad](tmp_path)
    assert str(caught.value)


@pytest.mark.parametrize("read", [pliant.World, pliant.Scene.read, pliant.World.load, pliant.read_mesh])
def test_a_pipe_is_no_file(tmp_path: pathlib.Path, read: Callable[[Any], Any]) -> None:
    """Reading it would wait for a writer."""
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    # A writer that ends after a second: a reader that opens the pipe then fails here instead of waiting forever.
    ends = threading.Timer(1, os.close, [os.open(pipe, os.O_RDWR)])
    ends.start()
    with pytest.raises(pliant.Error, match="not a regular file") as caught:
        read(str(pipe))
    ends.join()
    assert caught.value.file == str(pipe)


LONE = "\ud800"
NOT_UNICODE: dict[str, tuple[Callable[[], Any], str]] = {
    "a name": (lambda: pliant.World({"objects": [{"name": LONE, "rope": ROPE}]}), "/objects/0/name: "),
    "a key": (lambda: pliant.World({"objects": [], LONE: 1}), "the key '\\ud800'"),
    "a name in a list": (lambda: pliant.World({"pairs": [{"objects": ["a", LONE]}]}), "/pairs/0/objects/1: "),
    "an object to add": (lambda: pliant.World({"objects": []}).add(name=LONE, rope=ROPE), "/objects/0/name: "),
    "a path": (lambda: pliant.World(LONE), "the path '\\ud800' is not valid Unicode"),
    "a path to load": (lambda: pliant.World.load(LONE), "text that is not valid Unicode"),
    "an array": (lambda: pliant.Scene(arrays={LONE: [[0, 0, 0]]}).compiled(), "text that is not valid Unicode"),
    "text": (lambda: pliant.Scene.parse(LONE), "text is '\\ud800', a str that is not valid Unicode"),
    "a look-up": (lambda: pliant.World({"objects": []})[LONE], "name is '\\ud800', a str that is not valid Unicode"),
}


@pytest.mark.parametrize("bad", NOT_UNICODE)
def test_text_that_is_not_valid_unicode(bad: str) -> None:
    call, says = NOT_UNICODE[bad]
    with pytest.raises((pliant.Error, TypeError, KeyError)) as caught:
        call()
    assert says in str(caught.value) and "not valid Unicode" in str(caught.value)


BAD_FORCES: dict[str, Callable[[Any], Any]] = {
    "another shape": lambda a: setattr(a, "forces", np.zeros((N - 1, 3), np.float32)),
    "no array": lambda a: setattr(a, "forces", None),
    "text": lambda a: setattr(a, "forces", "strong"),
    "another object's positions": lambda a: setattr(a, "positions", np.zeros((2, 3))),
    "an attribute that is not there": lambda a: setattr(a, "force", 1),
    "raises": lambda a: 1 / 0,
    "ends": lambda a: exit(3),
}


@pytest.mark.parametrize("bad", BAD_FORCES)
def test_forces(bad: str) -> None:
    world = pliant.World(cloth_scene(), threads=1, forces=BAD_FORCES[bad])
    start = world.state()
    for _ in range(2):
        with pytest.raises((ValueError, TypeError, AttributeError, ZeroDivisionError, SystemExit)):
            world.run(3)
        world.restore(start)


def test_a_force_that_is_not_finite() -> None:
    def push(arrays: pliant.ForceArrays) -> None:
        arrays.forces[3] = np.nan

    world = pliant.World(cloth_scene(), threads=1, forces=push)
    report = world.step()
    assert "not finite at particle 3 of object 'cloth'" in report.warnings[0]
    assert np.isfinite(world["cloth"].positions()).all()
