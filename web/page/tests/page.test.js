// The page in Chromium: it loads, draws, steps, drags, says what is wrong, and fits a phone. Run by scripts/page test.
// Pictures go to web/page/shots.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdir } from "node:fs/promises";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { framesOf, hashes } from "../../package/test/support.js";

const folder = fileURLToPath(new URL("..", import.meta.url));
const shots = `${folder}shots`;
const port = 4173 + (process.pid % 500);
const address = `http://127.0.0.1:${port}/`;
let server, browser;

before(async () => {
  await mkdir(shots, { recursive: true });
  server = spawn(process.execPath, ["node_modules/vite/bin/vite.js", "preview", "--host", "127.0.0.1", "--port", `${port}`, "--strictPort"], {
    cwd: folder,
    stdio: "ignore",
  });
  for (let tries = 0; ; ++tries) {
    const answers = await fetch(address).then((answer) => answer.ok, () => false);
    if (answers) break;
    assert.ok(tries < 100, "the server does not start");
    await new Promise((done) => setTimeout(done, 100));
  }
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  });
});
after(async () => {
  await browser?.close();
  server?.kill();
});

/** A page that fails its test by any error on its console. */
async function open(hash = "", options = { viewport: { width: 1100, height: 700 } }) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.stack));
  const start = performance.now();
  await page.goto(`${address}${hash}`);
  await ready(page);
  return { page, errors, context, milliseconds: performance.now() - start };
}

/** Waits until a scene is shown. */
async function ready(page) {
  await page.waitForFunction(() => globalThis.pliantPage?.view.pictures > 0 && pliantPage.frame() && !document.querySelector("#loading").textContent, null, {
    timeout: 120_000,
  });
}

async function steps(page, count) {
  for (let i = 0; i < count; ++i) await page.evaluate(() => pliantPage.world.step());
}

async function runTo(page, frame) {
  await page.waitForFunction((wanted) => pliantPage.frame().frame >= wanted, frame, { timeout: 240_000 });
}

/** The share of the canvas's pixels that are unlike the sky. */
async function drawnShare(page) {
  const png = await page.locator("#view").screenshot();
  return page.evaluate(async (bytes) => {
    const image = await createImageBitmap(new Blob([new Uint8Array(bytes)]));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let unlike = 0;
    for (let i = 0; i < data.length; i += 4)
      if (Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 40) ++unlike;
    return unlike / (data.length / 4);
  }, [...png]);
}

test("the first picture is there, in colour, without an error on the console", async (t) => {
  const { page, errors, context, milliseconds } = await open();
  t.diagnostic(`first picture after ${milliseconds.toFixed(0)} ms`);
  assert.ok((await drawnShare(page)) > 0.02, "nothing coloured is drawn");
  await page.screenshot({ path: `${shots}/first.png` });
  assert.deepEqual(errors, []);
  await context.close();
});

test("play, pause, step and restart, by buttons and keys", async () => {
  const { page, errors, context } = await open("#scene=rope");
  await page.getByRole("button", { name: "Step" }).click();
  await runTo(page, 1);
  await page.getByRole("button", { name: "Play" }).click();
  await runTo(page, 10);
  await page.getByRole("button", { name: "Pause" }).click();
  await page.waitForTimeout(300);
  const frame = () => page.evaluate(() => pliantPage.frame().frame);
  const paused = await frame();
  await page.waitForTimeout(400);
  assert.equal(await frame(), paused);
  await page.locator("#view").focus();
  await page.keyboard.press("s");
  await runTo(page, paused + 1);
  const camera = () => page.evaluate(() => pliantPage.view.controls.object.position.toArray());
  const [from] = await camera();
  await page.keyboard.press("ArrowLeft");
  assert.notEqual((await camera())[0], from);
  await page.keyboard.press("Space");
  await runTo(page, paused + 5);
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Restart" }).click();
  await page.waitForFunction(() => pliantPage.frame().frame === 0);
  assert.deepEqual(errors, []);
  await context.close();
});

for (const name of ["rope", "flag", "bodies/pyramid", "liquids/dam_break", "soft_bodies/squeeze", "tears/sheet"])
  test(`golden hash of ${name} in the browser`, async () => {
    const { page, errors, context } = await open(`#scene=${name}`);
    await steps(page, framesOf(name));
    assert.equal(await page.evaluate(() => pliantPage.world.hash()), (await hashes())[name]);
    assert.deepEqual(errors, []);
    await context.close();
  });

