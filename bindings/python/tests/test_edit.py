"""Edits of objects in a World: pins, attachments, cuts, stiffness, masses, whole descriptions."""

from __future__ import annotations

import copy
import subprocess
import sys
from typing import Any, Callable

import numpy as np
import pytest
from conftest import cloth_scene

import pliant


def test_pins_hold_where_particles_are(world: pliant.World) -> None:
    world.run(10)
    cloth = world["cloth"]
    before = cloth.positions()
    with world.edit("cloth") as edit:
        assert edit.pins.tolist() == [0, 5]
        edit.pin([35, 30, 0])
        edit.unpin([5])
        assert edit.pins.tolist() == [0, 35, 30]
    np.testing.assert_array_equal(cloth.positions(), before)
    world.run(10)
    moved = np.abs(cloth.positions() - before).max(axis=1)
    assert (moved[[0, 30, 35]] == 0).all() and moved[5] > 0.05
    cloth.set_targets([35], before[[35]] + [0, 0.1, 0])
    world.step()
    np.testing.assert_allclose(cloth.positions()[35], before[35] + np.array([0, 0.1, 0], np.float32), atol=1e-6)


def test_a_cloth_without_pins_falls_freely(world: pliant.World) -> None:
    world.edit(world["cloth"]).apply()
    edit = world.edit("cloth")
    edit.unpin()
    edit.apply()
    before = world["cloth"].velocities()[:, 1].mean()
    world.step()
    assert world["cloth"].velocities()[:, 1].mean() - before == pytest.approx(-9.81 / 60, rel=0.01)


def test_attachments_come_and_go(world: pliant.World) -> None:
    cloth = world["cloth"]
    with world.edit("cloth") as edit:
        edit.unpin()
        edit.attach([0, 5], cloth.positions()[[0, 5]])
        edit.attach([35], [[0.5, 0.5, 0.5]], compliance=1e-6, damping=1e-3)
        assert edit.attachments.tolist() == [0, 5, 35]
    cloth.set_attachment_targets([0], [[-0.5, 0.2, -0.5]])
    world.run(60)
    np.testing.assert_allclose(cloth.positions()[0], [-0.5, 0.2, -0.5], atol=0.01)
    np.testing.assert_allclose(cloth.positions()[35], [0.5, 0.5, 0.5], atol=0.05)
    with world.edit("cloth") as edit:
        edit.detach([35])
        assert edit.attachments.tolist() == [0, 5]
        edit.detach()
        assert len(edit.attachments) == 0
    low = cloth.positions()[:, 1].mean()
    world.run(5)
    assert cloth.positions()[:, 1].mean() < low - 0.02


def test_a_cut_splits_particles_and_keeps_momentum(world: pliant.World) -> None:
    world.run(5)
    cloth = world["cloth"]
    masses, velocities, positions = world.edit("cloth").masses, cloth.velocities(), cloth.positions()
    free = [i for i in range(36) if i not in (0, 5)]
    edit = world.edit("cloth")
    edit.cut([12, 13, 14, 15, 16, 17])
    assert edit.particles == 42 and edit.origins.tolist() == [*range(36), *edit.origins[36:].tolist()]
    assert set(edit.origins[36:].tolist()) == {12, 13, 14, 15, 16, 17}
    news = edit.apply()
    assert news.tolist() == list(range(36)) and cloth.particles == 42
    np.testing.assert_array_equal(cloth.positions(), positions[edit.origins])
    parted = world.edit("cloth").masses
    others = [*free, *range(36, 42)]
    np.testing.assert_allclose(parted[others] @ cloth.velocities()[others], masses[free] @ velocities[free], rtol=1e-4)
    world.run(20)
    assert cloth.positions()[30:36, 1].max() < cloth.positions()[:12, 1].min() - 0.2  # the lower part falls


def test_changes_are_made_together_and_follow_one_another(world: pliant.World) -> None:
    with world.edit("cloth") as edit:
        edit.cut([12, 13, 14, 15, 16, 17])
        edit.pin([41])
        edit.remove_triangles([0])
        assert len(edit.triangles) == 49
    assert world["cloth"].particles == 42 and world.edit("cloth").pins.tolist() == [0, 5, 41]
    parts = np.zeros(49, np.int32)
    parts[:10] = 1
    with world.edit("cloth") as edit:
        edit.part_triangles(parts)
        assert edit.particles > 42
    assert world.step().ok


