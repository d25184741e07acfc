// The scenes of the gallery: text and the mesh files beside it, loaded when chosen.

const texts = import.meta.glob<string>("../../../scenes/**/*.json", { query: "?raw", import: "default" });
const files = import.meta.glob<string>("../../../scenes/**/*.obj", { query: "?raw", import: "default" });

const root = "../../../scenes/";
/** URDF needs tinyxml2, which the module has not. The others are variants for comparisons. */
const leftOut = /robot_arm|fold_no|fold_filter|xpbd_cloth|w1_64|chain_100/;

export interface GalleryScene {
  name: string;
  group: string;
}

export interface SceneSource {
  text: string;
  files: Record<string, string>;
}

export const gallery: GalleryScene[] = Object.keys(texts)
  .map((path) => path.slice(root.length, -".json".length))
  .filter((name) => !leftOut.test(name))
  .sort()
  .map((name) => ({ name, group: name.includes("/") ? name.split("/")[0] : "cloth" }));

/** The mesh files in the folder of a scene that its text names. */
async function filesOf(folder: string, text: string): Promise<Record<string, string>> {
  const found: Record<string, string> = {};
  for (const [path, read] of Object.entries(files)) {
    const name = path.slice(root.length + folder.length);
    if (path.startsWith(root + folder) && text.includes(`"${name}"`)) found[name] = await read();
  }
  return found;
}

export async function readScene(name: string): Promise<SceneSource> {
  const read = texts[`${root}${name}.json`];
  if (!read) throw new Error(`there is no scene '${name}' in the gallery`);
  return withFiles(name, await read());
}

/** A changed text of a gallery scene, with the files of that scene. */
export async function withFiles(name: string, text: string): Promise<SceneSource> {
  const folder = name.includes("/") ? `${name.split("/").slice(0, -1).join("/")}/` : "";
  return { text, files: await filesOf(folder, text) };
}
