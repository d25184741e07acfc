"""Calls the C library from Python, by nothing but ctypes: ctypes_test.py LIBRARY SCENES."""

import ctypes
import json
import sys
import threading

library = ctypes.CDLL(sys.argv[1])
scenes = sys.argv[2]
library.pliant_last_error.restype = ctypes.c_char_p
library.pliant_version.restype = ctypes.c_char_p
library.pliant_world_step.argtypes = [ctypes.c_void_p, ctypes.c_float]


class Id(ctypes.Structure):
    _fields_ = [("kind", ctypes.c_int32), ("slot", ctypes.c_int32), ("generation", ctypes.c_int32)]


def call(name, *arguments):
    """Calls a function and raises its words if it fails."""
    if getattr(library, name)(*arguments) != 0:
        raise RuntimeError(library.pliant_last_error().decode())


def text(name, *handle):
    """Asks for the length of a text, then for the text."""
    length = ctypes.c_size_t()
    call(name, *handle, None, ctypes.c_size_t(0), ctypes.byref(length))
    buffer = ctypes.create_string_buffer(length.value + 1)
    call(name, *handle, buffer, ctypes.c_size_t(len(buffer)), None)
    return buffer.value.decode()


def world_of(path):
    scene, world = ctypes.c_void_p(), ctypes.c_void_p()
    call("pliant_scene_read", path.encode(), None, ctypes.byref(scene))
    call("pliant_world_create", scene, 1, ctypes.byref(world))
    call("pliant_scene_free", scene)
    return world


world = world_of(scenes + "/w1_64.json")
start = text("pliant_world_hash", world)
for _ in range(3):
    call("pliant_world_step", world, 0)
assert len(start) == 64 and text("pliant_world_hash", world) != start

ids, count = (Id * 4)(), ctypes.c_size_t()
call("pliant_world_ids", world, 0, ids, ctypes.c_size_t(4), ctypes.byref(count))
positions = (ctypes.c_float * (3 * 4096))()
call("pliant_object_positions", world, ids[0], positions, ctypes.c_size_t(4096))
assert count.value == 1 and min(positions[1::3]) < max(positions[1::3])

report = json.loads(text("pliant_report_json", world))
assert report["frame"] == 3 and report["ok"]
assert "cotton" in [fabric["name"] for fabric in json.loads(text("pliant_materials"))["fabrics"]]
assert "$schema" in json.loads(text("pliant_schema"))

try:
    call("pliant_object_positions", world, Id(0, 7, 0), positions, ctypes.c_size_t(4096))
    raise AssertionError("a stale id was taken")
except RuntimeError as error:
    assert "no object 7" in str(error), error

# While another thread runs a World, every call says that it is busy, between frames too; and it is not freed.
BUSY, STOPPED = 10, 6
rope = world_of(scenes + "/rope.json")
runs, seen = [], []
thread = threading.Thread(
    target=lambda: runs.append(library.pliant_world_run(rope, ctypes.c_int64(10**9), None)), daemon=True
)
length = ctypes.c_size_t()
thread.start()
while len(seen) < 2000 and thread.is_alive():
    status = library.pliant_world_name(rope, Id(0, 0, 0), None, ctypes.c_size_t(0), ctypes.byref(length))
    if seen or status == BUSY:
        seen.append(status)
assert library.pliant_world_free(rope) == BUSY
call("pliant_world_stop", rope, 1)
thread.join()
assert set(seen) == {BUSY}, set(seen)
assert runs == [STOPPED]
call("pliant_world_free", rope)

call("pliant_world_free", world)
assert library.pliant_world_free(world) != 0
print("Python", sys.version.split()[0], "called libpliant_c", library.pliant_version().decode())
