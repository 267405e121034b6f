// Colours of the scene, and answers drawn in it.
import * as api from "./api.js";
import { escape } from "./charts.js";
import * as colors from "./colors.js";
import { report } from "./messages.js";
import { showResult } from "./results.js";
import { $, page, root } from "./state.js";
import { cloud, draw, toLocal } from "./view.js";
import { t } from "./words.js";

export function paint() {
  if (!page.scene || !cloud) return;
  const name = $("color").value;
  const now = page.shownResult ?? colors.coloring(name, page.scene, page.answer);
  const shown = page.shownResult || (page.onLayer && name === "answer") ? colors.plain(root.dataset.theme === "dark") : now;
  cloud.paint(shown ?? colors.coloring("none"));
  const legend = now?.legend;
  page.legend = legend;
  $("legend").innerHTML = !legend ? "" : `<b>${escape(legend.title)}</b>` + (legend.keys
    ? legend.keys.map(({ color, text }) => `<div><i class="swatch" style="background:${color}"></i>${escape(text)}</div>`).join("")
    : `<div class="ramp" style="background:${legend.gradient}"></div><div class="ends"><span>${escape(legend.ends[0])}</span><span>${escape(legend.ends[1])}</span></div>`);
  const isOutlined = $("outlines").getAttribute("aria-pressed") === "true";
  if (isOutlined) $("legend").innerHTML += `<div class="lines">${colors.OUTLINES.map(([color, text]) => `<div><i class="swatch" style="background:rgb(${color})"></i>${text}</div>`).join("")}</div>`;
  draw();
}
export function setColor(name) {
  $("color").value = name;
  if (page.shownResult) {
    page.shownResult = null;
    cloud.clearLayer();
    cloud.scene.visible = true;
  }
  if (name.startsWith("result ")) {
    showResult(name).then((coloring) => { page.shownResult = coloring; paint(); }).catch(report);
    return;
  }
  if (name === "color" && !page.hasColors) {
    page.hasColors = true;
    page.loaded.forEach((part) => loadColors(part).catch(report));
  }
  paint();
}
// The own colours of the points of a part of the cloud.
export async function loadColors({ chunk, number }) {
  cloud.setColors(chunk, await api.colors(number));
  draw();
}
// Offers the own colours of the points where they differ: files may have the fields and nothing in them. Unless another
// way was chosen meanwhile they are shown.
export async function offerColors() {
  const { chunks, has_color: hasColors } = page.scene;
  for (let number = 0, first; hasColors && number < chunks.length; number++) {
    const own = await api.colors(number);
    first ??= own[0];
    if (!own.some((color) => color !== first)) continue;
    const plain = $("color").querySelector("[value=none]");
    $("color").insertBefore(new Option(t`Own colours`, "color"), plain);
    if (page.isColorChosen) return;
    // an answer is shown until its question is left
    if (page.before) page.before = "color";
    else setColor("color");
    return;
  }
}
// Heights from the lowest to the highest but for some odd points.
const ENDS = [0.02, 0.98];
export function scaleHeights() {
  if (!cloud.chunks.length) return;
  const local = cloud.heights(ENDS);
  cloud.own.heights.value.set(...local);
  page.scene.heights = local.map((z) => (z + page.scene.origin[2]) / page.scene.metres_per_unit[2]);
  paint();
}
function offerAnswer() {
  const select = $("color");
  if (![...select.options].some((option) => option.value === "answer")) select.add(new Option(t`Answer`, "answer"));
  page.before ??= select.value;
  setColor("answer");
}
// The sun of an answer lights the scene.
page.light = ({ azimuth_deg: azimuth, elevation_deg: elevation }) => {
  const [a, e] = [azimuth - (page.scene.grid_north_deg ?? 0), elevation].map((deg) => (deg * Math.PI) / 180);
  cloud.setSun([Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), Math.sin(e)]);
};
page.values = (bytes) => {
  cloud.clearLayer();
  page.onLayer = false;
  cloud.setValues(bytes);
  offerAnswer();
};
function quantised(rows) {
  const low = [0, 1, 2].map((i) => rows.reduce((m, r) => Math.min(m, r[i]), Infinity));
  const high = [0, 1, 2].map((i) => rows.reduce((m, r) => Math.max(m, r[i]), -Infinity));
  const step = low.map((v, i) => Math.max((high[i] - v) / 65535, 1e-6));
  const places = new Uint16Array(rows.length * 4);
  rows.forEach((r, k) => [0, 1, 2].forEach((i) => { places[4 * k + i] = Math.round((r[i] - low[i]) / step[i]); }));
  return [low, step, places];
}
// Cells on the ground instead of values of points: places, values, size and colours.
function onLayer(rows, values, size, coloring) {
  page.answer = coloring;
  page.onLayer = true;
  cloud.setValues(null);
  cloud.layer(...quantised(rows), new Uint8Array(values), size, coloring);
  offerAnswer();
}
page.cells = (answer) => {
  const { first_center: [x, y], cell_m: cell, columns, rows } = answer.grid;
  const heights = new Float32Array(answer.body, 0, columns * rows);
  const answers = new Uint8Array(answer.body, 4 * columns * rows);
  const known = [], values = [];
  heights.forEach((z, i) => {
    if (!Number.isFinite(z) || answers[i] > 2) return;
    known.push([x + (i % columns) * cell, y - Math.floor(i / columns) * cell, z + 0.12]);
    values.push(answers[i]);
  });
  onLayer(known, values, cell * 1.25, colors.ofAnswers({ tells_unproven: true }, t`From where the place is seen`));
};
page.hourCells = (answer) => {
  const v = new Float32Array(answer.body);
  const rows = Array.from({ length: v.length / 4 }, (_, i) => [v[4 * i], v[4 * i + 1], v[4 * i + 2] + 0.12]);
  const low = 0, high = Math.max(answer.possible_hours, 0.1);
  onLayer(rows, rows.map((_, i) => Math.round(((v[4 * i + 3] - low) / (high - low)) * 255)), answer.cell_m * 1.3, colors.ofHours(low, high));
};
// Changes of hours: rows of x, y, z and hours.
page.changedCells = (rows, cell) => {
  const most = rows.reduce((m, r) => Math.max(m, Math.abs(r[3])), 0.1);
  onLayer(rows.map(([x, y, z]) => [x, y, z + 0.12]), rows.map((r) => Math.round((r[3] / most + 1) * 127.5)), cell * 1.3, colors.ofHoursChange(most));
};
page.plane = (answer) => {
  const v = new Float32Array(answer.body);
  const rows = Array.from({ length: v.length / 3 }, (_, i) => [v[3 * i], v[3 * i + 1], v[3 * i + 2] + 0.06]);
  cloud.layer(...quantised(rows), new Uint8Array(rows.length).fill(1), cloud.own.size.value * 1.4, colors.ofAnswers({}));
};
page.line = (answer) => {
  const [a, b] = page.places.map(({ local }) => local);
  const at = answer.first_block ? toLocal(answer.first_block.place) : null;
  page.marks = [
    { line: [a, at ?? b], style: `stroke="${answer.answer === "unproven" ? "#4a86e8" : "#f5a300"}" stroke-width="4"` },
    ...(at ? [{ line: [at, b], style: 'stroke="#2f3d73" stroke-width="3" stroke-dasharray="7 5"' }, { at, label: t`blocked here`, color: "#d1495b", down: 20 }] : []),
    { at: a, label: "A" }, { at: b, label: "B" },
  ];
};
