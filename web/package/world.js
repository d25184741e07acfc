// Worlds, their objects and states.
import { Drag } from "./drag.js";
import { writeArrays } from "./scene.js";

/** A copy of borrowed memory, in the caller's array if there is one. */
function copyOf(view, out) {
  if (out === undefined) return view.slice();
  if (out.length !== view.length) throw new RangeError(`the array has ${out.length} numbers, and needs ${view.length}`);
  out.set(view);
  return out;
}

export class World {
  constructor(memory, handle) {
    this.memory = memory;
    this.handle = handle;
    this.drags = new Set();
  }

  static of(memory, scene) {
    return memory.using((arena) => {
      const into = arena.bytes(4);
      memory.call("pliant_world_create", scene, 0, into);
      return new World(memory, memory.u32()[into / 4]);
    });
  }

  static fromBytes(memory, bytes) {
    return memory.using((arena) => {
      const at = arena.bytes(bytes.length);
      const into = arena.bytes(4);
      memory.u8().set(bytes, at);
      memory.call("pliant_world_from_bytes", at, bytes.length, into);
      return new World(memory, memory.u32()[into / 4]);
    });
  }

  step(dt = 0) {
    for (const drag of this.drags) drag.apply(dt || this.info.frameTime);
    this.memory.call("pliant_world_step", this.handle, dt);
  }

  run(frames) {
    for (let i = 0; i < frames; ++i) this.step();
  }

  get info() {
    const memory = this.memory;
    return memory.using((arena) => {
      const at = arena.bytes(72);
      memory.u32()[at / 4] = 72;
      memory.call("pliant_world_get_info", this.handle, at);
      return {
        time: memory.f64()[(at + 8) / 8],
        frame: memory.i64(at + 16),
        frameTime: memory.f64()[(at + 24) / 8],
        frames: memory.i64(at + 32),
      };
    });
  }

  /** Asks a function of the World for a text. */
  text(name) {
    return this.memory.askText((...into) => this.memory.module[`_${name}`](this.handle, ...into));
  }
  hash() {
    return this.text("pliant_world_hash");
  }
  describe() {
    return this.text("pliant_world_describe");
  }
  explain() {
    return this.text("pliant_report_explain");
  }
  advice() {
    return this.text("pliant_report_advice");
  }
  report() {
    return JSON.parse(this.text("pliant_report_json"));
  }
  parts() {
    return JSON.parse(this.text("pliant_web_parts"));
  }

  /** A number by its name. */
  number(name, of) {
    return this.memory.using((arena) => {
      const into = arena.bytes(8);
      this.memory.call(name, this.handle, arena.text(of), into);
      return this.memory.f64()[into / 8];
    });
  }
  measure(name) {
    return this.number("pliant_world_measure", name);
  }

  /** Calls `body` with the address of an id. */
  withId(id, body) {
    return this.memory.using((arena) => body(arena.integers(id), arena));
  }

  find(kind, name) {
    return this.memory.using((arena) => {
      const into = arena.bytes(12);
      this.memory.call("pliant_world_find", this.handle, kind, arena.text(name), into);
      return Array.from(this.memory.i32().subarray(into / 4, into / 4 + 3));
    });
  }
  ids(kind) {
    const ask = (...into) => this.memory.module._pliant_world_ids(this.handle, kind, ...into);
    const { at, count } = this.memory.askList(ask, 12, 64);
    const words = this.memory.i32();
    return Array.from({ length: count }, (_, i) => Array.from(words.subarray(at / 4 + 3 * i, at / 4 + 3 * i + 3)));
  }
  nameOf(id) {
    const memory = this.memory;
    return this.withId(id, (at) => memory.askText((...into) => memory.module._pliant_world_name(this.handle, at, ...into)));
  }
  objects() {
    return this.ids(0).map((id) => new WorldObject(this, id));
  }
  object(nameOrId) {
    return new WorldObject(this, typeof nameOrId === "string" ? this.find(0, nameOrId) : nameOrId);
  }
  collider(nameOrId) {
    return new WorldCollider(this, typeof nameOrId === "string" ? this.find(1, nameOrId) : nameOrId);
  }

  /** Adds what a function of the C library adds. */
  add(name, description, arrays) {
    return this.memory.using((arena) => {
      const list = writeArrays(arena, arrays);
      const into = arena.bytes(12);
      this.memory.call(name, this.handle, arena.text(JSON.stringify(description)), list.at, list.count, into);
      return Array.from(this.memory.i32().subarray(into / 4, into / 4 + 3));
    });
  }
  addObject(description, arrays) {
    return this.object(this.add("pliant_world_add_object", description, arrays));
  }
  addCollider(description, arrays) {
    return this.add("pliant_world_add_collider", description, arrays);
  }
  remove(thing) {
    this.withId(thing.id ?? thing, (at) => this.memory.call("pliant_world_remove", this.handle, at));
  }

