"""Scenes as dicts with arrays."""

from __future__ import annotations

import copy
import json
import pathlib
import pickle

import numpy as np
import pytest
from conftest import ROOT, cloth_scene

import pliant


def hash_after(scene: pliant.Scene, frames: int = 5) -> str:
    world = pliant.World(scene, threads=1)
    world.run(frames)
    return world.state_hash()


def test_arrays_give_the_bits_of_the_same_mesh_in_the_format() -> None:
    by_array = cloth_scene()
    by_name = cloth_scene()
    by_name["objects"][0]["cloth"]["mesh"] = {"grid": {"columns": 6, "rows": 6, "width": 1, "depth": 1}}
    assert hash_after(by_array) == hash_after(by_name)


def test_a_file_that_was_read_gives_the_bits_of_the_file() -> None:
    path = ROOT / "scenes" / "chain_100.json"
    scene = pliant.Scene.read(path)
    assert hash_after(scene) == hash_after(pliant.Scene(json.loads(path.read_text())))


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s)), pliant.Scene])
def test_a_copy_gives_the_same_bits(copied) -> None:  # type: ignore[no-untyped-def]
    scene = cloth_scene()
    again = copied(scene)
    assert isinstance(again, pliant.Scene)
    assert hash_after(again) == hash_after(scene)
    again["objects"][0]["cloth"]["material"] = "silk"
    assert scene["objects"][0]["cloth"]["material"] == "cotton"


def test_a_change_of_the_dict_changes_the_world() -> None:
    scene = pliant.Scene.read(ROOT / "scenes" / "chain_100.json")
    before = hash_after(scene)
    scene["gravity"] = [0, -1, 0]
    assert hash_after(scene) != before


def test_arrays_by_name_and_in_any_type() -> None:
    vertices, triangles = pliant.grid_mesh(6, 6, 1, 1)
    scene = cloth_scene()
    scene["objects"][0]["cloth"]["mesh"] = {"array": "sheet"}
    scene.arrays["sheet"] = (vertices.astype(np.float64), triangles.astype(np.int64).tolist())
    assert hash_after(scene) == hash_after(cloth_scene())
    plain, arrays = scene.extract()
    assert json.loads(json.dumps(plain)) == plain
    assert hash_after(pliant.Scene(plain, arrays=arrays)) == hash_after(scene)


def test_extract_of_arrays_in_the_dict() -> None:
    plain, arrays = cloth_scene().extract()
    assert hash_after(pliant.Scene(plain, arrays=arrays)) == hash_after(cloth_scene())


def test_positions_and_tetrahedra_are_arrays_too() -> None:
    points = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]])
    scene = pliant.Scene(gravity=(0, 0, 0))
    scene.add(soft_body={"tetrahedra": (points, [[0, 1, 2, 3]])}, name="tetrahedron")
    scene.add(particles={"positions": points + 1, "masses": np.full(4, 0.5)}, name="dust")
    world = pliant.World(scene)
    np.testing.assert_array_equal(world["tetrahedron"].positions(), points.astype(np.float32))
    np.testing.assert_array_equal(world["dust"].positions(), (points + 1).astype(np.float32))


def test_names_of_what_is_added() -> None:
    scene = pliant.Scene()
    line = {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 3}}
    names = [scene.add(rope=line), scene.add(rope=line), scene.add(rope=line, name="leash")]
    assert names == ["rope", "rope_2", "leash"]
    assert [scene.add_collider(plane={}), scene.add_collider(plane={})] == ["plane", "plane_2"]
    with pytest.raises(pliant.Error, match="'leash' is taken"):
        scene.add(rope=line, name="leash")


def test_a_dict_that_was_given_stays_as_it_is() -> None:
    given = {"objects": [{"rope": {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 3}}}]}
    kept = copy.deepcopy(given)
    scene = pliant.Scene(given)
    scene["objects"][0]["name"] = "changed"
    scene.add(rope=given["objects"][0]["rope"])
    assert given == kept


def test_lookup_and_assign() -> None:
    scene = cloth_scene()
    assert scene.lookup("/objects/0/cloth/material") == "cotton"
    scene.assign("/settings/substeps", 7)
    scene.assign("/objects/0/pins/-", {"particles": [3]})
    scene.assign("/new~1name/a~0b", 1)
    assert scene["settings"] == {"substeps": 7}
    assert scene["objects"][0]["pins"][1] == {"particles": [3]}
    assert scene["new/name"] == {"a~b": 1}