// What tears keeps its World instead of a State.
for (const name of ["rope", "tears/sheet"])
  test(`the slider goes back in ${name}, and on from there with the same bits`, async () => {
    const { page, errors, context } = await open(`#scene=${name}`);
    const frame = () => page.evaluate(() => pliantPage.frame().frame);
    const hash = () => page.evaluate(() => pliantPage.world.hash());
    const seen = [await hash()];
    for (let i = 1; i <= 8; ++i) {
      await steps(page, 1);
      seen.push(await hash());
    }
    const past = page.getByLabel("Frame", { exact: true });
    for (const wanted of [3, 0, 6]) {
      await past.fill(`${wanted}`);
      await page.waitForFunction((to) => pliantPage.frame().frame === to, wanted);
      assert.equal(await hash(), seen[wanted]);
    }
    assert.equal(await past.getAttribute("max"), "8", "what comes later is there");
    await steps(page, 2);
    assert.equal(await hash(), seen[8]);
    await past.fill("2");
    await page.waitForFunction(() => pliantPage.frame().frame === 2);
    await steps(page, 1);
    assert.equal(await past.getAttribute("max"), "3", "a step replaces what came later");
    assert.equal(await frame(), 3);
    assert.deepEqual(errors, []);
    await context.close();
  });

test("a long past is kept with gaps, from its first frame", async () => {
  const { page, errors, context } = await open("#scene=rope");
  await steps(page, 250);
  const kept = await page.evaluate(() => pliantPage.frame().kept);
  assert.deepEqual(kept.slice(0, 3), [0, 2, 4]);
  assert.equal(kept.at(-1), 250);
  assert.equal(await page.evaluate(() => pliantPage.world.seek(101)), 100);
  assert.deepEqual(errors, []);
  await context.close();
});

test("a flag of 64 x 64: simulation and drawing are timed apart", async (t) => {
  const { page, errors, context } = await open("#scene=flag");
  await page.locator("summary").click();
  const editor = page.getByLabel("Edit the scene");
  const scene = JSON.parse(await editor.inputValue());
  Object.assign(scene.objects[0].cloth.mesh.grid, { columns: 64, rows: 64 });
  await editor.fill(JSON.stringify(scene));
  await editor.press("Control+Enter");
  await page.waitForFunction(() => pliantPage.frame().objects[0].positions.length === 3 * 64 * 64);
  await page.getByRole("button", { name: "Play" }).click();
  await runTo(page, 20);
  const sample = () =>
    page.evaluate(() => ({ frame: pliantPage.frame().frame, step: pliantPage.frame().report.milliseconds }));
  const [start, first] = [performance.now(), await sample()];
  const times = [];
  while (performance.now() - start < 4000) {
    await page.waitForTimeout(50);
    times.push((await sample()).step);
  }
  const rate = ((await sample()).frame - first.frame) / ((performance.now() - start) / 1000);
  const drawing = await page.evaluate(() => pliantPage.view.milliseconds);
  const step = times.sort((a, b) => a - b)[times.length >> 1];
  t.diagnostic(`${step.toFixed(1)} ms a step, ${drawing.toFixed(1)} ms a picture, ${rate.toFixed(0)} frames a second`);
  assert.match(await page.locator("#milliseconds").textContent(), /^[0-9.]+ ms a step$/);
  assert.match(await page.locator("#rate").textContent(), /^[0-9]+ ms, [0-9]+ a second$/);
  assert.match(await page.locator("#residual").textContent(), /%/);
  await page.screenshot({ path: `${shots}/flag_64.png` });
  assert.deepEqual(errors, []);
  await context.close();
});

test("where the processor renders, the page draws without highlights, and coarsely on fine displays", async () => {
  const { page, errors, context } = await open("#scene=drape", { viewport: { width: 600, height: 500 }, deviceScaleFactor: 2 });
  const { looks, wide, shown } = await page.evaluate(() => {
    const { scene, canvas } = pliantPage.view;
    const looks = [];
    scene.traverse((thing) => thing.isMesh && thing.visible && looks.push(thing.material.type));
    return { looks, wide: canvas.width, shown: canvas.clientWidth };
  });
  assert.ok(looks.length > 0 && looks.every((look) => look === "MeshLambertMaterial"), `${looks}`);
  assert.equal(wide, shown);
  assert.deepEqual(errors, []);
  await context.close();
});

