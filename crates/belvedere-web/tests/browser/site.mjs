// Uses the site as people do, in Chromium: the demo, a file that is chosen, one by its address, wrong files, two tabs,
// without threads, without a network. Usage: site.mjs FOLDER PROGRAM BROWSER CLOUD
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, extname, join } from "node:path";
import { ofProgram, split } from "./program.mjs";

const { chromium } = createRequire(new URL("../../../belvedere-viewer/page/", import.meta.url))("playwright-core");
const [site, program, executablePath, cloud] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "belvedere-site-"));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".wasm": "application/wasm" };
const done = [];
const times = [];
const started = Date.now();

// A server of files with ranges; what it sent of clouds is counted.
let sent = 0;
function serve(isolates) {
  const server = createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url, "http://a").pathname).replace(/\/$/, "/index.html");
    const path = name === "/tile.laz" ? cloud : join(site, name);
    let bytes;
    try {
      bytes = name === "/tiles.vpc" ? catalogue : readFileSync(path);
    } catch {
      response.writeHead(404).end();
      return;
    }
    const headers = { "Content-Type": TYPES[extname(path)] ?? "application/octet-stream", "Accept-Ranges": "bytes" };
    if (isolates) Object.assign(headers, { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" });
    const range = /bytes=(\d+)-(\d+)/.exec(request.headers.range ?? "");
    if (range) {
      const [first, last] = [Number(range[1]), Math.min(Number(range[2]), bytes.length - 1)];
      sent += last - first + 1;
      response.writeHead(206, { ...headers, "Content-Range": `bytes ${first}-${last}/${bytes.length}`, "Content-Length": last - first + 1 });
      response.end(bytes.subarray(first, last + 1));
      return;
    }
    response.writeHead(200, { ...headers, "Content-Length": bytes.length });
    response.end(request.method === "HEAD" ? undefined : bytes);
  });
  return new Promise((found) => server.listen(0, "127.0.0.1", () => found([server, `http://127.0.0.1:${server.address().port}/`])));
}
// Two tiles of which one is there, a kilometre from each other.
let catalogue = null;
function catalogueOf({ shown: { origin, low, high, metres_per_unit: units, point_count: count } }) {
  const [west, south, , east, north] = [low, high].flatMap((corner) => corner.map((v, i) => (v + origin[i]) / units[i]));
  const tile = (href, away) => ({ type: "Feature", properties: { "pc:count": count, "proj:bbox": [west + away - 1, south - 1, east + away + 1, north + 1] }, assets: { data: { href } } });
  return Buffer.from(JSON.stringify({ type: "FeatureCollection", features: [tile("./tile.laz", 0), tile("./missing.laz", 1000)] }));
}
const problems = [];
function watched(page, url) {
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("request", (request) => { if (!request.url().startsWith(url) && !/^(blob|data):/.test(request.url())) problems.push(`fetches ${request.url()}`); });
  page.on("console", (message) => { if (/Content.Security|cannot be used/.test(message.text())) problems.push(message.text()); });
  return page;
}
const isReady = () => window.belvedere?.isLoaded && window.belvedere.ready;
// long enough for an engine that was compiled in haste, on a machine that does all else too
const ready = (page) => page.waitForFunction(isReady, null, { timeout: 400_000 });
const message = async (page) => {
  await page.waitForFunction(() => !document.getElementById("message").hidden && document.getElementById("message").innerText, null, { timeout: 20_000 });
  return page.evaluate(() => document.getElementById("message").innerText);
};
async function step(name, work) {
  await work();
  done.push(name);
}
// Points that are lit, and a number that tells all answers apart.
const shadow = async (page) => {
  await page.evaluate(() => { Object.assign(belvedere.time, { date: "2026-06-21", zone: "Europe/Amsterdam", minutes: 1080 }); belvedere.choose("shadow"); });
  await page.waitForFunction(() => belvedere.last?.body && !belvedere.last.isFirst && document.querySelector("#took"), null, { timeout: 200_000 });
  return page.evaluate(async () => {
    const digest = await crypto.subtle.digest("SHA-256", belvedere.last.body);
    return [belvedere.last.lit, [...new Uint8Array(digest)].join()];
  });
};
async function main() {
  const [isolating, url] = await serve(true);
  const [plain, plainUrl] = await serve(false);
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"] });
  const native = await ofProgram(program, cloud);
  const digest = async (bytes) => [...new Uint8Array(await crypto.subtle.digest("SHA-256", bytes))].join();
  // the shadow of the page in the steps below
  const evening = JSON.stringify({ time: "2026-06-21T18:00", zone: "Europe/Amsterdam" });
  const [{ lit }, values] = split(native.answers.find(({ path, body }) => path === "ask/shadow" && body === evening).bytes);
  const expected = [lit, await digest(values)];
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  const page = watched(await context.newPage(), url);
  await page.goto(url);
  const open = async (own, path) => {
    const from = Date.now();
    await own.setInputFiles("#choose", path);
    await ready(own);
    return (Date.now() - from) / 1000;
  };

  await step("a file that is chosen answers as the program does, with threads", async () => {
    assert.ok(await page.evaluate(() => crossOriginIsolated));
    const seconds = await open(page, cloud);
    assert.deepEqual(await shadow(page), expected);
    times.push(`scene with threads ${seconds.toFixed(1)} s`);
  });
  await step("the scene is kept, and found the next time", async () => {
    // its size grows until it is whole
    let [before, size] = [-1, 0];
    for (const until = Date.now() + 200_000; (size < 1000 || size !== before) && Date.now() < until; await page.waitForTimeout(1500)) {
      before = size;
      size = await page.evaluate(async () => {
        const folder = await (await navigator.storage.getDirectory()).getDirectoryHandle("scenes").catch(() => null);
        let sum = 0;
        for await (const handle of folder?.values() ?? []) sum += (await handle.getFile()).size;
        return sum;
      });
    }
    await page.goto("about:blank");
    await page.goto(url);
    await page.waitForFunction(() => !document.getElementById("kept").hidden);
    assert.match(await page.evaluate(() => document.getElementById("kept").innerText), /1 scene is kept/);
    const from = Date.now();
    const seconds = await open(page, cloud);
    assert.deepEqual(await shadow(page), expected);
    // nothing is kept again: it was found, and was whole
    await page.waitForTimeout(3500);
    assert.ok(await page.evaluate(async (from) => {
      const folder = await (await navigator.storage.getDirectory()).getDirectoryHandle("scenes");
      for await (const handle of folder.values()) if ((await handle.getFile()).lastModified > from) return false;
      return true;
    }, from));
    times.push(`the second time ${seconds.toFixed(1)} s`);
    await page.evaluate(async () => (await navigator.storage.getDirectory()).removeEntry("scenes", { recursive: true }));
  });
  await step("with threads every question is answered as by the program", async () => {
    const replies = await page.evaluate(async (questions) => {
      const worker = new Worker("engine-worker.js");
      const next = (wanted) => new Promise((found) => {
        worker.onmessage = ({ data }) => { if (data.lost || data.failure || wanted(data)) found(data); };
      });
      const file = await (await fetch("tile.laz")).blob();
      const isBuilt = next(({ state }) => state?.scene);
      worker.postMessage({ open: { files: [{ name: "tile.laz", file }], max_points: 1e7 } });
      await isBuilt;
      const replies = [];
      for (const { path, body } of questions) {
        const reply = next((data) => data.reply);
        worker.postMessage({ ask: { path, body } });
        const { refused, reply: bytes, lost } = await reply;
        const body_ = bytes && !refused ? new Uint8Array(bytes).slice(4 + new DataView(bytes).getUint32(0, true)) : null;
        replies.push({ refused, lost, sum: body_ && [...new Uint8Array(await crypto.subtle.digest("SHA-256", body_))].join() });
      }
      worker.terminate();
      return replies;
    }, native.answers.map(({ path, body }) => ({ path, body })));
    for (const [i, { path, body, isRefused, bytes }] of native.answers.entries()) {
      if (isRefused) assert.equal(replies[i].refused, JSON.parse(new TextDecoder().decode(bytes)).error, path);
      else assert.equal(replies[i].sum, await digest(split(bytes)[1]), `${path} ${body}: ${JSON.stringify(replies[i])}`);
    }
  });
  await step("without shared memory there is one thread, and the same answer", async () => {
    const alone = await browser.newContext({ viewport: { width: 1280, height: 720 }, serviceWorkers: "block" });
    const own = watched(await alone.newPage(), plainUrl);
    await own.goto(plainUrl);
    assert.ok(!await own.evaluate(() => crossOriginIsolated));
    const seconds = await open(own, cloud);
    assert.deepEqual(await shadow(own), expected);
    times.push(`scene without threads ${seconds.toFixed(1)} s`);
    await alone.close();
  });
  await step("files that are none are refused in words", async () => {
    const own = watched(await context.newPage(), url);
    for (const [name, content, words] of [["broken.laz", "this is no cloud", /broken\.laz/], ["picture.jpg", "abc", /picture\.jpg/]]) {
      writeFileSync(join(folder, name), content);
      await own.goto(url);
      await own.setInputFiles("#choose", join(folder, name));
      assert.match(await message(own), words);
    }
    // and another can be chosen at once
    await own.setInputFiles("#choose", cloud);
    await ready(own);
    assert.deepEqual(await shadow(own), expected);
    await own.click("#open");
    await own.waitForFunction(() => !document.getElementById("start").hidden && !window.belvedere.scene);
    await own.close();
  });
  await step("of too many points a part is chosen", async () => {
    const small = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    // half of a tenth of a GB: room for 71 428 points
    await small.addInitScript(() => Object.defineProperty(navigator, "deviceMemory", { get: () => 0.1 }));
    const own = watched(await small.newPage(), url);
    await own.goto(url);
    await own.setInputFiles("#choose", cloud);
    await own.waitForFunction(() => !document.getElementById("part").hidden, null, { timeout: 60_000 });
    const corners = () => own.evaluate(() => document.querySelector("#part output").textContent);
    const middle = await corners();
    await own.focus("#part svg");
    await own.keyboard.press("ArrowLeft");
    assert.notEqual(await corners(), middle);
    if (process.env.PICTURES) await own.screenshot({ path: join(process.env.PICTURES, "part.png") });
    await own.click("#part button");
    await ready(own);
    const count = await own.evaluate(() => belvedere.scene.point_count);
    assert.ok(count > 20_000 && count <= 71_428, `${count} points`);
    await small.close();
  });
  await step("an address is read by its parts, and can be shared", async () => {
    sent = 0;
    const own = watched(await context.newPage(), url);
    await own.goto(`${url}#open=${encodeURIComponent(`${url}tile.laz`)}`);
    await ready(own);
    assert.deepEqual(await shadow(own), expected);
    const size = statSync(cloud).size;
    // the town has columns of results, which are read in a second pass; see the tile below for what is read of others
    const most = 2 * size + 4 * 65_536;
    assert.ok(sent > 0 && sent <= most, `${sent} bytes were sent, of a file of ${size}`);
    await own.goto("about:blank");
    await own.goto(`${url}#open=${encodeURIComponent(`${url}missing.laz`)}`);
    assert.match(await message(own), /404/);
    await own.close();
  });
  await step("of a catalogue of tiles a part is chosen on the map, and only its tiles are read", async () => {
    catalogue = catalogueOf(native.state);
    const own = watched(await context.newPage(), url);
    await own.goto(`${url}#open=${encodeURIComponent(`${url}tiles.vpc`)}`);
    await own.waitForSelector("#part:not([hidden])");
    assert.match(await own.evaluate(() => document.getElementById("part").innerText), /The catalogue has 2 tiles/);
    // it begins in the middle, where none lies
    await own.click("#part button");
    assert.match(await message(own), /No tile of the catalogue lies there/);
    await own.focus("#part svg");
    for (let i = 0; i < 40; i++) await own.keyboard.press("ArrowLeft");
    await own.click("#part button");
    await ready(own);
    assert.deepEqual(await shadow(own), expected);
    await own.goto("about:blank");
    await own.goto(`${url}#open=${encodeURIComponent(`${url}none.vpc`)}`);
    assert.match(await message(own), /none\.vpc[^]*404/);
    await own.close();
  });
  const [, tile] = /<meta name="tile"[^>]* data-file="([^"]+)"/.exec(readFileSync(join(site, "index.html"), "utf8")) ?? [];
  // without it test-site has said so
  if (tile) await step("a real tile is one click away", async () => {
    const own = watched(await context.newPage(), url);
    await own.goto(url);
    assert.equal(await own.evaluate(() => document.getElementById("tile").innerText), 'Delft "AHN3" (CC0)');
    sent = 0;
    await own.click("#tile");
    await ready(own);
    // beside the chunks of points, each once: blocks around the header, its records, the start of the points, the table
    const size = statSync(join(site, tile)).size;
    assert.ok(sent > 0 && sent <= size + 4 * 65_536, `${sent} bytes were sent, of a file of ${size}`);
    assert.ok(await own.evaluate(() => belvedere.scene.point_count > 200_000 && /7415/.test(belvedere.scene.crs) && belvedere.scene.latitude_deg > 50));
    await own.close();
  });
  await step("a model and a map are shown beside the cloud", async () => {
    const [{ low, high, origin }] = [native.state.shown];
    const middle = low.map((v, i) => (v + high[i]) / 2 + origin[i]);
    const corner = (x, y, z) => `v ${middle[0] + x} ${middle[1] + y} ${middle[2] + z}`;
    writeFileSync(join(folder, "planned.obj"), `${[corner(0, 0, 0), corner(9, 0, 0), corner(0, 9, 9)].join("\n")}\nf 1 2 3\n`);
    const line = [[0, 0], [9, 9]].map(([x, y]) => [middle[0] + x, middle[1] + y]);
    writeFileSync(join(folder, "walk.geojson"), JSON.stringify({ type: "FeatureCollection", features: [{ type: "Feature", properties: {}, geometry: { type: "LineString", coordinates: line } }] }));
    execFileSync(program, ["shadow", cloud, "--sun", "200,40", "--cell", "2", "-o", join(folder, "lit.tif")], { stdio: "ignore" });
    const own = watched(await context.newPage(), url);
    await own.goto(url);
    await own.setInputFiles("#choose", [join(folder, "lit.tif"), join(folder, "planned.obj"), cloud, join(folder, "walk.geojson")]);
    await ready(own);
    await own.waitForFunction(() => belvedere.cloud.meshes?.length === 2 && !document.getElementById("meshes").hidden);
    await own.selectOption("#color", "result 0 0");
    await own.waitForFunction(() => document.getElementById("legend").innerText.includes("lit.tif"), null, { timeout: 60_000 });
    assert.match(await own.evaluate(() => document.getElementById("title").innerText), new RegExp(basename(cloud)));
    await own.close();
  });
  await step("two tabs with the same file", async () => {
    const tabs = await Promise.all([0, 1].map(async () => {
      const own = watched(await context.newPage(), url);
      await own.goto(url);
      await own.setInputFiles("#choose", cloud);
      return own;
    }));
    for (const own of tabs) {
      await ready(own);
      assert.deepEqual(await shadow(own), expected);
      await own.close();
    }
  });
  await step("a server without the headers gives threads too, and no network is needed", async () => {
    const away = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    const own = watched(await away.newPage(), plainUrl);
    await own.goto(plainUrl);
    await own.waitForFunction(() => crossOriginIsolated && navigator.serviceWorker.controller, null, { timeout: 60_000 });
    await away.setOffline(true);
    plain.closeAllConnections();
    plain.close();
    await own.reload();
    await own.click("#demo");
    await ready(own);
    await away.close();
  });

  await browser.close();
  isolating.close();
  assert.deepEqual(problems, []);
  console.log(`the site, ${basename(cloud)}: ${done.length} steps passed in ${((Date.now() - started) / 1000).toFixed(0)} s (${times.join(", ")})`);
}

try {
  await main();
} catch (error) {
  console.error(`the site: ${done.length} steps passed (${done.at(-1) ?? "none"}), then:`);
  console.error(error);
  console.error(problems);
  process.exitCode = 1;
} finally {
  rmSync(folder, { recursive: true, force: true });
  setTimeout(() => process.exit(), 500);
}
