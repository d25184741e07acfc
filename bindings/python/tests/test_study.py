"""Studies on processes, threads and alone."""

from __future__ import annotations

import concurrent.futures
import csv
import json
import os
import pathlib
import threading
from typing import Any

import numpy as np
import pytest
from conftest import cloth_scene

import pliant
from pliant import _pliant
from pliant.study import Table, variants

VARY: dict[str, list[Any]] = {"/objects/0/cloth/material": ["cotton", "silk"], "/settings/substeps": [5, 10]}


def droop(world: pliant.World) -> Any:
    return world["cloth"].positions()[:, 1].min()


def heights(world: pliant.World) -> Any:
    return world["cloth"].positions()[:3, 1]


def dies(world: pliant.World) -> Any:
    os._exit(3)


def dies_without_gravity(world: pliant.World) -> Any:
    return droop(world) or os._exit(3)


def fails(world: pliant.World) -> Any:
    raise RuntimeError("no measure")


def hashes_alone() -> list[str]:
    hashes = []
    for material in VARY["/objects/0/cloth/material"]:
        for substeps in VARY["/settings/substeps"]:
            scene = cloth_scene()
            scene["objects"][0]["cloth"]["material"] = material
            scene["settings"] = {"substeps": substeps}
            world = pliant.World(scene, threads=2)
            world.run(5)
            hashes.append(world.state_hash())
    return hashes


@pytest.mark.parametrize("where", ["processes", "threads", "here"])
def test_rows_have_the_bits_of_worlds_alone(where: str) -> None:
    scene = cloth_scene()
    if where == "processes":
        table = pliant.study(scene, VARY, measure={"droop": droop}, workers=2)
    elif where == "threads":
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            table = pliant.study(scene, VARY, measure={"droop": droop}, executor=pool)
    else:
        table = pliant.study(scene, VARY, measure=droop, workers=0)
    assert table.column("state_hash") == hashes_alone()
    assert [row["/settings/substeps"] for row in table] == [5, 10, 5, 10]
    assert all(row["ok"] and row["frames"] == 5 and isinstance(row["droop"], float) for row in table)
    assert "settings" not in scene and not table.failures


def test_failures_are_rows() -> None:
    rows: list[dict[str, Any]] = [
        {"/objects/0/cloth/material": "paper"},
        {"/objects/0/cloth/material": "silk"},
        {"/gravity": [0, 1e300, 0]},
        {"/nothing/there": 3},
    ]
    table = pliant.study(cloth_scene(), rows, workers=0)
    assert [row["ok"] for row in table] == [False, True, False, False]
    assert "'paper'" in table[0]["explain"] and table[0]["state_hash"] is None
    assert [row["explain"] for row in table.failures] == [table[i]["explain"] for i in (0, 2, 3)]
    table = pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure=fails, workers=0)
    assert not table[0]["ok"] and table[0]["explain"] == "measure 'fails': RuntimeError: no measure" and table[0]["fails"] is None


def test_names_of_measures_that_are_columns() -> None:
    for name in ("ok", "frames", "explain", "/gravity"):
        with pytest.raises(pliant.Error, match=f"a measure is called '{name}'"):
            pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure={name: fails}, workers=0)


def test_resume_keeps_files_of_others(tmp_path: pathlib.Path) -> None:
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({"objects": []}, indent=2), encoding="utf-8")
    notes = tmp_path / "notes.txt"
    notes.write_text("precious", encoding="utf-8")
    for path in (scene, notes):
        before = path.read_bytes()
        with pytest.raises(pliant.Error, match="line [12] is no row of a study"):
            pliant.study(cloth_scene(), {"/settings/substeps": [5]}, frames=1, workers=0, resume=path)
        assert path.read_bytes() == before
    with pytest.raises(pliant.Error, match="this is no file"):
        pliant.study(cloth_scene(), {"/settings/substeps": [5]}, frames=1, workers=0, resume=tmp_path)
    cut = tmp_path / "cut.jsonl"
    cut.write_text('{"key": "12', encoding="utf-8")
    assert pliant.study(cloth_scene(), {"/settings/substeps": [5]}, frames=1, workers=0, resume=cut)[0]["ok"]


def test_a_process_that_dies_is_a_row() -> None:
    table = pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure=dies, workers=1)
    assert [row["ok"] for row in table] == [False] and table[0]["explain"]