test("the keyboard chooses a point or a body, and drags it", async () => {
  for (const [scene, words] of [["drape", /the middle of/], ["bodies/pyramid", /^Chosen: the body/]]) {
    const { page, errors, context } = await open(`#scene=${scene}`);
    await page.locator("#view").focus();
    await page.keyboard.press("n");
    const chosen = page.locator("#chosen");
    assert.match(await chosen.textContent(), words);
    const first = await chosen.textContent();
    await page.keyboard.press("n");
    assert.notEqual(await chosen.textContent(), first);
    await page.keyboard.press("Shift+N");
    assert.equal(await chosen.textContent(), first);
    const place = () => page.evaluate(() => pliantPage.view.chosen.position.toArray());
    const before = await place();
    for (let i = 0; i < 8; ++i) await page.keyboard.press("Shift+ArrowUp");
    const frame = await page.evaluate(() => pliantPage.frame().frame);
    await runTo(page, frame + 20);
    const after = await place();
    assert.ok(after[1] > before[1] + 0.02, `${scene}: ${before} to ${after}`);
    await page.screenshot({ path: `${shots}/chosen_${scene.split("/").pop()}.png` });
    await page.keyboard.press("Escape");
    assert.equal(await chosen.textContent(), "");
    assert.equal(await page.evaluate(() => pliantPage.view.chosen.visible), false);
    assert.deepEqual(errors, []);
    await context.close();
  }
});

test("the keyboard drags on after the slider, which shows no report of another frame", async () => {
  const { page, errors, context } = await open("#scene=drape");
  await page.locator("#view").focus();
  await page.keyboard.press("n");
  const drag = async () => {
    for (let i = 0; i < 8; ++i) await page.keyboard.press("Shift+ArrowUp");
    const frame = await page.evaluate(() => pliantPage.frame().frame);
    await runTo(page, frame + 20);
  };
  const height = () => page.evaluate(() => pliantPage.view.chosen.position.y);
  await drag();
  const residual = page.locator("#residual");
  await page.waitForFunction(() => document.querySelector("#residual").textContent !== "-");
  await page.getByLabel("Frame", { exact: true }).fill("2");
  await page.waitForFunction(() => pliantPage.frame().frame === 2);
  assert.equal(await residual.textContent(), "-");
  assert.equal(await page.locator("#contacts").textContent(), "-");
  const before = await height();
  await page.locator("#view").focus();
  await drag();
  assert.ok((await height()) > before + 0.02, `${before} to ${await height()}`);
  assert.notEqual(await residual.textContent(), "-");
  assert.deepEqual(errors, []);
  await context.close();
});

test("what cannot be grabbed is let go, and the next drag works", async () => {
  const { page, errors, context } = await open("#scene=drape");
  await page.locator("#view").focus();
  await page.keyboard.press("n");
  await page.evaluate(() => {
    pliantPage.world.grab = () => {
      delete pliantPage.world.grab;
      return Promise.reject(new Error("it is gone"));
    };
  });
  await page.keyboard.press("Shift+ArrowUp");
  await page.waitForFunction(() => document.querySelector("#chosen").textContent.includes("it is gone"));
  const height = () => page.evaluate(() => pliantPage.view.chosen.position.y);
  const before = await height();
  for (let i = 0; i < 8; ++i) await page.keyboard.press("Shift+ArrowUp");
  await runTo(page, 20);
  assert.ok((await height()) > before + 0.02, `${before} to ${await height()}`);
  assert.deepEqual(errors, []);
  await context.close();
});

