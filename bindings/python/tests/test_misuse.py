# mypy: ignore-errors
"""Misuse raises, changes nothing, and never crashes."""

from __future__ import annotations

import io
import math
import pathlib
import pickle
from typing import Any, Callable

import numpy as np
import pytest
from conftest import ROOT, cloth_scene

import pliant

N = 36  # particles of the cloth
PLACE = np.zeros((N, 3), np.float32)


class Strange:
    """Something that is no array, no number and no str."""


def view_of(shape: tuple[int, ...], step: int) -> Any:
    return np.zeros(tuple(n * step for n in shape), np.float32)[tuple(slice(None, None, step) for _ in shape)]


def unaligned() -> Any:
    return np.frombuffer(bytearray(N * 3 * 4 + 1), np.uint8)[1:].view(np.float32).reshape(N, 3)


def read_only() -> Any:
    array = PLACE.copy()
    array.flags.writeable = False
    return array


# Arrays that cannot be filled. Of Object.positions, velocities, MeshCollider.positions.
BAD_OUT: dict[str, Callable[[], Any]] = {
    "float64": lambda: np.zeros((N, 3)),
    "float16": lambda: np.zeros((N, 3), np.float16),
    "int32": lambda: np.zeros((N, 3), np.int32),
    "uint8": lambda: np.zeros((N, 3), np.uint8),
    "bool": lambda: np.zeros((N, 3), bool),
    "complex64": lambda: np.zeros((N, 3), np.complex64),
    "object": lambda: np.zeros((N, 3), object),
    "text": lambda: np.full((N, 3), "a"),
    "big endian": lambda: np.zeros((N, 3), ">f4"),
    "structured": lambda: np.zeros(N, [("x", "f4"), ("y", "f4"), ("z", "f4")]),
    "fewer rows": lambda: np.zeros((N - 1, 3), np.float32),
    "more rows": lambda: np.zeros((N + 1, 3), np.float32),
    "four columns": lambda: np.zeros((N, 4), np.float32),
    "two columns": lambda: np.zeros((N, 2), np.float32),
    "flat": lambda: np.zeros(N * 3, np.float32),
    "three dimensions": lambda: np.zeros((1, N, 3), np.float32),
    "no dimension": lambda: np.zeros((), np.float32),
    "empty": lambda: np.zeros((0, 3), np.float32),
    "transposed": lambda: np.zeros((3, N), np.float32).T,
    "fortran": lambda: np.zeros((N, 3), np.float32, order="F"),
    "strided": lambda: view_of((N, 3), 2),
    "reversed": lambda: np.zeros((N, 3), np.float32)[::-1],
    "broadcast": lambda: np.broadcast_to(np.float32(0), (N, 3)),
    "unaligned": unaligned,
    "read-only": read_only,
    "list": lambda: [[0.0] * 3] * N,
    "bytes": lambda: bytes(N * 12),
    "bytearray": lambda: bytearray(N * 12),
    "number": lambda: 3.0,
    "str": lambda: "out",
    "dict": lambda: {},
    "class": lambda: Strange,
    "object of ours": lambda: Strange(),
}  # fmt: skip

# Vectors for each particle that cannot be taken.
BAD_VECTORS: dict[str, Callable[[], Any]] = {
    "fewer rows": lambda: np.zeros((N - 1, 3)),
    "more rows": lambda: np.zeros((N + 1, 3), np.float32),
    "four columns": lambda: np.zeros((N, 4)),
    "flat": lambda: np.zeros(N * 3),
    "three dimensions": lambda: np.zeros((N, 1, 3)),
    "empty": lambda: np.zeros((0, 3)),
    "empty list": lambda: [],
    "nan": lambda: np.full((N, 3), np.nan),
    "infinity": lambda: np.where(np.arange(N * 3).reshape(N, 3) == 50, np.inf, 0),
    "too large for float32": lambda: np.full((N, 3), 1e300),
    "complex": lambda: np.zeros((N, 3), complex),
    "bool": lambda: np.zeros((N, 3), bool),
    "text": lambda: np.full((N, 3), "a"),
    "objects": lambda: np.full((N, 3), Strange(), object),
    "ragged": lambda: [[0, 0, 0]] * (N - 1) + [[0, 0]],
    "None": lambda: None,
    "number": lambda: 1.0,
    "str": lambda: "vectors",
    "dates": lambda: np.zeros((N, 3), "datetime64[s]"),
    "bytes": lambda: b"0" * N * 3,
}  # fmt: skip

