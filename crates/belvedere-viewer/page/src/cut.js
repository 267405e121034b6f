// A part of the cloud that is shown alone: between two heights, and between two corners on the map. All points stay in
// the scene, and answers are the same.
import { card } from "./card.js";
import { escape } from "./charts.js";
import { $, page } from "./state.js";
import { cloud, draw, toFile, toLocal } from "./view.js";
import { fixed, t } from "./words.js";

// Step of the heights, units of the file.
const STEP = 0.1;
const inFile = (z) => toFile([0, 0, z])[2];
const inLocal = (z) => toLocal([0, 0, z])[2];

// The corners of the part, local metres; without any, all is shown.
export function setCut(cut) {
  page.cut = cut;
  cloud.setCut(cut);
  $("cut").setAttribute("aria-pressed", Boolean(cut) || page.tool.name === "cut");
  draw();
}
// All of the scene, and by how much more, metres: places of points are rounded to steps.
const MORE = 0.01;
const whole = () => ({ low: page.scene.low.map((v) => v - MORE), high: page.scene.high.map((v) => v + MORE) });
export function cutPanel() {
  const [foot, top] = [page.scene.low[2], page.scene.high[2]].map(inFile);
  const { low, high } = page.cut ?? whole();
  const slider = (name, id, z) => `<div class="field"><label for="${id}">${name}</label><span><output>${fixed(inFile(z), 1)}</output> ${escape(page.scene.unit)}</span></div><input id="${id}" type="range" min="${foot}" max="${top}" step="${STEP}" value="${inFile(z)}">`;
  page.marks = page.places.map(({ clicked }) => ({ at: clicked }));
  card(`<p class="note">${page.places.length === 1 ? t`Click the opposite corner.` : t`Shows a part of the points alone: between two heights, and, after two clicks, between these corners on the map. Answers still count all of them.`}</p>`
    + `${slider(t`Not above`, "cut-high", high[2])}${slider(t`Not below`, "cut-low", low[2])}`
    + `<div class="row"><button id="all"${page.cut ? "" : " hidden"}>${t`Show all`}</button></div>`, (box) => {
    const all = box.querySelector("#all");
    const move = () => {
      const [bottom, up] = ["cut-low", "cut-high"].map((id) => Number(box.querySelector(`#${id}`).value));
      box.querySelectorAll("output").forEach((output, i) => { output.textContent = fixed([up, bottom][i], 1); });
      const now = page.cut ?? whole();
      // sliders may end a step before the scene does
      const ends = [bottom <= foot ? whole().low[2] : inLocal(bottom), up >= top - STEP ? whole().high[2] : inLocal(up)];
      setCut({ low: [now.low[0], now.low[1], ends[0]], high: [now.high[0], now.high[1], ends[1]] });
      all.hidden = false;
    };
    box.querySelectorAll("[type=range]").forEach((input) => { input.oninput = move; });
    all.onclick = () => { page.places = []; setCut(null); cutPanel(); };
  });
  draw();
}
// Takes the corners that were clicked.
export function cutAt() {
  if (page.places.length === 2) {
    const [a, b] = page.places.map(({ clicked }) => clicked);
    const now = page.cut ?? whole();
    setCut({ low: [Math.min(a[0], b[0]), Math.min(a[1], b[1]), now.low[2]], high: [Math.max(a[0], b[0]), Math.max(a[1], b[1]), now.high[2]] });
    page.places = [];
  }
  cutPanel();
}
