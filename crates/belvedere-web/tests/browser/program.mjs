// What the program answers for a cloud, to be compared with.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";

export const split = (bytes) => {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))), bytes.subarray(4 + length)];
};
async function programOf(program, cloud, crs) {
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
    ["ask/shadow", { time: "2026-06-21T18:00", ...on, points: "sample", probability: true }],
    ["ask/seen", { place: file(a.local, 1.7), points: "sample", probability: true }],
    ["ask/seen", { place: file(a.local, 1.7) }],
    ["ask/seen", { place: file(b.local, 1.7), points: "sample" }],
    ["ask/line", { observer: file(a.local, 1.7), target: file(b.local, 1.7) }],
    ["ask/daylight", { time: "2026-11-27T16:50", ...on }],
    ["ask/sun", { place: file(a.local, 0.3), date: "2026-03-20", ...on }],
    ["ask/around", { place: file(b.local, 1.7) }],
    ["ask/who", { place: file(byHeight.at(-1).local, 0.5) }],
    ...[0, 1, 2].map((part) => roofs[Math.floor((part * roofs.length) / 3)]).filter(Boolean).map(({ local }) => ["ask/roof", { place: file(local) }]),
    ["ask/surfaces", {}],
    ...roofs.slice(0, 1).map(({ local }) => ["ask/surfaces", { place: file(local) }]),
    ["ask/sun_area", { corners: square(12), date: "2026-06-21", ...on }],
    ["ask/plan", { clear: [], buildings: [{ corners: square(10), base: file(a.local)[2], height_m: 9 }], meshes: [] }],
    ["plans/1/ask/shadow", { time: "2026-06-21T15:00", ...on }],
    ["plans/1/ask/line", { observer: file(a.local, 1.7), target: file(b.local, 1.7) }],
    ["ask/nothing", {}],
    ["plans/9/ask/line", { observer: [0, 0, 0], target: [0, 0, 1] }],
  ];
  return all;
}

// All that the program says of a cloud, and then nothing more: while the module computes, connections would time out.
export async function ofProgram(program, cloud, crs) {
  const { child, url, state } = await programOf(program, cloud, crs);
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
