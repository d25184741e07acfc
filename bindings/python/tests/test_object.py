"""Objects and colliders: arrays in and out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import cloth_scene

import pliant


def test_positions_are_in_the_order_of_the_mesh(world: pliant.World) -> None:
    vertices, triangles = pliant.grid_mesh(6, 6, 1, 1)
    cloth = world["cloth"]
    np.testing.assert_array_equal(cloth.positions(), vertices)
    out = np.full((36, 3), np.nan, np.float32)
    assert cloth.positions(out) is out
    np.testing.assert_array_equal(out, vertices)
    at, corners = cloth.mesh()
    np.testing.assert_array_equal(at, vertices)
    np.testing.assert_array_equal(corners, triangles)
    assert cloth.particles == len(cloth) == 36 and cloth.constraints["distance"] == 85
    assert repr(cloth) == "<pliant.Object 'cloth': 36 particles>"


def test_velocities_impulses_and_forces() -> None:
    scene = pliant.Scene(gravity=(0, 0, 0))
    scene.add(particles={"positions": np.eye(3), "masses": [1, 2, 4]}, name="dust")
    dust = (world := pliant.World(scene))["dust"]
    dust.set_velocities([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    dust.add_impulses(np.full((3, 3), 8.0))
    np.testing.assert_allclose(dust.velocities(), [[9, 8, 8], [4, 5, 4], [2, 2, 3]])
    dust.set_velocities(np.zeros((3, 3), np.float32))
    dust.set_forces([[60, 0, 0]] * 3)
    world.step()
    np.testing.assert_allclose(dust.velocities()[:, 0], [1, 0.5, 0.25], rtol=1e-5)
    world.step()
    np.testing.assert_allclose(dust.velocities()[:, 0], [1, 0.5, 0.25], rtol=1e-5)


def unaligned(rows: Any) -> Any:
    """A read-only array at an odd address, as one that came over a network can be."""
    array = np.asarray(rows, np.float32)
    return np.frombuffer(b"0" + array.tobytes(), np.uint8)[1:].view(np.float32).reshape(array.shape)


ARRAYS = [unaligned, list, np.asarray, lambda a: np.asarray(a)[::-1][::-1], lambda a: np.asarray(a, np.float64)]


@pytest.mark.parametrize("make", ARRAYS)
def test_targets_are_reached(world: pliant.World, make) -> None:  # type: ignore[no-untyped-def]
    cloth = world["cloth"]
    cloth.set_targets([0, 5], make([[-0.5, 0.1, -0.5], [0.5, 0.2, -0.5]]))
    world.step()
    np.testing.assert_allclose(cloth.positions()[[0, 5]], [[-0.5, 0.1, -0.5], [0.5, 0.2, -0.5]], atol=1e-6)


def test_attachment_targets() -> None:
    scene = cloth_scene()
    scene["objects"][0]["attachments"] = [{"particles": [35], "target": [0.5, 0, 0.5]}]
    del scene["objects"][0]["pins"]
    world = pliant.World(scene, threads=1)
    world["cloth"].set_attachment_targets([0], [[0.5, 1, 0.5]])
    world.run(5)
    assert world["cloth"].positions()[35, 1] == pytest.approx(1, abs=0.05)


def test_teleport(world: pliant.World) -> None:
    before = world["cloth"].positions()
    world["cloth"].teleport((0, 2, 0))
    np.testing.assert_allclose(world["cloth"].positions(), before + [0, 2, 0], atol=1e-6)
    world["cloth"].teleport(rotation=(0, 0, 1, 0))
    np.testing.assert_allclose(world["cloth"].positions()[:, 1], -(before + [0, 2, 0])[:, 1], atol=1e-6)


def test_colliders_move(world: pliant.World) -> None:
    ball, board = world.collider("ball"), world.mesh_collider("board")
    ball.set_pose((0, -0.4, 0), (0, 0, 0, 1))
    board.set_pose([0, 0.1, 0])
    world.step()
    np.testing.assert_allclose(ball.pose().position, (0, -0.4, 0), atol=1e-6)
    np.testing.assert_allclose(board.positions()[:, 1], -0.9, atol=1e-6)
    ball.teleport((0, -1, 0))
    np.testing.assert_allclose(ball.pose().position, (0, -1.4, 0), atol=1e-6)
    corners = board.positions(np.empty((4, 3), np.float32)) + np.float32(0.1)
    board.set_positions(corners)
    world.step()
    np.testing.assert_allclose(board.positions(), corners, atol=1e-6)
    ball.set_surface_velocity((1, 0, 0))
    board.set_surface_velocity((1, 0, 0))


def test_bodies_joints_and_motors(machine_scene: pliant.Scene) -> None:
    world = pliant.World(machine_scene, threads=1)
    machine = world["machine"]
    assert machine.pose("door").position == pytest.approx((0.6, 0, 0))
    assert machine.pose(0) == machine.pose("post") == pliant.Pose((0, 0, 0), (0, 0, 0, 1))
    machine.set_motor("hinge", target=np.pi / 2, most=5000)
    world.run(120)
    assert machine.pose("door").rotation[1] == pytest.approx(np.sin(np.pi / 4), abs=0.02)
    load = machine.joint_load(0)
    weight = 1.8 * 0.8 * 0.04 * 1000 * 9.81
    assert load.force[1] == pytest.approx(weight, rel=0.02)
    assert machine.joint_load("hinge") == load
    state = machine.joint_state("hinge")
    assert state.rotation == pytest.approx((np.pi / 2, 0, 0), abs=0.02) and state.angular_velocity[0] < 0.1
    with pytest.raises(pliant.Error, match="record_joint_loads"):
        machine.mean_joint_load("hinge")
    world.record_joint_loads()
    world.step()
    assert machine.mean_joint_load(0).force[1] == pytest.approx(weight, rel=0.02)
    assert not machine.joint_is_broken(0) and not machine.body_is_asleep(1)
    machine.set_pose("post", (0, 0.5, 0))
    world.step()
    assert machine.pose("post").position == pytest.approx((0, 0.5, 0))
    assert machine.orientations().shape == (2, 4) and machine.angular_velocities().shape == (2, 3)


def test_a_balloon_has_a_volume_and_a_gas_a_temperature() -> None:
    scene = pliant.Scene(gravity=(0, 0, 0), settings={"record_multipliers": True})
    scene.add(cloth={"mesh": pliant.sphere_mesh(3), "material": "rubber sheet"}, name="ball")
    world = pliant.World(scene)
    assert world["ball"].enclosed_volume() == pytest.approx(4 / 3 * np.pi, rel=0.02)
    world.step()
    assert world["ball"].multipliers("distance").shape == (world["ball"].constraints["distance"],)
    with pytest.raises(pliant.Error, match="no constraints of the type 'dist'; it has .*'distance'"):
        world["ball"].multipliers("dist")
    np.testing.assert_array_equal(world["ball"].present(), np.arange(world["ball"].particles))
    with pytest.raises(pliant.Error, match="no channel 'temperature'"):
        world["ball"].channel("temperature")
