// What if: buildings that are drawn or loaded, areas that are cleared, and whether answers are those before, after, or
// the change.
import * as api from "./api.js";
import { card, corners, remarks } from "./card.js";
import { escape } from "./charts.js";
import { report } from "./messages.js";
import { paint } from "./paint.js";
import { save } from "./save.js";
import { $, page } from "./state.js";
import { cloud, draw, toFile } from "./view.js";
import { t } from "./words.js";

const LINE = 'stroke="#1d4e89" stroke-width="2.5"';
const HINTS = {
  building: t`Click the corners of the building.`,
  area: t`Click around what shall go, such as a tree or a house.`,
};
// the address has the token of the program that the plan was made for
const KEPT = `plan ${location.pathname}`;
let drawing = "building";
let height = 12;
page.plan = { clear: [], buildings: [], meshes: [] };
page.loadedMeshes = [];
page.planned = null;
page.when = "after";

const isEmpty = ({ clear, buildings, meshes }) => !clear.length && !buildings.length && !meshes.length;
// Number of the plan that questions are about, and whether they are also about the scene before it.
export const planInUse = () => (page.planned && page.when !== "before" ? page.planned.plan : null);
export const isChange = () => page.planned !== null && page.when === "change";

// What of the plan is seen: its buildings, and the points that it clears.
function show() {
  const isShown = planInUse() !== null;
  cloud.setPlan(isShown ? page.planned.triangles : null);
  cloud.cleared = isShown ? page.planned.cleared : null;
  if (!page.answer || page.onLayer || !page.last) cloud.setValues(null);
  $("plan").hidden = !page.planned;
  paint();
}
export function setWhen(when) {
  page.when = $("when").value = when;
  show();
  if (page.last || page.tool.places === 0) page.ask();
}
page.setWhen = setWhen;

// Number of the last change: what comes of an earlier one, still on its way, no longer counts.
let changes = 0;
// Has the scene with the plan made.
async function make() {
  changes += 1;
  const number = changes;
  if (isEmpty(page.plan)) {
    page.planned = null;
    return;
  }
  const answer = await api.ask("plan", page.plan);
  if (number !== changes) return;
  const triangles = new Float32Array(answer.body.slice(0, answer.triangle_bytes));
  page.planned = { ...answer, triangles, cleared: answer.points_cleared ? new Uint8Array(answer.body, answer.triangle_bytes) : null };
}
async function change(edit) {
  const before = structuredClone(page.plan);
  edit(page.plan);
  page.places = [];
  page.marks = [];
  try {
    if (!isEmpty(page.plan)) panel(`<p class="busy">${t`Changing the scene …`}</p>`);
    await make();
    sessionStorage.setItem(KEPT, JSON.stringify([page.plan, page.loadedMeshes]));
    if (page.when === "before") page.when = $("when").value = "after";
    show();
    panel(page.plan.clear.length > before.clear.length && page.planned ? remarks(page.planned) : "");
  } catch (error) {
    page.plan = before;
    panel("");
    report(error);
  }
  draw();
}
page.changePlan = change;

// The plan of this tab before it was loaded again.
export async function restore() {
  const kept = sessionStorage.getItem(KEPT);
  // a page that opens files itself may have opened another
  if (!kept || api.opens) return;
  [page.plan, page.loadedMeshes] = JSON.parse(kept);
  await make();
  show();
  draw();
}

// Takes the corners that were clicked.
export function finish() {
  const corners = page.places.map(({ clicked }) => toFile(clicked)).filter((corner, i, all) => !i || corner.some((v, k) => v !== all[i - 1][k]));
  if (corners.length < 3) return panel(`<p class="note">${t`At least three corners are needed.`}</p>`);
  const outline = corners.map(([x, y]) => [x, y]);
  return change((plan) => {
    if (drawing === "area") plan.clear.push(outline);
    else plan.buildings.push({ corners: outline, base: Math.min(...corners.map((corner) => corner[2])), height_m: height });
  });
}
async function load(file) {
  try {
    const { mesh } = await api.loadMesh(file);
    page.loadedMeshes[mesh] = file.name;
    await change((plan) => plan.meshes.push(mesh));
  } catch (error) {
    report(error);
  }
}

