// Choosing a question, clicking its places, and what is said of the answer.
import * as api from "./api.js";
import { card, corners, lifted, remarks } from "./card.js";
import { escape } from "./charts.js";
import * as colors from "./colors.js";
import { cutAt, cutPanel } from "./cut.js";
import { invited } from "./first.js";
import { measurePanel } from "./measure.js";
import { hint, lost, report } from "./messages.js";
import { finish, isChange, outline, panel, planInUse } from "./plan.js";
import { setColor } from "./paint.js";
import { cloudPanel, listenToReading, readingChoices } from "./reading.js";
import { csv, diagram, geojson, picture, save } from "./save.js";
import { $, canvas, page, toolOf, TOOLS } from "./state.js";
import { changed } from "./change.js";
import { clockText, setPlaying } from "./time.js";
import { ASIDES } from "./tools.js";
import { count, fixed, t } from "./words.js";
import { cloud, complete, draw, placeAt, shownPlace, toFile } from "./view.js";

export function choose(tool) {
  invited();
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
  cloud?.setSun(null);
  page.onLayer = false;
  cloud?.setValues(null);
  if (page.before) {
    const before = page.before;
    page.before = null;
    $("color").querySelector("[value=answer]")?.remove();
    setColor(before);
  }
  $("card").hidden = true;
  for (const { name } of ASIDES) $(name).setAttribute("aria-pressed", tool.name === name || (name === "cut" && Boolean(page.cut)));
  if (tool.name === "plan") panel();
  else if (tool.name === "measure") measurePanel();
  else if (tool.name === "cut") cutPanel();
  else if (tool.name === "crs") cloudPanel();
  else if (tool.places === 0) ask();
  // where the names of the questions are short, nothing else says what to do
  else if (tool.height || (tool.name !== "look" && !$("tools").querySelector("p").offsetHeight)) card(`<p class="note">${escape(tool.hint)}</p>`);
  draw();
}
page.choose = (name) => choose(toolOf(name));
export function click(x, y) {
  const near = placeAt(x, y);
  if (!near) return hint(t`There is no point of the cloud at this place. Click on a point.`);
  invited();
  const found = cloud.nearest(near);
  // what is planned has no points
  const isPoint = found && (!cloud.plan || found.away < (2 * cloud.own.size.value) ** 2);
  pick(isPoint ? found.place : near, isPoint ? found : null);
}
page.click = click;
// What a value of a point says of its light.
function lightOf(value, { certainty, before }) {
  // those of a change say something else
  if (before) return undefined;
  if (!certainty) return colors.LIGHT[value]?.[0];
  return value <= 200 ? t`lit with a probability of ${Math.round(value / 2)} %` : undefined;
}
// Classes of points that may lie on buildings: buildings, and where nobody classified, all.
const BUILDINGS = [0, 1, 6];
// Adds the plane of the roof that a point lies on to what is said of the point.
async function roofAt(file, list) {
  const { roof } = await api.ask("surfaces", { place: file });
  if (!roof) return;
  const way = roof.azimuth_deg === null ? "" : `, ${t`azimuth`} ${fixed(roof.azimuth_deg, 1)}°`;
  list.insertAdjacentHTML("beforeend", `<dt>${t`Plane of the roof`}</dt><dd>${t`slope`} ${fixed(roof.slope_deg, 1)}°${way}</dd>`
    + `<dt>${t`Its points`}</dt><dd>${t`${count(roof.points)}, which scatter by ${fixed(100 * roof.noise_m, 1)} cm`}</dd>`
    + `<dt>${t`Its height`}</dt><dd>${t`known to ${fixed(100 * roof.sd_m, 2)} cm (standard deviation)`}</dd>`);
}
// What is known of a clicked place, and the questions about it.
function ofPlace(clicked, point) {
  const file = toFile(clicked);
  const code = point?.class;
  const answer = page.tool.name === "shadow" && page.last ? lightOf(point?.value, page.last) : undefined;
  const offered = TOOLS.filter(({ places, name }) => places === 1 && name !== "look");
  if (page.tool.places === 0 && !offered.length) return hint(t`This question is about all points. It needs no click.`);
  page.marks = [{ at: clicked }];
  card(`<p class="verdict" style="font-size:17px">${shownPlace(file)}</p><dl><dt>x, y, z</dt><dd>${escape(page.scene.crs)}</dd>`
    + `${page.scene.classes.length && code !== undefined ? `<dt>${t`Class`}</dt><dd>${code} ${escape(colors.CLASSES[code]?.[0] ?? "")}</dd>` : ""}`
    + `${answer ? `<dt>${t`At the time below`}</dt><dd>${escape(answer)}</dd>` : ""}</dl><pre>${file.join(",")}</pre>`
    + (offered.length ? `<h3>${t`Ask about this place`}</h3><div class="row">${offered.map(({ name, title }) => `<button data-about="${name}">${escape(title)}</button>`).join("")}</div>` : ""), (box) => {
    box.querySelectorAll("[data-about]").forEach((button) => { button.onclick = () => { page.choose(button.dataset.about); pick(clicked); }; });
    if (BUILDINGS.includes(code) && page.scene.roof_count && !api.exported) roofAt(file, box.querySelector("dl")).catch(report);
  });
  draw();
}
function pick(clicked, point = null) {
  const { tool } = page;
  if (tool.name === "look" || tool.places === 0) return ofPlace(clicked, point);
  if (page.places.length >= tool.places) page.places = [];
  const isFirst = page.places.length === 0;
  page.places.push({ clicked, local: isFirst && tool.height ? lifted(clicked, tool.above ?? tool.height[1]) : clicked });
  if (tool.name === "measure") return measurePanel();
  if (tool.name === "cut") return cutAt();
  if (tool.name === "plan") {
    page.marks = outline(page.places);
    panel();
    draw();
    return;
  }
  const labels = tool.places === 2 ? ["A", "B"] : [];
  page.marks = page.places.map(({ local }, i) => ({ at: local, label: labels[i] }));
  if (tool.places === Infinity) {
    page.places.forEach(({ local }, i) => { if (i) page.marks.push({ line: [page.places[i - 1].local, local], style: 'stroke="#1d4e89" stroke-width="2.5"' }); });
    card(`<p class="note">${corners(page.places)}</p>${page.places.length < 3 ? "" : `<div class="row"><button id="done">${t`Ask`} (Enter)</button></div>`}`, (box) => {
      const done = box.querySelector("#done");
      if (done) done.onclick = () => ask();
    });
  } else if (page.places.length === tool.places) ask();
  else card(`<p class="note">${t`Now click B.`}</p>`);
  draw();
}
page.pick = pick;

