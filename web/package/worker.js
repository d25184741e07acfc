// A worker that holds a World: it steps, and posts what there is to draw. client.js is its other end.
import { History } from "./history.js";
import { createPliant, PliantError } from "./index.js";
import { buffersOf, readFrame, readParts } from "./picture.js";

const ready = createPliant();
let world, parts, history, timer, drag;
let contactsWanted = false;
let liquidSurfaces = false;
let playing = false;
let drawn = true; // the client has drawn the last frame
let isStep = false; // the present is what the last step made, so the report is of it
let due = 0;

function post(milliseconds) {
  const frame = readFrame(world, parts, { liquidSurfaces });
  frame.milliseconds = milliseconds;
  frame.report = world.report();
  frame.isStep = isStep;
  frame.advice = world.advice();
  frame.kept = history.frames;
  if (contactsWanted) frame.contacts = world.contacts();
  drawn = false;
  postMessage({ frame }, buffersOf(frame));
}

function step() {
  const start = performance.now();
  if (drag?.pose) world.collider(drag.id).setPose(drag.pose);
  world.step();
  isStep = true;
  history.keep(world);
  post(performance.now() - start);
}

/** Steps as fast as time goes by, and no faster than the client draws. */
function tick() {
  timer = undefined;
  if (!playing || !world) return;
  if (!drawn) return; // `drawn` goes on
  try {
    step();
  } catch (error) {
    playing = false;
    return postMessage({ failed: plain(error) });
  }
  due = Math.max(due + 1000 * world.info.frameTime, performance.now() - 100);
  later();
}

function later() {
  if (playing && timer === undefined) timer = setTimeout(tick, Math.max(0, due - performance.now()));
}

function plain(error) {
  const { name, message, stack } = error;
  return error instanceof PliantError ? { ...error, name, message } : { name, message: `${message}`, stack };
}

const calls = {
  async load(pliant, { description, options, keepState }) {
    const scene = pliant.scene(description, options);
    let made;
    try {
      const findings = scene.check();
      made = scene.world();
      if (keepState && world) carry(world, made);
      history?.free();
      world?.free();
      world = made;
      drag = undefined;
      isStep = false;
      world.recordContacts(contactsWanted);
      parts = readParts(world);
      history = new History(world, parts);
      due = performance.now();
      return { parts, findings, info: world.info, version: pliant.version, summary: world.describe() };
    } finally {
      scene.free();
    }
  },
  async check(pliant, { description, options }) {
    return pliant.check(description, options);
  },
  async schema(pliant) {
    return pliant.schema();
  },
  async show() {
    post(0);
  },
  async step() {
    step();
  },
  async seek(pliant, frame) {
    drag?.release?.();
    drag = undefined;
    world = history.restore(world, frame, pliant);
    isStep = false;
    world.recordContacts(contactsWanted);
    post(0);
    return world.info.frame;
  },
  async play(_, on) {
    playing = on;
    due = performance.now();
    later();
  },
  async drawn() {
    drawn = true;
    later();
  },
  async contacts(_, on) {
    contactsWanted = on;
    world?.recordContacts(on);
  },
  async showLiquidSurfaces(_, on) {
    liquidSurfaces = on;
  },
  async grab(_, { id, particle, point, radius }) {
    drag?.release?.();
    drag = undefined; // if what follows fails
    const object = world.object(id);
    drag = object.drag(particle ?? object.nearest(point), { radius });
    return drag.target;
  },
  async grabCollider(_, { id }) {
    drag?.release?.();
    drag = { id, pose: undefined };
    return Array.from(world.collider(id).pose());
  },
  async moveTo(_, target) {
    if (!drag) return;
    if (drag.moveTo) drag.moveTo(target);
    else drag.pose = target;
  },
  async release() {
    drag?.release?.();
    drag = undefined;
  },
  async hash() {
    return world.hash();
  },
  async save() {
    return world.bytes();
  },
  async record(_, { frames, suffix }) {
    isStep = frames > 0;
    return world.record(frames, suffix);
  },
};

/** Gives a new World the state of the old one, if it fits. */
function carry(from, to) {
  const state = from.copyState();
  try {
    to.restore(state);
  } catch (error) {
    if (!(error instanceof PliantError)) throw error;
  } finally {
    state.free();
  }
}

onmessage = async ({ data: { call, number, value } }) => {
  try {
    const result = await calls[call](await ready, value);
    if (number !== undefined) postMessage({ number, result });
  } catch (error) {
    postMessage({ number, error: plain(error) });
  }
};
