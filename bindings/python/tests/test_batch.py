"""Batches: many worlds, each with the bits that it has alone."""

from __future__ import annotations

import pathlib
import subprocess
import sys
from typing import Any, Callable

import numpy as np
import pytest
from conftest import cloth_scene, seconds_until_interrupted

import pliant


def alone(scene: pliant.Scene, frames: int) -> pliant.World:
    world = pliant.World(scene, threads=1)
    world.run(frames)
    return world


@pytest.mark.parametrize("threads", [0, 1, 2, 3, 7])
def test_each_has_the_bits_that_it_has_alone(threads: int) -> None:
    gravities = [[0, -float(i), 0] for i in range(7)]
    batch = pliant.Batch(cloth_scene(), 7, vary={"/gravity": gravities}, threads=threads)
    reports = [batch.step()[0], *batch.run(4)]
    assert [report.frame for report in reports] == [1] + [5] * 7
    for gravity, of_batch in zip(gravities, batch.state_hashes()):
        scene = cloth_scene()
        scene["gravity"] = gravity
        assert alone(scene, 5).state_hash() == of_batch
    assert len(set(batch.state_hashes())) == 7


def test_equal_worlds_are_equal() -> None:
    batch = pliant.Batch(cloth_scene(), 4)
    batch.run()
    assert set(batch.state_hashes()) == {alone(cloth_scene(), 5).state_hash()}
    assert len(batch) == len(batch.worlds) == 4 and batch.worlds[2].frame == 5
    assert repr(batch) == "<pliant.Batch of 4 worlds>"


def test_vary_that_is_wrong_says_where() -> None:
    with pytest.raises(TypeError, match="return nothing"):
        pliant.Batch(cloth_scene(), 2, vary=lambda scene, i: scene.copy())
    with pytest.raises(pliant.Error, match="of world 1: -1 is out of range"):
        pliant.Batch(cloth_scene(), 3, vary={"/objects/0/thickness": [0.01, -1, 0.01]})


def test_vary_by_a_function() -> None:
    def vary(scene: pliant.Scene, i: int) -> None:
        scene["objects"][0]["cloth"]["material"] = ["cotton", "silk"][i]

    batch = pliant.Batch(cloth_scene(), 2, vary=vary)
    batch.run(3)
    silk = cloth_scene()
    silk["objects"][0]["cloth"]["material"] = "silk"
    assert batch.state_hashes() == [alone(cloth_scene(), 3).state_hash(), alone(silk, 3).state_hash()]


def test_arrays_of_all_worlds() -> None:
    batch = pliant.Batch(cloth_scene(), 3, vary={"/gravity": [[0, 0, 0], [0, -5, 0], [0, -9, 0]]})
    cloth = batch["cloth"]
    assert (cloth.name, cloth.particles, len(cloth)) == ("cloth", 36, 3)
    targets = np.array([[[-0.5, 0.01 * i, -0.5], [0.5, 0, -0.5]] for i in range(3)])
    cloth.set_targets([0, 5], targets)
    cloth.set_velocities(np.zeros((3, 36, 3)))
    cloth.add_impulses(np.zeros((3, 36, 3), np.float32))
    cloth.set_forces(np.zeros((3, 36, 3)))
    batch.step()
    out = np.empty((3, 36, 3), np.float32)
    assert cloth.positions(out) is out
    for i, world in enumerate(batch.worlds):
        np.testing.assert_array_equal(out[i], world["cloth"].positions())
        np.testing.assert_array_equal(cloth.velocities()[i], world["cloth"].velocities())
        np.testing.assert_allclose(out[i, 0], targets[i, 0], atol=1e-6)


def test_motors_and_poses(machine_scene: pliant.Scene) -> None:
    batch = pliant.Batch(machine_scene, 2)
    batch["machine"].set_motor("hinge", [0.5, -0.5], most=5000)
    batch.run(60)
    positions, rotations = batch["machine"].poses("door")
    assert positions.shape == (2, 3)
    np.testing.assert_allclose(rotations[:, 1], [np.sin(0.25), -np.sin(0.25)], atol=0.02)


