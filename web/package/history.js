// What a World was like at earlier frames, so that it can go back to them.

const most = 240; // frames that are kept
const budget = 96e6; // [bytes]
const [bytesOfParticle, bytesOfContact] = [100, 350]; // of a State, about

/** Contacts that a State may hold. */
function contactsOf({ contacts = 0, pairs }) {
  return contacts + (pairs?.contacts ?? 0);
}

function isOutOfMemory({ name, status }) {
  return status === "PLIANT_NO_MEMORY" || name === "RangeError"; // the latter of arrays of JavaScript
}

/** Frames of a World from its start: each one, then every second, fourth, ... as they become too many. */
export class History {
  constructor(world, parts) {
    this.kept = [];
    this.stride = 1;
    this.size = 0; // of what is kept [bytes], about
    // A State fits its World only as long as nothing tears; the World's own bytes always do.
    this.whole = parts.objects.some((part) => part.changes);
    this.particles = world.objects().reduce((sum, object) => sum + object.info.particles, 0);
    this.keep(world);
  }

  get frames() {
    return this.kept.map(({ frame }) => frame);
  }

  /** Keeps the present, and forgets what was after it. */
  keep(world) {
    const { frame } = world.info;
    while (this.kept.length > 0 && this.kept.at(-1).frame >= frame) {
      this.forget(this.kept.pop());
      if (this.kept.length === 1) this.stride = 1; // all anew from the first frame
    }
    if (frame % this.stride !== 0) return;
    try {
      this.kept.push(this.copy(world, frame));
    } catch (error) {
      if (!isOutOfMemory(error)) throw error;
      return this.thin();
    }
    this.size += this.kept.at(-1).size;
    while (this.kept.length > most || (this.size > budget && this.kept.length > 2)) this.thin();
  }

  copy(world, frame) {
    const held = this.whole ? world.bytes() : world.copyState();
    const size = this.whole
      ? held.length
      : bytesOfParticle * this.particles + bytesOfContact * contactsOf(world.report());
    return { frame, held, size };
  }

  thin() {
    this.stride *= 2;
    const stays = (one) => one === this.kept[0] || one.frame % this.stride === 0;
    for (const one of this.kept.filter((one) => !stays(one))) this.forget(one);
    this.kept = this.kept.filter(stays);
  }

  /** The World at the last kept frame up to `frame`: the same one, or a new one, which replaces it. */
  restore(world, frame, pliant) {
    const found = this.kept.filter((one) => one.frame <= frame).at(-1) ?? this.kept[0];
    if (!found) return world;
    if (!this.whole) world.restore(found.held);
    const now = this.whole ? pliant.worldFromBytes(found.held) : world;
    if (now !== world) world.free();
    return now;
  }

  forget({ held, size }) {
    this.size -= size;
    if (!this.whole) held.free();
  }
  free() {
    this.kept.forEach((one) => this.forget(one));
    this.kept = [];
  }
}
