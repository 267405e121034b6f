// The page: puts together the scene, the ways of moving, the questions and what is said of them.
import { Vector3, WebGLRenderer } from "three";
import * as api from "./api.js";
import { Mover } from "./camera.js";
import { escape } from "./charts.js";
import { Cloud } from "./cloud.js";
import * as colors from "./colors.js";
import { csv, diagram, geojson, picture, save } from "./save.js";
import { TOOLS as ALL } from "./tools.js";

const $ = (id) => document.getElementById(id);
const root = document.documentElement;
const canvas = $("view");
// a page without a server answers what is stored in it
const TOOLS = ALL.filter(({ name }) => !api.exported || name === "look" || (name === "shadow" && api.exported.suns.length));
const page = { scene: null, tool: TOOLS[0], places: [], marks: [], answer: null, time: { date: "", zone: "UTC", minutes: 780 }, last: null };
window.belvedere = page;

// ---- drawing ----
let renderer, cloud, mover;
let waiting = false;
let moved = 0;
function draw() {
  if (waiting || !cloud) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    const start = performance.now();
    cloud.render(mover.camera, getComputedStyle(root).getPropertyValue("--ground").trim());
    renderer.getContext().finish();
    const spent = performance.now() - start;
    // fewer points while things move slowly, more where there is room
    if (performance.now() - moved < 400) cloud.budget = Math.max(1e5, Math.min(2e7, cloud.budget * (spent > 60 ? 0.7 : spent < 20 ? 1.25 : 1)));
    overlay();
    page.frames = (page.frames ?? 0) + 1;
  });
}
let rest;
function changed() {
  moved = performance.now();
  draw();
  clearTimeout(rest);
  // a full picture once nothing moves any more
  rest = setTimeout(() => { const budget = cloud.budget; cloud.budget = Math.max(budget, 4e6); moved = 0; draw(); setTimeout(() => { cloud.budget = budget; }, 60); }, 350);
}
function resize() {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(width, height, false);
  cloud.resize(canvas.width, canvas.height);
  mover.camera.aspect = width / height;
  mover.camera.updateProjectionMatrix();
  draw();
}

// ---- coordinates ----
const toFile = (local) => local.map((v, i) => Number(((v + page.scene.origin[i]) / page.scene.metres_per_unit[i]).toFixed(3)));
const toLocal = (file) => file.map((v, i) => v * page.scene.metres_per_unit[i] - page.scene.origin[i]);
page.toFile = toFile;
const shownPlace = (file) => file.map((v) => v.toFixed(2)).join("  ");

function onScreen(local) {
  const v = new Vector3(...local).project(mover.camera);
  return v.z > 1 || v.z < -1 ? null : [((v.x + 1) / 2) * canvas.clientWidth, ((1 - v.y) / 2) * canvas.clientHeight];
}
// The place that is drawn at a pixel of the page.
function placeAt(x, y) {
  const ratio = canvas.width / canvas.clientWidth;
  const depth = cloud.depthAt(x * ratio, y * ratio, Math.round(5 * ratio));
  if (depth === null) return null;
  const { camera } = mover;
  const ray = new Vector3((x / canvas.clientWidth) * 2 - 1, 1 - (y / canvas.clientHeight) * 2, 0.5).unproject(camera).sub(camera.position).normalize();
  const range = depth / ray.dot(camera.getWorldDirection(new Vector3()));
  return camera.position.clone().addScaledVector(ray, range).toArray();
}
page.placeAt = placeAt;
page.onScreen = onScreen;

