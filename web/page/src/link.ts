// A link that holds the scene: its gallery name, or its text, deflated, after the #.

async function through(bytes: Uint8Array<ArrayBuffer>, stream: ReadableWritablePair<Uint8Array, BufferSource>): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function pack(text: string): Promise<string> {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  let binary = "";
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

export async function unpack(packed: string): Promise<string> {
  const binary = atob(packed.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(binary, (letter) => letter.charCodeAt(0));
  return new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")));
}

export interface Linked {
  name?: string;
  text?: string;
}

/** What the address says: #scene=NAME, and #text=... if the text was changed. */
export async function readLink(hash: string): Promise<Linked> {
  const members = new URLSearchParams(hash.replace(/^#/, ""));
  const packed = members.get("text");
  return { name: members.get("scene") ?? undefined, text: packed ? await unpack(packed) : undefined };
}

export async function makeLink(name: string, text?: string): Promise<string> {
  return `#scene=${encodeURIComponent(name)}${text === undefined ? "" : `&text=${await pack(text)}`}`;
}
