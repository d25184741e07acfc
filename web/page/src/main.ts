// The page: it wires the controls, the picture and the World in its worker together.
import { PliantError, type Parts } from "pliant";
import { WorkerWorld, type WorkerFrame } from "pliant/client";
import { Dragging } from "./drag";
import { gallery, readScene, withFiles, type SceneSource } from "./gallery";
import { makeLink, readLink } from "./link";
import { applied, untouched, type Knobs } from "./settings";
import { View, type SceneCamera } from "./view";

const first = "tablecloth";

function byId<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const choice = byId<HTMLSelectElement>("scene");
const playButton = byId<HTMLButtonElement>("play");
const text = byId<HTMLTextAreaElement>("text");
const canvas = byId<HTMLCanvasElement>("view");
const view = new View(canvas);
const world = new WorkerWorld();

let name = first;
let source: SceneSource = { text: "", files: {} };
let knobs: Knobs = { ...untouched };
let isPlaying = false;
let parts: Parts | undefined;
let last: WorkerFrame | undefined;
let waitsFor: { keepCamera: boolean; done: () => void } | undefined;
const dragging = new Dragging(canvas, view, world, {
  parts: () => parts,
  frame: () => last,
  onstart: () => isPlaying || setPlaying(true),
  say: (words) => say("chosen", words),
});

// ---- Words

function say(id: string, words: string): void {
  const place = byId(id);
  if (place.textContent !== words) place.textContent = words;
}

function showError(error: unknown): void {
  const place = byId("error");
  place.hidden = error === undefined;
  if (error === undefined) return void (place.textContent = "");
  const { message } = error as Error;
  place.textContent = message;
  if (error instanceof PliantError && error.line > 0 && text.value === applied(text.value, knobs)) {
    byId<HTMLDetailsElement>("editor").open = true;
    selectPlace(error.line, error.column);
  }
  place.scrollIntoView({ block: "nearest" });
}

/** Selects the rest of a line of the text, from a column on. */
function selectPlace(line: number, column: number): void {
  const lines = text.value.split("\n");
  const start = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
  const end = start + (lines[line - 1]?.length ?? 0);
  text.setSelectionRange(start + Math.max(0, column - 1), end);
  text.scrollTop = ((line - 4) * text.scrollHeight) / lines.length;
}

const percent = (share: number) => `${(100 * share).toPrecision(2)} %`;

/** What the solve leaves of what it is to solve: the largest share, and of what. */
function residualOf({ estimates }: WorkerFrame["report"]): string {
  const found = Object.entries<any>(estimates ?? {}).map(([kind, { last }]) => ({ kind, excess: last.excess as number }));
  if (found.length === 0) return "-";
  const { kind, excess } = found.reduce((a, b) => (b.excess > a.excess ? b : a));
  return excess < 5e-5 ? `below 0.01 % (${kind})` : `${percent(excess)} (${kind})`;
}

let saidAdvice = 0;
function measure(frame: WorkerFrame): void {
  const { report } = frame;
  showPast(frame);
  if (!frame.isStep) return ["contacts", "residual", "overstretch"].forEach((id) => say(id, "-"));
  if (report.milliseconds > 0) say("milliseconds", `${report.milliseconds.toFixed(1)} ms a step`);
  say("substeps-used", `${report.substeps}`);
  say("contacts", `${(report.contacts ?? 0) + (report.pairs?.contacts ?? 0)}`);
  say("residual", residualOf(report));
  say("overstretch", report.overstretch ? percent(report.overstretch.p99) : "-");
  if (performance.now() - saidAdvice > 2000) {
    saidAdvice = performance.now();
    say("advice", frame.advice);
  }
}

let counted = { pictures: 0, at: performance.now() };
setInterval(() => {
  const now = performance.now();
  const rate = ((1000 * (view.pictures - counted.pictures)) / (now - counted.at)).toFixed(0);
  if (view.milliseconds > 0) say("rate", `${view.milliseconds.toFixed(0)} ms, ${rate} a second`);
  counted = { pictures: view.pictures, at: now };
}, 1000);

// ---- The World

world.onframe = (frame) => {
  last = frame;
  if (waitsFor && parts) {
    const { keepCamera, done } = waitsFor;
    waitsFor = undefined;
    view.show(parts, frame, keepCamera ? undefined : cameraOf(source.text));
    view.showEdges(byId<HTMLInputElement>("show-edges").checked);
    done();
  } else {
    view.update(frame);
  }
  dragging.show();
  measure(frame);
};
world.onfail = (error) => {
  setPlaying(false);
  showError(error);
};