// ---- marks, scale, north ----
function overlay() {
  const parts = [];
  const dot = (local, label, color = "#1d4e89") => {
    const at = onScreen(local);
    if (at) parts.push(`<circle cx="${at[0]}" cy="${at[1]}" r="6" fill="${color}" stroke="#fff" stroke-width="2"/>${label ? `<text x="${at[0] + 10}" y="${at[1] - 8}">${escape(label)}</text>` : ""}`);
  };
  const line = (a, b, style) => {
    const [p, q] = [onScreen(a), onScreen(b)];
    if (p && q) parts.push(`<path d="M${p}L${q}" fill="none" ${style}/>`);
  };
  for (const mark of page.marks) {
    if (mark.line) line(...mark.line, mark.style);
    else dot(mark.at, mark.label, mark.color);
  }
  $("marks").innerHTML = parts.join("");
  const forward = mover.camera.getWorldDirection(new Vector3());
  const up = mover.camera.up.clone().applyQuaternion(mover.camera.quaternion);
  const facing = Math.hypot(forward.x, forward.y) > 0.02 ? Math.atan2(forward.x, forward.y) : Math.atan2(up.x, up.y);
  const north = facing + ((page.scene?.grid_north_deg ?? 0) * Math.PI) / 180;
  $("needle").setAttribute("transform", `rotate(${(-north * 180) / Math.PI})`);
  const middle = mover.kind === "orbit" ? mover.camera.position.distanceTo(mover.orbit.target) : 20;
  const metre = canvas.clientHeight / (2 * middle * Math.tan((mover.camera.fov * Math.PI) / 360));
  const nice = [1, 2, 5].flatMap((k) => [0.01, 0.1, 1, 10, 100, 1000, 10000].map((t) => k * t)).sort((a, b) => a - b).filter((m) => m * metre <= 150).at(-1) ?? 0.01;
  $("scale").firstElementChild.textContent = nice >= 1000 ? `${nice / 1000} km` : nice >= 1 ? `${nice} m` : `${nice * 100} cm`;
  $("scale").lastElementChild.style.width = `${nice * metre}px`;
  if (page.scene) $("drawn").textContent = `${cloud.drawn.toLocaleString("en")} of ${page.scene.point_count.toLocaleString("en")} points drawn`;
}

// ---- colours ----
function paint() {
  if (!page.scene || !cloud) return;
  const name = $("color").value;
  const now = colors.coloring(name, page.scene, page.answer);
  const shown = page.onLayer && name === "answer" ? colors.plain(root.dataset.theme === "dark") : now;
  cloud.paint(shown ?? colors.coloring("none"));
  const legend = now?.legend;
  page.legend = legend;
  $("legend").innerHTML = !legend ? "" : `<b>${escape(legend.title)}</b>` + (legend.keys
    ? legend.keys.map(({ color, text }) => `<div><i class="swatch" style="background:${color}"></i>${escape(text)}</div>`).join("")
    : `<div class="ramp" style="background:${legend.gradient}"></div><div class="ends"><span>${escape(legend.ends[0])}</span><span>${escape(legend.ends[1])}</span></div>`);
  draw();
}
function setColor(name) {
  $("color").value = name;
  if (name === "color" && !page.hasColors) {
    page.hasColors = true;
    page.loaded.forEach(({ chunk, number }) => api.colors(number).then((values) => { cloud.setColors(chunk, values); draw(); }).catch(report));
  }
  paint();
}
function offerAnswer() {
  const select = $("color");
  if (![...select.options].some((option) => option.value === "answer")) select.add(new Option("Answer", "answer"));
  page.before ??= select.value;
  setColor("answer");
}
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
  page.answer = colors.ofAnswers({ tells_unproven: true });
  page.answer.legend.title = "From where the place is seen";
  page.onLayer = true;
  cloud.layer(...quantised(known), new Uint8Array(values), cell * 1.25, page.answer);
  offerAnswer();
};
page.hourCells = (answer) => {
  const v = new Float32Array(answer.body);
  const rows = Array.from({ length: v.length / 4 }, (_, i) => [v[4 * i], v[4 * i + 1], v[4 * i + 2] + 0.12]);
  const low = 0, high = Math.max(answer.possible_hours, 0.1);
  const values = new Uint8Array(rows.map((_, i) => Math.round(((v[4 * i + 3] - low) / (high - low)) * 255)));
  page.answer = colors.ofHours(low, high);
  page.onLayer = true;
  cloud.layer(...quantised(rows), values, answer.cell_m * 1.3, page.answer);
  offerAnswer();
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
    ...(at ? [{ line: [at, b], style: 'stroke="#2f3d73" stroke-width="3" stroke-dasharray="7 5"' }, { at, label: "blocked here", color: "#d1495b" }] : []),
    { at: a, label: "A" }, { at: b, label: "B" },
  ];
};