// The card of the plan; `note` says what happens now.
export function panel(note = "") {
  const { clear, buildings, meshes } = page.plan;
  const item = (kind, i, text, more = "") => `<li>${escape(text)}${more}<button data-remove="${kind}" data-i="${i}" aria-label="${t`Remove ${escape(text)}`}" title="${t`Remove`}">×</button></li>`;
  const list = [
    ...buildings.map(({ height_m: high }, i) => item("buildings", i, t`Building ${i + 1}`, `<span><input type="number" min="0.1" step="0.5" value="${high}" data-height="${i}" aria-label="${t`Height of building ${i + 1} in metres`}"> ${t`m high`}</span>`)),
    ...meshes.map((number, i) => item("meshes", i, page.loadedMeshes[number])),
    ...clear.map((_, i) => item("clear", i, t`Cleared area ${i + 1}`)),
  ].join("");
  const files = page.planned?.files ?? [];
  card(`<div class="row"><button data-draw="building" aria-pressed="${drawing === "building"}">${t`Draw a building`}</button><button data-draw="area" aria-pressed="${drawing === "area"}">${t`Clear an area`}</button>`
    + `<button id="mesh">${t`Load a mesh`}</button><input id="meshfile" type="file" hidden aria-label="${t`Mesh file`}"></div>`
    + (drawing === "building" ? `<div class="field"><label for="high">${t`Height of the building`}</label><span><input id="high" type="number" min="0.1" step="0.5" value="${height}"> m</span></div>` : "")
    + (note || `<p class="note">${page.places.length ? corners(page.places) : HINTS[drawing]}</p>`)
    + (!note && page.places.length >= 3 ? `<div class="row"><button id="done">${t`Finish`} (Enter)</button></div>` : "")
    + (list ? `<ul class="plan">${list}</ul><p class="note">${t`Questions are now answered with the plan. Before, after and change are at the top (V).`}</p>` : "")
    + (page.planned ? `<h3>${t`The scene on the command line`}</h3><pre id="command">${escape(page.planned.command)}</pre>` : "")
    + (files.length ? `<div class="row">${files.map(({ name }, i) => `<button data-file="${i}">${t`Save ${escape(name)}`}</button>`).join("")}</div>` : ""), (box) => {
    const all = (selector, work) => box.querySelectorAll(selector).forEach(work);
    all("#done", (button) => { button.onclick = finish; });
    all("[data-draw]", (button) => { button.onclick = () => { drawing = button.dataset.draw; page.places = []; page.marks = []; panel(); draw(); }; });
    all("[data-remove]", (button) => { button.onclick = () => change((plan) => plan[button.dataset.remove].splice(Number(button.dataset.i), 1)); });
    all("[data-height]", (input) => { input.onchange = () => { const value = Number.parseFloat(input.value); if (value > 0) change((plan) => { plan.buildings[input.dataset.height].height_m = value; }); }; });
    all("[data-file]", (button) => { const { name, content } = files[button.dataset.file]; button.onclick = () => save(name, content, "text/plain"); });
    all("#high", (input) => { input.onchange = () => { height = Math.max(Number.parseFloat(input.value) || height, 0.1); }; });
    const chosen = box.querySelector("#meshfile");
    box.querySelector("#mesh").onclick = () => chosen.click();
    chosen.onchange = () => { if (chosen.files[0]) load(chosen.files[0]); };
  });
}
// Marks of the corners that were clicked.
export function outline(places) {
  return places.flatMap(({ clicked }, i) => [{ at: clicked }, ...(i ? [{ line: [places[i - 1].clicked, clicked], style: LINE }] : [])]);
}
