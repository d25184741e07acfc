// Drags: particles that follow a target, as a mouse wants it.

const most = 12; // the greatest speed that a drag gives [m/s]
const gain = 0.15; // share of the distance to the target that is added up in each step
const mostLag = 0.5; // [m]

/** Pulls a particle and what is near it towards a target: velocities at the start of each step, so that constraints and
 * contacts still have the last word. A pinned particle gets targets instead, which it reaches exactly. */
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
    const at = this.object.positionsView().slice(3 * this.particle, 3 * this.particle + 3);
    // What gravity and the rest of the object keep from the target is added up, so that a load is lifted all the way.
    this.lag = this.lag.map((lag, k) => Math.min(Math.max(lag + gain * (this.target[k] - at[k]), -mostLag), mostLag));
    const way = this.target.map((t, k) => (t - at[k] + this.lag[k]) / dt);
    const speed = Math.hypot(...way);
    const cut = speed > most ? most / speed : 1;
    const velocities = this.object.velocities();
    for (const { i, share } of this.near)
      for (let k = 0; k < 3; ++k) velocities[3 * i + k] += share * (cut * way[k] - velocities[3 * i + k]);
    this.object.setVelocities(velocities);
  }

  release() {
    this.object.world.drags.delete(this);
  }
}
