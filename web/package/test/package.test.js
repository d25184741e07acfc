// The package in node: scenes, errors, arrays, files, drags, states and files of frames.
import assert from "node:assert/strict";
import { test } from "node:test";
import { buffersOf, PliantError, readFrame, readParts } from "../index.js";
import { filesOf, pliant, sceneText } from "./support.js";

const engine = await pliant();

const sheet = {
  objects: [
    {
      name: "sheet",
      cloth: { mesh: { grid: { columns: 11, rows: 11, width: 1, depth: 1 } }, material: "cotton" },
      pins: [{ particles: [0, 10] }],
    },
  ],
};

function caught(body) {
  try {
    body();
  } catch (error) {
    assert.ok(error instanceof PliantError, `${error.stack}`);
    return error;
  }
  assert.fail("nothing was thrown");
}

test("version, schema and materials", () => {
  assert.match(engine.version, /^\d+\.\d+\.\d+$/);
  assert.ok(engine.schema().$defs);
  assert.ok(engine.materials().fabrics.some(({ name }) => name === "silk"));
});

test("a refused scene says where and what to do", () => {
  const error = caught(() => engine.world('{\n  "objects": [{"cloht": {}}]\n}'));
  assert.equal(error.status, "PLIANT_REFUSED");
  assert.equal(error.line, 2);
  assert.ok(error.column > 0);
  assert.match(error.message, /cloht/);
  assert.match(error.message, /did you mean 'cloth'/);
  assert.match(caught(() => engine.world("{")).message, /scene:1/);
});

test("findings of a scene", () => {
  const fine = engine.check(sheet);
  assert.equal(fine.filter(({ isGrave }) => isGrave).length, 0);
  const scene = engine.scene(sheet);
  assert.deepEqual([scene.info.objects, scene.info.particles], [1, 121]);
  assert.ok(Math.abs(scene.info.frameTime - 1 / 60) < 1e-7);
  scene.set("/settings/substeps", 7);
  const world = scene.world();
  scene.free();
  world.step();
  assert.equal(world.report().substeps, 7);
  world.free();
});

test("values are set by pointer", () => {
  const world = engine.world(sheet, { values: { "/settings/substeps": 9 } });
  world.step();
  assert.equal(world.report().substeps, 9);
  world.free();
});

test("a free particle falls by g t^2 / 2", () => {
  const world = engine.world({ objects: [{ name: "sheet", cloth: sheet.objects[0].cloth }], settings: { substeps: 100 } });
  world.run(30);
  assert.ok(Math.abs(world.info.time - 0.5) < 1e-6);
  assert.equal(world.info.frame, 30);
  const y = world.object("sheet").positions()[1];
  assert.ok(Math.abs(y + 0.5 * 9.81 * 0.25) < 0.005, `${y}`);
  world.free();
});

test("positions: copies, the caller's array, and a view", () => {
  const world = engine.world(sheet);
  const object = world.object("sheet");
  assert.deepEqual(object.info.particles, 121);
  const out = new Float32Array(363);
  assert.equal(object.positions(out), out);
  assert.deepEqual(object.positionsView(), out);
  assert.throws(() => object.positions(new Float32Array(3)), RangeError);
  const before = object.positions();
  world.step();
  assert.deepEqual(before, out);
  assert.notDeepEqual(object.positions(), out);
  assert.equal(object.triangles().length, 3 * 200);
  const { positions, normals } = object.surface();
  assert.equal(positions.length, normals.length);
  assert.ok(Math.abs(Math.hypot(...normals.subarray(3, 6)) - 1) < 1e-5);
  world.free();
});

test("a mesh of arrays is the mesh of the grid", () => {
  const grid = engine.world(sheet);
  const arrays = { mine: { positions: grid.object("sheet").positions(), triangles: grid.object("sheet").triangles() } };
  const cloth = { mesh: { array: "mine" }, material: "cotton" };
  const mine = engine.world({ objects: [{ ...sheet.objects[0], cloth }] }, { arrays });
  for (const world of [grid, mine]) world.run(5);
  assert.equal(mine.hash(), grid.hash());
  assert.throws(() => engine.world(sheet, { arrays: { mine: { positions: [1, 2] } } }), RangeError);
  grid.free();
  mine.free();
});

test("files of meshes are read from memory", async () => {
  const text = await sceneText("contact/ring");
  assert.match(caught(() => engine.world(text)).message, /ring\.obj/);
  const world = engine.world(text, { files: await filesOf("contact/ring") });
  world.step();
  world.free();
});

test("pinned particles follow targets, and drags of pins do", () => {
  const world = engine.world(sheet);
  const object = world.object("sheet");
  object.setTargets([0], [-0.5, 0.2, -0.5]);
  world.step();
  assert.ok(Math.abs(object.positions()[1] - 0.2) < 1e-6);
  const drag = object.drag(10);
  drag.moveTo([0.5, 0.1, -0.5]);
  world.step();
  assert.ok(Math.abs(object.positions()[31] - 0.1) < 1e-6);
  drag.release();
  assert.throws(() => object.drag(121), RangeError);
  world.free();
});

