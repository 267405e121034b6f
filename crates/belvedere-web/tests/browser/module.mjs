// The engine in Node, for tests: the module with a host that reads files from the disk.
import { closeSync, fstatSync, openSync, readSync } from "node:fs";
import { basename } from "node:path";
import { readFile } from "node:fs/promises";

export async function moduleOf(path) {
  const module = await WebAssembly.compile(await readFile(path));
  const memory = new WebAssembly.Memory({ initial: 1024, maximum: 65536, shared: true });
  const files = new Map();
  let reply;
  const bytes = (at, length) => new Uint8Array(memory.buffer, at, length);
  const text = (at, length) => new TextDecoder().decode(bytes(at, length).slice());
  const known = {
    read: (id, at, to, length) => readSync(files.get(id), bytes(to, length), 0, length, at),
    reply: (at, length) => { reply = bytes(at, length).slice(); },
    stage: () => {},
    tick: () => {},
    failed: (at, length) => { throw new Error(text(at, length)); },
    spawn: () => { throw new Error("no threads here"); },
  };
  const imports = { host: known, env: { memory } };
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    if (from !== "host" && from !== "env") (imports[from] ??= {})[name] = () => { throw new Error(`${name} is called`); };
  }
  const { exports } = await WebAssembly.instantiate(module, imports);
  exports.start();
  const call = (name, ...values) => {
    const given = values.map((value) => {
      const encoded = typeof value === "string" ? new TextEncoder().encode(value) : value;
      const at = exports.take(encoded.length);
      bytes(at, encoded.length).set(encoded);
      return [at, encoded.length];
    });
    const status = exports[name](...given.flat());
    for (const [at, length] of given) exports.give(at, length);
    return { refused: status !== 0, bytes: reply };
  };
  return {
    imports: WebAssembly.Module.imports(module),
    call,
    json: (name, ...values) => {
      const { refused, bytes: own } = call(name, ...values);
      const said = new TextDecoder().decode(own);
      if (refused) throw new Error(said);
      return JSON.parse(said);
    },
    add: (path) => {
      const file = openSync(path);
      files.set(files.size, file);
      return { name: basename(path), id: files.size - 1, size: fstatSync(file).size };
    },
    megabytes: () => memory.buffer.byteLength / 1e6,
    close: () => { for (const file of files.values()) closeSync(file); },
  };
}
