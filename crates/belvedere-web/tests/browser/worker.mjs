// The worker reads files of servers with bad manners: it copies no more than was requested, and mixes no versions.
import { readFileSync } from "node:fs";
import { createContext, runInContext } from "node:vm";

const SIZE = 300_000;
const content = Uint8Array.from({ length: SIZE }, (_, i) => (i * 7 + (i >> 8)) % 251);

// A request as browsers have it, answered by `server(method, from, to, number)`.
function requestsTo(server) {
  let number = 0;
  return class {
    headers = {};
    open(method) { this.method = method; }
    setRequestHeader(name, value) { this.headers[name] = value; }
    getResponseHeader(name) { return this.given[name] ?? null; }
    send() {
      const [from, to] = (/bytes=(\d+)-(\d+)/.exec(this.headers.Range ?? "") ?? [0, 0, SIZE - 1]).slice(1).map(Number);
      const { status = this.headers.Range ? 206 : 200, bytes = content.slice(from, to + 1), headers = {} } = server(this.method, from, to + 1, number++) ?? {};
      this.status = status;
      this.given = { "Content-Length": this.method === "HEAD" ? SIZE : bytes.length, ...headers };
      this.response = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    }
  };
}

// The host of a worker whose only file lies on a server, with memory of which all around `room` bytes is guarded.
function worker(server, url = "https://ann:s3cret@example.org/a.laz?sig=k3y") {
  const said = [];
  const self = { crossOriginIsolated: false };
  const context = createContext({
    self, console: { error: (text) => said.push(text), warn: () => {} }, URL, Uint8Array, TextDecoder, TextEncoder, performance, postMessage: () => {},
    XMLHttpRequest: requestsTo(server), WebAssembly, Number, Math,
  });
  const source = readFileSync(new URL("../../site/engine-worker.js", import.meta.url), "utf8");
  const scope = runInContext(`${source}; ({ host, files, WebFile, useMemory: (given) => { memory = given; } })`, context);
  const memory = { buffer: new ArrayBuffer(2 * SIZE) };
  scope.useMemory(memory);
  let failure = null;
  try {
    scope.files.set(0, new scope.WebFile(url));
  } catch (error) {
    failure = error.message;
  }
  const read = (at, length) => {
    const all = new Uint8Array(memory.buffer).fill(255);
    const count = scope.host.read(0, at, 1000, length);
    const beside = all.slice(0, 1000).every((byte) => byte === 255) && all.slice(1000 + length).every((byte) => byte === 255);
    return { count, beside, bytes: all.slice(1000, 1000 + Math.max(count, 0)) };
  };
  return { read, said, failure };
}

const failures = [];
const check = (is, what) => { if (!is) failures.push(what); };
const isOf = ({ count, bytes }, at) => count > 0 && bytes.every((byte, i) => byte === content[at + i]);
const places = [[0, 10], [65_530, 20], [100_000, 100_000], [299_000, 1000], [65_536, 65_536], [299_999, 1]];
const refused = (server, word, from = 0) => {
  const { read, said } = worker(server);
  const results = places.map(([at, length]) => [read(at, length), at]);
  check(results.every(([result]) => result.beside), `${word}: bytes are written beside the room`);
  check(results.every(([result, at]) => result.count === -1 || isOf(result, at)), `${word}: bytes of another place`);
  check(results.slice(from).some(([result]) => result.count === -1) && said.some((text) => text.includes(word)), `${word}: not refused: ${said}`);
  check(said.every((text) => !/s3cret|k3y|ann/.test(text)), `${word}: a secret is said: ${said}`);
};

const good = worker(() => ({ headers: { ETag: "a" } }));
check(places.every(([at, length]) => { const result = good.read(at, length); return result.beside && isOf(result, at); }), `a good server is not read: ${good.said}`);
refused((method, from, to) => method === "GET" ? { bytes: content.slice(from, to + 5000) } : {}, "is not what it was");
refused((method, from, to) => method === "GET" ? { bytes: content.slice(from, to - 1) } : {}, "is not what it was");
refused((method) => method === "GET" ? { bytes: content } : {}, "is not what it was");
refused((method) => method === "GET" ? { status: 200, bytes: content } : {}, "gives no parts");
refused((method, from, to, number) => ({ headers: { ETag: `"${number > 2 ? "b" : "a"}"` } }), "changed on the server");
refused((method, from, to, number) => ({ headers: { "Last-Modified": `${number > 2 ? "Tue" : "Mon"}` } }), "changed on the server");
refused((method, from, to) => method === "GET" ? { headers: { "Content-Range": `bytes ${from + 1}-${to}/${SIZE}` } } : {}, "another part");
refused((method, from, to) => method === "GET" ? { headers: { "Content-Range": `bytes ${from}-${to - 1}/${SIZE + 1}` } } : {}, "changed on the server");
refused((method) => method === "GET" ? { status: 403 } : {}, "answers with 403");
const missing = worker(() => ({ status: 404 }));
check(/404/.test(missing.failure) && !/s3cret|k3y|ann/.test(missing.failure), `a missing file: ${missing.failure}`);
failures.forEach((failure) => console.error(failure));
console.log(`the worker and servers with bad manners: ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