// Whether answers can be shown by how sure they are: pulses tell, of what is yes or no.
const offersSure = (tool) => tool.samples && page.scene.tells_unproven && !api.exported && !(tool.time && page.time.trees === "seasons");
// Probabilities stand behind the answers, a byte for each.
function withProbabilities(answer) {
  if (!answer.certainty) return answer;
  const half = answer.body.byteLength / 2;
  return { ...answer, probabilities: answer.body.slice(half), body: answer.body.slice(0, half) };
}

// Date, time and zone as questions have them, and what gets through trees.
function timeNow() {
  const { date, zone, minutes, trees } = page.time;
  return { date, zone, clock: clockText(minutes), trees: trees === "opaque" ? trees : { [trees]: "by_date" } };
}
// Whether answers are compared with those of another time.
const isCompared = (tool) => Boolean(tool.between && page.compared && !isChange() && !api.exported);

let asking;
export async function ask(quick = false) {
  const { tool } = page;
  if (tool.name === "plan") return finish();
  if (ASIDES.includes(tool)) return;
  asking?.abort();
  const mine = (asking = new AbortController());
  if (page.failure) {
    card(`<p class="verdict">${t`No answer`}</p><p class="note">${escape(page.failure)}</p>`);
    return;
  }
  if (!page.ready) {
    card(`<p class="busy">${t`The answer comes as soon as the scene is ready.`}</p>`);
    page.pending = true;
    return;
  }
  if (tool.time && page.scene.latitude_deg === null) {
    card(`<p class="verdict">${t`The location is unknown`}</p><p class="note">${t`The sun needs to know where on earth the cloud lies, but its file names no reference system. Open it again with the reference system of the cloud.`}</p>`);
    return;
  }
  if (tool.time && !page.time.date) {
    card(`<p class="verdict">${t`The date is missing`}</p><p class="note">${t`Choose a day below.`}</p>`);
    return;
  }
  if (tool.time && !page.time.zone) {
    card(`<p class="verdict">${t`The time zone is missing`}</p><p class="note">${t`Write one below, such as Europe/Amsterdam or +02:00.`}</p>`);
    return;
  }
  const places = page.places.map(({ local }) => toFile(local));
  page.last = tool.places === 0 ? page.last : null;
  const busy = setTimeout(() => { if (!page.last) card(`<p class="busy">${t`Asking …`}</p>`); }, 150);
  const start = performance.now();
  // with a plan, the change is that from the answer before it
  const answered = async (question, values) => {
    const sure = page.isSure && offersSure(tool) && !isChange() && !isCompared(tool) ? { probability: true } : {};
    const after = withProbabilities(await api.ask(question, { ...values, ...sure }, mine.signal, planInUse()));
    if (tool.change && isChange()) return { ...after, isPlanned: true, before: await api.ask(question, values, mine.signal) };
    if (!isCompared(tool)) return after;
    return { ...after, before: await api.ask(question, { ...values, ...page.compared }, mine.signal, planInUse()) };
  };
  try {
    const [question, values] = tool.ask(places, timeNow());
    // of many points a sample is answered first
    if (tool.samples && page.scene.samples_first && !api.exported) {
      const answer = await answered(question, { ...values, points: "sample" });
      if (mine.signal.aborted) return;
      const shown = { ...answer, isFirst: true, took: performance.now() - start };
      if (quick) page.last = shown;
      showAnswer(tool, shown, places);
      if (quick) return;
      // whoever still moves the time waits for nothing else
      if (tool.time) await new Promise((go) => setTimeout(go, 250));
      if (mine.signal.aborted) return;
    }
    const answer = await answered(question, values);
    if (mine.signal.aborted) return;
    answer.took = performance.now() - start;
    page.last = answer;
    if (tool.places === Infinity) page.marks = page.marks.concat({ line: [page.places.at(-1).local, page.places[0].local], style: 'stroke="#1d4e89" stroke-width="2.5"' });
    showAnswer(tool, answer, places);
  } catch (error) {
    if (error.name === "AbortError") return;
    if (error instanceof api.Lost) return lost(error);
    card(`<p class="verdict">${t`No answer`}</p><p class="note">${escape(error.message)}</p>${readingChoices()}`, listenToReading);
  } finally {
    clearTimeout(busy);
    if (asking === mine) asking = null;
  }
}
page.ask = ask;
// Commands of which no word is broken where it fits into a line.
const words = (commands) => commands.split("\n").map((command) => command.split(" ").map((word) => `<span>${escape(word)}</span>`).join(" ")).join("\n");
// Those of an answer and those of its files, each once.
const together = (answer = [], files = []) => [...answer, ...files.filter(({ text }) => !answer.some((own) => own.text === text))];
function showAnswer(tool, answer, places) {
  const shown = answer.before ? changed(tool, answer, page) : tool.show(answer, page);
  const html = shown.html ?? shown;
  const where = places.length === 1 ? `<dl><dt>${t`Place`}</dt><dd>${shownPlace(places[0])}</dd></dl>` : "";
  const rows = answer.before ? null : tool.rows?.(answer, page);
  const buttons = [
    ...(rows ? [`<button data-save="csv">${t`Table`} (.csv)</button>`] : []),
    ...(tool.properties && !answer.before ? [`<button data-save="geojson">${t`Map`} (.geojson)</button>`] : []),
    `<button data-save="png">${t`Picture`} (.png)</button>`,
  ].join("");
  const time = tool.time ? page.ofTime() : "";
  const sure = offersSure(tool) && !answer.before ? `<button id="sure" aria-pressed="${page.isSure}">${t`Show how sure each answer is`}</button>` : "";
  const compare = tool.between && !api.exported && !answer.isPlanned ? `<button id="compare" aria-pressed="${Boolean(page.compared)}">${page.compared ? t`Compare no longer` : t`Compare this time with another`}</button>` : "";
  const more = sure || compare ? `<div class="row">${sure}${compare}</div>` : "";
  card(`${html}${more}${time ? `<p class="note" id="oftime">${escape(time)}</p>` : ""}${remarks({ remarks: together(answer.remarks, page.remarks) })}${readingChoices()}${where}<h3>${t`The same on the command line`}</h3><pre id="command">${words(shown.command ?? answer.command)}</pre><div class="row"><button data-save="copy">${t`Copy command`}</button>${buttons}</div>`
    + `<p class="note" id="took">${api.exported ? t`Stored in this file.` : t`Answered in ${Math.round(answer.took)} ms.`}</p>`, (box) => {
    shown.after?.(box);
    listenToReading(box);
    const comparing = box.querySelector("#compare");
    if (comparing) comparing.onclick = () => {
      const [, { time, zone }] = tool.ask(places, timeNow());
      page.compared = page.compared ? null : { time, zone };
      if (page.compared) hint(t`Choose another date or time below.`);
      ask();
    };
    const isSure = box.querySelector("#sure");
    if (isSure) isSure.onclick = () => { page.isSure = !page.isSure; ask(); };
    box.querySelectorAll("[data-save]").forEach((button) => { button.onclick = () => saveAs(button, tool, answer, places); });
  });
  page.whenShown?.();
  page.whenShown = null;
  draw();
}
async function saveAs(button, tool, answer, places) {
  const name = `${tool.name}-${page.scene.title.replace(/\..*$/, "")}`;
  const kind = button.dataset.save;
  if (kind === "copy") {
    await navigator.clipboard?.writeText($("command").textContent).catch(() => {});
    button.textContent = t`Copied`;
  } else if (kind === "csv") save(`${name}.csv`, csv(tool.rows(answer, page)), "text/csv");
  else if (kind === "geojson") {
    const [shape, coordinates] = tool.geometry?.(places) ?? ["Point", places[0]];
    save(`${name}.geojson`, geojson(name, [[shape, coordinates, tool.properties(answer)]], page.scene), "application/geo+json");
  } else {
    const chart = $("card").querySelector("figure svg");
    save(`${name}.png`, chart ? await diagram(chart) : await snapshot());
  }
}
export async function snapshot() {
  await complete();
  const keys = page.legend?.keys ?? [];
  const text = [page.scene.title, page.legend?.title].filter(Boolean).join(": ");
  return picture(canvas, $("marks"), keys, text, `${page.scene.crs}; ${t`scale bar`} ${$("scale").textContent}`);
}
