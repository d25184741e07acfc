"""Gauges of a scene."""

from __future__ import annotations

import math

import pytest

import pliant


def falling_cube() -> pliant.Scene:
    """A cube of water of 0.1 m above a floor; it falls freely at first."""
    scene = pliant.Scene(frame_time=1 / 60, gravity=(0, -10, 0))
    scene.add(liquid={"fill": {"min": [0, 1, 0], "max": [0.1, 1.1, 0.1]}, "spacing": 0.02}, name="water")
    scene.add_collider(plane={}, name="floor")
    scene["gauges"] = [
        {"name": "depth", "height": {"min": [0, 0, 0], "max": [0.1, 2, 0.1]}},
        {"name": "flow", "flow": {"corner": [-1, 1.05, -1], "side_a": [4, 0, 0], "side_b": [0, 0, 4]}},
        {"name": "front", "front": {"direction": [0, -1, 0]}},
        {"name": "force", "force": {"on": "floor"}},
    ]
    return scene


def test_gauges_are_read_by_name() -> None:
    world = pliant.World(falling_cube())
    gauges = world.gauges()
    assert gauges.units == {"depth": "m", "flow": "m^3/s", "front": "m", "force": "N"}
    first = gauges.read()
    assert first["depth"] == pytest.approx(0.1, rel=0.01) and first["front"] == pytest.approx(-1, abs=0.01)
    assert math.isnan(first["flow"]) and math.isnan(first["force"])
    for _ in world.frames(6):
        values = gauges.read()
    seconds = 5.5 / 60  # the middle of the last frame; side_a x side_b points down
    assert values["flow"] == pytest.approx(0.1 * 0.1 * 10 * seconds, rel=0.1)
    assert values["front"] == pytest.approx(-1 + 10 * 0.1**2 / 2, abs=0.01) and values["force"] == 0
    assert repr(gauges) == "<pliant.Gauges: 4 gauges>"


def test_gauges_keep_their_world() -> None:
    gauges = pliant.World(falling_cube()).gauges()
    assert gauges.read()["depth"] == pytest.approx(0.1, rel=0.01)


def test_what_gauges_cannot_measure_is_named(world: pliant.World) -> None:
    with pytest.raises(pliant.Error, match="the scene has no gauges"):
        world.gauges()
    falling = pliant.World(falling_cube())
    falling.remove(falling.collider("floor"))
    with pytest.raises(pliant.Error, match="the force on 'floor', which does not exist"):
        falling.gauges()
