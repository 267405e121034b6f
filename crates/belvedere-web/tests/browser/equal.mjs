// The module answers as the program does: every part and every question, byte for byte. Numbers of heads may differ by
// 1e-9, since sine and cosine come from the platform. Usage: equal.mjs ENGINE PROGRAM CLOUD[=CRS]...
import assert from "node:assert/strict";
import { basename } from "node:path";
import { moduleOf } from "./module.mjs";
import { ofProgram, split } from "./program.mjs";

const [engine, program, ...clouds] = process.argv.slice(2);
const HEADS = 1e-9;

function assertNear(a, b, where) {
  if (typeof a === "number" && typeof b === "number") assert.ok(Math.abs(a - b) <= HEADS * Math.max(1, Math.abs(a)), `${where}: ${a} and ${b}`);
  else if (a && b && typeof a === "object" && typeof b === "object") {
    // in any order
    assert.deepEqual(Object.keys(a).sort(), Object.keys(b).sort(), where);
    for (const key of Object.keys(a)) assertNear(a[key], b[key], `${where}.${key}`);
  } else assert.equal(a, b, where);
}
const same = (a, b) => Buffer.compare(Buffer.from(a.buffer, a.byteOffset, a.byteLength), Buffer.from(b.buffer, b.byteOffset, b.byteLength)) === 0;

const module = await moduleOf(engine);
const foreign = module.imports.filter(({ module: from, name }) => !(from === "host" && ["read", "reply", "stage", "tick", "failed", "spawn"].includes(name)) && !(from === "env" && name === "memory"));
// what a crate that reads clocks brings along is never called: module.mjs would throw
assert.ok(foreign.every(({ module: from }) => from.startsWith("__wbindgen")), JSON.stringify(foreign));

for (const named of clouds) {
  const [cloud, crs] = named.split("=");
  const native = await ofProgram(program, cloud, crs);
  const from = performance.now();
  const own = await moduleOf(engine);
  const opened = own.json("open", JSON.stringify({ files: [own.add(cloud)], reading: { crs }, max_points: 1e7 }));
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
