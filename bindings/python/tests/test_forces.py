"""Forces that are functions: what they get and do, what they raise, and that Python can collect them."""

from __future__ import annotations

import copy
import gc
import pathlib
import signal
import subprocess
import sys
import weakref
from typing import Any, Callable, Iterator

import numpy as np
import pytest
from conftest import cloth_scene

import pliant


@pytest.fixture
def new_garbage_alone() -> Iterator[None]:
    """The collector looks only at what the test makes; what mypy left of other tests takes it seconds."""
    gc.freeze()
    yield
    gc.unfreeze()


def test_a_force_on_arrays() -> None:
    """A particle of 2 kg under 6 N for half a second: 1.5 m/s."""
    scene = pliant.Scene(gravity=(0, 0, 0))
    scene.add(particles={"positions": np.zeros((1, 3)), "masses": [2]}, name="ball")
    scene.add(particles={"positions": np.ones((1, 3)), "masses": [2]}, name="other")
    seen = []

    def push(arrays: pliant.ForceArrays) -> None:
        seen.append((arrays.object, arrays.time, float(arrays.masses[0])))
        arrays.forces[:, 0] = 6

    world = pliant.World(scene, forces={"ball": push})
    world.run(30)
    np.testing.assert_allclose(world["ball"].velocities(), [[1.5, 0, 0]], rtol=1e-5)
    np.testing.assert_array_equal(world["other"].velocities(), [[0, 0, 0]])
    assert {name for name, _, _ in seen} == {"ball"} and seen[0][2] == 2
    everywhere = pliant.World(scene, forces=push)
    everywhere.run(30)
    np.testing.assert_allclose(everywhere["other"].velocities(), [[1.5, 0, 0]], rtol=1e-5)


def test_masses_are_those_of_now() -> None:
    """Another object of the same name and number of particles, of 50 kg instead of 2."""
    scene = pliant.Scene(gravity=(0, 0, 0))
    scene.add(particles={"positions": np.zeros((1, 3)), "masses": [2]}, name="ball")
    seen = []

    def weigh(arrays: pliant.ForceArrays) -> None:
        seen.append(float(arrays.masses[0]))
        arrays.forces[:, 0] = arrays.masses

    world = pliant.World(scene, forces=weigh)
    world.step()
    world.remove("ball")
    world.add(particles={"positions": np.zeros((1, 3)), "masses": [50]}, name="ball")
    world.step()
    assert (seen[0], seen[-1]) == (2, 50)
    np.testing.assert_allclose(world["ball"].velocities(), [[1 / 60, 0, 0]], rtol=1e-5)


def test_a_handler_that_a_force_sets_stays() -> None:
    def is_ignored() -> bool:
        status = pathlib.Path("/proc/self/status").read_text()
        return bool(int(status.split("SigIgn:")[1].split()[0], 16) & 1 << (signal.SIGINT - 1))

    def ignore(arrays: pliant.ForceArrays) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    world = pliant.World(cloth_scene(), threads=1, forces=ignore)
    before = signal.getsignal(signal.SIGINT)
    try:
        world.run(1)
        assert is_ignored()
    finally:
        signal.signal(signal.SIGINT, before)


class Broken(Exception):
    pass


@pytest.mark.parametrize("call", [lambda w: w.step(), lambda w: w.run(3), lambda w: list(w.frames(3))])
def test_an_exception_of_a_force_comes_out_and_the_world_is_as_it_was(call: Callable[[pliant.World], Any]) -> None:
    fails_from = 2.5 / 60  # within the third frame

    def push(arrays: pliant.ForceArrays) -> None:
        arrays.forces[:, 0] = 1e-3
        if arrays.time > fails_from:
            raise Broken("no")

    world = pliant.World(cloth_scene(), threads=1, forces=push)
    world.run(2)
    before = world.state_hash()
    for _ in range(2):
        with pytest.raises(Broken, match="no"):
            call(world)
        assert world.state_hash() == before and world.frame == 2
    fails_from = 1e9
    assert world.step().ok
    alone = pliant.World(cloth_scene(), threads=1, forces=push)
    alone.run(3)
    assert world.state_hash() == alone.state_hash()


def test_run_goes_back_to_the_last_frame_that_was_complete() -> None:
    def push(arrays: pliant.ForceArrays) -> None:
        if arrays.time > 2.5 / 60:
            raise Broken

    world = pliant.World(cloth_scene(), threads=1, forces=push)
    with pytest.raises(Broken):
        world.run(5)
    assert world.frame == 2
    alone = pliant.World(cloth_scene(), threads=1)
    alone.run(2)
    assert world.state_hash() == alone.state_hash()


def returns_forces(arrays: pliant.ForceArrays) -> Any:
    return -0.1 * arrays.velocities


def yields(arrays: pliant.ForceArrays) -> Any:
    yield arrays.forces


