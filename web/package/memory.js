// Memory of the module: texts, lists and structures of the C library (bindings/c), and its errors as exceptions.

/** What the engine refused, or what went wrong. */
export class PliantError extends Error {
  constructor(message, parts = {}) {
    super(message);
    this.name = "PliantError";
    this.status = parts.status ?? "PLIANT_REFUSED";
    this.file = parts.file ?? "";
    this.line = parts.line ?? 0;
    this.column = parts.column ?? 0;
    this.object = parts.object ?? "";
    this.element = parts.element ?? "";
    this.problem = parts.problem ?? message;
    this.advice = parts.advice ?? "";
  }
}

/** Memory of a call: freed at its end, whatever happens. Addresses are numbers; views die when the heap grows. */
class Arena {
  constructor(memory) {
    this.memory = memory;
    this.kept = [];
  }
  bytes(size) {
    const at = this.memory.malloc(size);
    this.kept.push(at);
    this.memory.u8().fill(0, at, at + size);
    return at;
  }
  text(value) {
    if (value === null || value === undefined) return 0;
    const bytes = new TextEncoder().encode(value);
    const at = this.bytes(bytes.length + 1);
    this.memory.u8().set(bytes, at);
    return at;
  }
  floats(values) {
    const at = this.bytes(4 * Math.max(values.length, 1));
    this.memory.f32().set(values, at / 4);
    return at;
  }
  integers(values) {
    const at = this.bytes(4 * Math.max(values.length, 1));
    this.memory.i32().set(values, at / 4);
    return at;
  }
  /** A structure of 32-bit members, in order; 64-bit ones are not in those that go in. */
  words(...values) {
    return this.integers(values);
  }
  free() {
    for (const at of this.kept) this.memory.module._free(at);
  }
}

export class Memory {
  constructor(module) {
    this.module = module;
    this.scratch = 0;
    this.room = 0;
  }
  u8() {
    return this.module.HEAPU8;
  }
  i32() {
    return this.module.HEAP32;
  }
  u32() {
    return this.module.HEAPU32;
  }
  f32() {
    return this.module.HEAPF32;
  }
  f64() {
    return this.module.HEAPF64;
  }
  i64(at) {
    return Number(new DataView(this.module.HEAPU8.buffer).getBigInt64(at, true));
  }
  malloc(size) {
    const at = this.module._malloc(Math.max(size, 8));
    if (at === 0) throw new PliantError(`there is no memory for ${size} bytes`, { status: "PLIANT_NO_MEMORY" });
    return at;
  }
  text(at) {
    return at === 0 ? "" : this.module.UTF8ToString(at);
  }

  /** Calls `body` with memory that is freed after it. */
  using(body) {
    const arena = new Arena(this);
    try {
      return body(arena);
    } finally {
      arena.free();
    }
  }

  /** Throws the last error as an exception. */
  fail(status) {
    this.using((arena) => {
      const at = arena.bytes(36);
      this.u32()[at / 4] = 36;
      const name = this.text(this.module._pliant_status_name(status));
      const message = this.text(this.module._pliant_last_error());
      if (this.module._pliant_last_error_parts(at) !== 0) throw new PliantError(message, { status: name });
      const words = this.u32().subarray(at / 4, at / 4 + 9);
      throw new PliantError(message, {
        status: name,
        line: words[2],
        column: words[3],
        file: this.text(words[4]),
        object: this.text(words[5]),
        element: this.text(words[6]),
        problem: this.text(words[7]),
        advice: this.text(words[8]),
      });
    });
  }

  /** Calls a function of the C library; a status that is not 0 becomes an exception. */
  call(name, ...args) {
    const status = this.module[`_${name}`](...args);
    if (status !== 0) this.fail(status);
  }

  /** Memory that the next call of this function gives to something else; it grows, and is kept. */
  borrow(size) {
    if (size > this.room) {
      if (this.scratch !== 0) this.module._free(this.scratch);
      this.scratch = this.room = 0;
      this.scratch = this.malloc(size);
      this.room = size;
    }
    return this.scratch;
  }

  /** Asks for a text: `ask(into, capacity, length)` returns a status. */
  askText(ask) {
    const length = this.askList(ask, 1, 4096, 1);
    return new TextDecoder().decode(this.u8().subarray(length.at, length.at + length.count));
  }

  /** Asks for a list of unknown length, of `size` bytes an element. Returns where it is (in borrowed memory) and its length. */
  askList(ask, size, guess = 1024, more = 0) {
    return this.using((arena) => {
      const told = arena.bytes(4);
      let capacity = guess;
      for (;;) {
        const at = this.borrow(capacity * size);
        const status = ask(at, capacity, told);
        const count = this.u32()[told / 4];
        if (status === 0) return { at, count };
        if (status !== 4 || count + more <= capacity) this.fail(status);
        capacity = count + more;
      }
    });
  }
}
