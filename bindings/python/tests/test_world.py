"""Worlds: stepping, states, contents, files."""

from __future__ import annotations

import copy
import gc
import io
import os
import pathlib
import pickle
import threading
import time
import weakref
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, cloth_scene, seconds_until_interrupted

import pliant

GOLDEN = dict(line.split() for line in (ROOT / "tests" / "golden" / "hashes.txt").read_text().splitlines())
SCENES = [
    "bodies/belt", "bodies/pyramid", "bodies/ragdoll", "bodies/turntable", "chain_100", "hanging_cloth", "incline",
    "knot", "rods/winch", "rope", "soft_bodies/finger", "tied_rope", "w1_64",
]  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_the_hash_is_that_of_the_program(name: str) -> None:
    """The golden hashes of the C++ tests: 40 frames, 16 of scenes in folders."""
    world = pliant.World(ROOT / "scenes" / f"{name}.json")
    world.run(16 if "/" in name else 40)
    assert world.state_hash() == GOLDEN[name]


def test_threads_change_no_bits() -> None:
    hashes = set()
    for threads in (1, 2, 3):
        world = pliant.World(cloth_scene(20), threads=threads)
        assert world.threads == threads
        world.run(4)
        hashes.add(world.state_hash())
    assert len(hashes) == 1


def test_step_run_and_frames_do_the_same() -> None:
    worlds = [pliant.World(cloth_scene(), threads=1) for _ in range(3)]
    for _ in range(5):
        worlds[0].step()
    report = worlds[1].run()
    reports = list(worlds[2].frames())
    assert report.frame == len(reports) == worlds[0].frame == 5
    assert worlds[0].time == pytest.approx(5 / 60)
    assert len({world.state_hash() for world in worlds}) == 1


def test_a_report_is_attributes_and_a_dict(world: pliant.World) -> None:
    report = world.step()
    assert report.ok and report.explain() == "" and not report.stopped
    values = report.as_dict()
    assert set(values) == set(report.keys()) == set(report) and "worst_overstretch" in values
    for key in report:
        assert report[key] == getattr(report, key) == values[key]
    assert dict(report)["frame"] == 1
    assert report.overstretch is not None and report.overstretch["object"] == "cloth"
    with pytest.raises(KeyError):
        report["nothing"]
    assert world.advice(report) == ""


def test_contents_by_name(world: pliant.World) -> None:
    assert list(world) == ["cloth"] and len(world) == 1
    assert "cloth" in world and "ball" not in world and 3 not in world
    assert [one.name for one in world.objects] == ["cloth"]
    assert [one.name for one in world.colliders] == ["ball"]
    assert [one.name for one in world.mesh_colliders] == ["board"]
    assert world.collider("ball").pose() == pliant.Pose((0, -0.5, 0), (0, 0, 0, 1))
    with pytest.raises(KeyError, match="has 'cloth'"):
        world["shirt"]


