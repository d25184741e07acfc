// A World in a worker, so that a page stays responsive while it steps.
import { PliantError } from "./memory.js";

export class WorkerWorld {
  /** @param makeWorker for bundlers that want to see `new Worker` in the page's own code */
  constructor(makeWorker = () => new Worker(new URL("./worker.js", import.meta.url), { type: "module" })) {
    this.worker = makeWorker();
    this.waiting = new Map();
    this.next = 0;
    this.onframe = () => {};
    this.onfail = () => {};
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.onerror = (event) => this.onfail(new Error(event.message || "the worker did not start"));
  }

  receive({ frame, failed, number, result, error }) {
    if (frame) {
      this.onframe(frame);
      this.worker.postMessage({ call: "drawn" });
      return;
    }
    if (failed) return this.onfail(errorOf(failed));
    const waits = this.waiting.get(number);
    this.waiting.delete(number);
    if (!waits) return error && this.onfail(errorOf(error));
    if (error) waits.reject(errorOf(error));
    else waits.resolve(result);
  }

  call(name, value) {
    const number = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(number, { resolve, reject });
      this.worker.postMessage({ call: name, number, value });
    });
  }

  load(description, options = {}, { keepState = false } = {}) {
    return this.call("load", { description, options, keepState });
  }
  check(description, options = {}) {
    return this.call("check", { description, options });
  }
  play(on = true) {
    return this.call("play", on);
  }
  recordContacts(on = true) {
    return this.call("contacts", on);
  }
  showLiquidSurfaces(on = true) {
    return this.call("showLiquidSurfaces", on);
  }
  grab(id, { particle, point, radius = 0 }) {
    return this.call("grab", { id, particle, point, radius });
  }
  grabCollider(id) {
    return this.call("grabCollider", { id });
  }
  record(frames, suffix = ".glb") {
    return this.call("record", { frames, suffix });
  }
  end() {
    this.worker.terminate();
  }
}

for (const name of ["schema", "show", "step", "seek", "moveTo", "release", "hash", "save"])
  WorkerWorld.prototype[name] = function (value) {
    return this.call(name, value);
  };

function errorOf({ name, message, ...parts }) {
  if (name === "PliantError") return new PliantError(message, parts);
  return Object.assign(new Error(message), { name, stack: parts.stack });
}