BAD_INDICES: dict[str, Any] = {
    "negative": [-1],
    "too large": [N],
    "far too large": [2**31 - 1],
    "over 32 bits": [2**40],
    "no pin": [7],
    "fractions": [0.5],
    "nan": [math.nan],
    "text": ["a"],
    "str": "corners",
    "None": None,
    "two dimensions": [[0]],
    "two for one": [0, 5],
    "number": 0,
    "bool": [True],
    "twice": [0, 0],
}

BAD_VECTOR: dict[str, Any] = {
    "two numbers": (0, 0),
    "four numbers": (0, 0, 0, 0),
    "nan": (0, math.nan, 0),
    "infinity": (math.inf, 0, 0),
    "too large": (1e300, 0, 0),
    "text": "abc",
    "None": None,
    "nested": [[0, 0, 0]],
    "dict": {"x": 0},
    "words": ["a", "b", "c"],
    "number": 1,
}

BAD_ROTATION: dict[str, Any] = {
    "zero": (0, 0, 0, 0),
    "three numbers": (0, 0, 0),
    "nan": (0, 0, 0, math.nan),
    "infinity": (0, 0, 0, math.inf),
    "None": None,
    "text": "turn",
}

RAISES = (ValueError, TypeError, KeyError, IndexError, OverflowError)


def unchanged(world: pliant.World, misuse: Callable[[], Any]) -> None:
    """The misuse raises, and the World is as before, and goes on as if nothing had been."""
    world.run(2)
    before = world.state()
    with pytest.raises(RAISES) as caught:
        misuse()
    assert str(caught.value)
    assert world.state() == before
    world.run(2)
    after = world.state_hash()
    world.restore(before)
    world.run(2)
    assert world.state_hash() == after


@pytest.mark.parametrize("bad", BAD_OUT)
@pytest.mark.parametrize("read", ["positions", "velocities"])
def test_out(world: pliant.World, read: str, bad: str) -> None:
    out = BAD_OUT[bad]()
    with pytest.raises(pliant.Error, match="float32"):
        getattr(world["cloth"], read)(out)
    with pytest.raises(pliant.Error):
        world.mesh_collider("board").positions(out)


@pytest.mark.parametrize("bad", BAD_VECTORS)
@pytest.mark.parametrize("write", ["set_velocities", "add_impulses", "set_forces"])
def test_vectors(world: pliant.World, write: str, bad: str) -> None:
    unchanged(world, lambda: getattr(world["cloth"], write)(BAD_VECTORS[bad]()))


@pytest.mark.parametrize("bad", BAD_VECTORS)
def test_positions_of_a_mesh_collider(world: pliant.World, bad: str) -> None:
    unchanged(world, lambda: world.mesh_collider("board").set_positions(BAD_VECTORS[bad]()))


@pytest.mark.parametrize("bad", BAD_INDICES)
def test_particles_of_targets(world: pliant.World, bad: str) -> None:
    unchanged(world, lambda: world["cloth"].set_targets(BAD_INDICES[bad], [[0, 0, 0]]))


@pytest.mark.parametrize("bad", BAD_INDICES)
def test_attachments_of_targets(world: pliant.World, bad: str) -> None:
    unchanged(world, lambda: world["cloth"].set_attachment_targets(BAD_INDICES[bad], [[0, 0, 0]]))


@pytest.mark.parametrize("bad", [bad for bad in BAD_VECTORS if "rows" not in bad])
def test_targets(world: pliant.World, bad: str) -> None:
    unchanged(world, lambda: world["cloth"].set_targets([0], BAD_VECTORS[bad]()))


def test_targets_of_a_particle_twice(world: pliant.World) -> None:
    unchanged(world, lambda: world["cloth"].set_targets([0, 0], [[0, 0, 0], [1, 0, 0]]))
    with pytest.raises(pliant.Error, match="particle 0: is given twice; give each one position"):
        world["cloth"].set_targets([0, 0], [[0, 0, 0], [1, 0, 0]])


def test_masked_arrays(world: pliant.World) -> None:
    """What lies under a mask is no value; an array without masked values is taken."""
    values = np.ma.zeros((N, 3), np.float32)
    world["cloth"].set_velocities(values)
    values[3, 1] = np.ma.masked
    unchanged(world, lambda: world["cloth"].set_velocities(values))
    unchanged(world, lambda: world["cloth"].set_velocities(values.astype(float)))
    with pytest.raises(pliant.Error, match="velocities have masked values; fill or remove them"):
        world["cloth"].set_velocities(values)
    with pytest.raises(pliant.Error, match="/gravity: this array has masked values"):
        pliant.World(pliant.Scene(gravity=np.ma.array([0, -9.81, 0], mask=[0, 1, 0])))