def test_add_and_remove(world: pliant.World) -> None:
    added = world.add(rope={"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 4}})
    assert added.name == "rope" and len(added) == 4 and list(world) == ["cloth", "rope"]
    plane = world.add_collider(plane={}, position=[0, -2, 0])
    mesh = world.add_collider(mesh=pliant.grid_mesh(2, 2, 1, 1), name="shelf", position=[0, -2, 0])
    assert isinstance(plane, pliant.Collider) and isinstance(mesh, pliant.MeshCollider)
    world.run(3)
    world.remove(added)
    world.remove(plane)
    world.remove(mesh)
    assert not added.exists and list(world) == ["cloth"]
    with pytest.raises(pliant.Error, match="removed"):
        added.positions()
    second = world.add(rope={"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 4}})
    assert second.exists and not added.exists
    world.remove("rope")


def test_state_restores_exactly(world: pliant.World) -> None:
    world.run(3)
    state = world.state()
    world.run(3)
    later = world.state_hash()
    for one in (state, pickle.loads(pickle.dumps(state))):
        world.restore(one)
        assert world.frame == 3
        world.run(3)
        assert world.state_hash() == later
    assert state == pickle.loads(pickle.dumps(state)) and hash(state) == hash(pickle.loads(pickle.dumps(state)))
    assert state != world.state() and state.hash() != later and state.particles == 40
    assert state != 3


def test_save_load_and_pickle(world: pliant.World, tmp_path: pathlib.Path) -> None:
    world.add(rope={"line": {"from": [2, 0, 0], "to": [3, 0, 0], "points": 4}})
    world.run(3)
    world.save(tmp_path / "a.world")
    others = [pliant.World.load(tmp_path / "a.world"), pickle.loads(pickle.dumps(world))]
    world.run(3)
    for other in others:
        assert list(other) == list(world)
        other.run(3)
        assert other.state_hash() == world.state_hash()
        other.add(rope={"line": {"from": [4, 0, 0], "to": [5, 0, 0], "points": 4}})
        other.save(tmp_path / "b.world")
        assert list(pliant.World.load(tmp_path / "b.world")) == ["cloth", "rope", "rope_2"]


def test_a_copy_of_a_world_goes_its_own_way(world: pliant.World) -> None:
    world.run(2)
    other = copy.copy(world)
    assert other.state_hash() == world.state_hash()
    other.step()
    assert (world.frame, other.frame) == (2, 3)


def test_a_writer_writes_frames(world: pliant.World, tmp_path: pathlib.Path) -> None:
    with world.writer(tmp_path / "cloth.obj") as out:
        for _ in world.frames(2):
            out.add()
    assert [os.path.basename(path) for path in out.written] == ["cloth_0000.obj", "cloth_0001.obj", "cloth_0002.obj"]
    with pytest.raises(pliant.Error, match="has finished"):
        out.add()
    vertices, _ = pliant.read_mesh(out.written[2])
    assert len(vertices) == 36


def write(world: pliant.World, *given: Any, **options: Any) -> pliant.Writer:
    with world.writer(*given, **options) as out:
        for _ in range(2):
            world.step()
            out.add()
    return out


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb", "usda", "pc2", "pvd"])
def test_a_writer_in_memory_has_the_bytes_of_the_files(tmp_path: pathlib.Path, suffix: str) -> None:
    on_disk = write(pliant.World(cloth_scene(), threads=1), tmp_path / f"frames.{suffix}")
    there = {str(pathlib.Path(path).relative_to(tmp_path)): pathlib.Path(path).read_bytes() for path in on_disk.written}
    out = write(pliant.World(cloth_scene(), threads=1), format=suffix)
    assert out.files == there
    assert out.written == list(there)
    assert out.files is out.files
    with pytest.raises(pliant.Error, match="not in memory"):
        print(on_disk.files)


def test_files_of_frames_in_memory_come_at_once(world: pliant.World) -> None:
    out = world.writer(format=".PLY")
    assert list(out.files) == ["frames_0000.ply"]
    del out.files["frames_0000.ply"]
    world.step()
    out.add()
    assert list(out.files) == ["frames_0001.ply"]


@pytest.mark.parametrize("suffix", ["glb", "usda"])
def test_a_file_object_gets_the_bytes(tmp_path: pathlib.Path, suffix: str) -> None:
    buffer = io.BytesIO()
    write(pliant.World(cloth_scene(), threads=1), buffer, format=suffix)
    in_memory = write(pliant.World(cloth_scene(), threads=1), format=suffix).files[f"frames.{suffix}"]
    assert buffer.getvalue() == in_memory
    with open(tmp_path / "run", "wb") as file:
        write(pliant.World(cloth_scene(), threads=1), file, format=suffix)
    assert (tmp_path / "run").read_bytes() == in_memory


def test_what_a_file_object_raises_comes_out_of_finish(world: pliant.World) -> None:
    class Full:
        def write(self, data: bytes) -> None:
            raise OSError(f"no room for {data[:4]!r}")

    out = world.writer(Full(), format="glb")  # type: ignore[arg-type]
    with pytest.raises(OSError, match="no room for b'glTF'"):
        out.finish()


def test_a_file_object_that_refers_to_its_writer_is_freed(world: pliant.World) -> None:
    class Refers:
        writer: Any = None

        def write(self, data: bytes) -> None:
            pass

    file = Refers()
    file.writer = world.writer(file, format="glb")  # type: ignore[arg-type]
    gone = weakref.ref(file)
    del file
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize(
    "given, words",
    [
        (lambda: {}, "needs a path or a format"),
        (lambda: {"path": "a.glb", "format": "glb"}, "`format` is given beside a path; leave it out"),
        (lambda: {"path": io.BytesIO()}, "give format='glb' or format='usda'"),
        (lambda: {"path": io.BytesIO(), "format": "pvd"}, "a run as '.pvd' is several files"),
        (lambda: {"path": io.StringIO(), "format": "glb"}, "takes text, and frames are bytes; open it with mode 'wb'"),
        (lambda: {"format": "gltf"}, "'gltf' is not a format of frames; choose 'obj'"),
        (lambda: {"format": ""}, "'' is not a format"),
    ],
)
def test_wrong_targets_of_a_writer(world: pliant.World, given: Any, words: str) -> None:
    with pytest.raises(pliant.Error) as caught:
        world.writer(**given())
    assert words in str(caught.value)


def test_contact_events() -> None:
    scene = cloth_scene()
    del scene["objects"][0]["pins"]
    world = pliant.World(scene, threads=1)
    for read in (world.contact_events, world.body_touches):
        with pytest.raises(pliant.Error, match="contact events are not recorded; call record_contact_events"):
            read()
    world.record_contact_events()
    begun = []
    for _ in world.frames(40):
        begun += [event for event in world.contact_events() if event.change == "begin"]
    assert [(event.first, event.second) for event in begun][0] == ("cloth", "ball")
    assert begun[0].impulse > 0 and begun[0].normal[1] > 0.5


def test_what_bodies_touch() -> None:
    """A cube of 1 kg at rest on a plane: its weight over the frame."""
    scene = pliant.Scene()
    solid = {"box": {"half_extents": [0.1, 0.1, 0.1]}}
    scene.add(name="dice", bodies=[{"name": "die", "solids": [solid], "mass": 1, "position": [0, 0.1, 0]}])
    scene.add_collider(name="floor", plane={})
    world = pliant.World(scene, threads=1)
    world.record_contact_events()
    world.run(30)
    (touch,) = world.body_touches()
    assert {(touch.first, touch.first_body), (touch.second, touch.second_body)} == {("dice", "die"), ("floor", "")}
    assert abs(touch.push[1]) / world.frame_time == pytest.approx(9.81, rel=0.02)
    second = world.add(name="late", bodies=[{"name": "top", "solids": [solid], "mass": 1, "position": [0, 0.3, 0]}])
    world.run(30)
    assert ("late", "top") in [(touch.second, touch.second_body) for touch in world.body_touches()]
    world.remove(second)
    assert all(touch.first and touch.second for touch in world.body_touches())
    world.remove("dice")
    assert world.body_touches() == []


def test_descriptions(world: pliant.World) -> None:
    report = world.step()
    assert "cloth" in cloth_scene().describe() and "cloth" in world.describe() and "frame 1" in report.describe()


def test_energies_of_free_fall() -> None:
    scene = pliant.Scene()
    scene.add(particles={"positions": np.array([[0, 2, 0]]), "masses": [3]})
    world = pliant.World(scene)
    assert world.kinetic_energy() == 0 and world.potential_energy() == pytest.approx(3 * 9.81 * 2, rel=1e-5)
    world.run(30)
    assert world.kinetic_energy() == pytest.approx(0.5 * 3 * (9.81 * 0.5) ** 2, rel=1e-4)


def test_other_threads_run_during_a_step() -> None:
    world = pliant.World(cloth_scene(60), threads=1)
    counted = 0
    refused = []
    thread = threading.Thread(target=world.run, args=(60,))
    thread.start()
    while thread.is_alive():
        counted += 1
        try:
            world.step()
        except pliant.Error as error:
            refused.append(error)
        time.sleep(0.0005)
    thread.join()
    assert counted > 10 and refused


def test_stop_ends_a_run_from_another_thread() -> None:
    world = pliant.World(cloth_scene(30), threads=1)
    reports: list[pliant.Report] = []
    thread = threading.Thread(target=lambda: reports.append(world.run(1_000_000)))
    thread.start()
    while thread.is_alive():
        world.stop()
        time.sleep(0.01)
    assert reports[0].stopped


def test_a_stop_between_frames_ends_the_next_step_alone(world: pliant.World) -> None:
    world.step()
    world.stop()
    report = world.step()
    assert report.stopped and world.frame == 1
    assert not world.step().stopped and world.frame == 2
    frames = []
    for report in world.frames(10):
        frames.append(report.stopped)
        if len(frames) == 1:
            world.stop()
    assert frames == [False, True] and world.run(2).ok and world.frame == 5


@pytest.mark.parametrize("loop", ["world.run(10**9)", "for _ in world.frames(10**9): pass", "while True: world.step()"])
@pytest.mark.parametrize("size", [8, 130])
def test_ctrl_c_ends_within_a_second(loop: str, size: int) -> None:
    """With frames of microseconds, and of a second: self-collision of a sheet that is folded onto itself."""
    program = f"""
import sys, pliant
scene = pliant.Scene(settings={{"substeps": {20 if size < 100 else 2000}}})
scene.add(cloth={{"mesh": pliant.grid_mesh({size}, {size}, 1, 1)}}, pins=[{{"particles": [0]}}])
world = pliant.World(scene, threads=1)
print("ready", flush=True)
try:
    {loop}
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    assert seconds_until_interrupted(program) < 5  # on a loaded machine; a frame takes far longer


def test_a_world_lives_as_long_as_what_refers_to_it() -> None:
    cloth = pliant.World(cloth_scene(), threads=1)["cloth"]
    records = cloth.records()
    assert cloth.positions().shape == (36, 3)
    del cloth
    assert np.isfinite(records[:36]).all()


def test_records_are_the_positions_in_storage_order(world: pliant.World) -> None:
    cloth = world["cloth"]
    records, order = cloth.records(), cloth.storage_order()
    for _ in world.frames(3):
        np.testing.assert_array_equal(records[np.argsort(order)][:36, :3], cloth.positions())
    assert not records.flags.writeable
    state = pliant.World(cloth_scene(), threads=1).state()
    with pytest.raises(pliant.Error, match="1 view of its records"):
        world.restore(state)
    with pytest.raises(pliant.Error, match="view of its records"):
        world.remove("cloth")
    del records
    world.restore(state)


def test_records_of_what_tears_are_refused() -> None:
    world = pliant.World(ROOT / "scenes" / "tears" / "block.json")
    with pytest.raises(pliant.Error, match="move in memory"):
        next(iter(world.objects)).records()
