"""Worlds that several tests use."""

from __future__ import annotations

import pathlib
import signal
import subprocess
import sys
import time

import pytest

import pliant

ROOT = pathlib.Path(__file__).parents[3]


def cloth_scene(n: int = 6) -> pliant.Scene:
    """A cloth of n x n particles that hangs from two corners, a ball below it, and a board that is a mesh."""
    scene = pliant.Scene(frame_time=1 / 60, frames=5)
    scene.add(cloth={"mesh": pliant.grid_mesh(n, n, 1, 1), "material": "cotton"}, pins=[{"particles": [0, n - 1]}])
    scene.add_collider(name="ball", sphere={"radius": 0.2}, position=[0, -0.5, 0])
    scene.add_collider(name="board", mesh=pliant.grid_mesh(2, 2, 1, 1), position=[0, -1, 0])
    return scene


@pytest.fixture
def world() -> pliant.World:
    return pliant.World(cloth_scene(), threads=1)


@pytest.fixture(scope="session")
def machine_scene() -> pliant.Scene:
    """A door on a hinge with a motor, and a kinematic body."""
    return pliant.Scene(
        objects=[
            {
                "name": "machine",
                "bodies": [
                    {"name": "post", "solids": [{"box": {"half_extents": [0.1, 1, 0.1]}}], "kinematic": True},
                    {"name": "door", "solids": [{"box": {"half_extents": [0.4, 0.9, 0.02]}}], "position": [0.6, 0, 0]},
                ],
                "joints": [
                    {
                        "name": "hinge",
                        "between": ["post", "door"],
                        "hinge": {"anchor": [0.15, 0, 0], "axis": [0, 1, 0], "motor": {"position": 0, "most": 500}},
                    }
                ],
            }
        ]
    )


def seconds_until_interrupted(program: str) -> float:
    """Runs a program that prints "ready", sends it a Ctrl-C, and expects it to print "interrupted". Returns how long
    that took [s]."""
    # Whoever starts the tests in the background has SIGINT ignored, which a child would inherit.
    start = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    with subprocess.Popen([sys.executable, "-c", start + program], stdout=subprocess.PIPE, text=True) as child:
        try:
            assert child.stdout is not None and child.stdout.readline() == "ready\n"
            time.sleep(0.3)
            sent = time.monotonic()
            child.send_signal(signal.SIGINT)
            assert child.communicate(timeout=60)[0] == "interrupted\n"
            return time.monotonic() - sent
        finally:
            child.kill()
