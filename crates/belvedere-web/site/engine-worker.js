// Runs the engine: one worker that owns the scene, and one for each thread of it where the page may share memory.
// Files are read where they are, part by part; nothing is sent anywhere.

const BLOCK = 1 << 18;
const WEB_BLOCK = 1 << 16;
const MAX_BLOCKS = 64;
// scenes that are kept in the browser, all together
const MAX_KEPT_BYTES = 1e9;
// what the module knows the file of a kept scene by
const KEPT = 1 << 20;
const STACK = 1 << 20;
const MAX_THREADS = 8;

const files = new Map();
let engine = null;
let memory = null;
let reply = null;
let isPool = false;
let reportedAt = 0;
let isPrepared = false;
let keepAs = null;
const threads = [];

// ---- what the module needs of its host

const bytesAt = (at, length) => new Uint8Array(memory.buffer, at, length);
// a copy: what is shared cannot be decoded or sent
const copy = (at, length) => bytesAt(at, length).slice();
const textAt = (at, length) => new TextDecoder().decode(copy(at, length));

const host = {
  read: (id, at, to, length) => {
    try {
      // the module gave room for no more than it requested
      const bytes = files.get(id).read(at, length).subarray(0, length);
      bytesAt(to, bytes.length).set(bytes);
      return bytes.length;
    } catch (error) {
      console.error(String(error));
      return -1;
    }
  },
  reply: (at, length) => { reply = copy(at, length); },
  stage: (at, length, total) => {
    reportedAt = performance.now();
    postMessage({ stage: textAt(at, length), total });
  },
  tick: () => {
    // the page itself looks at shared memory
    if (isPool || self.crossOriginIsolated || performance.now() - reportedAt < 150) return;
    reportedAt = performance.now();
    postMessage({ done: new Uint32Array(memory.buffer, engine.progress(), 1)[0] });
  },
  failed: (at, length) => { postMessage({ lost: textAt(at, length) }); },
  spawn: (builder) => { threads.pop().postMessage({ run: builder }); },
};
function importsOf(module) {
  const imports = { host, env: {} };
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    if (from === "env" && name === "memory") imports.env.memory = memory;
    // a crate that reads clocks brings these along; nothing calls them
    else if (from !== "host") (imports[from] ??= {})[name] = () => { throw new Error(`${name} is not there`); };
  }
  return imports;
}

// ---- files

class Blocks {
  constructor(size, side) {
    Object.assign(this, { size, side, kept: new Map() });
  }
  read(at, length) {
    const whole = Math.min(length, this.size - at);
    if (whole >= this.side) return this.wholePart(at, at + whole);
    const number = Math.floor(at / this.side);
    let block = this.kept.get(number);
    if (!block) {
      block = this.wholePart(number * this.side, Math.min((number + 1) * this.side, this.size));
      if (this.kept.size >= MAX_BLOCKS) this.kept.delete(this.kept.keys().next().value);
      this.kept.set(number, block);
    }
    const from = at - number * this.side;
    return block.subarray(from, from + Math.min(whole, this.side - from));
  }
  wholePart(from, to) {
    const bytes = this.part(from, to);
    if (bytes.length !== to - from) throw new Error(`${this.name} gives ${bytes.length} bytes of the ${to - from} from ${from} on: the file is not what it was when it was opened; open it again`);
    return bytes;
  }
}
class LocalFile extends Blocks {
  constructor(file) {
    super(file.size, BLOCK);
    this.name = file.name;
    this.file = file;
    this.reader = new FileReaderSync();
  }
  part(from, to) {
    return new Uint8Array(this.reader.readAsArrayBuffer(this.file.slice(from, to)));
  }
}
class WebFile extends Blocks {
  constructor(url) {
    const head = requested("HEAD", url);
    super(sizeOf(head, url), WEB_BLOCK);
    this.name = shown(url);
    this.url = url;
    this.version = versionOf(head);
  }
  part(from, to) {
    const request = requested("GET", this.url, `bytes=${from}-${to - 1}`);
    if (request.status !== 206) throw new Error(`${this.name} gives no parts of files (HTTP ranges): download the file, and open it from the disk`);
    // what a server of another site does not let pages read is null
    const range = /^bytes (\d+)-(\d+)\/(\d+|\*)$/.exec(request.getResponseHeader("Content-Range") ?? "");
    if (range && (Number(range[1]) !== from || Number(range[2]) !== to - 1)) throw new Error(`${this.name} gives another part than the one that is needed: download the file, and open it from the disk`);
    const version = versionOf(request);
    const isOther = version.some((own, i) => own && this.version[i] && own !== this.version[i]);
    if (isOther || (range && range[3] !== "*" && Number(range[3]) !== this.size)) throw new Error(`${this.name} changed on the server while it was read: open it again`);
    return new Uint8Array(request.response);
  }
}
// A file of the web that is read as a whole.
class WholeFile {
  constructor(url) {
    this.bytes = new Uint8Array(requested("GET", url).response);
    this.size = this.bytes.length;
  }
  read(at, length) {
    return this.bytes.subarray(at, at + length);
  }
}
function requested(method, url, range) {
  const request = new XMLHttpRequest();
  request.open(method, url, false);
  request.responseType = "arraybuffer";
  if (range) request.setRequestHeader("Range", range);
  try {
    request.send();
  } catch {
    throw new Error(`${shown(url)} cannot be read from this page: the server is not there, or it does not allow other pages to read from it (CORS). Download the file, and open it from the disk`);
  }
  if (request.status >= 400) throw new Error(`${shown(url)}: the server answers with ${request.status}`);
  return request;
}
// An address as it is shown: without user, password and key.
function shown(url) {
  const { protocol, host, pathname, username, password, search, hash } = new URL(url);
  return `${protocol}//${host}${pathname}${username || password || search || hash ? "?***" : ""}`;
}
function sizeOf(head, url) {
  const size = Number(head.getResponseHeader("Content-Length"));
  if (!(size > 0)) throw new Error(`${shown(url)}: the server does not tell the size of the file`);
  return size;
}
// What a server calls this version of a file, as far as it lets the page know.
const versionOf = (request) => ["ETag", "Last-Modified"].map((name) => request.getResponseHeader(name));
// A file in the browser's own store.
class KeptFile extends Blocks {
  constructor(handle) {
    super(handle.getSize(), BLOCK);
    this.name = "the scene that was kept";
    this.handle = handle;
  }
  part(from, to) {
    const bytes = new Uint8Array(to - from);
    return bytes.subarray(0, this.handle.read(bytes, { at: from }));
  }
}

