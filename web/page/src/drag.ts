// Dragging what is drawn: by the pointer, or by the keyboard, which chooses a point first.
import type { Frame, Parts } from "pliant";
import type { WorkerWorld } from "pliant/client";
import * as THREE from "three";
import type { Grip } from "./matter";
import type { View } from "./view";

/** What the keyboard can take hold of. */
interface Choice {
  words: string;
  grip: Grip;
  where: (frame: Frame) => ArrayLike<number> | undefined;
}

/** False where something is gone that was chosen: a particle of a liquid, or a point of what was torn. */
function isPlace(at: ArrayLike<number> | undefined): at is ArrayLike<number> {
  return at !== undefined && at.length >= 3;
}

const manyBodies = 60; // of an object; the keyboard chooses one after another

/** Vertices by which an object can be taken, and what to call them: its middle and where it reaches farthest. */
function handlesOf(positions: Float32Array): Map<number, string> {
  const count = positions.length / 3;
  const best = (measure: (i: number) => number) => {
    let [found, least] = [0, Infinity];
    for (let i = 0; i < count; ++i) {
      const value = measure(i);
      if (value < least) [found, least] = [i, value];
    }
    return found;
  };
  const mean = [0, 0, 0];
  for (let i = 0; i < positions.length; ++i) mean[i % 3] += positions[i] / count;
  const away = (i: number) => Math.hypot(...mean.map((m, k) => positions[3 * i + k] - m));
  const handles = new Map<number, string>();
  const add = (words: string, measure: (i: number) => number) => {
    const found = best(measure);
    if (!handles.has(found)) handles.set(found, words);
  };
  add("the middle", away);
  add("the lowest point", (i) => positions[3 * i + 1]);
  add("the highest point", (i) => -positions[3 * i + 1]);
  add("the left end", (i) => positions[3 * i]);
  add("the right end", (i) => -positions[3 * i]);
  return handles;
}

function choicesOf(parts: Parts, frame: Frame): Choice[] {
  const choices: Choice[] = [];
  parts.objects.forEach((part, o) => {
    const free = part.bodies.map((body, index) => ({ ...body, index })).filter((body) => !body.fixed);
    for (const body of free.slice(0, manyBodies))
      choices.push({
        words: `the body ${body.name || body.index + 1} of ${part.name}`,
        grip: { id: part.id, particle: body.particle },
        where: ({ objects }) => objects[o].poses?.subarray(7 * body.index, 7 * body.index + 3),
      });
    const positions = frame.objects[o].positions;
    if (!positions || positions.length === 0 || part.kind === "smoke") return;
    for (const [vertex, words] of handlesOf(positions))
      choices.push({
        words: `${words} of ${part.name}`,
        grip: { id: part.id },
        where: ({ objects }) => objects[o].positions?.subarray(3 * vertex, 3 * vertex + 3),
      });
  });
  parts.colliders.forEach(({ name, id, shape, is_keyframed }, c) => {
    if (shape.kind === "plane" || is_keyframed) return;
    const where = ({ colliders }: Frame) => colliders[c].subarray(0, 3);
    choices.push({ words: `the collider ${name}`, grip: { id, isCollider: true }, where });
  });
  return choices;
}

interface Hold {
  /** The pointer that holds it; none: the keyboard. */
  pointer?: number;
  /** Where it was taken. */
  from: THREE.Vector3;
  /** Where what is held was then: a particle's position, or a collider's pose. Empty until the worker has answered. */
  held: number[];
  /** Where it is to be. */
  to: THREE.Vector3;
}

export interface Surroundings {
  parts: () => Parts | undefined;
  frame: () => Frame | undefined;
  /** Something is dragged: time must go on. */
  onstart: () => void;
  say: (words: string) => void;
}