def test_check_finds_what_pliant_check_finds() -> None:
    assert cloth_scene().check() == []
    scene = cloth_scene()
    vertices, triangles = pliant.grid_mesh(6, 6, 1, 1)
    vertices[7] = vertices[8] + [1e-5, 0, 0]  # slivers
    scene["objects"][0]["cloth"]["mesh"] = (vertices, triangles)
    findings = scene.check()
    assert findings and all(isinstance(finding, pliant.Finding) for finding in findings)
    grave, message, advice = findings[0]
    assert isinstance(grave, bool) and message and isinstance(advice, str)
    assert all(not one.grave for one in cloth_scene().check(seconds=0.2))


def test_write_and_read(tmp_path: pathlib.Path) -> None:
    scene = pliant.Scene.read(ROOT / "scenes" / "chain_100.json")
    scene.write(tmp_path / "scene.json")
    assert hash_after(pliant.Scene.read(tmp_path / "scene.json")) == hash_after(scene)
    with pytest.raises(pliant.Error, match="cannot hold"):
        cloth_scene().write(tmp_path / "cloth.json")


def test_errors_have_their_parts(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "wrong.json"
    path.write_text('{"objects": [\n  {"cloth": {"mesh": {"gird": 1}}}]}')
    with pytest.raises(pliant.Error) as caught:
        pliant.Scene.read(path)
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.file, error.line) == (str(path), 2) and error.column > 0
    assert error.element.startswith("/objects/0/cloth/mesh") and "'gird'" in error.problem and error.advice
    assert str(error).startswith(f"{path}:2:")
    again = pickle.loads(pickle.dumps(error))
    assert (again.element, again.line, str(again)) == (error.element, 2, str(error))


def test_errors_of_a_dict_name_the_place_and_no_line() -> None:
    scene = cloth_scene()
    scene["objects"][0]["cloth"]["material"] = "paper"
    with pytest.raises(pliant.Error) as caught:
        pliant.World(scene)
    assert caught.value.element == "/objects/0/cloth/material" and caught.value.line == 0


def test_meshes(tmp_path: pathlib.Path) -> None:
    vertices, triangles = pliant.sphere_mesh(2)
    assert vertices.dtype == np.float32 and triangles.dtype == np.int32
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1, atol=1e-6)
    pliant.write_mesh(str(tmp_path / "ball.obj"), (vertices, triangles))
    again = pliant.read_mesh(str(tmp_path / "ball.obj"))
    np.testing.assert_array_equal(again[0], vertices)
    np.testing.assert_array_equal(again[1], triangles)


def test_a_scene_sees_changes_of_its_files_and_folder(tmp_path: pathlib.Path) -> None:
    for name, columns in (("a", 4), ("b", 5)):
        (tmp_path / name).mkdir()
        pliant.write_mesh(str(tmp_path / name / "mesh.obj"), pliant.grid_mesh(columns, 4, 1, 1))
    scene = pliant.Scene(folder=tmp_path / "a")
    scene.add(cloth={"mesh": {"file": "mesh.obj"}})
    assert pliant.World(scene)["cloth"].particles == 16
    scene.folder = str(tmp_path / "b")
    assert pliant.World(scene)["cloth"].particles == 20
    pliant.write_mesh(str(tmp_path / "b" / "mesh.obj"), pliant.grid_mesh(6, 4, 1, 1))
    assert pliant.World(scene)["cloth"].particles == 24
    scene.write(tmp_path / "a" / "scene.json")
    read = pliant.Scene.read(tmp_path / "a" / "scene.json")
    pliant.write_mesh(str(tmp_path / "a" / "mesh.obj"), pliant.grid_mesh(7, 4, 1, 1))
    assert pliant.World(read)["cloth"].particles == 28


def test_values_that_are_assigned_are_copied() -> None:
    gravity = [0, -5, 0]
    scene = cloth_scene()
    scene.assign("/gravity", gravity)
    scene["gravity"][1] = 7
    assert gravity == [0, -5, 0]


def test_fabrics() -> None:
    fabrics = pliant.fabrics()
    assert fabrics["cotton"]["area_density"] == pytest.approx(0.15, rel=0.5)
    scene = cloth_scene()
    cotton = {key: value for key, value in fabrics["cotton"].items() if key not in ("name", "source")}
    scene["objects"][0]["cloth"]["material"] = cotton
    assert hash_after(scene) == hash_after(cloth_scene())
