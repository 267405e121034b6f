// Clicks through the page in Chromium: pictures, each question, files, keyboard, two tabs, bad files, a lost
// connection.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const [program, executablePath] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "belvedere-page-"));
const started = Date.now();
const done = [];
const children = [];

async function serve(...files) {
  const child = spawn(program, ["view", ...files, "--no-browser"], { cwd: folder, stdio: ["ignore", "pipe", "ignore"] });
  children.push(child);
  const [url] = await new Promise((found) => createInterface({ input: child.stdout }).once("line", (line) => found([line])));
  return { child, url };
}
const problems = [];
async function open(browser, url, device = { viewport: { width: 1280, height: 720 } }) {
  const page = await browser.newPage(device);
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("request", (request) => { if (!request.url().startsWith(url) && !/^(blob|data):/.test(request.url())) problems.push(`fetches ${request.url()}`); });
  await page.goto(url);
  return page;
}
const ready = (page) => page.waitForFunction(() => window.belvedere?.isLoaded && window.belvedere.ready && window.belvedere.frames > 0 && !window.belvedere.cloud.left, null, { timeout: 30_000 });
// Number of pixels of the picture whose colour is near to one.
const pixels = (page, color) => page.evaluate(async ([r, g, b]) => {
  await belvedere.complete();
  const from = document.getElementById("view");
  const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
  const context = canvas.getContext("2d");
  context.drawImage(from, 0, 0, 320, 180);
  const { data } = context.getImageData(0, 0, 320, 180);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 90) count += 1;
  return count;
}, color);
const answered = (page) => page.waitForFunction(() => window.belvedere.last && document.querySelector("#took"), null, { timeout: 20_000 });
const text = (page) => page.evaluate(() => document.querySelector("#card").innerText);
async function step(name, work) {
  await work();
  done.push(name);
}
// A pixel where the page shows a point of a class, away from the panels, with points at some distances from it too.
const pixelOf = (page, code, number = 0, around = []) => page.evaluate(async ([wanted, skip, around]) => {
  await belvedere.complete();
  for (let y = 250; y < 560; y += 7) for (let x = 300; x < 860; x += 7) {
    const place = belvedere.placeAt(x, y);
    const found = place && belvedere.cloud.nearest(place);
    if (found?.class === wanted && found.away < 0.02 && around.every(([right, down]) => belvedere.placeAt(x + right, y + down)) && skip-- <= 0) return [x, y];
  }
  return null;
}, [code, number, around]);
// A pixel of a roof: the highest with only points of buildings around it. Walls have gaps, chimneys are small.
const roofPixel = (page) => page.evaluate(async () => {
  await belvedere.complete();
  const placeOf = (x, y) => {
    const place = belvedere.placeAt(x, y);
    const found = place && belvedere.cloud.nearest(place);
    return found?.class === 6 ? place : null;
  };
  const steps = [-14, -7, 0, 7, 14];
  let highest = { z: -Infinity, at: null };
  for (let y = 250; y < 560; y += 7) for (let x = 300; x < 860; x += 7) {
    const place = placeOf(x, y);
    if (!place || place[2] <= highest.z) continue;
    if (steps.every((right) => steps.every((down) => placeOf(x + right, y + down)))) highest = { z: place[2], at: [x, y] };
  }
  return highest.at;
});