@pytest.mark.parametrize("bad", BAD_VECTOR)
@pytest.mark.parametrize("what", ["teleport", "ball", "board", "ball at once", "surface"])
def test_a_vector(world: pliant.World, what: str, bad: str) -> None:
    value = BAD_VECTOR[bad]
    calls: dict[str, Callable[[], None]] = {
        "teleport": lambda: world["cloth"].teleport(value),
        "ball": lambda: world.collider("ball").set_pose(value),
        "board": lambda: world.mesh_collider("board").set_pose(value),
        "ball at once": lambda: world.collider("ball").teleport(value),
        "surface": lambda: world.collider("ball").set_surface_velocity(value),
    }
    unchanged(world, calls[what])


@pytest.mark.parametrize("bad", BAD_ROTATION)
@pytest.mark.parametrize("what", ["teleport", "ball", "board"])
def test_a_rotation(world: pliant.World, what: str, bad: str) -> None:
    value = BAD_ROTATION[bad]
    calls: dict[str, Callable[[], None]] = {
        "teleport": lambda: world["cloth"].teleport((0, 0, 0), value),
        "ball": lambda: world.collider("ball").set_pose((0, 0, 0), value),
        "board": lambda: world.mesh_collider("board").set_pose((0, 0, 0), value),
    }
    unchanged(world, calls[what])


@pytest.mark.parametrize("dt", [0, -1, math.nan, math.inf, 1e300, "long", None, [1], True, 1e-300])
def test_dt(world: pliant.World, dt: Any) -> None:
    if dt is None:
        assert world.step(None).ok
    else:
        unchanged(world, lambda: world.step(dt))


@pytest.mark.parametrize("frames", [0, -1, 2.5, "many", 2**40, [3], math.nan])
@pytest.mark.parametrize("call", ["run", "frames"])
def test_frames(world: pliant.World, call: str, frames: Any) -> None:
    unchanged(world, lambda: getattr(world, call)(frames))


MACHINE: dict[str, Callable[[Any], Any]] = {
    "no such body": lambda m: m.pose("window"),
    "no such index": lambda m: m.pose(2),
    "negative index": lambda m: m.pose(-1),
    "huge index": lambda m: m.pose(2**40),
    "float index": lambda m: m.pose(0.5),
    "bool index": lambda m: m.pose(True),
    "None": lambda m: m.pose(None),
    "a dynamic body": lambda m: m.set_pose("door", (0, 0, 0)),
    "a pose of nothing": lambda m: m.set_pose("post", ()),
    "a pose with nan": lambda m: m.set_pose("post", (0, math.nan, 0)),
    "a rotation of zero": lambda m: m.set_pose("post", (0, 0, 0), (0, 0, 0, 0)),
    "no such joint": lambda m: m.set_motor("lock", 1),
    "no such motor": lambda m: m.set_motor("hinge", 1, motor="turbo"),
    "a target of nan": lambda m: m.set_motor("hinge", math.nan),
    "a target of text": lambda m: m.set_motor("hinge", "far"),
    "no target": lambda m: m.set_motor("hinge"),
    "a torque of zero": lambda m: m.set_motor("hinge", 1, most=0),
    "a negative torque": lambda m: m.set_motor("hinge", 1, most=-5),
    "a torque of text": lambda m: m.set_motor("hinge", 1, most="strong"),
    "a joint of no str": lambda m: m.set_motor(3, 1),
    "no joint 1": lambda m: m.joint_load(1),
    "no joint -1": lambda m: m.joint_load(-1),
    "a joint that is not there": lambda m: m.joint_load("lock"),
    "a joint of None": lambda m: m.joint_load(None),
    "a joint of True": lambda m: m.joint_load(True),
    "a mean load that is not recorded": lambda m: m.mean_joint_load("hinge"),
    "the state of no joint": lambda m: m.joint_state(7),
    "the state of joint 0.5": lambda m: m.joint_state(0.5),
    "no joint 1 that broke": lambda m: m.joint_is_broken(1),
    "no body 9 that sleeps": lambda m: m.body_is_asleep(9),
    "a surface velocity of 1e9": lambda m: m.set_surface_velocity("post", (1e9, 0, 0)),
    "no surface": lambda m: m.set_surface_velocity("window", (1, 0, 0)),
    "no group": lambda m: m.set_rest_factor(99, 1),
    "no group -1": lambda m: m.set_rest_factor(-1, 1),
    "a factor of text": lambda m: m.set_rest_factor(0, "big"),
    "a channel": lambda m: m.channel("temperature"),
    "a channel of no str": lambda m: m.channel(3),
    "multipliers of no str": lambda m: m.multipliers(None),
    "an attribute that is not there": lambda m: setattr(m, "name", "other"),
}