function setPlaying(on: boolean): void {
  isPlaying = on;
  playButton.textContent = on ? "Pause" : "Play";
  playButton.setAttribute("aria-pressed", `${on}`);
  void world.play(on);
}

/** Makes a World of the text and the sliders. */
async function load({ keepState = false, keepCamera = false } = {}): Promise<void> {
  const wasPlaying = isPlaying;
  showError(undefined);
  dragging.cancel();
  say("loading", "Making the scene ...");
  try {
    await world.play(false);
    const options = { files: source.files, name: "scene" };
    const loaded = await world.load(applied(source.text, knobs), options, { keepState });
    parts = loaded.parts;
    const shown = new Promise<void>((done) => (waitsFor = { keepCamera, done }));
    await world.show();
    await shown;
    say("advice", loaded.findings.map(({ message, advice }) => `${message}${advice ? `; ${advice}` : ""}`).join("\n"));
    saidAdvice = performance.now();
    document.documentElement.dataset.scene = name;
  } catch (error) {
    showError(error);
  }
  say("loading", "");
  if (wasPlaying) setPlaying(true);
}

/** A member of the scene's text. */
function memberOf(sceneText: string, name: string): any {
  try {
    return JSON.parse(sceneText)[name];
  } catch {
    return undefined; // the engine says what is wrong with the text
  }
}

const cameraOf = (sceneText: string): SceneCamera => memberOf(sceneText, "camera") ?? {};

function describe(): void {
  say("description", memberOf(source.text, "description") ?? "");
}

// ---- The past

const past = byId<HTMLInputElement>("past");
let wanted: number | undefined;
let isSeeking = false;

function showPast(frame: WorkerFrame): void {
  say("time", `${frame.time.toFixed(2)} s`);
  past.min = `${frame.kept[0] ?? 0}`;
  past.max = `${Math.max(frame.kept.at(-1) ?? 0, frame.frame)}`;
  if (wanted === undefined) past.value = `${frame.frame}`;
  past.setAttribute("aria-valuetext", `frame ${frame.frame}, ${frame.time.toFixed(2)} seconds`);
}

/** Goes to the frame where the slider is, until it stays there. */
async function seek(): Promise<void> {
  if (isSeeking) return;
  isSeeking = true;
  try {
    for (let at = wanted; at !== undefined; at = wanted === at ? undefined : wanted) await world.seek(at);
  } catch (error) {
    showError(error);
  }
  wanted = undefined;
  isSeeking = false;
}
past.addEventListener("input", () => {
  if (isPlaying) setPlaying(false);
  dragging.letGo(); // as the worker does
  wanted = Number(past.value);
  void seek();
});

function resetKnobs(): void {
  knobs = { ...untouched };
  for (const [id, value] of [["substeps", "0"], ["wind", "0"], ["stiffness", "0"], ["fabric", ""]]) byId<HTMLInputElement>(id).value = value;
  showKnobs();
}

async function choose(chosen: string, changed?: string): Promise<void> {
  name = chosen;
  choice.value = chosen;
  source = changed === undefined ? await readScene(chosen) : await withFiles(chosen, changed);
  text.value = source.text;
  resetKnobs();
  describe();
  await load();
}

// ---- Controls

for (const group of [...new Set(gallery.map((scene) => scene.group))].sort()) {
  const list = document.createElement("optgroup");
  list.label = group.replaceAll("_", " ");
  for (const scene of gallery.filter((one) => one.group === group)) {
    const words = scene.name.split("/").pop()!.replaceAll("_", " ");
    list.append(new Option(words, scene.name));
  }
  choice.append(list);
}
choice.addEventListener("change", async () => {
  history.replaceState(null, "", await makeLink(choice.value));
  await choose(choice.value).catch(showError);
});
playButton.addEventListener("click", () => setPlaying(!isPlaying));
byId("step").addEventListener("click", () => {
  setPlaying(false);
  world.step().catch(showError);
});
byId("restart").addEventListener("click", () => void load({ keepCamera: true }));
byId<HTMLInputElement>("show-contacts").addEventListener("change", (event) => {
  void world.recordContacts((event.target as HTMLInputElement).checked);
});
byId<HTMLInputElement>("show-liquids").addEventListener("change", (event) => {
  void world.showLiquidSurfaces((event.target as HTMLInputElement).checked);
  if (!isPlaying) void world.show();
});
byId<HTMLInputElement>("show-edges").addEventListener("change", (event) => {
  view.showEdges((event.target as HTMLInputElement).checked);
});