def test_a_process_that_dies_takes_no_other_row_along(tmp_path: pathlib.Path) -> None:
    kept = tmp_path / "rows.jsonl"
    vary = {"/gravity": [[0, -float(i), 0] for i in range(6)]}
    table = pliant.study(cloth_scene(), vary, measure={"droop": dies_without_gravity}, workers=2, resume=kept)
    assert [row["ok"] for row in table] == [False] + [True] * 5
    assert len(kept.read_text().splitlines()) == 5
    progress: list[tuple[int, int]] = []
    table = pliant.study(
        cloth_scene(), vary, measure={"droop": droop}, workers=0, resume=kept,
        progress=lambda done, of: progress.append((done, of)),
    )  # fmt: skip
    assert not table.failures and progress == [(6, 6)]


def test_processes_that_all_die_end_the_study() -> None:
    table = pliant.study(cloth_scene(), {"/settings/substeps": [5, 6, 7, 8, 9]}, measure=dies, workers=1)
    assert not any(row["ok"] for row in table)
    assert [row["explain"][:7] for row in table] == ["BrokenP"] * 3 + ["not run"] * 2


def test_rows_are_kept_as_they_come(tmp_path: pathlib.Path) -> None:
    """The first variant waits until the row of the second is in the file."""
    kept = tmp_path / "rows.jsonl"
    came = threading.Event()

    def wait(world: pliant.World) -> bool:
        return droop(world) < 0 or came.wait(10)

    vary = {"/gravity": [[0, 0, 0], [0, -1, 0]]}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        table = pliant.study(
            cloth_scene(), vary, measure={"came": wait}, executor=pool, resume=kept,
            progress=lambda done, of: came.set(),
        )  # fmt: skip
    assert table.column("came") == [True, True]
    assert [json.loads(line)["row"]["/gravity"][1] for line in kept.read_text().splitlines()] == [-1, 0]


def test_values_are_copies() -> None:
    gravity = [0, -1, 0]
    made = variants(cloth_scene(), [{"/gravity": gravity}, {"/gravity": gravity}])
    made[0].scene["gravity"][1] = 5
    row = made[1].run()
    gravity[1] = 7
    assert made[1].scene["gravity"] == made[1].values["/gravity"] == row["/gravity"] == [0, -1, 0]


def test_a_run_that_was_stopped_is_not_ok(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*arguments: Any, **named: Any) -> pliant.World:
        world = pliant.World(*arguments, **named)
        world.stop()
        return world

    monkeypatch.setattr(_pliant, "World", stopped)
    (row,) = pliant.study(cloth_scene(), [{}], workers=0)
    assert not row["ok"] and row["frames"] == 0 and "stopped" in row["explain"]


def test_resume_sees_files_and_folders(tmp_path: pathlib.Path) -> None:
    def key(folder: pathlib.Path) -> str:
        (one,) = variants(pliant.Scene(scene, folder=folder), [{}])
        return one.key

    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        pliant.write_mesh(str(tmp_path / name / "mesh.obj"), pliant.grid_mesh(4, 4, 1, 1))
    scene = {"objects": [{"cloth": {"mesh": {"file": "mesh.obj"}}}]}
    first = key(tmp_path / "a")
    assert first == key(tmp_path / "a") != key(tmp_path / "b")
    pliant.write_mesh(str(tmp_path / "a" / "mesh.obj"), pliant.grid_mesh(5, 4, 1, 1))
    assert key(tmp_path / "a") != first


def test_resume(tmp_path: pathlib.Path) -> None:
    kept = tmp_path / "rows.jsonl"
    calls = []

    def counted(world: pliant.World) -> float:
        calls.append(1)
        return float(droop(world))

    first = pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure={"droop": counted}, workers=0, resume=kept)
    with open(kept, "a", encoding="utf-8") as file:
        file.write('{"key": "half')  # as a run that was killed leaves it
    progress: list[tuple[int, int]] = []
    second = pliant.study(
        cloth_scene(), {"/settings/substeps": [5, 10]}, measure={"droop": counted}, workers=0, resume=kept,
        progress=lambda done, of: progress.append((done, of)),
    )  # fmt: skip
    assert len(calls) == 2 and second[0] == first[0] and progress == [(2, 2)]
    again = {"/settings/substeps": [10]}
    third = pliant.study(cloth_scene(), again, measure={"droop": counted}, workers=0, resume=kept)
    assert len(calls) == 2 and third[0] == second[1]  # the first row after the half line was not lost
    changed = cloth_scene()
    changed["gravity"] = [0, -1, 0]
    pliant.study(changed, {"/settings/substeps": [5]}, measure={"droop": counted}, workers=0, resume=kept)
    moved = cloth_scene()
    vertices, triangles = pliant.grid_mesh(6, 6, 2, 1)
    moved["objects"][0]["cloth"]["mesh"] = (vertices, triangles)
    pliant.study(moved, {"/settings/substeps": [5]}, measure={"droop": counted}, workers=0, resume=kept)
    assert len(calls) == 4