@pytest.mark.parametrize("bad", MACHINE)
def test_machines(machine_scene: pliant.Scene, bad: str) -> None:
    world = pliant.World(machine_scene, threads=1)
    if bad == "an attribute that is not there":
        with pytest.raises(AttributeError):
            MACHINE[bad](world["machine"])
    else:
        unchanged(world, lambda: MACHINE[bad](world["machine"]))


@pytest.mark.parametrize("factor", [-1, math.nan, math.inf, "big", None])
def test_rest_factor(world: pliant.World, factor: Any) -> None:
    unchanged(world, lambda: world["cloth"].set_rest_factor(0, factor))


# Uses of what is gone.
STALE: dict[str, Callable[[Any], Any]] = {
    "positions": lambda o: o.positions(),
    "positions into": lambda o: o.positions(PLACE.copy()),
    "velocities": lambda o: o.velocities(),
    "records": lambda o: o.records(),
    "velocity_records": lambda o: o.velocity_records(),
    "storage_order": lambda o: o.storage_order(),
    "mesh": lambda o: o.mesh(),
    "orientations": lambda o: o.orientations(),
    "angular_velocities": lambda o: o.angular_velocities(),
    "present": lambda o: o.present(),
    "enclosed_volume": lambda o: o.enclosed_volume(),
    "multipliers": lambda o: o.multipliers("distance"),
    "channel": lambda o: o.channel("age"),
    "name": lambda o: o.name,
    "particles": lambda o: o.particles,
    "substeps": lambda o: o.substeps,
    "constraints": lambda o: o.constraints,
    "len": lambda o: len(o),
    "set_targets": lambda o: o.set_targets([0], [[0, 0, 0]]),
    "set_attachment_targets": lambda o: o.set_attachment_targets([0], [[0, 0, 0]]),
    "set_velocities": lambda o: o.set_velocities(PLACE),
    "add_impulses": lambda o: o.add_impulses(PLACE),
    "set_forces": lambda o: o.set_forces(PLACE),
    "teleport": lambda o: o.teleport((0, 1, 0)),
    "pose": lambda o: o.pose(0),
    "set_pose": lambda o: o.set_pose(0, (0, 0, 0)),
    "set_surface_velocity": lambda o: o.set_surface_velocity(0, (0, 0, 0)),
    "set_motor": lambda o: o.set_motor("hinge", 0),
    "set_rest_factor": lambda o: o.set_rest_factor(0, 1),
    "joint_load": lambda o: o.joint_load(0),
    "joint_load by name": lambda o: o.joint_load("hinge"),
    "mean_joint_load": lambda o: o.mean_joint_load(0),
    "joint_state": lambda o: o.joint_state(0),
    "joint_is_broken": lambda o: o.joint_is_broken(0),
    "body_is_asleep": lambda o: o.body_is_asleep(0),
}


