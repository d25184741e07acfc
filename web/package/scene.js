// Scenes: text of the scene format, with meshes as arrays or files.
import { World } from "./world.js";

let folders = 0;

/** Puts files into a folder of the module's memory, which the scene's paths are relative to. */
function writeFiles(module, files) {
  const folder = `/pliant_scene_${folders++}`;
  module.FS.mkdir(folder);
  for (const [name, bytes] of Object.entries(files)) {
    const parts = name.split("/").slice(0, -1);
    let path = folder;
    for (const part of parts) {
      path += `/${part}`;
      if (!module.FS.analyzePath(path).exists) module.FS.mkdir(path);
    }
    module.FS.writeFile(`${folder}/${name}`, typeof bytes === "string" ? bytes : new Uint8Array(bytes));
  }
  return folder;
}

function removeFiles(module, folder) {
  for (const name of module.FS.readdir(folder)) {
    if (name === "." || name === "..") continue;
    const path = `${folder}/${name}`;
    if (module.FS.isDir(module.FS.stat(path).mode)) removeFiles(module, path);
    else module.FS.unlink(path);
  }
  module.FS.rmdir(folder);
}

/** A list of pliant_array: 28 bytes each. */
export function writeArrays(arena, arrays) {
  const words = [];
  for (const [name, { positions, triangles, tetrahedra }] of Object.entries(arrays ?? {})) {
    const elements = triangles ?? tetrahedra ?? [];
    const corners = triangles ? 3 : tetrahedra ? 4 : 0;
    if (positions.length % 3 !== 0) throw new RangeError(`array '${name}' has ${positions.length} floats: three a point`);
    if (corners > 0 && elements.length % corners !== 0)
      throw new RangeError(`array '${name}' has ${elements.length} indices: ${corners} an element`);
    words.push(28, arena.text(name), corners, arena.floats(positions), positions.length / 3);
    words.push(arena.integers(elements), corners > 0 ? elements.length / corners : 0);
  }
  return { at: words.length > 0 ? arena.integers(words) : 0, count: words.length / 7 };
}

export function writeOptions(arena, { arrays, values, name, folder }) {
  const list = writeArrays(arena, arrays);
  const pairs = Object.entries(values ?? {}).flatMap(([pointer, value]) => [
    arena.text(pointer),
    arena.text(JSON.stringify(value)),
  ]);
  const set = pairs.length > 0 ? arena.integers(pairs) : 0;
  return arena.words(32, arena.text(name), arena.text(folder), 0, list.at, list.count, set, pairs.length / 2);
}

export class Scene {
  constructor(memory, description, options = {}) {
    this.memory = memory;
    this.folder = options.files ? writeFiles(memory.module, options.files) : "";
    const text = typeof description === "string" ? description : JSON.stringify(description);
    try {
      this.handle = memory.using((arena) => {
        const into = arena.bytes(4);
        const given = writeOptions(arena, { ...options, folder: this.folder || undefined });
        memory.call("pliant_scene_parse", arena.text(text), given, into);
        return memory.u32()[into / 4];
      });
    } catch (error) {
      this.removeFolder();
      throw error;
    }
  }

  get info() {
    const memory = this.memory;
    return memory.using((arena) => {
      const at = arena.bytes(56);
      memory.u32()[at / 4] = 56;
      memory.call("pliant_scene_get_info", this.handle, at);
      return {
        frameTime: memory.f64()[(at + 8) / 8],
        frames: memory.i64(at + 16),
        objects: memory.i64(at + 24),
        colliders: memory.i64(at + 32),
        meshColliders: memory.i64(at + 40),
        particles: memory.i64(at + 48),
      };
    });
  }

  check() {
    const memory = this.memory;
    return memory.using((arena) => {
      const counts = arena.bytes(8);
      memory.call("pliant_scene_check", this.handle, counts, counts + 4);
      const findings = [];
      for (let i = 0; i < memory.u32()[counts / 4]; ++i) {
        const at = arena.words(16, 0, 0, 0);
        memory.call("pliant_scene_get_finding", this.handle, i, at);
        const words = memory.u32().subarray(at / 4, at / 4 + 4);
        findings.push({ isGrave: words[1] === 1, message: memory.text(words[2]), advice: memory.text(words[3]) });
      }
      return findings;
    });
  }

  set(pointer, value) {
    this.memory.using((arena) => {
      this.memory.call("pliant_scene_set", this.handle, arena.text(pointer), arena.text(JSON.stringify(value)));
    });
  }

  describe() {
    return this.memory.askText((...into) => this.memory.module._pliant_scene_describe(this.handle, ...into));
  }

  world() {
    return World.of(this.memory, this.handle);
  }

  removeFolder() {
    if (this.folder) removeFiles(this.memory.module, this.folder);
    this.folder = "";
  }

  free() {
    if (this.handle) this.memory.call("pliant_scene_free", this.handle);
    this.handle = 0;
    this.removeFolder();
  }
}