test("a scene's camera is where it says", async () => {
  const { page, errors, context } = await open("#scene=rope");
  await page.locator("summary").click();
  const editor = page.getByLabel("Edit the scene");
  const right = JSON.parse(await editor.inputValue());
  const look = async (camera) => {
    const text = JSON.stringify({ ...right, camera });
    await page.evaluate(async (changed) => {
      const packed = new Response(new Blob([changed]).stream().pipeThrough(new CompressionStream("deflate-raw")));
      const bytes = new Uint8Array(await packed.arrayBuffer());
      const coded = btoa(String.fromCharCode(...bytes));
      location.hash = `#scene=rope&text=${coded.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
    }, text);
    await page.waitForFunction((wanted) => document.querySelector("#text").value === wanted, text);
    await ready(page);
    return page.evaluate(() => {
      const { object, target } = pliantPage.view.controls;
      return [...object.position.toArray(), ...target.toArray(), object.fov].map((x) => Math.round(1000 * x) / 1000);
    });
  };
  assert.deepEqual(await look({ position: [1, 2, 3], look_at: [0, 1, 0], fov: 50 }), [1, 2, 3, 0, 1, 0, 50]);
  const [x, y, z, ...rest] = await look({ distance: 2, azimuth: 90, elevation: 30, look_at: [0, 1, 0] });
  assert.deepEqual([x, y, z], [1.732, 2, 0]);
  assert.deepEqual(rest.slice(0, 3), [0, 1, 0]);
  await look({});
  const middle = await page.evaluate(() => pliantPage.view.controls.target.toArray());
  const inside = await look({ position: middle });
  const away = Math.hypot(...middle.map((x, k) => x - inside[k]));
  assert.ok(inside.every(Number.isFinite) && away > 0.1, `${inside}`);
  await look({ distance: 1e-3, look_at: [0, 1, 0] });
  assert.ok(await page.evaluate(() => pliantPage.view.controls.object.near < 0.9e-3), "what it looks at is seen");
  assert.deepEqual(errors, []);
  await context.close();
});

/** Drags what a particle of the first object shows by some pixels, and returns how far the particle moved [m]. */
async function dragBy(page, particle, [dx, dy], pose = false) {
  const place = () =>
    page.evaluate(
      ([i, isPose]) => {
        const { positions, poses } = pliantPage.frame().objects[0];
        return Array.from(isPose ? poses.slice(7 * i, 7 * i + 3) : positions.slice(3 * i, 3 * i + 3));
      },
      [particle, pose],
    );
  const before = await place();
  const at = await page.evaluate((point) => pliantPage.view.placeOf(point), before);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) await page.mouse.move(at.x + (dx * i) / 8, at.y + (dy * i) / 8);
  const frame = await page.evaluate(() => pliantPage.frame().frame);
  await runTo(page, frame + 25);
  const after = await place();
  const now = await page.evaluate((point) => pliantPage.view.placeOf(point), after);
  await page.mouse.up();
  return { before, after, off: Math.hypot(now.x - at.x - dx, now.y - at.y - dy) };
}

test("a drag moves a point of cloth with the pointer", async () => {
  const { page, errors, context } = await open("#scene=drape");
  const cloth = await page.evaluate(() => pliantPage.frame().objects[0].positions.length / 3);
  const inside = Math.floor(cloth / 2) + 20; // of the cloth, not of its border, which a ray can miss
  const { before, after, off } = await dragBy(page, inside, [60, -90]);
  await page.screenshot({ path: `${shots}/drag.png` });
  assert.ok(after[1] > before[1] + 0.02, `${before} to ${after}`);
  assert.ok(off < 65, `${off} pixels off the pointer, of 108`);
  assert.deepEqual(errors, []);
  await context.close();
});

test("a drag moves a rigid body", async () => {
  const { page, errors, context } = await open("#scene=bodies/pyramid");
  const count = await page.evaluate(() => pliantPage.parts().objects[0].bodies.length);
  const { before, after } = await dragBy(page, count - 1, [120, -60], true);
  assert.ok(Math.hypot(...after.map((x, k) => x - before[k])) > 0.1, `${before} to ${after}`);
  await page.screenshot({ path: `${shots}/bodies.png` });
  assert.deepEqual(errors, []);
  await context.close();
});

test("every kind of matter is drawn", async () => {
  const { page, errors, context } = await open("#scene=liquids/dam_break");
  for (const [scene, frames] of [
    ["liquids/dam_break", 20],
    ["grains/heap", 20],
    ["soft_bodies/stairs", 20],
    ["rods/hair", 2],
    ["knot", 12],
    ["gas/plume", 12],
    ["flag", 20],
    ["bodies/bowl", 20],
    ["contact/ring", 12],
    ["tears/sheet", 10],
  ]) {
    await page.getByLabel("Scene", { exact: true }).selectOption(scene);
    await page.waitForFunction((wanted) => document.documentElement.dataset.scene === wanted, scene, { timeout: 120_000 });
    await ready(page);
    await steps(page, frames);
    await page.waitForTimeout(300);
    await page.screenshot({ path: `${shots}/${scene.replace("/", "_")}.png` });
    assert.equal(await page.locator("#error").isVisible(), false, await page.locator("#error").textContent());
    if (scene !== "rods/hair" && scene !== "gas/plume") assert.ok((await drawnShare(page)) > 0.003, `${scene} is not drawn`);
  }
  assert.deepEqual(errors, []);
  await context.close();
});

test("substeps, wind and stiffness change a scene that goes on", async () => {
  const { page, errors, context } = await open("#scene=flag");
  await steps(page, 3);
  const set = async (label, value) => {
    await page.getByLabel(label).fill(`${value}`);
    await page.waitForTimeout(350);
    await ready(page);
  };
  await set("Substeps", 24);
  assert.equal(await page.evaluate(() => pliantPage.frame().frame), 3, "the state is kept");
  await page.evaluate(() => pliantPage.world.step());
  assert.match(await page.locator("#substeps-used").textContent(), /^24$/);
  await set("Wind", 12);
  await set("Stiffness", 2);
  assert.match(await page.locator("#stiffness-value").textContent(), /^4 ×/);
  await page.evaluate(() => pliantPage.world.step());
  assert.equal(await page.evaluate(() => pliantPage.frame().frame), 5);
  assert.equal(await page.locator("#error").isVisible(), false);
  assert.deepEqual(errors, []);
  await context.close();
});

test("contacts are marked", async () => {
  const { page, errors, context } = await open("#scene=bodies/pyramid");
  await page.getByLabel("Show contacts").check();
  await steps(page, 5);
  assert.ok((await page.evaluate(() => pliantPage.frame().contacts.length)) > 0);
  assert.notEqual(await page.locator("#contacts").textContent(), "0");
  assert.deepEqual(errors, []);
  await context.close();
});

test("a liquid is drawn by its surface", async () => {
  const { page, errors, context } = await open("#scene=liquids/dam_break");
  await page.getByLabel("Show liquids by their surface").check();
  await page.waitForFunction(() => pliantPage.frame().objects.some((object) => object.surfaceTriangles?.length > 300));
  await steps(page, 15);
  await page.waitForTimeout(300);
  await page.screenshot({ path: `${shots}/surface.png` });
  assert.deepEqual(errors, []);
  await context.close();
});

test("a wrong scene is explained, and a right one in the link is shown", async () => {
  const { page, errors, context } = await open("#scene=drape");
  await page.locator("summary").click();
  const editor = page.getByLabel("Edit the scene");
  const right = await editor.inputValue();
  await editor.fill(right.replace('"cloth":', '"cloht":'));
  await page.getByRole("button", { name: "Apply" }).click();
  const alert = page.getByRole("alert");
  await alert.waitFor();
  const inside = (await alert.boundingBox()).y + (await alert.boundingBox()).height;
  assert.ok(inside <= 701, `the error ends ${inside} pixels below the top of 700`);
  assert.match(await alert.textContent(), /scene:\d+:\d+: .*cloht.*did you mean 'cloth'/s);
  const selected = await editor.evaluate((area) => area.value.slice(area.selectionStart, area.selectionEnd));
  assert.match(selected, /^"cloht"/);
  await page.screenshot({ path: `${shots}/error.png` });
  const changed = JSON.parse(right);
  changed.objects[0].name = "mine";
  await editor.fill(JSON.stringify(changed));
  await editor.press("Control+Enter");
  await page.waitForFunction(() => pliantPage.parts().objects[0].name === "mine");
  assert.equal(await alert.isVisible(), false);
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.waitForFunction(() => document.querySelector("#note").textContent.includes("link") || document.querySelector("#note").textContent.includes("address"));
  const link = new URL(page.url()).hash;
  const other = await open(link);
  assert.equal(await other.page.evaluate(() => pliantPage.parts().objects[0].name), "mine");
  assert.deepEqual([...errors, ...other.errors], []);
  await context.close();
  await other.context.close();
});

test("every control has a name for the keyboard and screen readers", async () => {
  const { page, context } = await open("#scene=rope");
  await page.locator("summary").click();
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, select, input, textarea, canvas")]
      .filter((control) => !(control.labels?.length || control.getAttribute("aria-label") || control.textContent.trim()))
      .map((control) => control.outerHTML),
  );
  assert.deepEqual(nameless, []);
  // The keyboard reaches all of them.
  const reached = new Set();
  await page.evaluate(() => document.activeElement?.blur());
  for (let i = 0; i < 32; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement?.id));
  }
  for (const id of ["scene", "play", "past", "step", "restart", "view", "substeps", "wind", "stiffness", "fabric", "show-contacts", "text", "apply", "share", "download"])
    assert.ok(reached.has(id), `Tab does not reach ${id}`);
  await context.close();
});

test("a phone shows the picture and the controls, without scrolling sideways", async () => {
  const { page, errors, context } = await open("", { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true, deviceScaleFactor: 2 });
  await page.screenshot({ path: `${shots}/phone.png` });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} pixels wide`);
  const canvas = await page.locator("#view").boundingBox();
  assert.ok(canvas.height > 300 && canvas.width > 380);
  assert.deepEqual(errors, []);
  await context.close();
});
