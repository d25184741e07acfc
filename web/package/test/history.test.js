// The history of a World: what it keeps within its budget, and what it does when memory ends. Worlds are made up.
import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../history.js";
import { PliantError } from "../memory.js";

const budget = 96e6; // [bytes]

/** A World of as many particles and contacts, of whose States `room` fit into memory. */
class MadeUp {
  constructor({ particles = 1, contacts = 0, bytes = 0, room = Infinity }) {
    Object.assign(this, { particles, contacts, bytesOf: bytes, room, alive: 0, info: { frame: 0 } });
  }
  objects() {
    return [{ info: { particles: this.particles } }];
  }
  report() {
    return this.info.frame === 0 ? {} : { contacts: 0, pairs: { contacts: this.contacts } };
  }
  copyState() {
    if (this.alive >= this.room) throw new PliantError("there is no memory", { status: "PLIANT_NO_MEMORY" });
    ++this.alive;
    return { free: () => --this.alive };
  }
  bytes() {
    return { length: this.bytesOf };
  }
  run(history, frames) {
    for (let i = 0; i < frames; ++i) {
      ++this.info.frame;
      history.keep(this);
    }
  }
}

const states = { objects: [{ changes: false }] };
const worlds = { objects: [{ changes: true }] };

test("240 frames at most are kept, from the first one", () => {
  const world = new MadeUp({});
  const history = new History(world, states);
  world.run(history, 1000);
  assert.deepEqual(history.frames.slice(0, 3), [0, 8, 16]);
  assert.equal(history.frames.at(-1), 1000);
  assert.equal(world.alive, history.frames.length, "the others are freed");
});

test("contacts of bodies count", () => {
  const world = new MadeUp({ particles: 1000, contacts: 20000 });
  const history = new History(world, states);
  world.run(history, 200);
  assert.ok(world.alive * 332 * 20000 < budget, `${world.alive} States`);
  assert.ok(world.alive > 5, `${world.alive} States`);
});

test("bytes of Worlds that grow are kept within the budget, two at least", () => {
  const world = new MadeUp({ bytes: 1e6 });
  const history = new History(world, worlds);
  world.run(history, 50);
  world.bytesOf = 8e6;
  world.run(history, 200);
  const size = history.kept.reduce((sum, { held }) => sum + held.length, 0);
  assert.ok(size <= budget, `${size}`);
  assert.equal(history.size, size);
  world.bytesOf = 2e8;
  world.run(history, 2000);
  assert.equal(history.frames[0], 0);
  assert.ok(history.frames.length <= 2, `${history.frames}`);
});

test("where memory ends, fewer frames are kept and time goes on", () => {
  for (const room of [0, 1, 7]) {
    const world = new MadeUp({ room });
    const history = new History(world, states);
    world.run(history, 100);
    assert.ok(history.frames.length <= room, `${history.frames}`);
    assert.equal(world.alive, history.frames.length);
    if (room > 0) assert.equal(history.frames[0], 0);
  }
  const broken = new MadeUp({});
  broken.copyState = () => assert.fail("another error");
  assert.throws(() => new History(broken, states), /another error/);
});

test("every frame is kept again after going back to the first one", () => {
  const world = new MadeUp({});
  const history = new History(world, states);
  world.run(history, 1000);
  world.info.frame = 0;
  world.run(history, 5);
  assert.deepEqual(history.frames, [0, 1, 2, 3, 4, 5]);
  history.free();
  assert.deepEqual([world.alive, history.size], [0, 0]);
});
