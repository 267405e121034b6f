// What the page shows stands in its address: a reload, and a bookmark while the program runs, keep view, question,
// places, date, zone and trees.
import { $, page, TOOLS } from "./state.js";
import { showClock } from "./time.js";
import { mover, toFile, toLocal } from "./view.js";

const EVERY = 500;
const short = (v) => Number(v.toFixed(3));

function written() {
  const { tool, time, places } = page;
  const view = [...mover.camera.position.toArray(), ...mover.orbit.target.toArray()].map(short);
  const words = { q: tool.name, date: time.date, minutes: time.minutes, zone: time.zone, trees: time.trees, view: [mover.kind, ...view].join(",") };
  if (tool.name !== "plan" && places.length) words.at = places.map(({ clicked }) => toFile(clicked).join(",")).join(";");
  if (tool.above !== undefined) words.above = tool.above;
  return `#${new URLSearchParams(words)}`;
}
// Keeps the address up to date. What a page forgets when it is closed at once is half a second.
export function remember() {
  setInterval(() => {
    if (!page.ready || document.hidden) return;
    const now = written();
    if (now !== location.hash) history.replaceState(null, "", now);
  }, EVERY);
}
// Shows what the address says.
export function recall(words = new URLSearchParams(location.hash.slice(1))) {
  const numbers = (text) => (text ?? "").split(",").map(Number);
  const minutes = Number(words.get("minutes"));
  if (/^\d{4}-\d\d-\d\d$/.test(words.get("date") ?? "")) page.time.date = $("date").value = words.get("date");
  if (words.get("zone")) page.time.zone = $("zone").value = words.get("zone");
  if (words.has("minutes") && minutes >= 0 && minutes < 1440) page.time.minutes = minutes;
  if (["opaque", "seasons"].includes(words.get("trees"))) page.time.trees = $("trees").querySelector("select").value = words.get("trees");
  showClock();
  const [kind, ...view] = (words.get("view") ?? "").split(",");
  const places = view.map(Number);
  if (["orbit", "walk", "fly"].includes(kind) && places.length === 6 && places.every(Number.isFinite)) {
    mover.orbit.target.set(...places.slice(3));
    mover.camera.position.set(...places.slice(0, 3));
    mover.camera.lookAt(mover.orbit.target);
    $("motion").value = mover.kind = kind;
    mover.orbit.enabled = kind === "orbit";
    if (kind === "orbit") mover.orbit.update();
    mover.changed();
  }
  const tool = TOOLS.find(({ name }) => name === words.get("q"));
  if (!tool || tool.name === "look" || tool.name === "plan") return;
  if (tool.height && Number.isFinite(Number(words.get("above") ?? NaN))) tool.above = Number(words.get("above"));
  page.choose(tool.name);
  for (const place of (words.get("at") ?? "").split(";").filter(Boolean).map(numbers)) if (place.length === 3 && place.every(Number.isFinite)) page.pick(toLocal(place));
  if (tool.places === Infinity && page.places.length >= 3) page.ask();
}