def test_states() -> None:
    batch = pliant.Batch(cloth_scene(), 3, vary={"/gravity": [[0, 0, 0], [0, -5, 0], [0, -9, 0]]})
    batch.run(2)
    states = batch.states()
    before = batch.state_hashes()
    batch.run(2)
    later = batch.state_hashes()
    batch.restore(states)
    assert batch.state_hashes() == before
    batch.run(2)
    assert batch.state_hashes() == later
    batch.restore(states[1])
    assert set(batch.state_hashes()) == {before[1]}


def batch_of(n: int = 3) -> pliant.Batch:
    return pliant.Batch(cloth_scene(), n)


def third_of(shape: tuple[int, ...], value: float) -> np.ndarray[Any, np.dtype[np.float32]]:
    """Ones, but for a value of the last particle in the last world."""
    array = np.ones(shape, np.float32)
    array[2, -1, 1] = value
    return array


BAD: dict[str, Callable[[pliant.Batch], Any]] = {
    "none": lambda b: batch_of(0),
    "less than none": lambda b: batch_of(-1),
    "too many": lambda b: batch_of(10**8),
    "a fraction": lambda b: batch_of(2.5),  # type: ignore[arg-type]
    "no scene": lambda b: pliant.Batch(None, 3),  # type: ignore[arg-type]
    "a wrong scene": lambda b: pliant.Batch({"objects": [{}]}, 3),
    "threads below zero": lambda b: pliant.Batch(cloth_scene(), 3, threads=-1),
    "values for fewer": lambda b: pliant.Batch(cloth_scene(), 3, vary={"/gravity": [[0, 0, 0]]}),
    "values of a number": lambda b: pliant.Batch(cloth_scene(), 3, vary={"/gravity": 3}),
    "values of a str": lambda b: pliant.Batch(cloth_scene(), 3, vary={"/description": "abc"}),
    "a wrong value": lambda b: pliant.Batch(cloth_scene(), 3, vary={"/gravity": [1, 2, 3]}),
    "a wrong pointer": lambda b: pliant.Batch(cloth_scene(), 1, vary={"gravity": [1]}),
    "vary by a number": lambda b: pliant.Batch(cloth_scene(), 3, vary=3),  # type: ignore[arg-type]
    "a function that raises": lambda b: pliant.Batch(cloth_scene(), 3, vary=lambda s, i: s["nothing"]),
    "no object": lambda b: b["shirt"],
    "a number for a name": lambda b: b[0],  # type: ignore[index]
    "frames": lambda b: b.run(0),
    "dt of zero": lambda b: b.step(0),
    "dt that is too short": lambda b: b.step(1e-12),
    "dt of nan": lambda b: b.step(float("nan")),
    "dt of True": lambda b: b.step(True),
    "frames of True": lambda b: b.run(True),
    "frames of text": lambda b: b.run("2"),  # type: ignore[arg-type]
    "dt of text": lambda b: b.step("1"),  # type: ignore[arg-type]
    "out of one world": lambda b: b["cloth"].positions(np.zeros((36, 3), np.float32)),
    "out of float64": lambda b: b["cloth"].positions(np.zeros((3, 36, 3))),  # type: ignore[arg-type]
    "out of more worlds": lambda b: b["cloth"].velocities(np.zeros((4, 36, 3), np.float32)),
    "forces of one world": lambda b: b["cloth"].set_forces(np.zeros((36, 3))),
    "forces of fewer worlds": lambda b: b["cloth"].set_forces(np.zeros((2, 36, 3))),
    "forces of fewer particles": lambda b: b["cloth"].set_forces(np.zeros((3, 35, 3))),
    "forces of text": lambda b: b["cloth"].set_forces(np.full((3, 36, 3), "a")),
    "ragged impulses": lambda b: b["cloth"].add_impulses([[1], [2, 3]]),  # type: ignore[arg-type]
    "nan": lambda b: b["cloth"].set_velocities(np.full((3, 36, 3), np.nan)),
    "velocities with a nan": lambda b: b["cloth"].set_velocities(third_of((3, 36, 3), np.nan)),
    "impulses with a nan": lambda b: b["cloth"].add_impulses(third_of((3, 36, 3), np.nan)),
    "impulses that are too large": lambda b: b["cloth"].add_impulses(third_of((3, 36, 3), 3e38)),
    "a target of nan": lambda b: b["cloth"].set_targets([0], third_of((3, 1, 3), np.nan)),
    "no pin": lambda b: b["cloth"].set_targets([7], np.zeros((3, 1, 3))),
    "targets of one world": lambda b: b["cloth"].set_targets([0], np.zeros((1, 3))),
    "no attachment": lambda b: b["cloth"].set_attachment_targets([0], np.zeros((3, 1, 3))),
    "no joint": lambda b: b["cloth"].set_motor("hinge", [0, 0, 0]),
    "fewer targets": lambda b: b["cloth"].set_motor("hinge", [0]),
    "no body": lambda b: b["cloth"].poses("door"),
    "a body of a fraction": lambda b: b["cloth"].poses(1.5),  # type: ignore[arg-type]
    "a body of None": lambda b: b["cloth"].poses(None),  # type: ignore[arg-type]
    "restoring nothing": lambda b: b.restore(None),  # type: ignore[arg-type]
    "restoring Nones": lambda b: b.restore([None] * 3),  # type: ignore[list-item]
    "restoring fewer": lambda b: b.restore(b.states()[:2]),
    "restoring another's": lambda b: b.restore(pliant.World(cloth_scene(7)).state()),
    "a batch that was not made": lambda b: pliant.Batch.__new__(pliant.Batch).step(),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore:nanobind")
@pytest.mark.parametrize("bad", BAD)
def test_misuse(bad: str) -> None:
    batch = batch_of()
    before = batch.state_hashes()
    with pytest.raises((ValueError, TypeError, KeyError)) as caught:
        BAD[bad](batch)
    assert str(caught.value)
    assert batch.state_hashes() == before
    assert all(report.ok for report in batch.step())


def test_what_is_refused_leaves_no_force_or_target() -> None:
    batch, same = batch_of(), batch_of()
    for bad in (np.nan, np.inf):
        with pytest.raises(pliant.Error, match="row 35 of world 2"):
            batch["cloth"].set_forces(third_of((3, 36, 3), bad))
        with pytest.raises(pliant.Error, match="row 0 of world 2"):
            batch["cloth"].set_targets([0], third_of((3, 1, 3), bad))
    batch.step()
    same.step()
    assert batch.state_hashes() == same.state_hashes()


def hold_and_attach(world: pliant.World) -> None:
    with world.edit("cloth") as edit:
        edit.pin([7])
        edit.attach([35], [[0.5, 0.3, 0.5]])


@pytest.mark.parametrize("call", ["set_targets", "set_attachment_targets"])
def test_targets_that_one_world_refuses_are_set_in_none(call: str) -> None:
    """The last world has neither the pin nor the attachment."""
    batch, same = batch_of(), batch_of()
    for world in (*batch.worlds[:2], *same.worlds[:2]):
        hold_and_attach(world)
    which, message = ([7], "is dynamic") if call == "set_targets" else ([0], "there are 0")
    targets = np.ones((3, 1, 3))
    with pytest.raises(pliant.Error, match=message):
        getattr(batch["cloth"], call)(which, targets)
    batch.step()
    same.step()
    assert batch.state_hashes() == same.state_hashes()
    hold_and_attach(batch.worlds[2])
    getattr(batch["cloth"], call)(which, targets)


def test_targets_of_sheets_that_tore() -> None:
    """What they are now counts, not what they were."""
    scene = cloth_scene()
    scene["objects"][0]["tearing"] = {"stretch": 1.2}
    batch = pliant.Batch(scene, 2)
    for world in batch.worlds:
        with world.edit("cloth") as edit:
            edit.cut([12, 13, 14, 15, 16, 17])
            edit.pin([41])
    batch["cloth"].set_targets([0, 41], np.zeros((2, 2, 3)))
    with pytest.raises(pliant.Error, match="particle 42"):
        batch["cloth"].set_targets([42], np.zeros((2, 1, 3)))


def test_an_object_that_one_world_lost_is_named() -> None:
    batch = batch_of()
    cloth = batch["cloth"]
    batch.worlds[1].remove("cloth")
    for call in (cloth.positions, lambda: cloth.set_targets([0], np.zeros((3, 1, 3)))):
        with pytest.raises(pliant.Error, match="'cloth'.* was removed from world 1 of the Batch"):
            call()


def test_motors_are_set_in_all_worlds_or_none(machine_scene: pliant.Scene) -> None:
    batch = pliant.Batch(machine_scene, 3)
    before = batch.state_hashes()
    with pytest.raises(pliant.Error, match="world 2 is not finite"):
        batch["machine"].set_motor("hinge", [1, 2, np.nan])
    assert batch.state_hashes() == before


def test_a_list_of_states_is_restored_in_all_worlds_or_none() -> None:
    batch = batch_of()
    start = batch.states()
    batch.run(2)
    before = batch.state_hashes()
    with pytest.raises(pliant.Error):
        batch.restore([*start[:2], pliant.World(cloth_scene(7)).state()])
    assert batch.state_hashes() == before
    records = batch.worlds[2]["cloth"].records()
    with pytest.raises(pliant.Error, match="view of its records"):
        batch.restore(start)
    assert batch.state_hashes() == before and len(records) > 0


def test_different_numbers_of_particles() -> None:
    batch = pliant.Batch(cloth_scene(), 2, vary=lambda scene, i: scene.update(cloth_scene(6 + i)))
    with pytest.raises(pliant.Error, match="36 particles in world 0, but 49 in world 1"):
        batch["cloth"]
    assert [world["cloth"].particles for world in batch.worlds] == [36, 49]


def test_a_world_of_a_batch_can_be_changed() -> None:
    batch = batch_of()
    rope = {"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 4}}
    batch.worlds[1].add(rope=rope)
    batch.step()
    with pytest.raises(KeyError):
        batch["rope"]
    assert batch["cloth"].positions().shape == (3, 36, 3)
    batch.worlds[1].remove("cloth")
    with pytest.raises(KeyError):
        batch["cloth"]


def test_a_batch_works_after_a_fork() -> None:
    """The child has none of the threads. Also in a program of its own: other tests leave other threads behind."""
    program = """
import os, sys, pliant
sys.path.insert(0, TESTS)
from conftest import cloth_scene
batch = pliant.Batch(cloth_scene(), 3, threads=2)
batch.step()
child = os.fork()
batch.step()
hashes = batch.state_hashes()
if child == 0:
    os._exit(0 if len(set(hashes)) == 1 and batch.worlds[0].frame == 2 else 1)
assert os.waitpid(child, 0)[1] == 0
"""
    text = program.replace("TESTS", repr(str(pathlib.Path(__file__).parent)))
    subprocess.run([sys.executable, "-c", text], check=True, timeout=120)


def test_ctrl_c_ends_a_batch() -> None:
    program = """
import pliant
scene = pliant.Scene()
scene.add(cloth={"mesh": pliant.grid_mesh(60, 60, 1, 1)}, pins=[{"particles": [0]}])
batch = pliant.Batch(scene, 4)
print("ready", flush=True)
try:
    batch.run(10**9)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    seconds_until_interrupted(program)