@pytest.mark.parametrize("force", [returns_forces, yields, lambda arrays: arrays.forces, lambda arrays: 0])
def test_a_force_that_returns_something_is_refused(force: Any) -> None:
    world = pliant.World(cloth_scene(), threads=1, forces={"cloth": force})
    before = world.state_hash()
    for _ in range(2):
        with pytest.raises(TypeError, match=f"the force function '{force.__qualname__}' returned .*fill the array instead"):
            world.step()
    assert world.state_hash() == before


def test_a_force_may_put_an_array_of_its_own() -> None:
    """The array may have any type, and be another one in each call."""
    scene = pliant.Scene(gravity=(0, 0, 0))
    scene.add(particles={"positions": np.zeros((1, 3)), "masses": [2]}, name="ball")

    def push(arrays: pliant.ForceArrays) -> None:
        assert arrays.forces.dtype == np.float32 and not arrays.forces.any()
        arrays.forces = np.full((1, 3), 120.0)

    world = pliant.World(scene, forces=push)
    world.run(2)
    np.testing.assert_allclose(world["ball"].velocities(), [[2, 2, 2]], rtol=1e-5)


def test_a_force_cannot_use_its_world() -> None:
    def push(arrays: pliant.ForceArrays) -> None:
        world["cloth"].positions()

    world = pliant.World(cloth_scene(), threads=1, forces=push)
    with pytest.raises(pliant.Error, match="is stepping"):
        world.step()


@pytest.mark.usefixtures("new_garbage_alone")
def test_a_force_that_refers_to_its_world_is_collected() -> None:
    class Held:
        pass

    held = Held()
    gone = weakref.ref(held)

    def make() -> None:
        def push(arrays: pliant.ForceArrays) -> None:
            assert held is not None and world is not None

        world = pliant.World(cloth_scene(), threads=1, forces=push)
        world.step()

    make()
    del held
    gc.collect()
    assert gone() is None


@pytest.mark.usefixtures("new_garbage_alone")
@pytest.mark.parametrize("part", ["object", "collider", "mesh collider", "frames", "writer", "edit"])
def test_a_force_that_refers_to_a_part_of_its_world_is_collected(part: str, tmp_path: pathlib.Path) -> None:
    class Held:
        pass

    held = Held()
    gone = weakref.ref(held)

    def make() -> None:
        def push(arrays: pliant.ForceArrays) -> None:
            assert held is not None and world is not None and refers is not None

        world = pliant.World(cloth_scene(), threads=1, forces=push)
        parts: dict[str, Callable[[], Any]] = {
            "object": lambda: world["cloth"],
            "collider": lambda: world.collider("ball"),
            "mesh collider": lambda: world.mesh_collider("board"),
            "frames": lambda: world.frames(2),
            "writer": lambda: world.writer(tmp_path / "a.obj"),
            "edit": lambda: world.edit("cloth"),
        }
        refers = parts[part]()
        world.step()

    make()
    del held
    gc.collect()
    assert gone() is None


def test_forces_that_are_forgotten_act_no_more() -> None:
    def push(arrays: pliant.ForceArrays) -> None:
        arrays.forces[:, 1] = 1

    world = pliant.World(cloth_scene(), threads=1, forces=push)
    world.step()
    world.forget_forces()
    alone = pliant.World(cloth_scene(), threads=1)
    alone.restore(world.state())
    world.step()
    alone.step()
    assert world.state_hash() == alone.state_hash()


def test_a_world_of_forgotten_forces_is_still_not_saved() -> None:
    world = pliant.World(cloth_scene(), threads=1, forces=lambda arrays: None)
    world.forget_forces()
    with pytest.raises(pliant.Error, match="force fields"):
        copy.deepcopy(world)
    other = pliant.World(cloth_scene(), threads=1)
    other.restore(world.state())


def test_what_fails_without_forces_is_told_as_it_is() -> None:
    """After forces were forgotten, no State is kept, to which a step that fails would go back."""
    program = """
import pathlib, resource, pliant
scene = pliant.Scene()
scene.add(cloth={"mesh": pliant.grid_mesh(6, 6, 1, 1)}, name="cloth")
world = pliant.World(scene, threads=1, forces=lambda arrays: None)
world.step()
world.forget_forces()
world.add(cloth={"mesh": pliant.grid_mesh(100, 100, 1, 1)}, name="large", collides=True, self_collision=True)
used = int(pathlib.Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used, resource.RLIM_INFINITY))
held, size = [], 1 << 24
while size > 1 << 14:
    try:
        held.append(bytes(size))
    except MemoryError:
        size //= 2
try:
    world.step()
except MemoryError as error:
    held.clear()
    assert "not enough memory" in str(error) and "::" not in str(error), error
else:
    raise SystemExit("it had enough memory")
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)


@pytest.mark.usefixtures("new_garbage_alone")
def test_an_object_lives_without_the_name_of_its_world() -> None:
    """What is visited is not collected while something refers to it."""

    def push(arrays: pliant.ForceArrays) -> None:
        arrays.forces[:, 1] = 1e-3 * len(seen)
        seen.append(1)

    seen: list[int] = []
    cloth = pliant.World(cloth_scene(), threads=1, forces=push)["cloth"]
    gc.collect()
    assert cloth.positions().shape == (36, 3) and len(cloth) == 36
