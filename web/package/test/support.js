// What the tests share: the module, the scenes of the repository and their golden hashes.
import { readdir, readFile } from "node:fs/promises";
import { createPliant } from "../index.js";

const root = new URL("../../../", import.meta.url);
let loading;

export function pliant() {
  return (loading ??= createPliant());
}

export function sceneText(name) {
  return readFile(new URL(`scenes/${name}.json`, root), "utf8");
}

/** The mesh files beside a scene that its text names. */
export async function filesOf(name) {
  const folder = new URL(`scenes/${name}/../`, root);
  const text = await sceneText(name);
  const found = {};
  const files = (await readdir(folder, { withFileTypes: true })).filter((one) => one.isFile()); // not the folder "bodies"
  for (const { name: file } of files)
    if (!file.endsWith(".json") && text.includes(`"${file}"`)) found[file] = await readFile(new URL(file, folder));
  return found;
}

/** Frames of a golden hash, as in tests/golden/cases.h and cases.cpp. */
export function framesOf(name) {
  const [plainFrames, contactFrames, tearingFrames] = [40, 16, 40];
  if (name.startsWith("tears/") || name === "bags/seeping") return tearingFrames;
  return name.includes("/") ? contactFrames : plainFrames;
}

export async function hashes() {
  const lines = (await readFile(new URL("tests/golden/hashes.txt", root), "utf8")).split("\n");
  return Object.fromEntries(lines.filter((line) => line && !line.startsWith("#")).map((line) => line.split(" ")));
}