function showKnobs(): void {
  const asIs = "as the scene says";
  say("substeps-value", knobs.substeps > 0 ? `${knobs.substeps}` : asIs);
  say("wind-value", knobs.wind > 0 ? `${knobs.wind} m/s` : asIs);
  say("stiffness-value", `${Number(knobs.stiffness.toPrecision(2))} ×`);
}

function readKnobs(): void {
  const value = (id: string) => Number(byId<HTMLInputElement>(id).value);
  knobs = {
    substeps: value("substeps"),
    wind: value("wind"),
    stiffness: 2 ** value("stiffness"),
    fabric: byId<HTMLSelectElement>("fabric").value,
  };
  showKnobs();
}

let turning: ReturnType<typeof setTimeout> | undefined;
for (const id of ["substeps", "wind", "stiffness", "fabric"]) {
  byId(id).addEventListener("input", () => {
    readKnobs();
    clearTimeout(turning);
    turning = setTimeout(() => void load({ keepState: true, keepCamera: true }), 250);
  });
}

async function apply(): Promise<void> {
  source = await withFiles(name, text.value);
  describe();
  history.replaceState(null, "", await makeLink(name, text.value));
  await load({ keepCamera: true });
}
byId("apply").addEventListener("click", () => void apply());
text.addEventListener("keydown", (event) => {
  if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void apply();
});

byId("share").addEventListener("click", async () => {
  const now = applied(text.value, knobs);
  const link = await makeLink(name, now === (await readScene(name)).text ? undefined : now);
  history.replaceState(null, "", link);
  try {
    await navigator.clipboard.writeText(location.href);
    say("note", "The link is copied. It holds the whole scene.");
  } catch {
    say("note", "The address of this page holds the whole scene: copy it.");
  }
});
byId("download").addEventListener("click", async () => {
  setPlaying(false);
  say("note", "Making 120 frames ...");
  try {
    const bytes = await world.record(120);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes as BlobPart], { type: "model/gltf-binary" }));
    link.download = `${name.split("/").pop()}.glb`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    await world.show();
    say("note", `${link.download} is saved: ${(bytes.length / 1e6).toFixed(1)} MB.`);
  } catch (error) {
    say("note", "");
    showError(error);
  }
});

const turn = 0.12; // [rad]
const keys: Record<string, () => void> = {
  ArrowLeft: () => view.orbit(-turn, 0),
  ArrowRight: () => view.orbit(turn, 0),
  ArrowUp: () => view.orbit(0, -turn),
  ArrowDown: () => view.orbit(0, turn),
  "+": () => view.orbit(0, 0, 0.9),
  "=": () => view.orbit(0, 0, 0.9),
  "-": () => view.orbit(0, 0, 1.1),
  " ": () => setPlaying(!isPlaying),
  s: () => byId("step").click(),
  r: () => byId("restart").click(),
  n: () => dragging.chooseNext(1),
  N: () => dragging.chooseNext(-1),
  Escape: () => dragging.cancel(),
};
const pushed = 0.03; // share of the scene's size
const shiftKeys: Record<string, () => void> = {
  ArrowLeft: () => dragging.push(-pushed, 0, 0),
  ArrowRight: () => dragging.push(pushed, 0, 0),
  ArrowUp: () => dragging.push(0, pushed, 0),
  ArrowDown: () => dragging.push(0, -pushed, 0),
  PageUp: () => dragging.push(0, 0, -pushed),
  PageDown: () => dragging.push(0, 0, pushed),
};
canvas.addEventListener("keydown", (event) => {
  const does = (event.shiftKey && shiftKeys[event.key]) || keys[event.key];
  if (event.ctrlKey || event.metaKey || event.altKey || !does) return;
  event.preventDefault();
  does();
});

// ---- Start

// For tests: what is shown, and where it is in the window.
Object.assign(window, { pliantPage: { world, view, frame: () => last, parts: () => parts } });

const linked = await readLink(location.hash).catch(() => ({}) as Awaited<ReturnType<typeof readLink>>);
const isKnown = gallery.some((scene) => scene.name === linked.name);
await choose(isKnown ? linked.name! : first, linked.text).catch(showError);
window.addEventListener("hashchange", async () => {
  const now = await readLink(location.hash).catch(showError);
  if (now?.name) await choose(now.name, now.text).catch(showError);
});