def test_an_edit_is_part_of_what_is_saved(world: pliant.World) -> None:
    with world.edit("cloth") as edit:
        edit.cut([12, 13, 14, 15, 16, 17])
        edit.unpin([0])
    world.run(2)
    same = copy.deepcopy(world)
    world.run(3)
    same.run(3)
    assert same["cloth"].particles == 42 and same.state_hash() == world.state_hash()


def hanging_spring() -> pliant.World:
    """1 kg on a link of 1 m with a compliance of 0.01 m/N."""
    scene = pliant.Scene(gravity=(0, -10, 0), settings={"substeps": 50})
    line = {"from": [0, 0, 0], "to": [0, -1, 0], "points": 2}
    scene.add(rope={"line": line, "stretch": {"compliance": 0.01}}, damping=5, pins=[{"particles": [0]}])
    return pliant.World(scene)


def test_stiffness_is_scaled_or_set() -> None:
    world = hanging_spring()
    with world.edit("rope") as edit:
        edit.set_masses([1, 1])
        assert edit.masses.tolist() == [1, 1]
    rope = world["rope"]

    def stretch() -> float:
        world.run(300)
        return float(-1 - rope.positions()[1, 1])

    assert stretch() == pytest.approx(0.1, rel=0.01)
    with world.edit(rope) as edit:
        edit.scale_stiffness("distance", 2)
    assert stretch() == pytest.approx(0.05, rel=0.01)
    with world.edit(rope) as edit:
        edit.set_compliance("distance", 0.02, damping=0.1)
    assert stretch() == pytest.approx(0.2, rel=0.01)
    with world.edit(rope) as edit:
        edit.set_masses([1, 0.5])
    assert stretch() == pytest.approx(0.1, rel=0.01)


def test_another_description_changes_the_material(world: pliant.World) -> None:
    world.run(5)
    cloth, before = world["cloth"], world["cloth"].positions()
    mass = world.edit("cloth").masses.sum()
    cloth_of = {"mesh": pliant.grid_mesh(6, 6, 1, 1), "material": "silk"}
    with world.edit("cloth") as edit:
        edit.describe(cloth=cloth_of, pins=[{"particles": [0]}], thickness=0.002)
    np.testing.assert_array_equal(cloth.positions(), before)
    silk = pliant.fabrics()["silk"]["area_density"] / pliant.fabrics()["cotton"]["area_density"]
    assert world.edit("cloth").masses.sum() == pytest.approx(mass * silk, rel=1e-4)
    assert world.edit("cloth").pins.tolist() == [0] and cloth.name == "cloth"


def test_tetrahedra_are_removed_and_parted() -> None:
    scene = pliant.Scene()
    box = {"box": {"size": [0.2, 0.2, 0.2], "cells": [2, 2, 2]}}
    scene.add(soft_body={"tetrahedra": box, "material": "gelatine"}, name="block")
    world = pliant.World(scene)
    with world.edit("block") as edit:
        count = len(edit.tetrahedra)
        edit.remove_tetrahedra([0])
        assert edit.tetrahedra.shape == (count - 1, 4)
    before = world["block"].particles
    with world.edit("block") as edit:
        edit.part_tetrahedra(np.arange(count - 1) % 2)
    assert world["block"].particles > before and world.step().ok


def test_an_exception_in_the_block_changes_nothing(world: pliant.World) -> None:
    before = world.state_hash()
    with pytest.raises(ZeroDivisionError):
        with world.edit("cloth") as edit:
            edit.unpin()
            assert 1 / 0
    assert world.edit("cloth").pins.tolist() == [0, 5] and world.state_hash() == before
    assert repr(world.edit("cloth")) == "<pliant.Edit of 'cloth': 36 particles>"
    assert edit.name == "cloth"