@pytest.mark.parametrize("use", STALE)
@pytest.mark.parametrize("again", [False, True], ids=["removed", "another in its slot"])
def test_an_object_that_was_removed(world: pliant.World, use: str, again: bool) -> None:
    rope = {"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 4}}
    gone = world.add(rope=rope)
    world.remove(gone)
    if again:
        world.add(rope=rope)
    assert not gone.exists and repr(gone) == "<pliant.Object: removed>"
    unchanged(world, lambda: STALE[use](gone))


def test_colliders_that_were_removed(world: pliant.World) -> None:
    ball, board = world.collider("ball"), world.mesh_collider("board")
    world.remove(ball)
    world.remove(board)
    uses: list[Callable[[], Any]] = [
        lambda: ball.pose(),
        lambda: ball.set_pose((0, 0, 0)),
        lambda: ball.teleport((0, 0, 0)),
        lambda: ball.set_surface_velocity((0, 0, 0)),
        lambda: board.positions(),
        lambda: board.set_positions(np.zeros((4, 3))),
        lambda: board.set_pose((0, 0, 0)),
        lambda: board.teleport((0, 0, 0)),
        lambda: world.remove(ball),
        lambda: world.remove(board),
        lambda: world.collider("ball"),
        lambda: world.mesh_collider("board"),
    ]
    for use in uses:
        unchanged(world, use)


WORLDS: dict[str, Callable[[Any, pathlib.Path], Any]] = {
    "no object": lambda w, p: w["shirt"],
    "a number": lambda w, p: w[0],
    "None": lambda w, p: w[None],
    "a collider as an object": lambda w, p: w["ball"],
    "an object as a collider": lambda w, p: w.collider("cloth"),
    "a collider of no str": lambda w, p: w.collider(3),
    "a mesh collider": lambda w, p: w.mesh_collider("ball"),
    "removing a name": lambda w, p: w.remove("shirt"),
    "removing a number": lambda w, p: w.remove(0),
    "removing from another": lambda w, p: w.remove(pliant.World(cloth_scene())["cloth"]),
    "removing a collider of another": lambda w, p: w.remove(pliant.World(cloth_scene()).collider("ball")),
    "adding nothing": lambda w, p: w.add(),
    "adding two kinds": lambda w, p: w.add(rope={}, cloth={}),
    "adding what is unknown": lambda w, p: w.add(jelly={}),
    "adding by position": lambda w, p: w.add({"rope": {}}),
    "adding an empty cloth": lambda w, p: w.add(cloth={}),
    "adding a taken name": lambda w, p: w.add(name="cloth", rope={"line": {"from": [0, 0, 0], "to": [1, 0, 0]}}),
    "adding no mesh": lambda w, p: w.add(cloth={"mesh": (PLACE, [[0, 1, 99]])}),
    "adding a mesh of nan": lambda w, p: w.add(cloth={"mesh": (np.full((3, 3), np.nan), [[0, 1, 2]])}),
    "adding a file that is not there": lambda w, p: w.add(cloth={"mesh": {"file": "nothing.obj"}}),
    "adding a collider of two shapes": lambda w, p: w.add_collider(plane={}, box={}),
    "adding a collider without a shape": lambda w, p: w.add_collider(position=[0, 0, 0]),
    "restoring nothing": lambda w, p: w.restore(None),
    "restoring a str": lambda w, p: w.restore(w.state_hash()),
    "restoring another's": lambda w, p: w.restore(pliant.World(cloth_scene(7)).state()),
    "saving nowhere": lambda w, p: w.save(p / "no folder" / "a.world"),
    "saving to a number": lambda w, p: w.save(3),
    "saving to bytes": lambda w, p: w.save(b"a.world"),
    "loading nothing": lambda w, p: pliant.World.load(p / "nothing.world"),
    "loading a scene": lambda w, p: pliant.World.load(ROOT / "scenes" / "rope.json"),
    "writing a suffix": lambda w, p: w.writer(p / "a.mpg"),
    "writing to a number": lambda w, p: w.writer(7),
    "writing to None": lambda w, p: w.writer(None),
    "writing a format that is unknown": lambda w, p: w.writer(format="mpg"),
    "writing a format that is a number": lambda w, p: w.writer(format=3),
    "writing many files to one": lambda w, p: w.writer(io.BytesIO(), format="obj"),
    "events of a str": lambda w, p: w.record_contact_events("yes"),
    "advice of nothing": lambda w, p: w.advice(None),
    "advice of a dict": lambda w, p: w.advice({}),
    "a state that does not unpickle": lambda w, p: pliant.State.__new__(pliant.State).__setstate__(b"nonsense"),
    "a world that does not unpickle": lambda w, p: pliant.World.__new__(pliant.World).__setstate__(b"nonsense"),
    "a state without a world": lambda w, p: pliant.State(),
    "an object without a world": lambda w, p: pliant.Object(),
    "a world that was not made": lambda w, p: pliant.World.__new__(pliant.World).step(),
    "an object that was not made": lambda w, p: pliant.Object.__new__(pliant.Object).positions(),
    "a report that was not made": lambda w, p: pliant.Report.__new__(pliant.Report).ok,
    "pickling an object": lambda w, p: pickle.dumps(w["cloth"]),
    "a step that is too short": lambda w, p: w.step(1e-12),
    "two for a step": lambda w, p: w.step(1, 2),
    "an argument that is unknown": lambda w, p: w.step(delta=1),
}


@pytest.mark.filterwarnings("ignore:nanobind")
@pytest.mark.parametrize("bad", WORLDS)
def test_worlds(world: pliant.World, tmp_path: pathlib.Path, bad: str) -> None:
    unchanged(world, lambda: WORLDS[bad](world, tmp_path))