async function main() {
  execFileSync(program, ["simulate", "town", "--extent", "60", "-o", "town"], { cwd: folder, stdio: "ignore" });
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"] });
  const { child, url } = await serve("town/cloud.laz");
  const page = await open(browser, url);
  await ready(page);
  await page.evaluate(() => { belvedere.time.date = "2026-06-21"; belvedere.time.zone = "Europe/Amsterdam"; document.getElementById("date").value = "2026-06-21"; document.getElementById("zone").value = "Europe/Amsterdam"; });

  await step("the first picture is that of the stored one", async () => {
    await page.waitForTimeout(800);
    const expected = join(here, "expected.png");
    const shown = await page.evaluate(() => {
      const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
      canvas.getContext("2d").drawImage(document.getElementById("view"), 0, 0, 320, 180);
      return canvas.toDataURL("image/png");
    });
    if (!existsSync(expected) || process.env.STORE) writeFileSync(expected, Buffer.from(shown.split(",")[1], "base64"));
    const difference = await page.evaluate(async ([a, b]) => {
      const data = await Promise.all([a, b].map(async (source) => {
        const image = Object.assign(new Image(), { src: source });
        await image.decode();
        const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, 320, 180).data;
      }));
      return data[0].reduce((sum, v, i) => sum + Math.abs(v - data[1][i]), 0) / data[0].length;
    }, [shown, `data:image/png;base64,${readFileSync(expected).toString("base64")}`]);
    // steps of 8 bits: other drivers round points to other pixels; an empty picture differs by 30
    assert.ok(difference < 6, `the picture differs by ${difference}`);
  });
  const ground = await pixelOf(page, 2, 20, [[60, 0], [40, 40], [-20, 0], [30, 4], [34, 34], [-16, 30]]);
  const roof = await roofPixel(page);
  assert.ok(ground && roof, "ground and roofs are in the picture");

  await step("coordinates under the pointer", async () => {
    await page.mouse.move(...ground);
    await page.waitForFunction(() => /\d+\.\d\d {2}\d+\.\d\d/.test(document.getElementById("where").textContent), null, { timeout: 5000 });
  });
  const ask = async (tool, places, expected) => {
    await page.click(`#tools [data-tool=${tool}]`);
    for (const place of places) await page.mouse.click(...place);
    await answered(page);
    const said = await text(page);
    assert.match(said, expected, said);
    assert.match(said, /belvedere [a-z-]+ town\/cloud\.laz/);
    return said;
  };
  await step("what is seen from here", async () => {
    const before = await pixels(page, [255, 176, 0]);
    await ask("seen", [ground], /\d+\.\d % is visible/);
    await page.waitForTimeout(300);
    assert.ok(await pixels(page, [255, 176, 0]) > before + 300, "what is visible is orange");
    assert.match(await page.evaluate(() => document.getElementById("legend").innerText), /visible[\s\S]*blocked/);
  });
  await step("a table is saved", async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=csv]")]);
    assert.match(readFileSync(await download.path(), "utf8"), /^answer,points\nvisible,\d+\n/);
    const [map] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=geojson]")]);
    assert.equal(JSON.parse(readFileSync(await map.path(), "utf8")).features[0].geometry.type, "Point");
    const [picture] = await Promise.all([page.waitForEvent("download"), page.click("#picture")]);
    assert.equal(readFileSync(await picture.path()).subarray(1, 4).toString(), "PNG");
  });
  await step("of many points a sample is answered first", async () => {
    const requested = [];
    page.on("request", (request) => { if (request.method() === "POST") requested.push(request.postDataJSON()?.points); });
    await page.evaluate(() => { belvedere.scene.samples_first = true; });
    await ask("seen", [ground], /is visible/);
    await page.waitForFunction(() => belvedere.last && !/About/.test(document.getElementById("card").innerText), null, { timeout: 5000 });
    assert.deepEqual(requested, ["sample", undefined]);
    await page.evaluate(() => { belvedere.scene.samples_first = false; });
  });
  await step("is B seen from A", async () => {
    await ask("line", [ground, roof], /B is (visible|blocked|unproven)[\s\S]*Length of the line/);
    assert.equal(await page.evaluate(() => document.querySelectorAll("#card figure svg").length), 1);
    await page.waitForFunction(() => document.querySelectorAll("#marks path").length >= 1, null, { timeout: 5000 });
  });
  await step("sun here", () => ask("sun", [roof], /\d+\.\d hours of sun[\s\S]*First light/));
  await step("shadow at a time", async () => {
    await ask("shadow", [], /% is lit/);
    const noon = await page.evaluate(() => belvedere.last.lit_share);
    await page.evaluate(() => { const hour = document.getElementById("hour"); hour.value = 1230; hour.dispatchEvent(new Event("input")); });
    await page.waitForFunction((before) => belvedere.last.lit_share < before - 0.1, noon, { timeout: 10_000 });
    assert.ok(await pixels(page, [51, 64, 111]) > 300, "what is in shadow is blue");
    await page.click("#play");
    await page.waitForFunction(() => belvedere.time.minutes !== 1230, null, { timeout: 10_000 });
    await page.click("#play");
  });
  await step("sky and space here", async () => {
    await ask("around", [ground], /Sky view factor 0\.\d\d/);
    assert.equal(await page.evaluate(() => document.querySelectorAll("#card canvas").length), 1);
  });
  await step("who sees this", async () => {
    await ask("who", [roof], /Seen from [\d,]+ m²/);
    await page.waitForTimeout(300);
    assert.ok(await page.evaluate(() => belvedere.cloud.extra.children.length) === 1);
  });
  await step("energy of a roof", () => ask("roof", [roof], /[\d,]+ kWh a year[\s\S]*Faces/));
  await step("sun hours of an area", async () => {
    const [x, y] = ground;
    await page.click("#tools [data-tool=sun_area]");
    for (const place of [[x, y], [x + 60, y], [x + 40, y + 40]]) await page.mouse.click(...place);
    await page.keyboard.press("Enter");
    await answered(page);
    assert.match(await text(page), /hours of sun[\s\S]*Ground in the area/);
  });
  await step("a plan: a building is drawn, and what it changes is shown", async () => {
    const [x, y] = ground;
    await page.keyboard.press("Escape");
    await page.keyboard.press("0");
    for (const place of [[x - 20, y], [x + 30, y + 4], [x + 34, y + 34], [x - 16, y + 30]]) await page.mouse.click(...place);
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => belvedere.planned, null, { timeout: 10_000 });
    assert.match(await text(page), /Building 1[\s\S]*town\/cloud\.laz --add planned\.obj/);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-file='0']")]);
    const obj = readFileSync(await download.path(), "utf8");
    assert.match(obj, /^v 15\d+\S* 46\d+\S* /m);
    // the same as a file beside it, higher
    writeFileSync(join(folder, "tower.obj"), obj.replaceAll(/^(v \S+ \S+) (\S+)$/gm, (_, xy, z) => `${xy} ${Number(z) + 10}`));
    await page.setInputFiles("#meshfile", join(folder, "tower.obj"));
    await page.waitForFunction(() => belvedere.planned?.triangles.length === 2 * 12 * 9, null, { timeout: 10_000 });
    await page.selectOption("#when", "change");
    await ask("shadow", [], /points lose the sun[\s\S]*before\.laz[\s\S]*--add planned\.obj --add tower\.obj[\s\S]*after\.laz/);
    await page.waitForTimeout(300);
    assert.ok(await pixels(page, [31, 95, 191]) > 20, "what loses the sun is blue");
    await page.evaluate(() => { belvedere.last = null; belvedere.setWhen("before"); });
    await answered(page);
    assert.match(await text(page), /% is lit/);
    assert.doesNotMatch(await text(page), /--add/);
    await page.keyboard.press("0");
    for (let i = 0; i < 2; i++) {
      await page.click("[data-remove]");
      await page.waitForFunction((left) => document.querySelectorAll("[data-remove]").length === left, 1 - i, { timeout: 10_000 });
    }
    assert.equal(await page.evaluate(() => belvedere.planned), null);
  });
  await step("everything by keyboard", async () => {
    await page.keyboard.press("Escape");
    await page.keyboard.press("t");
    await page.keyboard.press("2");
    await page.waitForTimeout(500);
    await page.keyboard.press("Enter");
    await answered(page);
    await page.keyboard.press("l");
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
    for (const press of ["ArrowLeft", "ArrowUp", "+", "-", "w", "a", "m", "w", "ArrowRight", "m", "e", "m", "c", "b", "b", "h", "?"]) await page.keyboard.press(press);
    assert.ok(await page.evaluate(() => document.getElementById("keys").open));
    await page.keyboard.press("Escape");
    const nameless = await page.evaluate(() => [...document.querySelectorAll("button, select, input")].filter((one) => !(one.innerText?.trim() || one.ariaLabel || one.title || one.labels?.length)).length);
    assert.equal(nameless, 0, "controls without a name for screen readers");
  });
  await step("a tablet: fingers turn, zoom and ask, and controls are large", async () => {
    const tablet = await open(browser, url, { viewport: { width: 1024, height: 768 }, hasTouch: true, isMobile: true });
    await ready(tablet);
    const cdp = await tablet.context().newCDPSession(tablet);
    const drag = async (from, by) => {
      const at = (share) => from.map(([x, y], id) => ({ x: x + share * by[id][0], y: y + share * by[id][1], id }));
      await cdp.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
      for (const share of [0.25, 0.5, 0.75, 1]) await cdp.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(share) });
      await cdp.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    };
    const view = () => tablet.evaluate(() => { const { camera, orbit } = belvedere.mover; return [orbit.getAzimuthalAngle(), camera.position.distanceTo(orbit.target)]; });
    const [before, far] = await view();
    await drag([[500, 400]], [[120, 0]]);
    assert.ok(Math.abs((await view())[0] - before) > 0.1, "one finger turns");
    await drag([[450, 400], [550, 400]], [[-80, 0], [80, 0]]);
    assert.ok((await view())[1] < 0.8 * far, "two fingers zoom");
    assert.ok(await tablet.evaluate(() => document.getElementById("card").hidden), "no drag asks");
    await tablet.tap("#home");
    await tablet.tap("#tools [data-tool=seen]");
    await tablet.touchscreen.tap(...await pixelOf(tablet, 2, 20));
    await answered(tablet);
    assert.match(await text(tablet), /% is visible/);
    await tablet.selectOption("#motion", "walk");
    const [x, y] = await tablet.evaluate(() => belvedere.mover.camera.position.toArray());
    await tablet.tap("#steps [data-go='1,0,0']");
    assert.notDeepEqual(await tablet.evaluate(() => belvedere.mover.camera.position.toArray().slice(0, 2)), [x, y], "the arrows go");
    const small = () => tablet.evaluate(() => [...document.querySelectorAll("button, select, input")].filter((one) => one.checkVisibility({ visibilityProperty: true }))
      .filter((one) => one.getBoundingClientRect().height < 40 || one.getBoundingClientRect().right > innerWidth).map((one) => one.outerHTML));
    for (const tool of ["seen", "shadow", "plan"]) {
      await tablet.evaluate((name) => belvedere.choose(name), tool);
      assert.deepEqual(await small(), []);
      await tablet.setViewportSize({ width: 768, height: 1024 });
      assert.deepEqual(await small(), []);
      await tablet.setViewportSize({ width: 1024, height: 768 });
    }
    await tablet.close();
  });
  await step("two tabs", async () => {
    const other = await open(browser, url);
    await ready(other);
    await other.click("#tools [data-tool=seen]");
    await other.mouse.click(...ground);
    await answered(other);
    // a plan is that of its tab, also when it is loaded again
    const [low] = await other.evaluate(() => [belvedere.toFile(belvedere.scene.low)]);
    await other.evaluate(([x, y, z]) => belvedere.changePlan((plan) => plan.buildings.push({ corners: [[x + 20, y + 20], [x + 30, y + 20], [x + 30, y + 30]], base: z, height_m: 9 })), low);
    await other.reload();
    await ready(other);
    await other.waitForFunction(() => belvedere.planned?.triangles.length === 8 * 9, null, { timeout: 10_000 });
    assert.equal(await page.evaluate(() => belvedere.planned), null);
    await other.close();
  });
  await step("a refusal is in words", async () => {
    await page.evaluate(() => { document.getElementById("zone").value = "Mars"; belvedere.time.zone = "Mars"; belvedere.choose("shadow"); });
    await page.waitForFunction(() => /No answer[\s\S]*Mars/.test(document.getElementById("card").innerText), null, { timeout: 5000 });
  });
  await step("an empty date and a click beside the cloud are answered in words", async () => {
    await page.evaluate(() => { belvedere.time.zone = "Europe/Amsterdam"; document.getElementById("zone").value = "Europe/Amsterdam"; belvedere.choose("sun"); });
    await page.fill("#date", "");
    await page.dispatchEvent("#date", "change");
    await page.mouse.click(...roof);
    await page.waitForFunction(() => /date is missing[\s\S]*Choose a day/.test(document.getElementById("card").innerText), null, { timeout: 5000 });
    await page.fill("#date", "2026-06-21");
    await page.dispatchEvent("#date", "change");
    await page.evaluate(() => belvedere.choose("seen"));
    const empty = await page.evaluate(() => {
      for (let y = 80; y < 600; y += 10) for (let x = 320; x < 860; x += 10) if (!belvedere.placeAt(x, y)) return [x, y];
      return null;
    });
    assert.ok(empty, "there is a place without points");
    await page.mouse.click(...empty);
    await page.waitForFunction(() => /no point of the cloud[\s\S]*Click on a point/.test(document.getElementById("message").innerText), null, { timeout: 5000 });
    assert.equal(await page.evaluate(() => belvedere.places.length), 0);
  });
  await step("a steep scene is shown whole", async () => {
    // a slope of 45 degrees, and a mast on its upper end
    const rows = Array.from({ length: 10_000 }, (_, i) => [2 * (i % 100), 2 * Math.floor(i / 100), 2 * Math.floor(i / 100)]);
    rows.push([100, 198, 320]);
    writeFileSync(join(folder, "slope.xyz"), `${rows.map((row) => row.join(" ")).join("\n")}\n`);
    const { url: other } = await serve("slope.xyz");
    const shown = await open(browser, other);
    await shown.waitForFunction(() => window.belvedere?.isLoaded && belvedere.frames > 0, null, { timeout: 30_000 });
    for (const button of ["#home", "#top"]) {
      await shown.click(button);
      await shown.waitForTimeout(200);
      const [left, top, right, bottom, bar] = await shown.evaluate(() => {
        const seen = belvedere.cloud.chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => belvedere.onScreen([0, 1, 2].map((k) => low[k] + places[4 * i + k] * step[k]))));
        if (seen.includes(null)) return [-1, -1, -1, -1, 0];
        const of = (axis, choose) => seen.reduce((v, at) => choose(v, at[axis]), seen[0][axis]);
        return [of(0, Math.min), of(1, Math.min), of(0, Math.max), of(1, Math.max), document.getElementById("bar").offsetHeight];
      });
      assert.ok(left >= 0 && right <= 1280 && top >= bar && bottom <= 720, `${button}: ${[left, top, right, bottom, bar]}`);
      assert.ok(right - left > 300 || bottom - top > 300, `${button}: it is large enough`);
    }
    await shown.close();
  });
  await step("a page in one file shows the shadows of a day and the views of viewpoints without a server", async () => {
    const viewpoints = ["--observer", "155000,463000", "--observer", "154985,463010,30"];
    execFileSync(program, ["view", "town/cloud.laz", "--export", "page.html", "--date", "2026-06-21", "--zone", "Europe/Amsterdam", ...viewpoints], { cwd: folder, stdio: "ignore" });
    const alone = await open(browser, `file://${join(folder, "page.html")}`);
    await ready(alone);
    assert.equal(await alone.evaluate(() => document.querySelectorAll("#tools button").length), 3);
    await alone.keyboard.press("2");
    await answered(alone);
    const [first, command] = await alone.evaluate(() => [belvedere.last.visible, document.getElementById("command").innerText]);
    assert.match(command, /belvedere viewshed town\/cloud\.laz --observer 155000,463000 -o seen\.laz/);
    await alone.selectOption("#viewpoint", "1");
    await alone.waitForFunction((before) => belvedere.last.visible > before && belvedere.marks.length === 2, first, { timeout: 5000 });
    await alone.waitForTimeout(300);
    assert.ok(await pixels(alone, [255, 176, 0]) > 500, "visible points are orange");
    await alone.keyboard.press("3");
    await answered(alone);
    assert.match(await text(alone), /% is lit[\s\S]*belvedere shadow town\/cloud\.laz --time 2026-06-21T/);
    const noon = await alone.evaluate(() => belvedere.last.lit_share);
    for (let i = 0; i < 7; i++) await alone.keyboard.press(">");
    await alone.waitForFunction((before) => belvedere.last.lit_share < before - 0.1, noon, { timeout: 5000 });
    await alone.close();
  });
  await step("a lost connection is in words", async () => {
    child.kill("SIGKILL");
    await page.waitForFunction(() => /connection to Belvedere is lost/.test(document.getElementById("message").innerText), null, { timeout: 8000 });
  });
  await step("results of other commands are shown", async () => {
    execFileSync(program, ["shadow", "town/cloud.laz", "--time", "2026-06-21T17:00", "--zone", "Europe/Amsterdam", "--cell", "1", "-o", "lit.tif"], { cwd: folder, stdio: "ignore" });
    writeFileSync(join(folder, "walk.geojson"), JSON.stringify({ type: "LineString", coordinates: [[154980, 462990], [155010, 463010]] }));
    const { url: other } = await serve("town/cloud.laz", "lit.tif", "walk.geojson");
    const shown = await open(browser, other);
    await ready(shown);
    await shown.waitForFunction(() => belvedere.shownResult && belvedere.cloud.meshes?.length === 1, null, { timeout: 10_000 });
    await shown.waitForTimeout(300);
    assert.match(await shown.evaluate(() => document.getElementById("legend").innerText), /lit\.tif/);
    assert.ok(await pixels(shown, [255, 176, 0]) > 500, "cells in the sun are orange");
    await shown.selectOption("#color", "class");
    await shown.waitForTimeout(300);
    assert.ok(await pixels(shown, [255, 176, 0]) < 200, "the raster is gone");
    await shown.close();
  });
  await step("own colours of points", async () => {
    const rows = Array.from({ length: 2500 }, (_, i) => `${(i % 50) / 5} ${Math.floor(i / 50) / 5} ${i % 50 < 25 ? 0 : 3} 220 30 200`);
    const head = `ply\nformat ascii 1.0\nelement vertex ${rows.length}\n${["x", "y", "z"].map((name) => `property float ${name}\n`).join("")}${["red", "green", "blue"].map((name) => `property uchar ${name}\n`).join("")}end_header\n`;
    writeFileSync(join(folder, "colored.ply"), `${head}${rows.join("\n")}\n`);
    const { url: other } = await serve("colored.ply");
    const shown = await open(browser, other);
    await shown.waitForFunction(() => window.belvedere?.isLoaded && belvedere.loaded[0].chunk.geometry.getAttribute("rgb565"), null, { timeout: 10_000 });
    assert.ok(await pixels(shown, [220, 30, 200]) > 500, "points have their colours");
    await shown.close();
  });
  await step("a bad file is in words", async () => {
    writeFileSync(join(folder, "bad.laz"), "LASF, but no more");
    const bad = await serve("bad.laz");
    const shown = await open(browser, bad.url);
    await shown.waitForFunction(() => /bad\.laz/.test(document.getElementById("message").innerText), null, { timeout: 5000 });
  });
  assert.deepEqual(problems, []);
  await browser.close();
}

let failure;
try {
  await main();
} catch (error) {
  failure = error;
}
children.forEach((child) => child.kill("SIGKILL"));
rmSync(folder, { recursive: true, force: true });
console.log(done.map((name) => `ok: ${name}`).join("\n"));
if (failure) {
  console.error(`failed after "${done.at(-1)}": ${failure.message}\n${problems.join("\n")}`);
  process.exit(1);
}
console.log(`the page was tested in ${((Date.now() - started) / 1000).toFixed(0)} s`);
process.exit(0);