  recordContacts(on = true) {
    this.memory.call("pliant_world_record_contacts", this.handle, on ? 1 : 0);
  }
  contacts() {
    const memory = this.memory;
    const { at, count } = memory.askList((...into) => memory.module._pliant_world_contacts(this.handle, ...into), 88, 64);
    return Array.from({ length: count }, (_, i) => {
      const here = at + 88 * i;
      const integers = memory.i32().subarray(here / 4, here / 4 + 8);
      const floats = memory.f32();
      return {
        change: ["began", "persists", "ended"][integers[0]],
        first: Array.from(integers.subarray(1, 4)),
        second: Array.from(integers.subarray(4, 7)),
        contacts: integers[7],
        impulse: memory.f64()[(here + 32) / 8],
        position: Array.from(floats.subarray((here + 40) / 4, (here + 52) / 4)),
        normal: Array.from(floats.subarray((here + 52) / 4, (here + 64) / 4)),
        pushOnFirst: Array.from(memory.f64().subarray((here + 64) / 8, (here + 88) / 8)),
      };
    });
  }

  bytes() {
    const memory = this.memory;
    const { at, count } = memory.askList((...into) => memory.module._pliant_world_bytes(this.handle, ...into), 1, 1 << 20);
    return memory.u8().slice(at, at + count);
  }
  copyState() {
    return this.memory.using((arena) => {
      const into = arena.bytes(4);
      this.memory.call("pliant_state_copy", this.handle, into);
      return new State(this.memory, this.memory.u32()[into / 4]);
    });
  }
  restore(state) {
    this.memory.call("pliant_state_restore", this.handle, state.handle);
  }

  /** Frames as a file: ".glb", ".usda", ... `frames` steps are made. */
  record(frames, suffix = ".glb") {
    const { memory } = this;
    const path = `/pliant_frames${suffix}`;
    memory.using((arena) => {
      const into = arena.bytes(4);
      memory.call("pliant_writer_open", this.handle, arena.text(path), into);
      const writer = memory.u32()[into / 4];
      try {
        memory.call("pliant_writer_add", writer, this.handle);
        for (let i = 0; i < frames; ++i) {
          this.step();
          memory.call("pliant_writer_add", writer, this.handle);
        }
        memory.call("pliant_writer_finish", writer);
      } finally {
        memory.call("pliant_writer_free", writer);
      }
    });
    const bytes = memory.module.FS.readFile(path);
    memory.module.FS.unlink(path);
    return bytes;
  }

  meshCollider(id) {
    return this.mesh("pliant_web_mesh_collider", id);
  }

  /** A mesh of the module, copied. */
  mesh(name, id, ...more) {
    const memory = this.memory;
    return this.withId(id, (at, arena) => {
      const into = arena.bytes(20);
      memory.call(name, this.handle, at, ...more, into);
      const [positions, normals, count, triangles, triangleCount] = memory.u32().subarray(into / 4, into / 4 + 5);
      const floats = memory.f32();
      return {
        positions: floats.slice(positions / 4, positions / 4 + 3 * count),
        normals: floats.slice(normals / 4, normals / 4 + 3 * count),
        triangles: memory.u32().slice(triangles / 4, triangles / 4 + 3 * triangleCount),
      };
    });
  }

  free() {
    this.drags.clear();
    if (this.handle) this.memory.call("pliant_world_free", this.handle);
    this.handle = 0;
  }
}

/** An object of a World. Its particles are in the order of its description. */
export class WorldObject {
  constructor(world, id) {
    this.world = world;
    this.id = id;
  }
  get name() {
    return this.world.nameOf(this.id);
  }
  get info() {
    const { memory } = this.world;
    return this.world.withId(this.id, (id, arena) => {
      const at = arena.bytes(64);
      memory.u32()[at / 4] = 64;
      memory.call("pliant_object_get_info", this.world.handle, id, at);
      const names = ["particles", "triangles", "bodies", "joints", "attachments", "constraints"];
      return {
        ...Object.fromEntries(names.map((name, i) => [name, memory.i64(at + 8 + 8 * i)])),
        substeps: memory.i32()[(at + 56) / 4],
        isFlow: memory.i32()[(at + 60) / 4] === 1,
      };
    });
  }

  /** A view of memory that a function fills for each particle: until the next call of the package. */
  view(name) {
    const { memory, handle } = this.world;
    const count = this.info.particles;
    const at = memory.borrow(12 * count);
    this.world.withId(this.id, (id) => memory.call(name, handle, id, at, count));
    return memory.f32().subarray(at / 4, at / 4 + 3 * count);
  }
  positionsView() {
    return this.view("pliant_object_positions");
  }
  positions(out) {
    return copyOf(this.positionsView(), out);
  }
  velocities(out) {
    return copyOf(this.view("pliant_object_velocities"), out);
  }