export class Dragging {
  private hold?: Hold;
  private chosen?: Choice;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly view: View,
    private readonly world: WorkerWorld,
    private readonly around: Surroundings,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const)
      canvas.addEventListener(end, (event) => {
        if (this.hold?.pointer === event.pointerId) this.letGo();
      });
  }

  private async take(grip: Grip, point: THREE.Vector3, pointer?: number): Promise<void> {
    const hold: Hold = { pointer, from: point, held: [], to: point };
    this.hold = hold;
    const radius = grip.particle === undefined ? 0.22 * this.view.extent : 0;
    const what = { particle: grip.particle, point: point.toArray(), radius };
    let held: number[] = [];
    try {
      held = await (grip.isCollider ? this.world.grabCollider(grip.id) : this.world.grab(grip.id, what));
    } catch (error) {
      if (this.hold === hold) this.letGo();
      return this.around.say(`It cannot be dragged: ${(error as Error).message}`);
    }
    if (this.hold !== hold) return void (this.hold ?? this.world.release());
    hold.held = held;
    this.pull(hold); // it may have been moved while the worker answered
    this.around.onstart();
  }

  private pull({ from, to, held }: Hold): void {
    if (held.length === 0) return;
    const moved = to.clone().sub(from).toArray();
    void this.world.moveTo(held.map((x, k) => x + (moved[k] ?? 0)));
  }

  letGo(): void {
    if (!this.hold) return;
    this.hold = undefined;
    this.view.controls.enabled = true;
    void this.world.release();
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || this.hold?.pointer !== undefined || event.shiftKey) return;
    const pick = this.view.pick(event.clientX, event.clientY);
    if (!pick) return;
    this.choose(undefined);
    this.view.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
    void this.take(pick.grip, pick.point, event.pointerId);
  }

  private move(event: PointerEvent): void {
    const { hold } = this;
    if (!hold || event.pointerId !== hold.pointer) {
      if (event.buttons !== 0) return;
      this.canvas.style.cursor = this.view.pick(event.clientX, event.clientY) ? "pointer" : "grab";
      return;
    }
    hold.to = this.view.pointAt(event.clientX, event.clientY, hold.from) ?? hold.to;
    this.pull(hold);
  }

  private choose(choice: Choice | undefined): void {
    this.letGo();
    this.chosen = choice;
    this.show();
    this.around.say(choice ? `Chosen: ${choice.words}. Shift and arrows drag it, Escape lets go.` : "");
  }

  /** Chooses the next thing that can be dragged, or the one before. */
  chooseNext(step: 1 | -1): void {
    const [parts, frame] = [this.around.parts(), this.around.frame()];
    if (!parts || !frame) return;
    const choices = choicesOf(parts, frame);
    if (choices.length === 0) return this.around.say("Nothing in this scene can be dragged.");
    const now = choices.findIndex(({ words }) => words === this.chosen?.words);
    const next = now < 0 ? (step > 0 ? 0 : choices.length - 1) : (now + step + choices.length) % choices.length;
    this.choose(choices[next]);
  }

  /** Moves what is chosen to the right, up and towards the viewer, in parts of the scene's size. */
  push(right: number, up: number, near: number): void {
    if (!this.chosen) this.chooseNext(1);
    const frame = this.around.frame();
    const at = frame && this.chosen?.where(frame);
    if (!isPlace(at) || !this.chosen) return;
    const way = this.view.alongView(right, up, near).multiplyScalar(this.view.extent);
    if (!this.hold) void this.take(this.chosen.grip, new THREE.Vector3().fromArray(at));
    const hold = this.hold!;
    hold.to = hold.to.clone().add(way);
    this.pull(hold);
  }

  /** Lets go, and chooses nothing. */
  cancel(): void {
    this.choose(undefined);
  }

  /** Marks what is chosen, where it is now. */
  show(): void {
    const frame = this.around.frame();
    const at = frame && this.chosen?.where(frame);
    this.view.mark(isPlace(at) ? at : undefined);
  }
}