// ---- scenes that are kept for the next time

async function kept() {
  try {
    return await (await navigator.storage.getDirectory()).getDirectoryHandle("scenes", { create: true });
  } catch {
    // a private window, or an old browser
    return null;
  }
}
async function makeRoom(folder, bytes) {
  const all = [];
  for await (const handle of folder.values()) all.push([handle.name, await handle.getFile()]);
  all.sort((a, b) => a[1].lastModified - b[1].lastModified);
  let sum = bytes + all.reduce((total, [, file]) => total + file.size, 0);
  for (const [name, file] of all) {
    if (sum <= MAX_KEPT_BYTES) return;
    await folder.removeEntry(name);
    sum -= file.size;
  }
}
async function keep(name) {
  const folder = await kept();
  if (!folder || engine.scene_file() !== 0) return;
  const bytes = reply;
  if (bytes.length > MAX_KEPT_BYTES) return;
  try {
    await makeRoom(folder, bytes.length);
    const handle = await (await folder.getFileHandle(name, { create: true })).createSyncAccessHandle();
    try {
      handle.truncate(0);
      handle.write(bytes, { at: 0 });
      handle.flush();
    } finally {
      handle.close();
    }
    postMessage({ kept: bytes.length });
  } catch (error) {
    // no room, or another tab writes it: the scene is built again next time
    await folder.removeEntry(name).catch(() => {});
    console.warn(`the scene is not kept: ${error}`);
  }
}
// Whether the scene was found and taken.
async function found(name) {
  const folder = await kept();
  let handle;
  try {
    handle = await (await folder.getFileHandle(name)).createSyncAccessHandle();
  } catch {
    return false;
  }
  try {
    const file = new KeptFile(handle);
    files.set(KEPT, file);
    postMessage({ stage: "opening the scene that was kept", total: 0 });
    if (call("build_from", JSON.stringify({ name: "scene.npz", id: KEPT, size: file.size })) === 0) return true;
    console.warn(`the scene that was kept cannot be used, and is built again: ${replied()}`);
  } finally {
    files.delete(KEPT);
    handle.close();
  }
  await folder.removeEntry(name).catch(() => {});
  return false;
}

// ---- the module

