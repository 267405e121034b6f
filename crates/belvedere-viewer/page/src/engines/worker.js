// The same questions, answered inside this browser: a worker holds the scene, and nothing leaves the computer.
import { t } from "../words.js";
import { Lost, Refused, split } from "./reply.js";

const STOPPED = t`The scene is lost: this tab has run out of memory, or Belvedere failed. Open the file again, or a smaller part of it.`;

let worker = null;
let lost = null;
const EMPTY = { title: "", stage: "", total: 0, done: 0, failure: null, remarks: [], mesh_count: 0, results: [], shown: null, scene: null };
let state = { ...EMPTY };
// where the worker counts what is done while it computes
let counter = null;
const parts = new Map();
// questions that wait: one at a time is with the worker, so that one that nobody waits for any more is not sent
const waiting = [];
let current = null;

// A part of what is drawn, which comes when it is ready.
function partOf(path) {
  if (!parts.has(path)) {
    let give;
    const promise = new Promise((resolve) => { give = resolve; });
    parts.set(path, { promise, give });
  }
  return parts.get(path);
}
function next() {
  if (current) return;
  current = waiting.shift() ?? null;
  if (!current) return;
  if (current.signal?.aborted) {
    current.reject(new DOMException("nobody waits for it", "AbortError"));
    current = null;
    return next();
  }
  worker.postMessage({ ask: { path: current.path, body: current.body } });
}
function send(path, body, signal) {
  if (lost) return Promise.reject(lost);
  return new Promise((resolve, reject) => {
    waiting.push({ path, body, signal, resolve, reject });
    next();
  });
}
function lose(text) {
  console.error(text);
  lost = new Lost(STOPPED);
  if (!state.scene) state.failure = STOPPED;
  for (const question of [current, ...waiting]) question?.reject(lost);
  waiting.length = 0;
  current = null;
}
function heard({ data }) {
  if (data.state) state = { ...data.state, stage: state.stage, total: state.total, done: state.done };
  if (data.stage !== undefined) Object.assign(state, { stage: data.stage, total: data.total, done: 0 });
  if (data.done !== undefined) state.done = data.done;
  if (data.counter) counter = new Uint32Array(data.counter.memory.buffer, data.counter.at, 1);
  if (data.part) partOf(data.part).give(data.bytes);
  if (data.tooMany) whenTooMany(data.tooMany);
  if (data.failure) state.failure = data.failure;
  if (data.lost) lose(data.lost);
  if (data.reply && current) {
    const { resolve, reject } = current;
    current = null;
    if (data.refused) reject(new Refused(data.refused));
    else resolve(data.reply);
    next();
  }
}

// Opens files that were chosen or dropped, or addresses: `{ name, file }` or `{ name, url }` each. Files with more
// points than fit are not read: `choose` gets their number and their corners.
let whenTooMany = null, opened = null;
export function open(files, options, choose) {
  worker?.terminate();
  state = { ...EMPTY };
  lost = null;
  whenTooMany = choose;
  opened = { files, ...options };
  worker = new Worker("engine-worker.js");
  worker.onmessage = heard;
  worker.onerror = (event) => lose(event.message ?? "the worker ended");
  worker.postMessage({ open: { files, ...options } });
}

// The tiles of a catalogue on the web.
export function tilesOf(url) {
  const reader = new Worker("engine-worker.js");
  return new Promise((found, refuse) => {
    reader.onmessage = ({ data }) => {
      if (data.tiles) found(data.tiles);
      else if (data.failure || data.lost) refuse(new Refused(data.failure ?? STOPPED));
    };
    reader.onerror = () => refuse(new Lost(STOPPED));
    reader.postMessage({ catalogue: url });
  }).finally(() => reader.terminate());
}

export const inBrowser = {
  state: async () => ({ ...state, done: counter ? counter[0] : state.done }),
  part: async (path) => (path === "balls" || path.startsWith("meshes/") ? send(path, "") : partOf(path).promise.then((bytes) => { parts.delete(path); return bytes; })),
  result: async (number) => split(await send(`results/${number}`, "")),
  ask: async (path, values, signal) => split(await send(path, JSON.stringify(values), signal)),
  // files of this computer are forgotten with the page, and are chosen again
  readAgain: async (choice) => {
    const { files: [{ url }], window: corners } = opened;
    const words = { open: url, window: corners?.join(","), ...choice };
    location.hash = new URLSearchParams(Object.entries(words).filter(([, value]) => value));
    location.reload();
  },
  loadMesh: async (file) => split(await send(`plan-meshes/${file.name}`, new Uint8Array(await file.arrayBuffer()))),
};
