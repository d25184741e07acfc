/** Pliant: position based dynamics by WebAssembly. Units are SI; quaternions are x, y, z, w. */

/** An object or collider: kind (0 object, 1 collider, 2 mesh collider), slot, generation. */
export type Id = [kind: number, slot: number, generation: number];
export type Vector = [number, number, number];

/** What the engine refused, or what went wrong: where, and what to do. */
export class PliantError extends Error {
  /** The name of the C library's status, as "PLIANT_REFUSED" or "PLIANT_STALE". */
  status: string;
  file: string;
  /** From 1; 0: none. */
  line: number;
  column: number;
  object: string;
  /** "vertex 12", "/objects/0/mesh" (a JSON pointer). */
  element: string;
  problem: string;
  advice: string;
}

/** A mesh or points in memory, to which a scene refers by {"array": "NAME"}: x, y, z of each point [m]. */
export interface MeshArray {
  positions: ArrayLike<number>;
  triangles?: ArrayLike<number>;
  tetrahedra?: ArrayLike<number>;
}

export interface SceneOptions {
  /** Meshes by name. */
  arrays?: Record<string, MeshArray>;
  /** Files by their path in the scene, as "ring.obj": text or bytes. */
  files?: Record<string, string | ArrayBuffer | Uint8Array>;
  /** Members to set by JSON pointer before the scene is checked: {"/settings/substeps": 20}. */
  values?: Record<string, unknown>;
  /** Stands for the file in errors. */
  name?: string;
}

export interface Finding {
  /** True: no World can be made. */
  isGrave: boolean;
  message: string;
  advice: string;
}

export interface SceneInfo {
  /** [s] */
  frameTime: number;
  frames: number;
  objects: number;
  colliders: number;
  meshColliders: number;
  particles: number;
}

export class Scene {
  readonly info: SceneInfo;
  /** Inspects the scene. */
  check(): Finding[];
  /** Sets a member by JSON pointer. */
  set(pointer: string, value: unknown): void;
  /** A summary for people. */
  describe(): string;
  /** Makes a World; the scene stays as it is. */
  world(): World;
  free(): void;
}

export interface WorldInfo {
  /** Simulated time [s]. */
  time: number;
  /** Number of complete steps. */
  frame: number;
  /** [s] */
  frameTime: number;
  /** The length of a run, as the scene wants it. */
  frames: number;
}

/** The contacts of two things in the last step. */
export interface Contact {
  change: "began" | "persists" | "ended";
  first: Id;
  second: Id;
  contacts: number;
  /** [N s] over the frame. */
  impulse: number;
  position: Vector;
  normal: Vector;
  pushOnFirst: Vector;
}

export interface Mesh {
  positions: Float32Array;
  /** Unit vectors, one for each position. */
  normals: Float32Array;
  triangles: Uint32Array;
}

export class World {
  readonly info: WorldInfo;
  /** Advances by `dt` seconds; without it by the scene's frame time. Throws a PliantError if a value is not finite. */
  step(dt?: number): void;
  run(frames: number): void;
  /** The SHA-256 hash of the state: the same as that of the native program. */
  hash(): string;
  describe(): string;
  /** The report of the last step (docs/reference/report.md). */
  report(): Record<string, any>;
  /** Problems and warnings of the last step; empty if there are none. */
  explain(): string;
  /** Where the solve fell short, and what to do. */
  advice(): string;
  /** "kinetic_energy", "stretch.mean", ... */
  measure(name: string): number;
  objects(): WorldObject[];
  object(nameOrId: string | Id): WorldObject;
  collider(nameOrId: string | Id): WorldCollider;
  addObject(description: object, arrays?: Record<string, MeshArray>): WorldObject;
  addCollider(description: object, arrays?: Record<string, MeshArray>): Id;
  remove(thing: WorldObject | WorldCollider | Id): void;
  /** Contacts are recorded from the next step on. */
  recordContacts(on?: boolean): void;
  contacts(): Contact[];
  /** The World as bytes, for `Pliant.worldFromBytes`. */
  bytes(): Uint8Array;
  copyState(): State;
  restore(state: State): void;
  /** Makes steps, and returns them as an animation: ".glb", ".usda", ".pc2". */
  record(frames: number, suffix?: string): Uint8Array;
  /** The present surface of a mesh collider. */
  meshCollider(id: Id): Mesh;
  parts(): Record<string, any>;
  free(): void;
}

export interface ObjectInfo {
  particles: number;
  triangles: number;
  bodies: number;
  joints: number;
  attachments: number;
  constraints: number;
  substeps: number;
  isFlow: boolean;
}