async function start() {
  const response = await fetch("engine.wasm");
  if (!response.ok) throw new Error(`engine.wasm cannot be loaded: ${response.status}`);
  const module = await WebAssembly.compile(await response.arrayBuffer());
  // shared also where no other thread may see it: there is one module for both
  memory = new WebAssembly.Memory({ initial: 1024, maximum: 65536, shared: true });
  engine = (await WebAssembly.instantiate(module, importsOf(module))).exports;
  engine.start();
  if (!self.crossOriginIsolated || navigator.hardwareConcurrency < 2) return;
  postMessage({ counter: { memory, at: engine.progress() } });
  // one processor is left to draw
  const count = Math.min(Math.max(navigator.hardwareConcurrency - 1, 2), MAX_THREADS);
  const up = [];
  for (let number = 0; number < count; number++) {
    const thread = new Worker("engine-worker.js", { name: `engine thread ${number}` });
    threads.push(thread);
    const stack = engine.take(STACK + 16);
    const storage = engine.take(engine.__tls_size.value + engine.__tls_align.value);
    up.push(new Promise((ready, fails) => {
      thread.onmessage = ({ data }) => (data.lost ? postMessage(data) : ready());
      thread.onerror = (event) => fails(new Error(event.message));
    }));
    thread.postMessage({ thread: { module, memory, stack: (stack + STACK) & ~15, storage: Math.ceil(storage / engine.__tls_align.value) * engine.__tls_align.value } });
  }
  // all of them, since this worker starts none while it waits for the pool
  await Promise.all(up);
  if (engine.start_threads(count) !== 0) throw new Error("the threads of the engine do not start");
}
async function joinPool(thread) {
  isPool = true;
  memory = thread.memory;
  engine = (await WebAssembly.instantiate(thread.module, importsOf(thread.module))).exports;
  engine.__stack_pointer.value = thread.stack;
  engine.__wasm_init_tls(thread.storage);
  postMessage({ up: true });
}
// Calls an export with texts or bytes; what it returns.
function call(name, ...values) {
  const given = values.map((value) => {
    const bytes = typeof value === "string" ? new TextEncoder().encode(value) : value;
    const at = engine.take(bytes.length);
    bytesAt(at, bytes.length).set(bytes);
    return [at, bytes.length];
  });
  try {
    return engine[name](...given.flat());
  } finally {
    for (const [at, length] of given) engine.give(at, length);
  }
}
const replied = () => new TextDecoder().decode(reply);

function tilesOf(url) {
  const source = new WholeFile(url);
  files.set(0, source);
  if (call("tiles", JSON.stringify({ name: url, id: 0, size: source.size })) !== 0) throw new Error(replied());
  postMessage({ tiles: JSON.parse(replied()) });
}
async function open({ files: chosen, reading = {}, window = null, max_points: maxPoints }) {
  const opened = chosen.map(({ name, file, url }, id) => {
    const source = file ? new LocalFile(file) : new WebFile(url);
    files.set(id, source);
    return { name, id, size: source.size };
  });
  const request = { files: opened, reading, window, max_points: maxPoints };
  call("announced", JSON.stringify(opened));
  const announced = JSON.parse(replied());
  if (!window && announced?.points > request.max_points) {
    postMessage({ tooMany: { ...announced, most: request.max_points } });
    return;
  }
  if (call("open", JSON.stringify(request)) !== 0) throw new Error(replied());
  const state = JSON.parse(replied());
  postMessage({ state });
  for (let chunk = 0; chunk < state.shown.chunks.length; chunk++) {
    for (const kind of state.shown.has_color ? ["points", "colors"] : ["points"]) {
      call("ask", `${kind}/${chunk}`, "");
      postMessage({ part: `${kind}/${chunk}`, bytes: reply.buffer }, [reply.buffer]);
    }
  }
  engine.scene_name();
  const name = `${replied()}.npz`;
  if (!await found(name)) {
    if (engine.build() !== 0) throw new Error(replied());
    keepAs = name;
  }
  const whole = JSON.parse(replied());
  postMessage({ stage: "indexing pulses", total: 0 });
  engine.index_proof();
  postMessage({ state: whole });
  idle = setTimeout(rest, 2000);
}
let idle = null;
// What is done while nobody asks: what most questions need, and keeping the scene.
async function rest() {
  if (!isPrepared) engine.prepare();
  isPrepared = true;
  const name = keepAs;
  keepAs = null;
  if (name) await keep(name);
}
function answer({ path, body }) {
  clearTimeout(idle);
  const isRefused = call("ask", path, body) !== 0;
  if (isRefused) postMessage({ reply: true, refused: replied() });
  else postMessage({ reply: reply.buffer }, [reply.buffer]);
  if (keepAs || !isPrepared) idle = setTimeout(rest, 2000);
}

// one message after the other, also where one waits for the browser
let last = Promise.resolve();
onmessage = ({ data }) => {
  last = last.then(async () => {
    try {
      if (data.thread) await joinPool(data.thread);
      else if (data.run !== undefined) engine.run_thread(data.run);
      else if (data.open) {
        await start();
        await open(data.open);
      } else if (data.catalogue) {
        await start();
        tilesOf(data.catalogue);
      } else if (data.ask) answer(data.ask);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError || isPool) postMessage({ lost: String(error) });
      else postMessage({ failure: error.message });
    }
  });
};
