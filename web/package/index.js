// Pliant in JavaScript: the engine as a module of WebAssembly, in browsers, workers and node.
import createModule from "./module/pliant-module.js";
import { Memory } from "./memory.js";
import { Scene } from "./scene.js";
import { World } from "./world.js";

export { PliantError } from "./memory.js";
export { Scene } from "./scene.js";
export { State, World, WorldCollider, WorldObject } from "./world.js";
export { Drag } from "./drag.js";
export { buffersOf, readFrame, readParts } from "./picture.js";

const isNode = typeof process === "object" && typeof process.versions?.node === "string" && typeof window === "undefined";

async function compile(wasm) {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return WebAssembly.compile(wasm);
  const url = wasm ?? new URL("./module/pliant-module.wasm", import.meta.url);
  if (isNode) {
    const { readFile } = await import(/* @vite-ignore */ "node:fs/promises");
    return WebAssembly.compile(await readFile(url));
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`cannot fetch ${url}: ${answer.status} ${answer.statusText}`);
  try {
    return await WebAssembly.compileStreaming(answer.clone());
  } catch {
    return WebAssembly.compile(await answer.arrayBuffer()); // a server without the type application/wasm
  }
}

class Pliant {
  constructor(module) {
    this.module = module;
    this.memory = new Memory(module);
  }
  get version() {
    return this.memory.text(this.module._pliant_version());
  }
  schema() {
    return JSON.parse(this.memory.askText(this.module._pliant_schema));
  }
  materials() {
    return JSON.parse(this.memory.askText(this.module._pliant_materials));
  }
  scene(description, options) {
    return new Scene(this.memory, description, options);
  }
  world(description, options) {
    const scene = this.scene(description, options);
    try {
      return scene.world();
    } finally {
      scene.free();
    }
  }
  worldFromBytes(bytes) {
    return World.fromBytes(this.memory, bytes);
  }
  check(description, options) {
    const scene = this.scene(description, options);
    try {
      return scene.check();
    } finally {
      scene.free();
    }
  }
}

export async function createPliant({ wasm, print = console.log, printErr = console.error } = {}) {
  const compiled = await compile(wasm);
  const module = await new Promise((resolve, reject) => {
    createModule({
      print,
      printErr,
      instantiateWasm(imports, done) {
        WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled), reject);
        return {};
      },
    }).then(resolve, reject);
  });
  return new Pliant(module);
}