// ---- questions ----
function choose(tool) {
  page.tool = tool;
  page.places = [];
  page.marks = [];
  page.last = null;
  asking?.abort();
  for (const button of $("tools").querySelectorAll("button")) button.setAttribute("aria-pressed", button.dataset.tool === tool.name);
  $("tools").querySelector("p").textContent = tool.hint;
  canvas.classList.toggle("asks", tool.name !== "look");
  $("timebar").hidden = !tool.time;
  $("timebar").querySelectorAll(".wide, #clock, #play").forEach((part) => { part.hidden = tool.time !== "hour"; });
  setPlaying(false);
  cloud?.clearLayer();
  page.onLayer = false;
  if (page.before) {
    const before = page.before;
    page.before = null;
    $("color").querySelector("[value=answer]")?.remove();
    setColor(before);
  }
  $("card").hidden = true;
  if (tool.places === 0) ask();
  else if (tool.height) card(`<p class="note">${escape(tool.hint)}</p>`);
  draw();
}
page.choose = (name) => choose(TOOLS.find((tool) => tool.name === name));
function field() {
  const { tool } = page;
  if (!tool.height) return "";
  tool.above ??= tool.height[1];
  return `<div class="field"><label for="above">${tool.height[0]}</label><span><input id="above" type="number" step="0.1" value="${tool.above}"> m</span></div>`;
}
function card(html, after) {
  const box = $("card");
  box.hidden = false;
  box.innerHTML = `<header><h2>${escape(page.tool.title)}</h2><button aria-label="Close" title="Close (Esc)">×</button></header>${field()}${html}`;
  box.querySelector("header button").onclick = () => choose(TOOLS[0]);
  const above = box.querySelector("#above");
  if (above) above.onchange = () => {
    const value = Number.parseFloat(above.value);
    if (!Number.isFinite(value)) return;
    page.tool.above = value;
    page.places.forEach((place, i) => { if (i === 0) place.local = lifted(place.clicked, value); });
    if (page.last) ask();
  };
  after?.(box);
}
const lifted = ([x, y, z], above) => [x, y, z + above];

function click(x, y) {
  const near = placeAt(x, y);
  if (!near) return;
  const found = cloud.nearest(near);
  pick(found?.place ?? near, found?.class);
}
page.click = click;
function pick(clicked, code) {
  const { tool } = page;
  if (tool.name === "look") {
    const file = toFile(clicked);
    page.marks = [{ at: clicked }];
    card(`<p class="verdict" style="font-size:17px">${shownPlace(file)}</p><dl><dt>x, y, z</dt><dd>${escape(page.scene.crs)}</dd>`
      + `${page.scene.classes.length ? `<dt>Class</dt><dd>${code} ${escape(colors.CLASSES[code]?.[0] ?? "")}</dd>` : ""}</dl><pre>${file.join(",")}</pre>`);
    draw();
    return;
  }
  if (tool.places === 0) return;
  if (page.places.length >= tool.places) page.places = [];
  const isFirst = page.places.length === 0;
  page.places.push({ clicked, local: isFirst && tool.height ? lifted(clicked, tool.above ?? tool.height[1]) : clicked });
  const labels = tool.places === 2 ? ["A", "B"] : [];
  page.marks = page.places.map(({ local }, i) => ({ at: local, label: labels[i] }));
  if (tool.places === Infinity) {
    page.places.forEach(({ local }, i) => { if (i) page.marks.push({ line: [page.places[i - 1].local, local], style: 'stroke="#1d4e89" stroke-width="2.5"' }); });
    card(`<p class="note">${page.places.length} corners. ${page.places.length < 3 ? "Click more." : "Press Enter or double-click to ask."}</p>`);
  } else if (page.places.length === tool.places) ask();
  else card(`<p class="note">Now click B.</p>`);
  draw();
}
page.pick = pick;

