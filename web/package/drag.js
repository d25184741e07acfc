// Drags: particles that follow a target, as a mouse wants it.

const most = 12; // the greatest speed that a drag gives [m/s]
const frequency = 150; // of the springs that pull, critically damped [1/s]
const gain = 0.05; // share of the distance to the target that is added up in each step
const mostLag = 0.5; // [m]

/** Pulls a particle and what is near it towards a target by critically damped springs, so that constraints and contacts
 * still have the last word. A pinned particle gets targets instead, which it reaches exactly. */
export class Drag {
  constructor(object, particle, { radius = 0 } = {}) {
    this.object = object;
    this.particle = particle;
    const positions = object.positionsView().slice();
    if (!(particle >= 0 && 3 * particle < positions.length))
      throw new RangeError(`particle ${particle} is none of ${positions.length / 3}`);
    this.target = Array.from(positions.subarray(3 * particle, 3 * particle + 3));
    this.lag = [0, 0, 0];
    this.isPinned = object.inverseMasses()[particle] === 0;
    this.near = this.isPinned ? [] : this.around(positions, radius);
    object.world.drags.add(this);
  }

  /** The particles near by, and how much each follows. */
  around(positions, radius) {
    const near = [{ i: this.particle, share: 1 }];
    for (let i = 0; radius > 0 && 3 * i < positions.length; ++i) {
      if (i === this.particle) continue;
      const away = Math.hypot(...[0, 1, 2].map((k) => positions[3 * i + k] - this.target[k]));
      if (away < radius) near.push({ i, share: (1 - (away / radius) ** 2) ** 2 });
    }
    return near;
  }

  moveTo(target) {
    this.target = Array.from(target);
  }

  apply(dt) {
    if (this.isPinned) return this.object.setTargets([this.particle], this.target);
    const positions = this.object.positionsView().slice();
    const at = positions.subarray(3 * this.particle, 3 * this.particle + 3);
    // What the rest of the object keeps from the target is added up, so that a load is lifted all the way.
    this.lag = this.lag.map((lag, k) => Math.min(Math.max(lag + gain * (this.target[k] - at[k]), -mostLag), mostLag));
    const way = this.target.map((t, k) => t - at[k] + this.lag[k]);
    const cut = Math.min((most * dt) / Math.hypot(...way), 1);
    // All are pulled the same way, so what is near keeps its shape.
    const places = this.near.flatMap(({ i }) => way.map((w, k) => positions[3 * i + k] + cut * w));
    this.object.setPulls(
      this.near.map(({ i }) => i),
      places,
      this.near.map(({ share }) => share * frequency),
    );
  }

  release() {
    this.object.world.drags.delete(this);
  }
}
