import type { Contact, Finding, Frame, Id, Parts, SceneOptions, WorldInfo } from "./index.js";

export interface WorkerFrame extends Frame {
  /** Of the step and of reading it, in the worker. */
  milliseconds: number;
  report: Record<string, any>;
  /** True if the last step made this state: after `seek` and `load` the report is of another one, or of none. */
  isStep: boolean;
  advice: string;
  contacts?: Contact[];
  /** The frames that `seek` returns to, ascending. */
  kept: number[];
}

export interface Loaded {
  parts: Parts;
  findings: Finding[];
  info: WorldInfo;
  version: string;
  summary: string;
}

/** A World in a web worker: it steps there, and gives each frame to `onframe`. Calls reject with a PliantError. */
export class WorkerWorld {
  constructor(makeWorker?: () => Worker);
  onframe: (frame: WorkerFrame) => void;
  /** An error while it plays. */
  onfail: (error: Error) => void;
  /** Reads a scene and replaces the World; `keepState`: with the state of the present one, if it fits. */
  load(description: string | object, options?: SceneOptions, more?: { keepState?: boolean }): Promise<Loaded>;
  check(description: string | object, options?: SceneOptions): Promise<Finding[]>;
  schema(): Promise<Record<string, any>>;
  /** Gives the present state to `onframe`. */
  show(): Promise<void>;
  step(): Promise<void>;
  /** Goes back to the last kept frame up to this one, and shows it; further steps replace what came after. */
  seek(frame: number): Promise<number>;
  /** Steps in real time, or slower if a step takes longer. */
  play(on?: boolean): Promise<void>;
  recordContacts(on?: boolean): Promise<void>;
  /** Frames have the surfaces of liquids, too. */
  showLiquidSurfaces(on?: boolean): Promise<void>;
  /** Lets a particle, or the one nearest to a point, and those within `radius` [m] follow `moveTo`; returns where it is. */
  grab(id: Id, what: { particle?: number; point?: number[]; radius?: number }): Promise<number[]>;
  /** Lets a primitive collider follow the poses of `moveTo`; returns its pose. */
  grabCollider(id: Id): Promise<number[]>;
  moveTo(target: ArrayLike<number>): Promise<void>;
  release(): Promise<void>;
  hash(): Promise<string>;
  save(): Promise<Uint8Array>;
  record(frames: number, suffix?: string): Promise<Uint8Array>;
  end(): void;
}
