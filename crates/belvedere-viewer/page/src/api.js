// What the page knows: the state of the scene, its points, and answers. Everything comes from the server that the page
// came from.

export class Refused extends Error {}
export class Lost extends Error {}

const LOST = "The connection to Belvedere is lost. Is the program still running?";

async function get(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Lost(LOST);
  }
  if (!response.ok) {
    const reply = await response.json().catch(() => ({}));
    throw new Refused(reply.error ?? `The server answers with ${response.status}.`);
  }
  return response;
}

// A page that was written as one file has its data in itself.
const own = document.getElementById("exported");
export const exported = own ? JSON.parse(own.textContent) : null;
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

function shadowOf({ time }) {
  const minutes = Number(time.slice(-5, -3)) * 60 + Number(time.slice(-2));
  const sun = exported.suns.reduce((a, b) => (Math.abs(b.minutes - minutes) < Math.abs(a.minutes - minutes) ? b : a));
  const bits = bytesOf(sun.bits);
  const body = new Uint8Array(exported.state.shown.point_count);
  let lit = 0;
  for (let i = 0; i < body.length; i++) lit += body[i] = (bits[i >> 3] >> (i & 7)) & 1;
  return { ...sun, lit, points: body.length, body: body.buffer };
}

function seenFrom({ viewpoint }) {
  const answer = exported.viewpoints[viewpoint];
  const packed = bytesOf(answer.answers);
  const body = new Uint8Array(exported.state.shown.point_count).map((_, i) => (packed[i >> 2] >> (2 * (i & 3))) & 3);
  return { ...answer, points: body.length, body: body.buffer };
}

export const state = async () => exported?.state ?? (await get("state")).json();
export const points = async (chunk) => new Uint16Array(exported ? bytesOf(exported.points[chunk]).buffer : await (await get(`points/${chunk}`)).arrayBuffer());
export const colors = async (chunk) => new Uint16Array(exported ? bytesOf(exported.colors[chunk]).buffer : await (await get(`colors/${chunk}`)).arrayBuffer());
export const mesh = async (number) => new Float32Array(await (await get(`meshes/${number}`)).arrayBuffer());
export const result = async (number) => answer(await get(`results/${number}`));
export const balls = async () => new Float32Array(await (await get("balls")).arrayBuffer());

// Asks a question of the scene, or of that with a plan: named values, and a byte for each of many places as `body`.
export async function ask(question, values, signal, plan = null) {
  if (exported) return question === "seen" ? seenFrom(values) : shadowOf(values);
  return answer(await get(`${plan === null ? "" : `plans/${plan}/`}ask/${question}`, {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(values), signal,
  }));
}
// Hands over a mesh file for plans.
export const loadMesh = async (file) => answer(await get(`plan-meshes/${encodeURIComponent(file.name)}`, {
  method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file,
}));
async function answer(response) {
  const bytes = await response.arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { ...head, body: bytes.slice(4 + length) };
}
