// The module answers as the program does: every part and every question, byte for byte. Numbers of heads may differ by
// 1e-9, since sine and cosine come from the platform. Usage: equal.mjs ENGINE PROGRAM CLOUD[=CRS]...
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { basename } from "node:path";
import { createInterface } from "node:readline";
import { moduleOf } from "./module.mjs";

const [engine, program, ...clouds] = process.argv.slice(2);
const HEADS = 1e-9;

const split = (bytes) => {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))), bytes.subarray(4 + length)];
};
function assertNear(a, b, where) {
  if (typeof a === "number" && typeof b === "number") assert.ok(Math.abs(a - b) <= HEADS * Math.max(1, Math.abs(a)), `${where}: ${a} and ${b}`);
  else if (a && b && typeof a === "object" && typeof b === "object") {
    // in any order
    assert.deepEqual(Object.keys(a).sort(), Object.keys(b).sort(), where);
    for (const key of Object.keys(a)) assertNear(a[key], b[key], `${where}.${key}`);
  } else assert.equal(a, b, where);
}
const same = (a, b) => Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), Buffer.from(b.buffer, b.byteOffset, b.byteLength)) === 0;

async function programOf(cloud, crs) {
  const child = spawn(program, ["view", cloud, ...(crs ? ["--crs", crs] : []), "--no-browser"], { stdio: ["ignore", "pipe", "ignore"] });
  process.on("exit", () => child.kill());
  const [url] = await new Promise((found) => createInterface({ input: child.stdout }).once("line", (line) => found([line])));
  let state;
  do {
    await new Promise((go) => setTimeout(go, 300));
    state = await (await fetch(`${url}state`)).json();
    assert.equal(state.failure, null);
  } while (!state.scene);
  return { child, url, state };
}

