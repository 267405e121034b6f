// What the page knows: the state of the scene, its points, and answers. Who answers differs: the server that the page
// came from, the page itself, or a worker in this browser.
import { http } from "./engines/http.js";
import { exported, stored } from "./engines/stored.js";
import { inBrowser } from "./engines/worker.js";

export { Lost, Refused } from "./engines/reply.js";
export { exported };

// Whether the page opens files itself.
export const opens = document.querySelector('meta[name="engine"]') !== null;
const engine = exported ? stored : opens ? inBrowser : http;

export const state = () => engine.state();
export const points = async (chunk) => new Uint16Array(await engine.part(`points/${chunk}`));
export const colors = async (chunk) => new Uint16Array(await engine.part(`colors/${chunk}`));
export const mesh = async (number) => new Float32Array(await engine.part(`meshes/${number}`));
export const balls = async () => new Float32Array(await engine.part("balls"));
export const result = (number) => engine.result(number);

// Asks a question of the scene, or of that with a plan: named values, and a byte for each of many places as `body`.
export const ask = (question, values, signal, plan = null) => engine.ask(`${plan === null ? "" : `plans/${plan}/`}ask/${question}`, values, signal);
// Reads the cloud again: `{ up, unit, crs }`, where it does not say these itself.
export const readAgain = (choice) => engine.readAgain(choice);
// Hands over a mesh file for plans.
export const loadMesh = (file) => engine.loadMesh(file);