def test_arrays_as_measures_are_kept(tmp_path: pathlib.Path) -> None:
    kept = tmp_path / "rows.jsonl"
    first = pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure=heights, workers=0, resume=kept)
    second = pliant.study(cloth_scene(), {"/settings/substeps": [5]}, measure=heights, workers=0, resume=kept)
    np.testing.assert_array_equal(first[0]["heights"], np.asarray(second[0]["heights"], np.float32))


@pytest.mark.parametrize("resumes", [False, True])
@pytest.mark.parametrize(
    "bad", [lambda w: w, lambda w: [w], lambda w: b"bytes", lambda w: 1j, lambda w: np.array([len]), lambda w: "\ud800"]
)
def test_measures_that_no_table_holds(tmp_path: pathlib.Path, bad: Any, resumes: bool) -> None:
    kept = tmp_path / "rows.jsonl" if resumes else None
    vary = {"/settings/substeps": [5]}
    table = pliant.study(cloth_scene(), vary, frames=1, measure={"bad": bad}, workers=0, resume=kept)
    assert not table[0]["ok"] and table[0]["bad"] is None
    assert "measure 'bad': returned" in table[0]["explain"] and "numbers, str, lists or arrays" in table[0]["explain"]
    table.write(tmp_path / "table.csv")


def test_variants_one_by_one() -> None:
    """As the tasks of a Slurm array run them."""
    rows = [variant.run() for variant in variants(cloth_scene(), VARY, measure=droop)]
    assert [row["state_hash"] for row in rows] == hashes_alone()


def test_a_table_writes_csv(tmp_path: pathlib.Path) -> None:
    table = pliant.study(cloth_scene(), VARY, measure=droop, workers=0)
    table.write(tmp_path / "table.csv")
    with open(tmp_path / "table.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["state_hash"] for row in rows] == table.column("state_hash")
    assert float(rows[0]["droop"]) == table[0]["droop"]
    assert table.columns[:3] == ["/objects/0/cloth/material", "/settings/substeps", "droop"]
    assert json.loads(json.dumps(table)) == table and isinstance(table, Table)


class Submits:
    """An executor such as a dask Client, which has `submit` alone."""

    def submit(self, function: Any, *arguments: Any) -> Any:
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        future.set_result(function(*arguments))
        return future


def test_any_executor_with_submit() -> None:
    table = pliant.study(cloth_scene(), VARY, executor=Submits())
    assert table.column("state_hash") == hashes_alone()


@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster() -> None:
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        measures = {"droop": lambda world: float(world["cloth"].positions()[:, 1].min())}
        table = pliant.study(cloth_scene(), VARY, measure=measures, executor=client)
    assert table.column("state_hash") == hashes_alone() and not table.failures
    assert table.column("droop") == pliant.study(cloth_scene(), VARY, measure=droop, workers=0).column("droop")


untyped: Any = pliant.study  # of calls that mypy would refuse


@pytest.mark.parametrize(
    "call",
    [
        lambda: untyped(cloth_scene(), 3),
        lambda: untyped(cloth_scene(), {"/gravity": 3}),
        lambda: untyped(cloth_scene(), [3]),
        lambda: untyped(cloth_scene(), {"/gravity": "abc"}),
        lambda: untyped(cloth_scene(), {"gravity": [1]}),
        lambda: untyped(None, VARY),
        lambda: untyped(cloth_scene(), VARY, measure=3),
        lambda: untyped(cloth_scene(), VARY, measure={"a": 3}),
        lambda: untyped(cloth_scene(), VARY, frames=0),
        lambda: untyped(cloth_scene(), VARY, frames=2.5),
        lambda: untyped(cloth_scene(), VARY, workers=-1),
        lambda: untyped(cloth_scene(), VARY, workers="two"),
        lambda: untyped(cloth_scene(), VARY, executor=3),
        lambda: untyped(cloth_scene(), VARY, measure=lambda world: 1, workers=2),
    ],
)
def test_misuse(call: Any) -> None:
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    assert str(caught.value)