// Questions of a cloud: places are taken from the points of its first part.
function questions(state, points) {
  const { low, step } = state.shown.chunks[0];
  const origin = state.shown.origin;
  const units = state.shown.metres_per_unit;
  const row = (i) => {
    const steps = new Uint16Array(points.slice(8 * i, 8 * i + 6).buffer);
    return { local: [0, 1, 2].map((axis) => low[axis] + steps[axis] * step[axis]), code: points[8 * i + 6] };
  };
  const rows = Array.from({ length: Math.min(points.length / 8, 20_000) }, (_, i) => row(i));
  const file = (local, above = 0) => [0, 1, 2].map((axis) => (local[axis] + (axis === 2 ? above : 0) + origin[axis]) / units[axis]);
  const byHeight = [...rows].sort((a, b) => a.local[2] - b.local[2]);
  const ground = (rows.filter(({ code }) => code === 2).length ? rows.filter(({ code }) => code === 2) : byHeight.slice(0, 200));
  const roofs = rows.filter(({ code }) => code === 6).sort((a, b) => b.local[2] - a.local[2]);
  const [a, b] = [ground[0], ground[Math.floor(ground.length / 2)]];
  const on = { zone: "Europe/Amsterdam" };
  const [x, y] = file(a.local);
  const square = (side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
  const all = [
    ["ask/shadow", { time: "2026-06-21T09:00", ...on, points: "sample" }],
    ...["2026-06-21T09:00", "2026-06-21T18:00", "2026-12-21T12:00"].map((time) => ["ask/shadow", { time, ...on }]),
    ["ask/shadow", { time: "2026-06-21T15:00", ...on, trees: "seasons" }],
    ["ask/shadow", { time: "2026-06-21T01:00", ...on }],
    ["ask/seen", { place: file(a.local, 1.7) }],
    ["ask/seen", { place: file(b.local, 1.7), points: "sample" }],
    ["ask/line", { observer: file(a.local, 1.7), target: file(b.local, 1.7) }],
    ["ask/sun", { place: file(a.local, 0.3), date: "2026-03-20", ...on }],
    ["ask/around", { place: file(b.local, 1.7) }],
    ["ask/who", { place: file(byHeight.at(-1).local, 0.5) }],
    ...[0, 1, 2].map((part) => roofs[Math.floor((part * roofs.length) / 3)]).filter(Boolean).map(({ local }) => ["ask/roof", { place: file(local) }]),
    ["ask/sun_area", { corners: square(12), date: "2026-06-21", ...on }],
    ["ask/plan", { clear: [], buildings: [{ corners: square(10), base: file(a.local)[2], height_m: 9 }], meshes: [] }],
    ["plans/1/ask/shadow", { time: "2026-06-21T15:00", ...on }],
    ["plans/1/ask/line", { observer: file(a.local, 1.7), target: file(b.local, 1.7) }],
    ["ask/nothing", {}],
    ["plans/9/ask/line", { observer: [0, 0, 0], target: [0, 0, 1] }],
  ];
  return all;
}

const module = await moduleOf(engine);
const foreign = module.imports.filter(({ module: from, name }) => !(from === "host" && ["read", "reply", "stage", "tick", "failed", "spawn"].includes(name)) && !(from === "env" && name === "memory"));
// what a crate that reads clocks brings along is never called: module.mjs would throw
assert.ok(foreign.every(({ module: from }) => from.startsWith("__wbindgen")), JSON.stringify(foreign));

// All that the program says of a cloud, and then nothing more: while the module computes, connections would time out.
async function ofProgram(cloud, crs) {
  const { child, url, state } = await programOf(cloud, crs);
  const get = async (path) => new Uint8Array(await (await fetch(url + path)).arrayBuffer());
  const { chunks, has_color: hasColor } = state.shown;
  const parts = [];
  for (const path of ["balls", ...chunks.flatMap((_, i) => [`points/${i}`, ...(hasColor ? [`colors/${i}`] : [])])]) parts.push([path, await get(path)]);
  const answers = [];
  for (const [path, values] of questions(state, parts.find(([name]) => name === "points/0")[1])) {
    const body = JSON.stringify(values);
    const response = await fetch(url + path, { method: "POST", headers: { "Content-Type": "application/json" }, body });
    answers.push({ path, body, isRefused: !response.ok, bytes: new Uint8Array(await response.arrayBuffer()) });
  }
  child.kill();
  return { state, parts, answers };
}

for (const named of clouds) {
  const [cloud, crs] = named.split("=");
  const native = await ofProgram(cloud, crs);
  const from = performance.now();
  const own = await moduleOf(engine);
  const opened = own.json("open", JSON.stringify({ files: [own.add(cloud)], crs, max_points: 1e7 }));
  const read = performance.now();
  const state = own.json("build");
  const built = performance.now();
  own.call("prepare");
  const prepared = performance.now();
  assertNear(native.state.shown, state.shown, "state.shown");
  assertNear(native.state.scene, state.scene, "state.scene");
  assert.equal(opened.scene, null);
  for (const [path, bytes] of native.parts) assert.ok(same(bytes, own.call("ask", path, "").bytes), `${path} differs`);
  let bytes = 0;
  const refusals = [];
  const text = (value) => new TextDecoder().decode(value);
  for (const { path, body, isRefused, bytes: reply } of native.answers) {
    const answer = own.call("ask", path, body);
    if (answer.refused || isRefused) {
      refusals.push(path);
      assert.equal(answer.refused && text(answer.bytes), isRefused && JSON.parse(text(reply)).error, path);
      continue;
    }
    const [[head, values], [ownHead, ownValues]] = [reply, answer.bytes].map(split);
    // the program names the path that was typed
    assertNear(JSON.parse(JSON.stringify(head).replaceAll(cloud, basename(cloud))), ownHead, path);
    assert.ok(same(values, ownValues), `${path} ${body}: the values differ`);
    bytes += ownValues.length;
  }
  own.close();
  const seconds = (a, b) => ((b - a) / 1000).toFixed(1);
  console.log(`${basename(cloud)}: ${state.shown.point_count} points, ${state.scene.ball_count} balls, ${bytes} bytes of answers are the same, and refusals of ${refusals.join(", ")}; read ${seconds(from, read)} s, built ${seconds(read, built)} s, prepared ${seconds(built, prepared)} s, ${own.megabytes().toFixed(0)} MB`);
}