/** An object of a World. Lists have x, y, z for each particle, in the order of its description. */
export class WorldObject {
  readonly id: Id;
  readonly name: string;
  readonly info: ObjectInfo;
  /** [m]; into `out`, or into a new array. */
  positions(out?: Float32Array): Float32Array;
  /** A view of the module's memory, without a copy: only until the next call of this package. */
  positionsView(): Float32Array;
  /** [m/s] */
  velocities(out?: Float32Array): Float32Array;
  triangles(): Uint32Array;
  /** Pairs of particles: the links of a rope, rods or hair. */
  lines(): Uint32Array;
  /** The particles that are present, ascending. */
  present(): Int32Array;
  /** [1/kg]; 0: pinned. */
  inverseMasses(): Float32Array;
  /** Of its rigid bodies: position and quaternion, seven numbers each. */
  poses(): Float32Array;
  orientations(): Float32Array;
  /** A number of each particle, as "temperature" of a gas. */
  channel(name: string): Float32Array;
  /** The surface of its particles or its finer skin, without rigid bodies. */
  surface(): Mesh;
  /** The surface of a solid of its rigid bodies, in the body's own axes. */
  solid(index: number): Mesh;
  liquidSurface(): Mesh;
  setVelocities(velocities: ArrayLike<number>): void;
  /** [N s] */
  addImpulses(impulses: ArrayLike<number>): void;
  /** [N], during the next step. */
  setForces(forces: ArrayLike<number>): void;
  /** Moves pinned particles to positions that they reach at the end of the next step. */
  setTargets(particles: ArrayLike<number>, positions: ArrayLike<number>): void;
  setPulls(particles: ArrayLike<number>, places: ArrayLike<number>, frequencies: ArrayLike<number>): void;
  setMotor(joint: string, target: number, options?: { motor?: string; most?: number }): void;
  /** The particle nearest to a point, of those that are present. */
  nearest(point: ArrayLike<number>): number;
  /** Lets a particle, and those within `radius` [m] of it, follow a target in each step until it is released. */
  drag(particle: number, options?: { radius?: number }): Drag;
}

export class Drag {
  target: number[];
  moveTo(target: ArrayLike<number>): void;
  release(): void;
}

export class WorldCollider {
  readonly id: Id;
  readonly name: string;
  /** Position and quaternion. */
  pose(): Float32Array;
  /** Moves it to a pose that it reaches at the end of the next step. */
  setPose(pose: ArrayLike<number>): void;
}

export class State {
  hash(): string;
  free(): void;
}

export interface ObjectPart {
  name: string;
  id: Id;
  kind: "surface" | "lines" | "balls" | "liquid" | "smoke" | "none";
  /** Linear RGB, 0 to 1. */
  colour: Vector;
  /** Of a particle or line [m]. */
  radius: number;
  /** True: it tears, so that triangles and lines can differ from frame to frame. */
  changes: boolean;
  /** True: particles come and go. */
  flows: boolean;
  triangles?: Uint32Array;
  lines?: Uint32Array;
  solids: Mesh[];
  bodies: { name: string; solid: number; particle: number; fixed: boolean }[];
}

export type ColliderShape =
  | { kind: "plane" }
  | { kind: "sphere"; radius: number }
  | { kind: "box"; half_extents: Vector }
  | { kind: "capsule"; radius: number; half_length: number };

export interface Parts {
  objects: ObjectPart[];
  colliders: { name: string; id: Id; colour: Vector; shape: ColliderShape; is_keyframed: boolean }[];
  mesh_colliders: { name: string; id: Id; colour: Vector; mesh: Mesh }[];
}

export interface FrameObject {
  positions?: Float32Array;
  normals?: Float32Array;
  triangles?: Uint32Array;
  lines?: Uint32Array;
  poses?: Float32Array;
  /** Of a liquid, if its surface is wanted. */
  surfacePositions?: Float32Array;
  surfaceNormals?: Float32Array;
  surfaceTriangles?: Uint32Array;
}

export interface Frame extends WorldInfo {
  objects: FrameObject[];
  colliders: Float32Array[];
  meshColliders: { positions: Float32Array; normals: Float32Array }[];
}

/** What there is to draw and stays. */
export function readParts(world: World): Parts;
/** What there is to draw and moves. */
export function readFrame(world: World, parts: Parts, options?: { liquidSurfaces?: boolean }): Frame;
/** The buffers of a frame, for `postMessage`. */
export function buffersOf(frame: Frame): ArrayBuffer[];

export interface Pliant {
  readonly version: string;
  /** The scene format as a JSON Schema. */
  schema(): Record<string, any>;
  materials(): Record<string, { name: string; source: string }[]>;
  /** Reads a scene: JSON text or an object of the scene format. Throws a PliantError with line and JSON pointer. */
  scene(description: string | object, options?: SceneOptions): Scene;
  /** Reads a scene and makes a World of it. */
  world(description: string | object, options?: SceneOptions): World;
  worldFromBytes(bytes: Uint8Array): World;
  check(description: string | object, options?: SceneOptions): Finding[];
}

export interface PliantOptions {
  /** The module: its address, bytes or a compiled one. Default: that beside this package's files. */
  wasm?: string | URL | BufferSource | WebAssembly.Module;
  print?: (text: string) => void;
  printErr?: (text: string) => void;
}

/** Loads the module. */
export function createPliant(options?: PliantOptions): Promise<Pliant>;
