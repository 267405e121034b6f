// What the page shows stands in its address, which can be kept and shared while the program runs: question, places,
// date, time, zone, trees, colour and view. Going back goes to the question before.
import { setCut } from "./cut.js";
import { setColor } from "./paint.js";
import { $, page, toolOf } from "./state.js";
import { clockText, showClock } from "./time.js";
import { mover, toFile, toLocal } from "./view.js";

const EVERY = 500;
const short = (v) => Number(v.toFixed(3));
const wordsOf = (hash) => new URLSearchParams(hash.slice(1));

function written() {
  const { tool, time, places } = page;
  // a page that opens files itself has there what it opened
  const opened = [...wordsOf(location.hash)].filter(([name]) => ["open", "crs", "window", "up", "unit"].includes(name));
  const words = { ...Object.fromEntries(opened), q: tool.name, d: time.date, t: clockText(time.minutes), z: time.zone };
  if (time.trees !== "opaque") words.trees = time.trees;
  if ($("outlines").getAttribute("aria-pressed") === "true") words.edges = "yes";
  if (page.isSure) words.sure = "yes";
  if (page.compared) Object.assign(words, { from: page.compared.time, fromz: page.compared.zone });
  if (tool.name !== "plan" && places.length) words.p = places.map(({ clicked }) => toFile(clicked).join(",")).join(";");
  if (tool.above !== undefined) words.h = tool.above;
  if (page.cut) words.cut = [page.cut.low, page.cut.high].flatMap(toFile).join(",");
  words.c = page.before ?? $("color").value;
  words.v = [mover.kind, ...[...mover.camera.position.toArray(), ...mover.orbit.target.toArray()].map(short)].join(",");
  // what may stand in an address as it is stays legible
  const text = (value) => encodeURIComponent(value).replaceAll(/%(2C|2F|3A|3B)/g, decodeURIComponent);
  return `#${Object.entries(words).map(([name, value]) => `${name}=${text(value)}`).join("&")}`;
}
// Keeps the address up to date: a question that was chosen is a new entry of the history. What a page forgets when it
// is closed at once is half a second.
export function remember() {
  setInterval(() => {
    if (!page.isRecalled || document.hidden) return;
    const now = written();
    if (now === location.hash) return;
    const before = wordsOf(location.hash).get("q");
    if (before && before !== page.tool.name) history.pushState(null, "", now);
    else history.replaceState(null, "", now);
  }, EVERY);
  addEventListener("popstate", () => { if (page.isRecalled) recall(); });
}
function recallTime(words) {
  const { time } = page;
  const clock = /^(\d\d):(\d\d)$/.exec(words.get("t") ?? "");
  const minutes = clock ? 60 * Number(clock[1]) + Number(clock[2]) : NaN;
  if (/^\d{4}-\d\d-\d\d$/.test(words.get("d") ?? "")) time.date = $("date").value = words.get("d");
  if (words.get("z")) time.zone = $("zone").value = words.get("z");
  if (minutes < 1440) time.minutes = minutes;
  if (["measured", "opaque", "seasons"].includes(words.get("trees"))) time.trees = $("trees").querySelector("select").value = words.get("trees");
  showClock();
}
function recallColor(name) {
  const isThere = [...$("color").options].some(({ value }) => value === name);
  if (!isThere || name === "answer") return;
  page.isColorChosen = true;
  if (page.before) page.before = name;
  else setColor(name);
}
function recallView(words) {
  const [kind, ...view] = (words.get("v") ?? "").split(",");
  const places = view.map(Number);
  if (!["orbit", "walk", "fly"].includes(kind) || places.length !== 6 || !places.every(Number.isFinite)) return;
  mover.orbit.target.set(...places.slice(3));
  mover.camera.position.set(...places.slice(0, 3));
  mover.camera.lookAt(mover.orbit.target);
  $("motion").value = mover.kind = kind;
  page.showSteps?.();
  mover.orbit.enabled = kind === "orbit";
  if (kind === "orbit") mover.orbit.update();
  mover.changed();
}
function recallCut(words) {
  const ends = (words.get("cut") ?? "").split(",").map(Number);
  setCut(ends.length === 6 && ends.every(Number.isFinite) ? { low: toLocal(ends.slice(0, 3)), high: toLocal(ends.slice(3)) } : null);
}
// Shows what the address says; returns whether it names a question.
export function recall(words = wordsOf(location.hash)) {
  page.isRecalled = true;
  const tool = toolOf(words.get("q"));
  recallTime(words);
  recallView(words);
  page.isSure = words.get("sure") === "yes";
  if ((words.get("edges") === "yes") !== ($("outlines").getAttribute("aria-pressed") === "true") && !$("outlines").hidden) $("outlines").click();
  page.compared = /^\d{4}-\d\d-\d\dT\d\d:\d\d$/.test(words.get("from") ?? "") && words.get("fromz") ? { time: words.get("from"), zone: words.get("fromz") } : null;
  if (!tool) return false;
  if (tool.height && Number.isFinite(Number(words.get("h") ?? NaN))) tool.above = Number(words.get("h"));
  page.choose(tool.name);
  const color = words.get("c");
  recallColor(color);
  if (color === "color") page.colorsKnown?.then(() => recallColor(color));
  if (tool.name === "plan") return true;
  for (const place of (words.get("p") ?? "").split(";").map((text) => text.split(",").map(Number))) if (place.length === 3 && place.every(Number.isFinite)) page.pick(toLocal(place));
  if (tool.places === Infinity && page.places.length >= 3) page.ask();
  return true;
}