CLOTH = {"mesh": pliant.grid_mesh(6, 6, 1, 1), "material": "silk"}
BAD: dict[str, Callable[[pliant.World, Any], Any]] = {
    "no object": lambda w, e: w.edit("shirt"),
    "a number": lambda w, e: w.edit(3),  # type: ignore[arg-type]
    "an object of another World": lambda w, e: w.edit(pliant.World(cloth_scene())["cloth"]),
    "an Edit without a World": lambda w, e: pliant.Edit(),
    "a pin of no particle": lambda w, e: e.pin([36]),
    "a pin of particle -1": lambda w, e: e.pin([-1]),
    "a pin of text": lambda w, e: e.pin("all"),
    "a pin of nothing": lambda w, e: e.pin(),
    "unpinning what is free": lambda w, e: e.unpin([7]),
    "unpinning no particle": lambda w, e: e.unpin([99]),
    "detaching what is free": lambda w, e: e.detach([0]),
    "an attachment of no particle": lambda w, e: e.attach([36], [[0, 0, 0]]),
    "two targets for one": lambda w, e: e.attach([0], [[0, 0, 0]] * 2),
    "a compliance of text": lambda w, e: e.attach([0], [[0, 0, 0]], compliance="soft"),
    "a negative compliance": lambda w, e: (e.attach([7], [[0, 0, 0]], compliance=-1), e.apply()),
    "a target of nan": lambda w, e: (e.attach([7], [[0, np.nan, 0]]), e.apply()),
    "a path of no edge": lambda w, e: e.cut([0, 35]),
    "a path of no particle": lambda w, e: e.cut([0, 99]),
    "no triangle": lambda w, e: e.remove_triangles([50]),
    "parts of fewer": lambda w, e: e.part_triangles([0, 1]),
    "tetrahedra of cloth": lambda w, e: e.remove_tetrahedra([0]),
    "parts of tetrahedra": lambda w, e: e.part_tetrahedra([0]),
    "no such type": lambda w, e: e.scale_stiffness("spring", 2),
    "a type of no str": lambda w, e: e.scale_stiffness(3, 2),
    "a factor of zero": lambda w, e: e.scale_stiffness("distance", 0),
    "a factor of nan": lambda w, e: e.scale_stiffness("distance", np.nan),
    "a factor of text": lambda w, e: e.scale_stiffness("distance", "2"),
    "compliance below zero": lambda w, e: e.set_compliance("distance", -1),
    "compliance of None": lambda w, e: e.set_compliance("distance", None),
    "masses of fewer": lambda w, e: e.set_masses([1, 2]),
    "masses of zero": lambda w, e: e.set_masses(np.zeros(36)),
    "masses below zero": lambda w, e: e.set_masses([1] * 35 + [-1]),
    "masses of nan": lambda w, e: e.set_masses([np.nan] * 36),
    "another name": lambda w, e: e.describe(name="shirt", cloth=CLOTH),
    "no description": lambda w, e: e.describe(),
    "a description of other particles": lambda w, e: e.describe(cloth={"mesh": pliant.grid_mesh(3, 3, 1, 1)}),
    "a wrong description": lambda w, e: e.describe(cloth={"mesh": pliant.grid_mesh(6, 6, 1, 1), "material": "paper"}),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore:nanobind")
@pytest.mark.parametrize("bad", BAD)
def test_misuse(world: pliant.World, bad: str) -> None:
    before = world.state_hash()
    with pytest.raises((ValueError, TypeError, KeyError)) as caught:
        BAD[bad](world, world.edit("cloth"))
    assert str(caught.value) and "::" not in str(caught.value)
    assert world.state_hash() == before and world.edit("cloth").pins.tolist() == [0, 5]
    assert world.step().ok


def test_an_edit_is_applied_once(world: pliant.World) -> None:
    with world.edit("cloth") as edit:
        edit.apply()
        assert repr(edit) == "<pliant.Edit of 'cloth': 36 particles, applied>"
    for change in (edit.apply, lambda: edit.pin([3]), edit.unpin, lambda: edit.cut([12, 13])):
        with pytest.raises(pliant.Error, match="this Edit was applied; make another"):
            change()


def test_an_edit_is_not_changed_while_another_thread_applies_it() -> None:
    """In a program of its own: a fault would end it. The cloth is large, so that the other thread gets a turn."""
    program = """
import threading, pliant
scene = pliant.Scene()
scene.add(cloth={"mesh": pliant.grid_mesh(150, 150, 1, 1)}, name="cloth", pins=[{"particles": [0]}])
world = pliant.World(scene, threads=1)
edit = world.edit("cloth")
thread = threading.Thread(target=edit.apply)
calls = [lambda: edit.pin([1]), edit.detach, edit.apply, lambda: edit.cut([0, 151, 302]), lambda: edit.set_masses([1])]
refused = []
thread.start()
while thread.is_alive():
    for call in calls:
        try:
            call()
        except pliant.Error as error:
            refused.append(str(error))
thread.join()
assert any("is being applied in another thread" in text for text in refused), set(refused)
assert edit.pins.tolist() == world.edit("cloth").pins.tolist() and edit.particles == world["cloth"].particles
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)


class AppliesMeanwhile:
    """A number or list of numbers that applies an Edit while it is converted."""

    def __init__(self, edit: pliant.Edit, values: Any) -> None:
        self.edit, self.values = edit, values

    def __float__(self) -> float:
        self.edit.apply()
        return float(self.values)

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        self.edit.apply()
        return np.array(self.values, dtype)


CHANGES: dict[str, Callable[[Any], Any]] = {
    "pin": lambda e: e.pin(AppliesMeanwhile(e, [7])),
    "unpin": lambda e: e.unpin(AppliesMeanwhile(e, [0])),
    "detach": lambda e: e.detach(AppliesMeanwhile(e, [0])),
    "cut": lambda e: e.cut(AppliesMeanwhile(e, [12, 13, 14])),
    "attach": lambda e: e.attach([7], [[0, 0, 0]], damping=AppliesMeanwhile(e, 1)),
    "set_compliance": lambda e: e.set_compliance("distance", 1, damping=AppliesMeanwhile(e, 1)),
    "scale_stiffness": lambda e: e.scale_stiffness("distance", AppliesMeanwhile(e, 2)),
    "set_masses": lambda e: e.set_masses(AppliesMeanwhile(e, np.ones(36))),
}  # fmt: skip


@pytest.mark.parametrize("change", CHANGES)
def test_arguments_that_apply_the_edit_change_nothing_after_that(world: pliant.World, change: str) -> None:
    edit = world.edit("cloth")
    with pytest.raises((pliant.Error, TypeError)):
        CHANGES[change](edit)
    assert (edit.particles, edit.pins.tolist(), len(edit.attachments)) == (36, [0, 5], 0)
    np.testing.assert_array_equal(edit.masses, world.edit("cloth").masses)


def test_an_edit_from_before_another_is_refused(world: pliant.World) -> None:
    first, second = world.edit("cloth"), world.edit("cloth")
    first.pin([30])
    second.pin([35])
    first.apply()
    before = world.state_hash()
    with pytest.raises(pliant.Error, match="'cloth'.* was edited or torn after this Edit was made; make another by"):
        second.apply()
    assert world.edit("cloth").pins.tolist() == [0, 5, 30] and world.state_hash() == before
    third = world.edit("cloth")
    world.run(2)  # steps alone do not outdate it
    third.pin([35])
    third.apply()
    assert world.edit("cloth").pins.tolist() == [0, 5, 30, 35]


def test_an_edit_that_failed_outdates_no_other(world: pliant.World) -> None:
    wrong, right = world.edit("cloth"), world.edit("cloth")
    wrong.attach([1], [[0, 0, 0]], -1)
    with pytest.raises(pliant.Error):
        wrong.apply()
    right.pin([30])
    right.apply()
    assert world.edit("cloth").pins.tolist() == [0, 5, 30]


@pytest.mark.parametrize("step", [lambda b: b.step(), lambda b: b.worlds[0].run(1), lambda b: b.worlds[0].step()])
def test_an_edit_from_before_a_tear_is_refused(step: Callable[[pliant.Batch], Any]) -> None:
    scene = cloth_scene()
    scene["objects"][0]["tearing"] = {"stretch": 1.2}
    batch = pliant.Batch(scene, 1)
    world = batch.worlds[0]
    edit = world.edit("cloth")
    world["cloth"].set_targets([0, 5], [[-1.5, 0, -0.5], [1.5, 0, -0.5]])
    step(batch)
    torn = world["cloth"].particles
    assert torn > 36
    edit.pin([35])
    with pytest.raises(pliant.Error, match="edited or torn"):
        edit.apply()
    assert world["cloth"].particles == torn
    with world.edit("cloth") as edit:
        edit.pin([35])
    assert world["cloth"].particles == torn and 35 in world.edit("cloth").pins


def test_what_is_gone_or_looked_at_is_not_edited(world: pliant.World) -> None:
    edit = world.edit("cloth")
    records = world["cloth"].records()
    with pytest.raises(pliant.Error, match="cannot be edited while 1 view of its records"):
        edit.apply()
    assert len(records) > 0
    del records
    world.remove("cloth")
    with pytest.raises(pliant.Error, match="removed"):
        edit.apply()
