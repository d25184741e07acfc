"""Bodies and joints of a Batch: each world's numbers are those of a World alone."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
import pytest

import pliant

N = 3


def two_doors() -> pliant.Scene:
    """A kinematic post with two doors on hinges that have motors."""
    door = {"solids": [{"box": {"half_extents": [0.4, 0.4, 0.02]}}]}
    return pliant.Scene(
        objects=[
            {
                "name": "machine",
                "bodies": [
                    {"name": "post", "solids": [{"box": {"half_extents": [0.1, 1, 0.1]}}], "kinematic": True},
                    {"name": "left", "position": [-0.6, 0, 0], **door},
                    {"name": "right", "position": [0.6, 0, 0], **door},
                ],
                "joints": [
                    {
                        "name": name + " hinge",
                        "between": ["post", name],
                        "hinge": {"anchor": [x, 0, 0], "axis": [0, 1, 0], "motor": {"position": 0, "most": 50}},
                    }
                    for name, x in [("left", -0.15), ("right", 0.15)]
                ],
            }
        ]
    )


def pair() -> tuple[pliant.Batch, list[pliant.World]]:
    """A Batch, and the same worlds alone."""
    batch = pliant.Batch(two_doors(), N, threads=2)
    worlds = [pliant.World(two_doors(), threads=1) for _ in range(N)]
    batch.record_joint_loads()
    for world in worlds:
        world.record_joint_loads()
    return batch, worlds


def run(batch: pliant.Batch, worlds: list[pliant.World], frames: int = 10) -> None:
    batch.run(frames)
    for world in worlds:
        world.run(frames)
    assert batch.state_hashes() == [world.state_hash() for world in worlds]


def test_a_motor_of_each_world() -> None:
    batch, worlds = pair()
    batch["machine"].set_motor("left hinge", [0.5, -0.5, 1], most=[5, 50, 500])
    for world, target, most in zip(worlds, [0.5, -0.5, 1], [5, 50, 500]):
        world["machine"].set_motor("left hinge", target, most=most)
    run(batch, worlds)
    assert len(set(batch.state_hashes())) == N


@pytest.mark.parametrize("target", [0.5, np.float32(0.5), np.float64(0.5), 0.5 * np.ones(N), np.array(0.5)])
def test_one_target_for_all(target: Any) -> None:
    batch, worlds = pair()
    batch["machine"].set_motor("right hinge", target, most=100)
    for world in worlds:
        world["machine"].set_motor("right hinge", 0.5, most=100)
    run(batch, worlds, 3)


def test_several_motors_at_once() -> None:
    batch, worlds = pair()
    joints = ["right hinge", "left hinge"]
    targets = np.array([[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])
    batch["machine"].set_motor(joints, targets)
    for world, of_world in zip(worlds, targets):
        for joint, target in zip(joints, of_world):
            world["machine"].set_motor(joint, target)
    run(batch, worlds, 3)
    batch["machine"].set_motor(joints, 0.2, most=np.full((N, 2), 5))
    for world in worlds:
        for joint in joints:
            world["machine"].set_motor(joint, 0.2, most=5)
    run(batch, worlds, 3)


def test_poses_are_set_and_read() -> None:
    batch, worlds = pair()
    to = np.array([[0, 0.1 * i, 0] for i in range(N)])
    turned = np.array([[0, np.sin(0.1 * i), 0, np.cos(0.1 * i)] for i in range(N)])
    batch["machine"].set_pose("post", to, turned)
    for world, position, rotation in zip(worlds, to, turned):
        world["machine"].set_pose("post", position, rotation)
    run(batch, worlds, 1)
    batch["machine"].set_pose(0, (0, 0, 0.2))
    for world in worlds:
        world["machine"].set_pose(0, (0, 0, 0.2))
    run(batch, worlds, 1)
    positions, rotations = batch["machine"].poses(["left", "right", 0])
    assert positions.shape == (N, 3, 3) and rotations.shape == (N, 3, 4)
    for i, world in enumerate(worlds):
        for k, body in enumerate(["left", "right", "post"]):
            pose = world["machine"].pose(body)
            assert (tuple(positions[i, k]), tuple(rotations[i, k])) == (pose.position, pose.rotation)
            assert tuple(batch["machine"].poses(body)[0][i]) == pose.position
    assert tuple(batch["machine"].poses()[0][1]) == pytest.approx((0, 0, 0.2))


def test_states_and_loads_of_joints() -> None:
    batch, worlds = pair()
    batch["machine"].set_motor("left hinge", [0.5, -0.5, 1])
    for world, target in zip(worlds, [0.5, -0.5, 1]):
        world["machine"].set_motor("left hinge", target)
    run(batch, worlds)
    machine = batch["machine"]
    joints: list[int | str] = ["left hinge", 1]
    states, loads, means = machine.joint_states(joints), machine.joint_loads(joints), machine.mean_joint_loads(joints)
    assert states.rotation.shape == loads.force.shape == means.torque.shape == (N, 2, 3)
    one = machine.joint_states("right hinge"), machine.joint_loads(1), machine.mean_joint_loads("right hinge")
    for i, world in enumerate(worlds):
        alone = world["machine"]
        for k, joint in enumerate(joints):
            for table, values in [
                (states, alone.joint_state(joint)),
                (loads, alone.joint_load(joint)),
                (means, alone.mean_joint_load(joint)),
            ]:
                assert [tuple(part[i, k]) for part in table] == list(values)
        for table, values in zip(one, (alone.joint_state(1), alone.joint_load(1), alone.mean_joint_load(1))):
            assert [tuple(part[i]) for part in table] == list(values)
    assert states.rotation[0, 0, 0] > 0 > states.rotation[1, 0, 0] and means.force[:, :, 1].min() > 100


def test_recording_ends() -> None:
    batch, worlds = pair()
    batch.record_contact_events()
    batch.step()
    batch.record_joint_loads(False)
    batch.record_contact_events(False)
    batch.step()
    with pytest.raises(pliant.Error, match="record_joint_loads"):
        batch["machine"].mean_joint_loads("left hinge")


def without_motor(scene: pliant.Scene, i: int) -> None:
    """The right hinge of the last world has no motor."""
    if i == N - 1:
        del scene["objects"][0]["joints"][1]["hinge"]["motor"]


def with_torque(scene: pliant.Scene, i: int) -> None:
    """The right motor of the last world is given a torque, which has no greatest torque beside it."""
    if i == N - 1:
        scene["objects"][0]["joints"][1]["hinge"]["motor"] = {"torque": 1}


def with_two(scene: pliant.Scene, i: int) -> None:
    """The right joint of the last world is a slider that also turns, and has two motors."""
    if i == N - 1:
        slides = {"anchor": [0.15, 0, 0], "axis": [0, 1, 0], "slide_motor": {"speed": 0, "most": 5}}
        scene["objects"][0]["joints"][1]["cylindrical"] = {**slides, "turn_motor": {"speed": 0, "most": 5}}
        del scene["objects"][0]["joints"][1]["hinge"]


def changes_nothing(batch: pliant.Batch, same: pliant.Batch, call: Callable[[Any], Any], match: str) -> None:
    """The call is refused, and the next step is that of a Batch without it."""
    with pytest.raises(pliant.Error, match=match):
        call(batch["machine"])
    assert batch.state_hashes() == same.state_hashes()
    batch.step()
    same.step()
    assert batch.state_hashes() == same.state_hashes()


RIGHT = "right hinge"
REFUSED_BY_ONE: dict[str, tuple[Any, Callable[[Any], Any], str]] = {
    "no motor": (without_motor, lambda m: m.set_motor(RIGHT, 1), "'right hinge': has no motor"),
    "no motor of a list": (without_motor, lambda m: m.set_motor(["left hinge", RIGHT], 1), "has no motor"),
    "a torque motor": (with_torque, lambda m: m.set_motor(RIGHT, 1, most=5), "beside its own"),
    "two motors": (with_two, lambda m: m.set_motor(RIGHT, 1), "has several motors"),
    "no such motor": (None, lambda m: m.set_motor(["left hinge", RIGHT], 1, motor="turbo"), "has no motor 'turbo'"),
    "a target that is too large": (None, lambda m: m.set_motor(RIGHT, [1, 1, 2e30]), "not finite"),
    "a tiny rotation": (None, lambda m: m.set_pose("post", (0, 0.1, 0), [[0, 0, 0, 1]] * 2 + [[0, 0, 0, 1e-16]]), "zero"),
    "a far place": (None, lambda m: m.set_pose("post", [[0, 0.1, 0]] * 2 + [[2e9, 0, 0]]), "1e9 m from the origin"),
    "a huge one": (None, lambda m: m.set_pose("post", (0, 0.1, 0), [[0, 0, 0, 1]] * 2 + [[0, 0, 0, 1e20]]), "too large"),
}  # fmt: skip


@pytest.mark.parametrize("refused", REFUSED_BY_ONE)
def test_what_one_world_refuses_is_set_in_none(refused: str) -> None:
    vary, call, match = REFUSED_BY_ONE[refused]
    changes_nothing(pliant.Batch(two_doors(), N, vary=vary), pliant.Batch(two_doors(), N, vary=vary), call, match)


@pytest.mark.parametrize("joints", [("left hinge", "right hinge"), np.array(["left hinge", "right hinge"])])
def test_any_sequence_of_names_or_indices(joints: Any) -> None:
    batch, worlds = pair()
    batch["machine"].set_motor(joints, 0.3)
    for world in worlds:
        world["machine"].set_motor("left hinge", 0.3)
        world["machine"].set_motor("right hinge", 0.3)
    run(batch, worlds, 2)
    machine = batch["machine"]
    sequences: list[Any] = [np.arange(3), range(3), (0, 1, 2)]
    for of in sequences:
        np.testing.assert_array_equal(machine.poses(of)[0], machine.poses(["post", "left", "right"])[0])


LEFT = "left hinge"
BAD: dict[str, Callable[[Any], Any]] = {
    "no joint": lambda m: m.set_motor("lock", 1),
    "no joint in a list": lambda m: m.set_motor([LEFT, "lock"], 1),
    "a joint by index": lambda m: m.set_motor(0, 1),
    "no joints": lambda m: m.set_motor([], 1),
    "no motor": lambda m: m.set_motor(LEFT, 1, motor="turbo"),
    "a motor of no str": lambda m: m.set_motor(LEFT, 1, motor=3),
    "two targets": lambda m: m.set_motor(LEFT, [1, 2]),
    "a target for each joint": lambda m: m.set_motor([LEFT, "right hinge"], [1, 2]),
    "targets for more joints": lambda m: m.set_motor([LEFT, "right hinge"], np.zeros((N, 3))),
    "a table for one joint": lambda m: m.set_motor(LEFT, np.zeros((N, 1))),
    "a target of nan": lambda m: m.set_motor(LEFT, [1, 2, np.nan]),
    "one target of nan": lambda m: m.set_motor(LEFT, np.nan),
    "a target of text": lambda m: m.set_motor(LEFT, "far"),
    "a target of True": lambda m: m.set_motor(LEFT, True),
    "a target of None": lambda m: m.set_motor(LEFT, None),
    "most of zero": lambda m: m.set_motor(LEFT, 1, most=[1, 2, 0]),
    "most of nan": lambda m: m.set_motor(LEFT, 1, most=np.nan),
    "most of text": lambda m: m.set_motor(LEFT, 1, most="all"),
    "most of two": lambda m: m.set_motor(LEFT, 1, most=[1, 2]),
    "a dynamic body": lambda m: m.set_pose("left", (0, 0, 0)),
    "a dynamic body by index": lambda m: m.set_pose(1, (0, 0, 0)),
    "no body to set": lambda m: m.set_pose("window", (0, 0, 0)),
    "no body 9": lambda m: m.set_pose(9, (0, 0, 0)),
    "bodies to set": lambda m: m.set_pose(["post"], (0, 0, 0)),
    "a pose of nan": lambda m: m.set_pose("post", [[0, 0, 0], [0, 0, 0], [0, np.nan, 0]]),
    "poses of two worlds": lambda m: m.set_pose("post", np.zeros((2, 3))),
    "poses of text": lambda m: m.set_pose("post", "here"),
    "a rotation of zero": lambda m: m.set_pose("post", (0, 0, 0), (0, 0, 0, 0)),
    "a rotation of three": lambda m: m.set_pose("post", (0, 0, 0), (0, 0, 0)),
    "rotations of nan": lambda m: m.set_pose("post", (0, 0, 0), (0, 0, 0, np.nan)),
    "no such body": lambda m: m.poses("window"),
    "a body of bytes": lambda m: m.poses(b"post"),
    "bodies of fractions": lambda m: m.poses([0.5]),
    "bodies of a dict": lambda m: m.poses({"post": 1}),
    "no such body in a list": lambda m: m.poses(["post", "window"]),
    "a body of an array": lambda m: m.poses(np.zeros(3)),
    "a state of no joint": lambda m: m.joint_states("lock"),
    "a state of joint 7": lambda m: m.joint_states(7),
    "a state of joint None": lambda m: m.joint_states([None]),
    "a state of joint True": lambda m: m.joint_states(True),
    "a load of no joint": lambda m: m.joint_loads(-1),
    "a mean load that is not recorded": lambda m: m.mean_joint_loads(LEFT),
}  # fmt: skip


@pytest.mark.parametrize("bad", BAD)
def test_misuse(bad: str) -> None:
    batch, same = pliant.Batch(two_doors(), N), pliant.Batch(two_doors(), N)
    with pytest.raises((ValueError, TypeError, KeyError)) as caught:
        BAD[bad](batch["machine"])
    assert str(caught.value) and "::" not in str(caught.value) and "std" not in str(caught.value)
    batch.step()
    same.step()
    assert batch.state_hashes() == same.state_hashes()