test("a drag moves a free particle to its target without swinging about it, and lets go", () => {
  // Nearer to the pins, so that cloth can reach the target.
  for (const move of [[0, 0.1, -0.15], [0.1, 0.1, -0.1], [0, 0.05, 0], [0.15, 0.2, -0.3]]) {
    const world = engine.world(sheet);
    const object = world.object("sheet");
    const particle = object.nearest([0, 0, 0.5]);
    assert.equal(particle, 10 * 11 + 5);
    world.run(5);
    const drag = object.drag(particle, { radius: 0.25 });
    const target = drag.target.map((x, k) => x + move[k]);
    const place = () => object.positions().subarray(3 * particle, 3 * particle + 3);
    drag.moveTo(target);
    world.run(39);
    for (let frame = 40; frame <= 100; ++frame) {
      world.step();
      const away = Math.hypot(...place().map((x, k) => x - target[k]));
      assert.ok(away < 0.03, `${away} m away in frame ${frame} of the move by ${move}`);
    }
    drag.release();
    const y = place()[1];
    world.run(20);
    assert.ok(place()[1] < y - 0.05, "it falls again");
    world.free();
  }
});

test("a drag moves a rigid body, and pushes what is in its way", async () => {
  const world = engine.world(await sceneText("bodies/pyramid"));
  const parts = readParts(world);
  const part = parts.objects.find(({ bodies }) => bodies.length > 0);
  const object = world.object(part.id);
  world.step();
  const before = object.poses();
  const body = part.bodies.findIndex(({ fixed }) => !fixed);
  const drag = object.drag(part.bodies[body].particle);
  drag.moveTo([before[7 * body], before[7 * body + 1] + 0.5, before[7 * body + 2] + 1]);
  world.run(60);
  const after = object.poses();
  assert.ok(after[7 * body + 2] > before[7 * body + 2] + 0.5, `${after[7 * body + 2] - before[7 * body + 2]}`);
  world.free();
});

test("the same bits after a state is restored, and after bytes are read", async () => {
  const world = engine.world(sheet);
  world.run(3);
  const state = world.copyState();
  const bytes = world.bytes();
  world.run(3);
  const hash = world.hash();
  world.restore(state);
  world.run(3);
  assert.equal(world.hash(), hash);
  const other = engine.worldFromBytes(bytes);
  other.run(3);
  assert.equal(other.hash(), hash);
  state.free();
  other.free();
  world.free();
});

test("contacts of a ball on the ground", () => {
  const world = engine.world({
    objects: [{ name: "ball", bodies: [{ solids: [{ sphere: { radius: 0.1 } }], position: [0, 0.1, 0] }] }],
    colliders: [{ name: "ground", plane: {} }],
  });
  world.recordContacts();
  world.run(10);
  const [contact] = world.contacts();
  const weight = ((4 / 3) * Math.PI * 0.1 ** 3 * 1000 * 9.81) / 60; // in a frame [N s]
  assert.ok(Math.abs(contact.impulse / weight - 1) < 0.05, `${contact.impulse} of ${weight}`);
  assert.deepEqual(contact.first.slice(0, 2), [0, 0]);
  assert.deepEqual(contact.second.slice(0, 2), [1, 0]);
  assert.ok(contact.normal[1] > 0.999);
  assert.ok(Math.abs(contact.position[1]) < 0.01);
  world.free();
});

test("objects come and go; ids of removed ones are stale", () => {
  const world = engine.world(sheet);
  const ball = world.addObject({ name: "ball", bodies: [{ solids: [{ sphere: { radius: 0.1 } }], position: [0, 2, 0] }] });
  assert.deepEqual(world.objects().map(({ name }) => name), ["sheet", "ball"]);
  world.step();
  world.remove(ball);
  assert.equal(caught(() => ball.positions()).status, "PLIANT_STALE");
  world.free();
  assert.equal(caught(() => world.step()).status, "PLIANT_NULL");
});

test("frames as .glb", () => {
  const world = engine.world(sheet);
  const bytes = world.record(3);
  assert.equal(new TextDecoder().decode(bytes.subarray(0, 4)), "glTF");
  assert.equal(new DataView(bytes.buffer, bytes.byteOffset).getUint32(8, true), bytes.length);
  assert.equal(world.info.frame, 3);
  world.free();
});

test("what there is to draw", async () => {
  for (const [name, kind] of [
    ["rope", "lines"],
    ["rods/hair", "none"],
    ["liquids/dam_break", "liquid"],
    ["grains/heap", "balls"],
    ["soft_bodies/squeeze", "surface"],
    ["gas/plume", "smoke"],
    ["bodies/pyramid", "none"],
  ]) {
    const world = engine.world(await sceneText(name), { files: await filesOf(name) });
    const parts = readParts(world);
    assert.ok(parts.objects.some((part) => part.kind === kind), `${name}: ${parts.objects.map((part) => part.kind)}`);
    world.step();
    const frame = readFrame(world, parts);
    for (const object of frame.objects) assert.ok((object.positions ?? object.poses ?? [0]).every(Number.isFinite));
    assert.ok(buffersOf(frame).every((buffer) => buffer instanceof ArrayBuffer));
    for (const part of parts.objects)
      if (part.kind === "lines") assert.ok(Math.max(...part.lines) < world.object(part.id).info.particles);
    world.free();
  }
});

test("memory of worlds is freed", () => {
  const size = () => engine.module.HEAPU8.length;
  const make = () => {
    const world = engine.world(sheet);
    world.step();
    world.free();
  };
  for (let i = 0; i < 20; ++i) make();
  const before = size();
  for (let i = 0; i < 200; ++i) make();
  assert.equal(size(), before);
});