let asking;
async function ask(quick = false) {
  const { tool } = page;
  asking?.abort();
  const mine = (asking = new AbortController());
  if (!page.ready) {
    card(`<p class="busy">The answer comes as soon as the scene is ready.</p>`);
    page.pending = true;
    return;
  }
  if (tool.time && page.scene.latitude_deg === null) {
    card(`<p class="verdict">The location is unknown</p><p class="note">The sun needs to know where on earth the cloud lies. Start again with its reference system, for example <code>--crs EPSG:7415</code>.</p>`);
    return;
  }
  const places = page.places.map(({ local }) => toFile(local));
  const { date, zone, minutes } = page.time;
  const clock = `${String(Math.floor(minutes / 60)).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
  page.last = tool.places === 0 ? page.last : null;
  const busy = setTimeout(() => { if (!page.last) card(`<p class="busy">Asking …</p>`); }, 150);
  const start = performance.now();
  try {
    const first = tool.first?.(places, { date, zone, clock }, page);
    if (first) {
      const answer = await api.ask(...first, mine.signal);
      if (mine.signal.aborted) return;
      const shown = { ...answer, isFirst: true, took: performance.now() - start };
      if (quick) page.last = shown;
      showAnswer(tool, shown, places);
      if (quick) return;
      // whoever still moves the time waits for nothing else
      if (tool.time) await new Promise((go) => setTimeout(go, 250));
      if (mine.signal.aborted) return;
    }
    const answer = await api.ask(...tool.ask(places, { date, zone, clock }), mine.signal);
    if (mine.signal.aborted) return;
    answer.took = performance.now() - start;
    page.last = answer;
    if (tool.places === Infinity) page.marks = page.marks.concat({ line: [page.places.at(-1).local, page.places[0].local], style: 'stroke="#1d4e89" stroke-width="2.5"' });
    showAnswer(tool, answer, places);
  } catch (error) {
    if (error.name === "AbortError") return;
    if (error instanceof api.Lost) return lost(error);
    card(`<p class="verdict">No answer</p><p class="note">${escape(error.message)}</p>`);
  } finally {
    clearTimeout(busy);
    if (asking === mine) asking = null;
  }
}
page.ask = ask;
function showAnswer(tool, answer, places) {
  const shown = tool.show(answer, page);
  const html = shown.html ?? shown;
  const where = places.length === 1 ? `<dl><dt>Place</dt><dd>${shownPlace(places[0])}</dd></dl>` : "";
  const rows = tool.rows?.(answer, page);
  const buttons = [
    ...(rows ? ['<button data-save="csv">Table (.csv)</button>'] : []),
    ...(tool.properties ? ['<button data-save="geojson">Map (.geojson)</button>'] : []),
    '<button data-save="png">Picture (.png)</button>',
  ].join("");
  card(`${html}${where}<h3>The same on the command line</h3><pre id="command">${escape(answer.command)}</pre><div class="row"><button data-save="copy">Copy command</button>${buttons}</div>`
    + `<p class="note" id="took">Answered in ${Math.round(answer.took)} ms.</p>`, (box) => {
    shown.after?.(box);
    box.querySelectorAll("[data-save]").forEach((button) => { button.onclick = () => saveAs(button, tool, answer, places); });
  });
  draw();
}
async function saveAs(button, tool, answer, places) {
  const name = `${tool.name}-${page.scene.title.replace(/\..*$/, "")}`;
  const kind = button.dataset.save;
  if (kind === "copy") {
    await navigator.clipboard?.writeText(answer.command).catch(() => {});
    button.textContent = "Copied";
  } else if (kind === "csv") save(`${name}.csv`, csv(tool.rows(answer, page)), "text/csv");
  else if (kind === "geojson") {
    const [shape, coordinates] = tool.geometry?.(places) ?? ["Point", places[0]];
    save(`${name}.geojson`, geojson(name, [[shape, coordinates, tool.properties(answer)]], page.scene.crs), "application/geo+json");
  } else {
    const chart = $("card").querySelector("figure svg");
    save(`${name}.png`, chart ? await diagram(chart) : await snapshot());
  }
}
async function snapshot() {
  cloud.render(mover.camera, getComputedStyle(root).getPropertyValue("--ground").trim());
  const keys = page.legend?.keys ?? [];
  const text = [page.scene.title, page.legend?.title].filter(Boolean).join(": ");
  return picture(canvas, $("marks"), keys, text, `${page.scene.crs}; scale bar ${$("scale").textContent}`);
}

// ---- time ----
let playing;
// Goes to the next time of the slider, and on to its beginning.
function step(sign = 1) {
  const { min, max, step: by } = $("hour");
  const next = page.time.minutes + sign * Number(by);
  page.time.minutes = next > Number(max) ? Number(min) : next < Number(min) ? Number(max) - (Number(max) % Number(by)) : next;
}
function setPlaying(on) {
  clearTimeout(playing);
  playing = null;
  $("play").setAttribute("aria-pressed", on);
  $("play").textContent = on ? "Pause" : "Play";
  if (!on) {
    if (page.last?.isFirst) ask();
    return;
  }
  const next = async () => {
    step();
    showClock();
    await ask(true);
    // nothing to see at night: on to the morning
    for (let i = 0; page.last?.elevation_deg < -6 && i < 6; i++) step();
    if ($("play").getAttribute("aria-pressed") === "true") playing = setTimeout(next, 60);
  };
  playing = setTimeout(next, 0);
}
function showClock() {
  $("hour").value = page.time.minutes;
  $("clock").textContent = `${String(Math.floor(page.time.minutes / 60)).padStart(2, "0")}:${String(page.time.minutes % 60).padStart(2, "0")}`;
}
function startTime() {
  if (api.exported) {
    Object.assign(page.time, { date: api.exported.date ?? "", zone: api.exported.zone ?? "" });
    const minutes = api.exported.suns.map((sun) => sun.minutes);
    if (minutes.length) Object.assign($("hour"), { min: minutes[0], max: minutes.at(-1), step: 60 });
    page.time.minutes = minutes[Math.floor(minutes.length / 2)] ?? 720;
    $("date").value = page.time.date;
    $("zone").value = page.time.zone;
    $("date").disabled = $("zone").disabled = true;
    return showClock();
  }
  const own = Intl.DateTimeFormat().resolvedOptions().timeZone;
  const longitude = page.scene.longitude_deg ?? 0;
  const ahead = -new Date().getTimezoneOffset() / 60;
  const sun = Math.round(longitude / 15);
  // the clocks of this computer, unless the scene lies elsewhere on earth
  page.time.zone = Math.abs(ahead - sun) <= 2.5 ? own : `${sun < 0 ? "-" : "+"}${String(Math.abs(sun)).padStart(2, "0")}:00`;
  page.time.date ||= new Date().toISOString().slice(0, 10);
  $("date").value = page.time.date;
  $("zone").value = page.time.zone;
  $("zones").innerHTML = (Intl.supportedValuesOf?.("timeZone") ?? []).map((zone) => `<option value="${zone}">`).join("");
  showClock();
}
const again = () => { if (page.last || page.tool.places === 0) ask(); };

// ---- messages ----
function lost(error) {
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>Try again</button>`;
  $("message").querySelector("button").onclick = () => { $("message").hidden = true; watch(); };
}
function report(error) {
  if (error instanceof api.Lost) return lost(error);
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>Close</button>`;
  $("message").querySelector("button").onclick = () => { $("message").hidden = true; };
}
const KEYS = [
  ["1 to 9", "Choose a question"], ["Enter", "Ask at the centre of the view"], ["Esc", "Close the answer"], ["Arrow keys", "Turn"], ["W A S D, Q E", "Move; down and up"],
  ["+ and −", "Zoom"], ["H", "Whole scene"], ["T", "From above"], ["C", "Next colour"], ["M", "Next way of moving"], ["B", "Balls"], ["Space", "Play the day"],
  ["< and >", "Earlier or later"], ["P", "Save a picture"], ["L", "Light or dark"], ["?", "This help"],
];
function help() {
  const box = $("keys");
  box.innerHTML = `<h2>Belvedere</h2><p>Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.</p>`
    + `<table>${KEYS.map(([key, what]) => `<tr><td><kbd>${escape(key)}</kbd></td><td>${escape(what)}</td></tr>`).join("")}</table>`
    + `<p>Orbit: drag to turn, right drag to move, wheel to zoom. Walk: eyes 1.7 m above the ground. Fly: W goes where you look.</p><form method="dialog"><button autofocus>Close</button></form>`;
  box.showModal();
}

// ---- loading ----
async function load(shown) {
  const { scene } = page;
  mover.show(scene.low, scene.high);
  cloud.own.size.value = Math.min(Math.max(scene.spacing * 1.8, 0.02), 5);
  cloud.own.most.value = 26 * renderer.getPixelRatio();
  cloud.own.heights.value.set(scene.low[2], scene.high[2]);
  page.loaded = [];
  const order = scene.chunks.map((_, i) => i);
  const one = async () => {
    for (let number = order.shift(); number !== undefined; number = order.shift()) {
      const { low, step } = scene.chunks[number];
      const chunk = cloud.add(low, step, await api.points(number));
      page.loaded.push({ chunk, number });
      draw();
    }
  };
  await Promise.all([one(), one(), one()]);
  // values come in the order of the chunks
  page.loaded.sort((a, b) => a.number - b.number);
  cloud.chunks = page.loaded.map(({ chunk }) => chunk);
  page.isLoaded = true;
  changed();
}
function begin(state) {
  const shown = state.shown;
  const [, , up] = shown.metres_per_unit;
  page.scene = {
    ...shown, title: state.title, unit: up === 1 ? "m" : "ft", latitude_deg: null,
    heights: [shown.low, shown.high].map((corner) => (corner[2] + shown.origin[2]) / up),
  };
  if (!shown.point_count && state.scene) Object.assign(page.scene, { low: state.scene.low, high: state.scene.high, spacing: 0.3 });
  $("title").textContent = document.title = state.title;
  document.title = `${state.title} – Belvedere`;
  $("facts").textContent = shown.point_count ? `${shown.point_count.toLocaleString("en")} points` : "ball file";
  $("crs").textContent = shown.crs;
  const ways = [["height", "Height"], ...(shown.classes.length > 1 ? [["class", "Class"]] : []), ...(shown.has_intensity ? [["intensity", "Intensity"]] : []), ...(shown.has_color ? [["color", "Own colours"]] : []), ["none", "Plain"]];
  $("color").replaceChildren(...ways.map(([value, text]) => new Option(text, value)));
  setColor(shown.has_color ? "color" : ways.length > 3 && shown.classes.length > 1 ? "class" : "height");
  return load(shown);
}
async function watch() {
  try {
    const state = await api.state();
    $("message").hidden = true;
    if (state.failure) {
      $("progress").hidden = true;
      throw new api.Refused(state.failure);
    }
    if (state.shown && !page.scene && (state.shown.point_count || state.scene)) begin(state).catch(report);
    for (page.meshes ??= 0; page.scene && page.meshes < (state.mesh_count ?? 0); page.meshes++) {
      api.mesh(page.meshes).then((values) => { cloud.addMesh(values); $("meshes").hidden = false; draw(); }).catch(report);
    }
    if (state.scene && page.scene && !page.ready) {
      Object.assign(page.scene, { ...state.scene, low: page.scene.low, high: page.scene.high });
      page.ready = true;
      startTime();
      if (!state.shown.point_count) toggleBalls();
      if (page.pending) ask();
    }
    $("progress").hidden = page.ready === true;
    const bar = $("progress").querySelector("progress");
    $("progress").querySelector("p").textContent = state.stage ? `Preparing: ${state.stage}` : "Preparing";
    if (state.total > 0) Object.assign(bar, { max: state.total, value: state.done });
    else bar.removeAttribute("value");
    if (!api.exported || !page.ready) setTimeout(watch, page.ready ? 4000 : 250);
  } catch (error) {
    report(error);
  }
}
async function toggleBalls() {
  const on = $("balls").getAttribute("aria-pressed") !== "true";
  $("balls").setAttribute("aria-pressed", on);
  try {
    if (on && !cloud.balls) cloud.addBalls(await api.balls());
  } catch (error) {
    return report(error);
  }
  if (cloud.balls) cloud.balls.visible = on;
  draw();
}

// ---- events ----
function theme(name) {
  root.dataset.theme = name;
  $("theme").textContent = name === "dark" ? "Light" : "Dark";
  if (page.last && page.tool.name === "seen") page.answer = colors.ofAnswers(page.last);
  paint();
}
function listen() {
  let down = null;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; $("crosshair").hidden = true; });
  canvas.addEventListener("pointerup", (event) => {
    if (down && event.button === 0 && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5 && page.scene) click(event.clientX, event.clientY);
    down = null;
  });
  canvas.addEventListener("dblclick", () => { if (page.tool.places === Infinity && page.places.length >= 3) ask(); });
  let hovering = false;
  canvas.addEventListener("pointermove", (event) => {
    if (hovering || event.buttons || !page.scene) return;
    hovering = true;
    requestAnimationFrame(() => {
      hovering = false;
      const place = placeAt(event.clientX, event.clientY);
      $("where").textContent = place ? shownPlace(toFile(place)) : "";
    });
  });
  $("color").onchange = () => setColor($("color").value);
  $("motion").onchange = () => mover.setKind($("motion").value);
  $("home").onclick = () => { $("motion").value = "orbit"; mover.show(page.scene.low, page.scene.high); };
  $("top").onclick = () => { $("motion").value = "orbit"; mover.show(page.scene.low, page.scene.high, true); };
  $("theme").onclick = () => theme(root.dataset.theme === "dark" ? "light" : "dark");
  $("picture").onclick = async () => save(`${page.scene.title.replace(/\..*$/, "")}.png`, await snapshot());
  $("balls").onclick = toggleBalls;
  $("meshes").onclick = () => {
    const on = $("meshes").getAttribute("aria-pressed") !== "true";
    $("meshes").setAttribute("aria-pressed", on);
    cloud.meshes.forEach((mesh) => { mesh.visible = on; });
    draw();
  };
  $("help").onclick = help;
  $("play").onclick = () => setPlaying(!playing);
  $("date").onchange = () => { page.time.date = $("date").value; again(); };
  $("hour").oninput = () => { page.time.minutes = Number($("hour").value); showClock(); again(); };
  $("zone").onchange = () => { page.time.zone = $("zone").value.trim(); again(); };
  addEventListener("resize", resize);
  addEventListener("keydown", key);
}
function cycle(select) {
  select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
  select.dispatchEvent(new Event("change"));
}
function key(event) {
  if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName) || event.ctrlKey || event.metaKey || event.altKey || $("keys").open) return;
  const on = event.target.tagName === "BUTTON";
  const turns = { ArrowLeft: [0.08, 0], ArrowRight: [-0.08, 0], ArrowUp: [0, 0.06], ArrowDown: [0, -0.06] };
  const goes = { w: [1, 0, 0], s: [-1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, -1], e: [0, 0, 1] };
  const presses = { h: "home", t: "top", b: "balls", p: "picture", l: "theme", "?": "help" };
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (on && (name === "Enter" || name === " ")) return;
  if (turns[name]) mover.turn(...turns[name]);
  else if (goes[name]) mover.go(...goes[name]);
  else if (presses[name]) { if (!$(presses[name]).hidden) $(presses[name]).click(); }
  else if (name === "+" || name === "=") mover.zoom(0.85);
  else if (name === "-") mover.zoom(1.18);
  else if (name === "c") cycle($("color"));
  else if (name === "m") cycle($("motion"));
  else if (name === "Escape") choose(TOOLS[0]);
  else if (name === " " && page.tool.time === "hour") $("play").click();
  else if ((name === "<" || name === "," || name === ">" || name === ".") && page.tool.time === "hour") {
    step(name === "<" || name === "," ? -1 : 1);
    showClock();
    again();
  } else if (name === "Enter") {
    if (page.tool.places === Infinity && page.places.length >= 3 && $("crosshair").hidden) ask();
    else {
      $("crosshair").hidden = false;
      click(canvas.clientWidth / 2, canvas.clientHeight / 2);
    }
  } else if (/^[1-9]$/.test(name) && TOOLS[Number(name) - 1]) choose(TOOLS[Number(name) - 1]);
  else return;
  event.preventDefault();
}

function start() {
  $("tools").innerHTML = `<h2>Questions</h2>${TOOLS.map((tool, i) => `<button data-tool="${tool.name}" aria-pressed="false" title="${tool.title} (${i + 1})">${tool.icon}<span>${tool.title}</span><kbd>${i + 1}</kbd></button>`).join("")}<p></p>`;
  for (const button of $("tools").querySelectorAll("button")) button.onclick = () => page.choose(button.dataset.tool);
  if (api.exported) $("balls").hidden = true;
  if (matchMedia("(prefers-color-scheme: dark)").matches) theme("dark");
  try {
    renderer = new WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true });
  } catch {
    report(new Error("This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration."));
    return;
  }
  cloud = page.cloud = new Cloud(renderer);
  mover = page.mover = new Mover(canvas, changed);
  mover.groundAt = (x, y) => cloud.groundAt(x, y);
  listen();
  resize();
  choose(TOOLS[0]);
  watch();
}
start();
