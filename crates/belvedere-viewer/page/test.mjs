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
import { de } from "./src/words/de.js";
import { fr } from "./src/words/fr.js";
import { nl } from "./src/words/nl.js";
import { clockOf, zoneOf } from "./src/zones.js";
import { unfitting } from "./fits.mjs";
import { holes, sourcesOfRust, texts } from "./texts.mjs";

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
// A machine of one core that tests beside this one answers late, which is no failure.
const PATIENCE = 600_000;
// With PAGE_FROM=folder the page is that of a folder, so that a changed one is tried without building the program anew.
async function fromFolder(page) {
  const from = process.env.PAGE_FROM;
  if (!from) return;
  const kinds = { "page.js": "text/javascript", "style.css": "text/css" };
  for (const [name, contentType] of Object.entries(kinds)) await page.route(`http://**/${name}`, (route) => route.fulfill({ body: readFileSync(join(from, name)), contentType }));
  await page.route((url) => url.protocol === "http:" && url.pathname.endsWith("/"), async (route) => route.fulfill({ response: await route.fetch(), body: readFileSync(join(from, "index.html")) }));
}
// Far from the clouds, whose clocks are not those of the computer, and at a time that does not change.
const NOW = "2026-06-21T13:02:00Z";
const DESK = { viewport: { width: 1280, height: 720 }, timezoneId: "America/New_York" };
async function open(browser, url, device = DESK, now = NOW) {
  const page = await browser.newPage(device);
  page.setDefaultTimeout(PATIENCE);
  await page.clock.setFixedTime(new Date(now));
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("request", (request) => { if (!request.url().startsWith(url) && !/^(blob|data):/.test(request.url())) problems.push(`fetches ${request.url()}`); });
  await fromFolder(page);
  await page.goto(url);
  return page;
}
const ready = (page) => page.waitForFunction(() => window.belvedere?.isLoaded && window.belvedere.ready && window.belvedere.frames > 0 && !window.belvedere.cloud.left);
// Panels have their places, and the picture has all points.
const settled = (page) => page.evaluate(async () => {
  const frame = () => new Promise((go) => requestAnimationFrame(go));
  await frame();
  await Promise.allSettled(document.getAnimations().map(({ finished }) => finished));
  await frame();
  await belvedere.complete(60_000);
});
// Number of pixels of the picture whose colour is near to one.
const pixels = (page, color) => page.evaluate(async ([r, g, b]) => {
  await belvedere.complete(60_000);
  const from = document.getElementById("view");
  const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
  const context = canvas.getContext("2d");
  context.drawImage(from, 0, 0, 320, 180);
  const { data } = context.getImageData(0, 0, 320, 180);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 90) count += 1;
  return count;
}, color);
const answered = (page) => page.waitForFunction(() => window.belvedere.last && document.querySelector("#took"));
const text = (page) => page.evaluate(() => document.querySelector("#card").innerText);
async function step(name, work) {
  await work();
  done.push(name);
}
// A pixel where the page shows a point of a class, away from the panels, with points of it at some distances too.
const pixelOf = (page, code, number = 0, around = []) => page.evaluate(async ([wanted, skip, around]) => {
  await belvedere.complete(60_000);
  const isOf = (place) => place && belvedere.cloud.nearest(place)?.class === wanted;
  for (let y = 250; y < 560; y += 7) for (let x = 300; x < 860; x += 7) {
    const place = belvedere.placeAt(x, y);
    const found = place && belvedere.cloud.nearest(place);
    if (found?.class === wanted && found.away < 0.02 && around.every(([right, down]) => isOf(belvedere.placeAt(x + right, y + down))) && skip-- <= 0) return [x, y];
  }
  return null;
}, [code, number, around]);
// A pixel of a roof: the highest with only points of buildings around it. Walls have gaps, chimneys are small.
const roofPixel = (page) => page.evaluate(async () => {
  await belvedere.complete(60_000);
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

// Zones of places, and the clocks there.
function zones() {
  const of = (near, own) => zoneOf(near, 15.3, -4.3, own, new Date(NOW));
  assert.match(Object.values(of(["Europe/Amsterdam"], "Asia/Tokyo")).join(), /^Europe.Amsterdam,that of the place$/);
  assert.equal(of(["Europe/Lisbon", "Europe/Madrid"], "Europe/Madrid").zone, "Europe/Madrid", "this computer's where it fits the place");
  assert.equal(of(["Europe/Amsterdam"], "Europe/Berlin").zone, "Europe/Amsterdam", "not this computer's though its clocks are the same");
  assert.match(of(["Europe/Warsaw", "Europe/Kaliningrad"], "Asia/Tokyo").why, /border/, "where clocks differ nearby it is said");
  assert.match(of([], "Europe/Paris").zone + of([], "Europe/Paris").why, /^\+01:00by the longitude/, "no zone of another continent");
  assert.equal(of([], "Africa/Luanda").zone, "Africa/Luanda");
  const clock = (zone) => { const { date, minutes } = clockOf(zone, new Date("2026-01-31T23:30:00Z")); return `${date} ${minutes}`; };
  assert.deepEqual(["Europe/Amsterdam", "America/New_York", "+02:00", "-03:30", "UTC"].map(clock), ["2026-02-01 30", "2026-01-31 1110", "2026-02-01 90", "2026-01-31 1200", "2026-01-31 1410"]);
  assert.equal(clockOf("Mars"), null);
}

// Every text is in every language, and no other; names of stages and remarks are those of the library.
function languages() {
  const [expected, rust] = [texts(), sourcesOfRust()];
  for (const [name, table] of Object.entries({ de, fr, nl })) {
    assert.deepEqual(Object.keys(table.texts).sort(), expected, name);
    for (const [text, own] of Object.entries(table.texts)) assert.equal(holes(own), holes(text), `${name}: ${text}`);
    for (const part of ["stages", "remarks", "refusals"]) {
      assert.deepEqual(Object.keys(table[part]).sort(), Object.keys(nl[part]).sort(), `${name}: ${part}`);
      for (const [key, own] of Object.entries(table[part])) {
        assert.ok(rust.includes(`"${key}"`), `${key} is no name of the library`);
        assert.equal(holes(own), holes(nl[part][key]), `${name}: ${key}`);
      }
    }
  }
}

async function main() {
  languages();
  done.push("texts in all languages");
  zones();
  done.push("zones of places, and the clocks there");
  execFileSync(program, ["simulate", "town", "--extent", "60", "-o", "town"], { cwd: folder, stdio: "ignore" });
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"] });
  const { child, url } = await serve("town/cloud.laz");
  const page = await open(browser, url);
  await ready(page);

  await step("the first screen answers: the shadows of now by the clocks of the place", async () => {
    await answered(page);
    await settled(page);
    const first = await page.evaluate(() => ({ tool: belvedere.tool.name, time: belvedere.time, invite: document.getElementById("invite")?.textContent }));
    assert.deepEqual([first.tool, first.time.date, first.time.minutes, first.time.zone], ["shadow", "2026-06-21", 900, "Europe/Amsterdam"]);
    assert.match(await text(page), /% is lit[\s\S]*This is now, by the clocks of the place[\s\S]*Europe\/Amsterdam: that of the place/);
    assert.match(first.invite, /Click anywhere to ask/);
    const { panels, height } = await page.evaluate(() => ({ panels: ["tools", "card", "timebar", "compass"].map((id) => document.getElementById(id).getBoundingClientRect().toJSON()), height: document.getElementById("timebar").offsetHeight }));
    assert.ok(height < 60, `the time is one row: ${height}`);
    for (const [i, a] of panels.entries()) for (const b of panels.slice(i + 1)) assert.ok(a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top, `panels overlap: ${JSON.stringify([a, b])}`);
    const seen = await page.evaluate(() => belvedere.cloud.chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => belvedere.onScreen([0, 1, 2].map((k) => low[k] + places[4 * i + k] * step[k])))));
    const [tools, card, timebar] = panels;
    assert.ok(seen.every(([x, y]) => x >= tools.right && x <= card.left && y >= 46 && y <= timebar.top), "the scene is shown whole beside the panels");
    const share = (axis, room) => (seen.reduce((v, at) => Math.max(v, at[axis]), 0) - seen.reduce((v, at) => Math.min(v, at[axis]), 1e4)) / room;
    const [across, upright] = [share(0, card.left - tools.right), share(1, timebar.top - 46)];
    assert.ok(Math.max(across, upright) > 0.9 && Math.min(across, upright) > 0.6, `the scene fills ${across} by ${upright} of the free place`);
  });
  await step("the first picture is that of the stored one", async () => {
    await settled(page);
    const expected = join(here, "expected.png");
    const shown = await page.evaluate(() => {
      const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
      canvas.getContext("2d").drawImage(document.getElementById("view"), 0, 0, 320, 180);
      return canvas.toDataURL("image/png");
    });
    if (!existsSync(expected) || process.env.STORE) writeFileSync(expected, Buffer.from(shown.split(",")[1], "base64"));
    const [difference, ofEmpty] = await page.evaluate(async ([a, b]) => {
      const data = await Promise.all([a, b].map(async (source) => {
        const image = Object.assign(new Image(), { src: source });
        await image.decode();
        const canvas = Object.assign(document.createElement("canvas"), { width: 320, height: 180 });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, 320, 180).data;
      }));
      const from = (other) => data[1].reduce((sum, v, i) => sum + Math.abs(v - other(i)), 0) / data[1].length;
      return [from((i) => data[0][i]), from((i) => data[1][i % 4])];
    }, [shown, `data:image/png;base64,${readFileSync(expected).toString("base64")}`]);
    // steps of 8 bits: other drivers round points to other pixels, which is little beside an empty picture
    assert.ok(ofEmpty > 3 && difference < 0.2 * ofEmpty, `the picture differs by ${difference}, an empty one by ${ofEmpty}`);
  });
  await step("colours of an answer are those of its legend", async () => {
    await settled(page);
    const strange = await page.evaluate(() => {
      // shares of red, green and blue: light and shade change all of them alike
      const shares = ([r, g, b]) => { const sum = Math.max(r + g + b, 1); return [r / sum, g / sum, b / sum]; };
      const keys = belvedere.legend.keys.map(({ color }) => shares([1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16))));
      const from = document.getElementById("view");
      const context = Object.assign(document.createElement("canvas"), { width: from.width, height: from.height }).getContext("2d");
      context.drawImage(from, 0, 0);
      const { data } = context.getImageData(0, 0, from.width, from.height);
      let [points, others] = [0, 0];
      for (let y = 100; y < 560; y += 4) for (let x = 300; x < 860; x += 4) {
        if (belvedere.cloud.depthAt(x, y, 0) === null) continue;
        const own = shares(data.subarray(4 * (y * from.width + x)));
        points += 1;
        if (keys.every((key) => Math.hypot(...key.map((v, i) => own[i] - v)) > 0.05)) others += 1;
      }
      return others / points;
    });
    // edges between lit and shadow are mixed
    assert.ok(strange < 0.04, `${strange} of the picture has colours of no answer`);
  });
  await step("a click asks, the address keeps what is shown, and back goes to the question before", async () => {
    await page.mouse.click(...await pixelOf(page, 2, 20));
    assert.equal(await page.evaluate(() => document.getElementById("invite")), null);
    assert.match(await text(page), /At the time below[\s\S]*(lit|in shadow)[\s\S]*Ask about this place/);
    const hash = () => page.evaluate(() => location.hash);
    await page.waitForFunction(() => location.hash.startsWith("#q=shadow"));
    assert.match(await hash(), /^#q=shadow&d=2026-06-21&t=15:00&z=Europe\/Amsterdam&c=class&v=orbit(,-?[\d.]+){6}$/);
    await page.click("[data-about=sun]");
    await answered(page);
    await page.waitForFunction(() => /^#q=sun&.*&p=15\d+/.test(location.hash));
    assert.ok(!(await hash()).includes(new URL(url).pathname.replaceAll("/", "")), "the token stays out");
    const before = await page.evaluate(() => belvedere.places[0].clicked);
    await page.evaluate(() => { const date = document.getElementById("date"); date.value = "2026-03-01"; date.dispatchEvent(new Event("change")); const zone = document.getElementById("zone"); zone.value = "+03:00"; zone.dispatchEvent(new Event("change")); belvedere.mover.turn(0.4, 0); });
    await page.selectOption("#color", "height");
    await page.waitForFunction(() => /d=2026-03-01.*z=%2B03:00.*c=height/.test(location.hash));
    const view = () => page.evaluate(() => belvedere.mover.camera.position.toArray().map((v) => v.toFixed(2)));
    const from = await view();
    await page.reload();
    await ready(page);
    await answered(page);
    const again = await page.evaluate(() => [belvedere.tool.name, belvedere.time.date, belvedere.time.zone, document.getElementById("color").value, belvedere.places[0].clicked]);
    assert.deepEqual(again.slice(0, 4), ["sun", "2026-03-01", "+03:00", "height"]);
    assert.ok(again[4].every((v, i) => Math.abs(v - before[i]) < 0.01));
    assert.deepEqual(await view(), from);
    await page.goBack();
    await page.waitForFunction(() => belvedere.tool?.name === "shadow" && belvedere.time.zone === "Europe/Amsterdam" && belvedere.last?.lit);
    await page.goForward();
    await page.waitForFunction(() => belvedere.tool.name === "sun" && belvedere.time.zone === "+03:00" && belvedere.last?.path);
    await page.goBack();
    await page.waitForFunction(() => belvedere.tool.name === "shadow" && belvedere.last?.lit);
    await page.keyboard.press("Escape");
    await page.keyboard.press("h");
    await page.evaluate(() => belvedere.complete(60_000));
  });
  await step("where it is night the first answer is that of noon, and says so", async () => {
    const night = await open(browser, url, DESK, "2026-01-10T23:10:00Z");
    await ready(night);
    await answered(night);
    assert.deepEqual(await night.evaluate(() => [belvedere.time.date, belvedere.time.minutes]), ["2026-01-11", 770]);
    assert.match(await text(night), /% is lit[\s\S]*It is 00:10 there now[\s\S]*this is noon/);
    await night.close();
  });
  await step("heights are coloured between the second and the 98th percentile", async () => {
    const [below, above, ends] = await page.evaluate(() => {
      const { chunks, own } = belvedere.cloud;
      const heights = chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => low[2] + step[2] * places[4 * i + 2]));
      const { x, y } = own.heights.value;
      return [heights.filter((z) => z < x).length / heights.length, heights.filter((z) => z > y).length / heights.length, belvedere.scene.heights.map((z, i) => z - belvedere.scene.origin[2] - [x, y][i])];
    });
    assert.ok(Math.abs(below - 0.02) < 0.01 && Math.abs(above - 0.02) < 0.01, `${below} ${above}`);
    assert.ok(ends.every((v) => Math.abs(v) < 1e-3), "the legend says so");
  });
  const ground = await pixelOf(page, 2, 20, [[60, 0], [40, 40], [-20, 0], [30, 4], [34, 34], [-16, 30]]);
  const roof = await roofPixel(page);
  assert.ok(ground && roof, "ground and roofs are in the picture");

  await step("coordinates under the pointer", async () => {
    await page.mouse.move(...ground);
    await page.waitForFunction(() => /\d+\.\d\d {2}\d+\.\d\d/.test(document.getElementById("where").textContent));
  });
  const ask = async (tool, places, expected) => {
    await page.click(`#tools [data-tool=${tool}]`);
    // a click asks about the place that is drawn there
    await settled(page);
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
    await settled(page);
    assert.ok(await pixels(page, [255, 176, 0]) > before + 300, "what is visible is orange");
    assert.match(await page.evaluate(() => document.getElementById("legend").innerText), /visible[\s\S]*blocked/);
  });
  await step("answers are layers: lone points are no spots, and sides of a line stay", async () => {
    const orange = async (is) => {
      await page.evaluate((is) => {
        const { chunks } = belvedere.cloud, decide = new Function("i", "x", `return ${is}`);
        const codes = new Uint8Array(belvedere.scene.point_count);
        for (const { first, count, places, low, step } of chunks) for (let i = 0; i < count; i++) codes[first + i] = decide(first + i, low[0] + places[4 * i] * step[0]) ? 1 : 0;
        belvedere.values(codes);
      }, is);
      await settled(page);
      return pixels(page, [255, 176, 0]);
    };
    const middle = await page.evaluate(() => (belvedere.scene.low[0] + belvedere.scene.high[0]) / 2);
    const [all, half, lone] = [await orange("true"), await orange(`x < ${middle}`), await orange("i % 60 === 0")];
    // one in sixty is 1.7 percent
    assert.ok(half > 0.25 * all && half < 0.75 * all && lone < 0.002 * all, `${[all, half, lone]} pixels`);
    await page.evaluate(() => belvedere.values(new Uint8Array(belvedere.last.body)));
  });
  await step("a table is saved", async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=csv]")]);
    assert.match(readFileSync(await download.path(), "utf8"), /^answer,points\nvisible,\d+\n/);
    const [map] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=geojson]")]);
    const { features: [{ geometry }], crs } = JSON.parse(readFileSync(await map.path(), "utf8"));
    assert.deepEqual([geometry.type, crs], ["Point", { type: "name", properties: { name: "urn:ogc:def:crs:EPSG::7415" } }]);
    const [picture] = await Promise.all([page.waitForEvent("download"), page.click("#picture")]);
    assert.equal(readFileSync(await picture.path()).subarray(1, 4).toString(), "PNG");
  });
  await step("of many points a sample is answered first", async () => {
    const requested = [];
    const note = (request) => { if (request.method() === "POST") requested.push(request.postDataJSON()?.points); };
    page.on("request", note);
    await page.evaluate(() => { belvedere.scene.samples_first = true; });
    await ask("seen", [ground], /is visible/);
    await page.waitForFunction(() => belvedere.last && !/About/.test(document.getElementById("card").innerText));
    page.off("request", note);
    assert.deepEqual(requested, ["sample", undefined]);
    await page.evaluate(() => { belvedere.scene.samples_first = false; });
  });
  await step("is B seen from A", async () => {
    await ask("line", [ground, roof], /B is (visible|blocked|unproven)[\s\S]*Length of the line/);
    assert.equal(await page.evaluate(() => document.querySelectorAll("#card figure svg").length), 1);
    await page.waitForFunction(() => document.querySelectorAll("#marks path").length >= 1);
  });
  await step("sun here", () => ask("sun", [roof], /\d+\.\d hours of sun[\s\S]*In nine of ten cases\s*\d+\.\d to \d+\.\d h[\s\S]*First light\s*\d\d:\d\d \(UTC\+2\)/));
  await step("shadow at a time", async () => {
    await ask("shadow", [], /% is lit/);
    const noon = await page.evaluate(() => belvedere.last.lit_share);
    await page.evaluate(() => { const hour = document.getElementById("hour"); hour.value = 1230; hour.dispatchEvent(new Event("input")); });
    await page.waitForFunction((before) => belvedere.last.lit_share < before - 0.1, noon);
    assert.ok(await pixels(page, [51, 64, 111]) > 300, "what is in shadow is blue");
    await page.click("#play");
    await page.waitForFunction(() => belvedere.time.minutes !== 1230);
    await page.click("#play");
  });
  await step("shadow by how sure it is, and one point of it", async () => {
    const said = await ask("shadow", [], /Show how sure each answer is/);
    assert.doesNotMatch(said, /90 % sure/);
    await page.click("#sure");
    await page.waitForFunction(() => belvedere.last?.certainty && document.querySelector("#took"));
    assert.match(await text(page), /90 % sure: lit[\s\S]*Less sure, or unproven[\s\S]*--probability --certain 0\.9/);
    const { sure, bytes, points, fits } = await page.evaluate(() => {
      const { certainty, body, probabilities, points } = belvedere.last;
      const [codes, likely] = [new Uint8Array(body), new Uint8Array(probabilities)];
      // what is as good as sure is what was answered, but for single points in a thousand
      const strange = likely.filter((p, i) => p <= 200 && ((p >= 198 && codes[i] === 0) || (p <= 2 && codes[i] === 1))).length;
      return { sure: certainty, bytes: [codes.length, likely.length], points, fits: strange * 1000 < points };
    });
    assert.deepEqual([sure.answers, ...bytes], [points, points, points]);
    const shares = [sure.certainly_visible_percent, sure.certainly_blocked_percent, sure.uncertain_percent];
    // each is rounded to a hundredth
    assert.ok(fits && shares.every((share) => share > 0) && Math.abs(shares.reduce((a, b) => a + b) - 100) < 0.02, JSON.stringify(sure));
    assert.match(await page.evaluate(() => document.getElementById("legend").innerText), /How likely it is lit[\s\S]*0 %[\s\S]*100 %/);
    await page.waitForFunction(() => location.hash.includes("sure=yes"));
    await page.mouse.click(...ground);
    await page.waitForFunction(() => /lit with a probability of \d+ %/.test(document.getElementById("card").innerText));
    await page.evaluate(() => { belvedere.isSure = false; });
  });
  await step("shadows of two times are compared", async () => {
    await page.evaluate(() => { belvedere.time.minutes = 720; });
    await ask("shadow", [], /Compare this time with another/);
    const before = await page.evaluate(() => [...new Uint8Array(belvedere.last.body)]);
    await page.click("#compare");
    await page.waitForFunction(() => /^0 points lose the sun, 0 points gain the sun/m.test(document.getElementById("card").innerText));
    await page.evaluate(() => { const hour = document.getElementById("hour"); hour.value = 1140; hour.dispatchEvent(new Event("input")); });
    await page.waitForFunction(() => !belvedere.last?.isFirst && /from 2026-06-21 12:00:00\+02:00 to 2026-06-21 19:00:00\+02:00/.test(document.querySelector("#card .note")?.innerText ?? "") && document.querySelector("#took"));
    // counted here from both answers
    const after = await page.evaluate(() => [...new Uint8Array(belvedere.last.body)]);
    const isLit = (code) => code === 1 || code === 2;
    const lost = before.filter((code, i) => isLit(code) && !isLit(after[i])).length;
    assert.ok(lost > 1000);
    assert.ok((await text(page)).includes(`${lost.toLocaleString("en")} points lose the sun`));
    assert.match(await text(page), /-o before\.laz[\s\S]*-o after\.laz/);
    await page.waitForFunction(() => location.hash.includes("from=2026-06-21T12:00"));
    await page.click("#compare");
    await page.waitForFunction(() => /% is lit/.test(document.getElementById("card").innerText));
  });
  await step("lengths, heights and areas are measured", async () => {
    await page.click("#measure");
    // a roof of 4 m by 3 m that rises 3 m along its 4 m: 5 m by 3 m in its plane
    await page.evaluate(() => [[0, 0, 0], [4, 0, 3], [4, 3, 3], [0, 3, 0]].forEach((place) => belvedere.pick(place)));
    assert.match(await text(page), /Length\s+13\.00 m\s+Length on the map\s+11\.00 m\s+Height of the last above the first\s+0\.00 m\s+Area on the map\s+12\.0 m²\s+Area in its plane\s+15\.0 m²/);
    await page.waitForFunction(() => [...document.querySelectorAll("#marks text")].filter(({ textContent }) => textContent === "5.00 m").length === 2);
    const [file] = await Promise.all([page.waitForEvent("download"), page.click("#map")]);
    const { features: [{ geometry, properties }] } = JSON.parse(readFileSync(await file.path(), "utf8"));
    assert.deepEqual([geometry.type, geometry.coordinates[0].length, properties.plane_area_m2], ["Polygon", 5, 15]);
    await page.click("#anew");
    assert.match(await text(page), /Click two places/);
    await page.keyboard.press("Escape");
  });
  await step("a part is shown alone", async () => {
    const seen = () => page.evaluate(async () => { await belvedere.complete(60_000); return belvedere.placeAt(640, 360)?.[2] ?? null; });
    await page.evaluate(() => { document.getElementById("top").click(); });
    const before = await seen();
    const lower = before - 1;
    await page.click("#cut");
    await page.evaluate((z) => { const high = document.getElementById("cut-high"); high.value = belvedere.toFile([0, 0, z])[2]; high.dispatchEvent(new Event("input")); }, lower);
    const after = await seen();
    assert.ok(after === null || after < lower + 0.2, `${before} and ${after}`);
    await page.waitForFunction(() => /cut=-?[\d.]+(,-?[\d.]+){5}/.test(location.hash));
    // answers are of all points
    await page.click("#tools [data-tool=shadow]");
    await answered(page);
    assert.ok(await page.evaluate(() => belvedere.last.points === belvedere.scene.point_count && document.getElementById("cut").getAttribute("aria-pressed") === "true"));
    await page.click("#cut");
    await page.click("#all");
    assert.ok(Math.abs(await seen() - before) < 0.2);
    await page.keyboard.press("Escape");
    await page.click("#home");
  });
  await step("sky and space here", async () => {
    await ask("around", [ground], /Sky view factor 0\.\d\d[\s\S]*Visible volume up to obstacles\s*[\d,]+ m³\s*With open directions, up to 100 m\s*[\d,]+ m³/);
    assert.equal(await page.evaluate(() => document.querySelectorAll("#card canvas").length), 1);
  });
  await step("who sees this", async () => {
    await ask("who", [roof], /Seen from [\d,]+ m²/);
    await settled(page);
    assert.ok(await page.evaluate(() => belvedere.cloud.extra.children.length) === 1);
  });
  await step("energy of a roof", () => ask("roof", [roof], /[\d,]+ kWh a year[\s\S]*solar energy received[\s\S]*not electricity[\s\S]*In nine of ten cases\s*[\d,]+ to [\d,]+ kWh[\s\S]*Faces/));
  await step("edges of roofs, and the plane of a point", async () => {
    // what is darker and redder than all points
    const edges = () => page.evaluate(async () => {
      await belvedere.complete(60_000);
      const from = document.getElementById("view");
      const context = Object.assign(document.createElement("canvas"), { width: from.width, height: from.height }).getContext("2d");
      context.drawImage(from, 0, 0);
      const { data } = context.getImageData(0, 0, from.width, from.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i] > 80 && data[i + 1] < 15 && data[i + 2] > 30) count += 1;
      return count;
    });
    await page.evaluate(() => belvedere.choose("look"));
    const before = await edges();
    await page.keyboard.press("o");
    await page.waitForFunction(() => belvedere.cloud.outlines?.length === 3 && location.hash.includes("edges=yes"));
    await settled(page);
    const shown = await edges();
    assert.ok(shown > before + 500, `${before}, ${shown}`);
    assert.match(await page.textContent("#legend"), /edge of a roof/);
    await page.mouse.click(...roof);
    await page.waitForFunction(() => /Plane of the roof/.test(document.querySelector("#card").innerText));
    // the same as the command finds
    execFileSync(program, ["surfaces", "town/cloud.laz", "-o", "found.geojson"], { cwd: folder, stdio: "ignore" });
    const slopes = JSON.parse(readFileSync(join(folder, "found.geojson"))).features.map(({ properties }) => properties.slope_deg?.toFixed(1));
    const [, slope] = /slope ([\d.]+)°/.exec(await text(page));
    assert.ok(slopes.includes(slope), `${slope} of ${slopes}`);
    await page.click("#outlines");
    await settled(page);
    assert.ok((await edges()) < before + 100, "they go again");
  });
  await step("sun hours of an area", async () => {
    const [x, y] = ground;
    await page.click("#tools [data-tool=sun_area]");
    await settled(page);
    for (const place of [[x, y], [x + 60, y], [x + 40, y + 40]]) await page.mouse.click(...place);
    await page.keyboard.press("Enter");
    await answered(page);
    assert.match(await text(page), /hours of sun[\s\S]*Ground in the area/);
  });
  await step("a plan: a building is drawn, and what it changes is shown", async () => {
    const [x, y] = ground;
    await page.keyboard.press("Escape");
    await page.keyboard.press("0");
    await settled(page);
    for (const place of [[x - 20, y], [x + 30, y + 4], [x + 34, y + 34], [x - 16, y + 30]]) await page.mouse.click(...place);
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => belvedere.planned);
    assert.match(await text(page), /Building 1[\s\S]*town\/cloud\.laz --add planned\.obj/);
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-file='0']")]);
    const obj = readFileSync(await download.path(), "utf8");
    assert.match(obj, /^v 15\d+\S* 46\d+\S* /m);
    // the same as a file beside it, higher
    writeFileSync(join(folder, "tower.obj"), obj.replaceAll(/^(v \S+ \S+) (\S+)$/gm, (_, xy, z) => `${xy} ${Number(z) + 10}`));
    await page.setInputFiles("#meshfile", join(folder, "tower.obj"));
    await page.waitForFunction(() => belvedere.planned?.triangles.length === 2 * 12 * 9);
    await page.selectOption("#when", "change");
    await ask("shadow", [], /points lose the sun[\s\S]*before\.laz[\s\S]*--add planned\.obj --add tower\.obj[\s\S]*after\.laz/);
    await settled(page);
    assert.ok(await pixels(page, [31, 95, 191]) > 20, "what loses the sun is blue");
    await page.evaluate(() => { belvedere.last = null; belvedere.setWhen("before"); });
    await answered(page);
    assert.match(await text(page), /% is lit/);
    assert.doesNotMatch(await text(page), /--add/);
    await page.keyboard.press("0");
    for (let i = 0; i < 2; i++) {
      await page.click("[data-remove]");
      await page.waitForFunction((left) => document.querySelectorAll("[data-remove]").length === left, 1 - i);
    }
    assert.equal(await page.evaluate(() => belvedere.planned), null);
  });
  await step("everything by keyboard", async () => {
    await page.keyboard.press("Escape");
    await page.keyboard.press("t");
    await page.keyboard.press("2");
    await settled(page);
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
  await step("in the language of the browser, or in one that is chosen", async () => {
    const dutch = await open(browser, url, { ...DESK, locale: "nl-NL" });
    await ready(dutch);
    await answered(dutch);
    const said = await text(dutch);
    assert.match(said, new RegExp(`\\d+,\\d % ${nl.texts["{0} is lit"].replace("{0} ", "")}`), said);
    assert.ok(said.includes(nl.remarks["targets-near-edge"].split("{percent} %) ")[1]), said);
    assert.equal(await dutch.evaluate(() => document.documentElement.lang), "nl");
    // all that is seen of the bar and the questions is of the table
    const seen = await dutch.evaluate(() => [...document.querySelectorAll("#bar button, #bar option:not([value^=result]), #tools button span, #tools h2")].map(({ textContent }) => textContent.trim()));
    const known = new Set(Object.values(nl.texts));
    assert.deepEqual(seen.filter((one) => !known.has(one)), []);
    await dutch.click("#help");
    await dutch.selectOption("#keys select", "fr");
    await ready(dutch);
    await answered(dutch);
    assert.equal(await dutch.evaluate(() => document.querySelector("#tools h2").textContent), fr.texts.Questions);
    await dutch.close();
  });
  await step("nothing is cut off, in four languages on three screens", async () => {
    for (const locale of ["en-GB", "nl-NL", "de-DE", "fr-FR"]) {
      const shown = await open(browser, url, { ...DESK, locale });
      await ready(shown);
      await answered(shown);
      assert.deepEqual(await unfitting(shown, answered), [], locale);
      await shown.close();
    }
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
    await answered(tablet);
    await tablet.evaluate(() => belvedere.choose("look"));
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
  await step("a phone: the view stays free, and all of the scene is in it", async () => {
    const phone = await open(browser, url, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    await ready(phone);
    await answered(phone);
    await settled(phone);
    await phone.evaluate(() => belvedere.complete(60_000));
    const { top, bottom, seen } = await phone.evaluate(() => ({
      top: document.getElementById("tools").getBoundingClientRect().bottom, bottom: document.getElementById("card").getBoundingClientRect().top,
      seen: belvedere.cloud.chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => belvedere.onScreen([0, 1, 2].map((k) => low[k] + places[4 * i + k] * step[k])))),
    }));
    assert.ok(bottom - top > 0.4 * 844, `${bottom - top} pixels are free`);
    assert.ok(seen.every(([x, y]) => x >= 0 && x <= 390 && y >= top && y <= bottom), "all of the scene is between the questions and the answer");
    await phone.close();
  });
  await step("two tabs", async () => {
    const other = await open(browser, url);
    await ready(other);
    await answered(other);
    await other.keyboard.press("Escape");
    await other.keyboard.press("h");
    await other.evaluate(() => belvedere.complete(60_000));
    await other.click("#tools [data-tool=seen]");
    await other.mouse.click(...ground);
    await answered(other);
    // a plan is that of its tab, also when it is loaded again
    const [low] = await other.evaluate(() => [belvedere.toFile(belvedere.scene.low)]);
    await other.evaluate(([x, y, z]) => belvedere.changePlan((plan) => plan.buildings.push({ corners: [[x + 20, y + 20], [x + 30, y + 20], [x + 30, y + 30]], base: z, height_m: 9 })), low);
    await other.reload();
    await ready(other);
    await other.waitForFunction(() => belvedere.planned?.triangles.length === 8 * 9);
    assert.equal(await page.evaluate(() => belvedere.planned), null);
    await other.close();
  });
  await step("a refusal is in words", async () => {
    await page.evaluate(() => { document.getElementById("zone").value = "Mars"; belvedere.time.zone = "Mars"; belvedere.choose("shadow"); });
    await page.waitForFunction(() => /No answer[\s\S]*Mars/.test(document.getElementById("card").innerText));
  });
  await step("an empty date and a click beside the cloud are answered in words", async () => {
    await page.keyboard.press("Escape");
    await page.keyboard.press("h");
    await page.evaluate(() => belvedere.complete(60_000));
    await page.evaluate(() => { belvedere.time.zone = "Europe/Amsterdam"; document.getElementById("zone").value = "Europe/Amsterdam"; belvedere.choose("sun"); });
    await page.fill("#date", "");
    await page.dispatchEvent("#date", "change");
    await settled(page);
    await page.mouse.click(...roof);
    await page.waitForFunction(() => /date is missing[\s\S]*Choose a day/.test(document.getElementById("card").innerText));
    await page.fill("#date", "2026-06-21");
    await page.dispatchEvent("#date", "change");
    await page.evaluate(() => belvedere.choose("seen"));
    await settled(page);
    const empty = await page.evaluate(() => {
      for (let y = 80; y < 600; y += 10) for (let x = 320; x < 860; x += 10) if (!belvedere.placeAt(x, y)) return [x, y];
      return null;
    });
    assert.ok(empty, "there is a place without points");
    await page.mouse.click(...empty);
    await page.waitForFunction(() => /no point of the cloud[\s\S]*Click on a point/.test(document.getElementById("message").innerText));
    assert.equal(await page.evaluate(() => belvedere.places.length), 0);
  });
  await step("a steep scene is shown whole", async () => {
    // a slope of 45 degrees, and a mast on its upper end
    const rows = Array.from({ length: 10_000 }, (_, i) => [2 * (i % 100), 2 * Math.floor(i / 100), 2 * Math.floor(i / 100)]);
    rows.push([100, 198, 320]);
    writeFileSync(join(folder, "slope.xyz"), `${rows.map((row) => row.join(" ")).join("\n")}\n`);
    const { url: other } = await serve("slope.xyz");
    const shown = await open(browser, other);
    await shown.waitForFunction(() => window.belvedere?.isLoaded && belvedere.frames > 0);
    for (const button of ["#home", "#top"]) {
      await shown.click(button);
      await settled(shown);
      const tools = await shown.evaluate(() => document.getElementById("tools").getBoundingClientRect().right);
      const [left, top, right, bottom, bar] = await shown.evaluate(() => {
        const seen = belvedere.cloud.chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => belvedere.onScreen([0, 1, 2].map((k) => low[k] + places[4 * i + k] * step[k]))));
        if (seen.includes(null)) return [-1, -1, -1, -1, 0];
        const of = (axis, choose) => seen.reduce((v, at) => choose(v, at[axis]), seen[0][axis]);
        return [of(0, Math.min), of(1, Math.min), of(0, Math.max), of(1, Math.max), document.getElementById("bar").offsetHeight];
      });
      assert.ok(left >= tools && right <= 1280 && top >= bar && bottom <= 720 - 34, `${button}: ${[left, top, right, bottom, bar]}`);
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
    assert.match(command, /belvedere viewshed cloud\.laz --observer 155000,463000 -o seen\.laz/);
    await alone.selectOption("#viewpoint", "1");
    await alone.waitForFunction((before) => belvedere.last.visible > before && belvedere.marks.length === 2, first);
    await settled(alone);
    assert.ok(await pixels(alone, [255, 176, 0]) > 500, "visible points are orange");
    await alone.keyboard.press("3");
    await answered(alone);
    assert.match(await text(alone), /% is lit[\s\S]*belvedere shadow cloud\.laz --time 2026-06-21T/);
    const noon = await alone.evaluate(() => belvedere.last.lit_share);
    for (let i = 0; i < 7; i++) await alone.keyboard.press(">");
    await alone.waitForFunction((before) => belvedere.last.lit_share < before - 0.1, noon);
    await alone.close();
  });
  await step("a lost connection is in words", async () => {
    child.kill("SIGKILL");
    await page.waitForFunction(() => /connection to Belvedere is lost/.test(document.getElementById("message").innerText));
  });
  await step("results of other commands are shown", async () => {
    execFileSync(program, ["shadow", "town/cloud.laz", "--time", "2026-06-21T17:00", "--zone", "Europe/Amsterdam", "--cell", "1", "-o", "lit.tif"], { cwd: folder, stdio: "ignore" });
    writeFileSync(join(folder, "walk.geojson"), JSON.stringify({ type: "LineString", coordinates: [[154980, 462990], [155010, 463010]] }));
    const { url: other } = await serve("town/cloud.laz", "lit.tif", "walk.geojson");
    const shown = await open(browser, other);
    await ready(shown);
    await shown.waitForFunction(() => belvedere.shownResult && belvedere.cloud.meshes?.length === 1);
    await settled(shown);
    assert.match(await shown.evaluate(() => document.getElementById("legend").innerText), /lit\.tif/);
    assert.ok(await pixels(shown, [255, 176, 0]) > 500, "cells in the sun are orange");
    await shown.selectOption("#color", "class");
    await settled(shown);
    assert.ok(await pixels(shown, [255, 176, 0]) < 200, "the raster is gone");
    await shown.close();
  });
  await step("a report says what the program printed, fits screens, and prints on A4 in four languages", async () => {
    const corners = [[-6, -6], [6, -6], [6, 6], [-6, 6]].map(([x, y]) => [155000 + x, 463000 + y]);
    const vertices = [0, 30].flatMap((z) => corners.map((corner) => `v ${corner.join(" ")} ${z}`)).join("\n");
    writeFileSync(join(folder, "tower.obj"), `o tower\n${vertices}\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n`);
    writeFileSync(join(folder, "panes.csv"), "x,y,z,azimuth,name,room\n155000,463014,8,180,A window with a name that is rather long,A large living room\n154986,463000,6,90,,A large living room\n");
    const area = ["--area", "155008,463008 155016,463008 155016,463016 155008,463016", "--rule", "nl-strict", "--zone", "Europe/Amsterdam"];
    for (const language of ["en", "nl", "de", "fr"]) {
      const words = ["report", "town/cloud.laz", "--windows", "panes.csv", "--add", "tower.obj", ...area, "--language", language, "-o", `${language}.html`];
      const said = execFileSync(program, words, { cwd: folder, stdio: ["ignore", "pipe", "ignore"] }).toString();
      const report = await browser.newPage();
      report.on("request", (request) => { if (!/^(file|data):/.test(request.url())) problems.push(`the report fetches ${request.url()}`); });
      for (const width of [390, 768, 1280]) {
        await report.setViewportSize({ width, height: 800 });
        await report.goto(`file://${folder}/${language}.html`);
        assert.equal(await report.evaluate(() => Math.max(0, document.documentElement.scrollWidth - innerWidth)), 0, `${language} overflows ${width} pixels`);
      }
      const shown = await report.innerText("main");
      if (language === "en") for (const line of said.split("\n").filter((line) => line && !line.startsWith("written"))) assert.ok(shown.includes(line), `${line} is not in the report`);
      // the width of A4 between its margins, at 96 pixels an inch
      await report.emulateMedia({ media: "print" });
      await report.setViewportSize({ width: 680, height: 1000 });
      const wide = await report.evaluate(() => [...document.querySelectorAll("table, svg, figure")].filter((part) => part.getBoundingClientRect().right > innerWidth + 1 || part.scrollWidth > part.clientWidth + 1).map((part) => part.outerHTML.slice(0, 80)));
      assert.deepEqual(wide, [], `${language} is cut on paper`);
      const printed = (await report.pdf({ preferCSSPageSize: true })).toString("latin1");
      const pages = printed.match(/\/Type\s*\/Page[^s]/g).length;
      assert.ok(pages >= 4 && pages <= 7, `${pages} pages`);
      assert.match(printed, /\/MediaBox\s*\[\s*0 0 59[45][.\d]* 84[12]/);
      await report.close();
    }
  });
  await step("own colours of points", async () => {
    const rows = Array.from({ length: 2500 }, (_, i) => `${(i % 50) / 5} ${Math.floor(i / 50) / 5} ${i % 50 < 25 ? 0 : 3} ${i % 50 < 40 ? "220 30 200" : "30 200 40"}`);
    const head = `ply\nformat ascii 1.0\nelement vertex ${rows.length}\n${["x", "y", "z"].map((name) => `property float ${name}\n`).join("")}${["red", "green", "blue"].map((name) => `property uchar ${name}\n`).join("")}end_header\n`;
    writeFileSync(join(folder, "colored.ply"), `${head}${rows.join("\n")}\n`);
    const { url: other } = await serve("colored.ply");
    const shown = await open(browser, other);
    await shown.waitForFunction(() => window.belvedere?.isLoaded && belvedere.loaded[0].chunk.geometry.getAttribute("rgb565"));
    assert.ok(await pixels(shown, [220, 30, 200]) > 500, "points have their colours");
    assert.equal(await shown.evaluate(() => document.getElementById("color").value), "color");
    await shown.close();
    // one colour for all tells nothing
    writeFileSync(join(folder, "grey.ply"), `${head}${rows.map((row) => row.replace(/ \d+ \d+ \d+$/, " 40 40 40")).join("\n")}\n`);
    const { url: third } = await serve("grey.ply");
    const grey = await open(browser, third);
    await grey.waitForFunction(() => window.belvedere?.isLoaded);
    await grey.evaluate(() => belvedere.colorsKnown);
    assert.deepEqual(await grey.evaluate(() => [belvedere.scene.has_color, document.getElementById("color").value, document.querySelector("#color [value=color]")]), [true, "height", null]);
    await grey.close();
  });
  await step("a cloud on its side without a unit is read as it is chosen", async () => {
    // level ground of 12 by 12 m with a block of 4 by 4 by 3 m, y up, in centimetres
    const rows = Array.from({ length: 3600 }, (_, i) => {
      const [x, z] = [(i % 60) / 5, Math.floor(i / 60) / 5];
      const isBlock = x >= 4 && x < 8 && z >= 4 && z < 8;
      return `${100 * x} ${isBlock ? 300 : 0} ${-100 * z}`;
    });
    writeFileSync(join(folder, "turned.xyz"), `${rows.join("\n")}\n`);
    const { url: other } = await serve("turned.xyz");
    const shown = await open(browser, other);
    await ready(shown);
    const height = () => shown.evaluate(() => belvedere.scene.high[2] - belvedere.scene.low[2]);
    await shown.waitForFunction(() => document.querySelector("#card #up"));
    assert.match(await text(shown), /Y looks up in this cloud[\s\S]*Read it with y up[\s\S]*Unit, which the files do not name/);
    assert.ok(Math.abs(await height() - 1180) < 0.1, "as it is read first");
    await shown.click("#up");
    await shown.waitForFunction(() => window.belvedere?.reading?.up === "y");
    await ready(shown);
    assert.ok(Math.abs(await height() - 300) < 0.1, "y is up");
    const seen = async (file, expected) => {
      await shown.click("#tools [data-tool=seen]");
      await shown.evaluate((file) => belvedere.pick(file.map((v, i) => v * belvedere.scene.metres_per_unit[i] - belvedere.scene.origin[i])), file);
      await shown.waitForFunction((words) => new RegExp(words).test(document.getElementById("card").innerText), expected);
    };
    // remarks go along in one file, no folder does
    execFileSync(program, ["view", join(folder, "turned.xyz"), "--export", "turned.html"], { cwd: folder, stdio: "ignore" });
    const sent = readFileSync(join(folder, "turned.html"), "utf8");
    assert.match(sent, /"key":"y-looks-up"/);
    assert.ok(!sent.includes(folder), "the folder of the sender stays out");
    // points are 20 m apart, so that the ground beside the block is unknown
    await seen([380, 600, 0], "No answer[\\s\\S]*Read it with z up[\\s\\S]*Unit, which the files do not name");
    await shown.selectOption("#unit", "centimetre");
    await shown.waitForFunction(() => window.belvedere?.reading?.unit === "centimetre");
    await ready(shown);
    assert.ok(Math.abs(await height() - 3) < 0.001, "in metres");
    await seen([60, 440, 0], "is visible[\\s\\S]*belvedere viewshed turned\\.xyz --up y --crs 'LOCAL_CS");
    await shown.close();
  });
  await step("who walks stands on the ground before walls without holes", async () => {
    // ground of 20 by 20 m with a hole in its middle, and a wall of which a third of the points is missing
    const rows = [];
    for (let i = 0; i < 80; i++) for (let k = 0; k < 80; k++) {
      const [x, y] = [i / 4 - 10, k / 4 - 10];
      if (Math.max(Math.abs(x), Math.abs(y)) > 2) rows.push(`${155000 + x} ${463000 + y} 0`);
      if (k < 24 && (i * 7919 + k * 104729) % 97 % 3) rows.push(`${155000 + x} 463009.8 ${k / 4}`);
    }
    writeFileSync(join(folder, "wall.xyz"), `${rows.join("\n")}\n`);
    const { url: other } = await serve("wall.xyz", "--crs", "EPSG:28992");
    const shown = await open(browser, other);
    await ready(shown);
    await shown.evaluate(() => belvedere.choose("look"));
    await shown.selectOption("#motion", "walk");
    const eye = await shown.evaluate(() => belvedere.toFile(belvedere.mover.camera.position.toArray()));
    assert.ok(Math.abs(eye[2] - 1.7) < 0.05, `the eye is ${eye[2]} m above the ground`);
    // dark below, where no sky is
    await shown.selectOption("#color", "height");
    const holes = await shown.evaluate(async () => {
      const { camera } = belvedere.mover;
      const local = ([x, y, z]) => [155000 + x, 463000 + y, z].map((v, i) => v - belvedere.scene.origin[i]);
      camera.position.set(...local([0, 2.5, 1.7]));
      camera.lookAt(...local([0, 9.8, 1.7]));
      belvedere.mover.changed();
      await belvedere.complete(60_000);
      const [[left, top], [right, bottom]] = [[-3, 9.8, 3.5], [3, 9.8, 1]].map((place) => belvedere.onScreen(local(place)).map(Math.round));
      const from = document.getElementById("view");
      const context = Object.assign(document.createElement("canvas"), { width: from.width, height: from.height }).getContext("2d");
      context.drawImage(from, 0, 0);
      const { data } = context.getImageData(left, top, right - left, bottom - top);
      let sky = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i] > 190) sky += 1;
      return sky / (data.length / 4);
    });
    assert.ok(holes < 0.002, `${holes} of the wall are holes`);
    await shown.close();
  });
  await step("the reference system is chosen in the card of the cloud", async () => {
    const { url: other } = await serve("wall.xyz");
    const shown = await open(browser, other);
    await ready(shown);
    await shown.click("#crs");
    assert.match(await text(shown), /Reference system\s*no reference system[\s\S]*Size\s*19\.8 m/);
    await shown.fill("#system-typed", "EPSG:1");
    await shown.click("#system button");
    await shown.waitForFunction(() => /EPSG:1/.test(document.getElementById("message").innerText));
    await shown.fill("#system-typed", "EPSG:28992");
    await shown.click("#system button");
    await shown.waitForFunction(() => window.belvedere?.reading?.crs === "EPSG:28992");
    await ready(shown);
    await shown.click("#tools [data-tool=shadow]");
    await answered(shown);
    assert.match(await text(shown), /belvedere shadow wall\.xyz --crs EPSG:28992/);
    await shown.close();
  });
  await step("a bad file is in words", async () => {
    writeFileSync(join(folder, "bad.laz"), "LASF, but no more");
    const bad = await serve("bad.laz");
    const shown = await open(browser, bad.url);
    await shown.waitForFunction(() => /bad\.laz/.test(document.getElementById("message").innerText));
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