  /** A list of numbers of unknown length; `size` of them an element. */
  list(name, size, kind, ...more) {
    const { memory, handle } = this.world;
    return this.world.withId(this.id, (id) => {
      const ask = (...into) => memory.module[`_${name}`](handle, id, ...more, ...into);
      const { at, count } = memory.askList(ask, 4 * size);
      return memory[kind]().slice(at / 4, at / 4 + size * count);
    });
  }
  triangles() {
    return this.list("pliant_object_triangles", 3, "u32");
  }
  lines() {
    return this.list("pliant_web_lines", 1, "u32");
  }
  present() {
    return this.list("pliant_object_present", 1, "i32");
  }
  inverseMasses() {
    return this.list("pliant_web_inverse_masses", 1, "f32");
  }
  poses() {
    return this.list("pliant_web_poses", 7, "f32");
  }
  orientations() {
    return this.list("pliant_object_orientations", 4, "f32");
  }
  channel(name) {
    return this.world.memory.using((arena) => this.list("pliant_object_channel", 1, "f32", arena.text(name)));
  }
  surface() {
    return this.world.mesh("pliant_web_surface", this.id);
  }
  solid(index) {
    return this.world.mesh("pliant_web_solid", this.id, index);
  }
  liquidSurface() {
    return this.world.mesh("pliant_web_liquid", this.id);
  }

  /** Gives three floats for each particle to a function. */
  give(name, values) {
    const { memory, handle } = this.world;
    if (values.length % 3 !== 0) throw new RangeError(`${values.length} floats are given: three a particle`);
    this.world.withId(this.id, (id, arena) => memory.call(name, handle, id, arena.floats(values), values.length / 3));
  }
  setVelocities(velocities) {
    this.give("pliant_object_set_velocities", velocities);
  }
  addImpulses(impulses) {
    this.give("pliant_object_add_impulses", impulses);
  }
  setForces(forces) {
    this.give("pliant_object_set_forces", forces);
  }
  setTargets(particles, positions) {
    const { memory, handle } = this.world;
    if (positions.length !== 3 * particles.length)
      throw new RangeError(`${particles.length} particles need ${3 * particles.length} floats, not ${positions.length}`);
    this.world.withId(this.id, (id, arena) =>
      memory.call("pliant_object_set_targets", handle, id, arena.integers(particles), arena.floats(positions), particles.length),
    );
  }
  /** Pulls particles towards places in the next step, as springs with critical damping of these frequencies [1/s] do. */
  setPulls(particles, places, frequencies) {
    const { memory, handle } = this.world;
    if (places.length !== 3 * particles.length || frequencies.length !== particles.length)
      throw new RangeError(`${particles.length} particles need three floats and a frequency each`);
    this.world.withId(this.id, (id, arena) => {
      const lists = [arena.integers(particles), arena.floats(places), arena.floats(frequencies)];
      memory.call("pliant_web_set_pulls", handle, id, ...lists, particles.length);
    });
  }
  setMotor(joint, target, { motor, most = 0 } = {}) {
    const { memory, handle } = this.world;
    this.world.withId(this.id, (id, arena) =>
      memory.call("pliant_object_set_motor", handle, id, arena.text(joint), arena.text(motor), target, most),
    );
  }

  /** The particle nearest to a point, of those that are there. */
  nearest(point) {
    const positions = this.positions();
    let [best, least] = [-1, Infinity];
    for (const i of this.present()) {
      const away = Math.hypot(...[0, 1, 2].map((k) => positions[3 * i + k] - point[k]));
      if (away < least) [best, least] = [i, away];
    }
    return best;
  }
  drag(particle, options) {
    return new Drag(this, particle, options);
  }
}

/** A primitive collider of a World. */
export class WorldCollider {
  constructor(world, id) {
    this.world = world;
    this.id = id;
  }
  get name() {
    return this.world.nameOf(this.id);
  }
  pose() {
    const { memory, handle } = this.world;
    return this.world.withId(this.id, (id, arena) => {
      const at = arena.bytes(28);
      memory.call("pliant_collider_pose", handle, id, at);
      return memory.f32().slice(at / 4, at / 4 + 7);
    });
  }
  setPose(pose) {
    const { memory, handle } = this.world;
    this.world.withId(this.id, (id, arena) => memory.call("pliant_collider_set_pose", handle, id, arena.floats(pose)));
  }
}

/** All that changes with time in a World. */
export class State {
  constructor(memory, handle) {
    this.memory = memory;
    this.handle = handle;
  }
  hash() {
    return this.memory.askText((...into) => this.memory.module._pliant_state_hash(this.handle, ...into));
  }
  free() {
    if (this.handle) this.memory.call("pliant_state_free", this.handle);
    this.handle = 0;
  }
}

