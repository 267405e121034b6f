// The first screen of a page that opens files itself.
import { extentOf, isCatalogue, meeting } from "./catalogue.js";
import { hint, report } from "./messages.js";
import { $, page } from "./state.js";
import { count, fixed, LANGUAGES, language, setLanguage, t } from "./words.js";
import { open, tilesOf } from "./engines/worker.js";

const DEMO = "demo.laz";

// Memory of a scene for each point, bytes: measured with AHN and towns of 12 points/m². The most that a page can have,
// and what a phone lets it have.
const BYTES_A_POINT = 700, MAX_BYTES = 3.8e9, MAX_BYTES_OF_PHONES = 0.7e9;
// How many points there is room for: in half of the memory that the browser tells of.
function maxPoints() {
  const isPhone = navigator.userAgentData?.mobile ?? /iPhone|iPad|Android/.test(navigator.userAgent);
  const bytes = isPhone ? MAX_BYTES_OF_PHONES : Math.min(MAX_BYTES, (navigator.deviceMemory ?? 8) * 0.5e9);
  return Math.floor(bytes / BYTES_A_POINT);
}
const fromFragment = () => new URLSearchParams(location.hash.slice(1));

// Asks which part of a cloud to open that does not fit as a whole: a square on its map that can be moved. `openPart`
// gets it, and says whether anything lies there; a catalogue has `tiles` on the map.
function chooseWindow(openPart, { points, most, low, high, side: longest = Infinity, tiles = [] }) {
  const size = [high[0] - low[0], high[1] - low[1]];
  // a tenth fewer: points do not lie evenly
  const covered = tiles.length ? tiles.reduce((sum, tile) => sum + (tile.high[0] - tile.low[0]) * (tile.high[1] - tile.low[1]), 0) : size[0] * size[1];
  const side = Math.min(Math.sqrt((covered * most * 0.9) / points), longest);
  const sides = size.map((length) => Math.min(side, length));
  const corner = [0, 1].map((i) => low[i] + (size[i] - sides[i]) / 2);
  const scale = 260 / Math.max(...size);
  const box = $("part");
  $("progress").hidden = true;
  $("start").hidden = false;
  $("start").firstElementChild.hidden = true;
  box.hidden = false;
  const millions = (n) => fixed(n / 1e6, 1);
  const [wide, deep] = sides.map(Math.round);
  box.querySelector("p").textContent = tiles.length ? t`The catalogue has ${count(tiles.length)} tiles. Choose the part to open: ${wide} by ${deep}, in the unit of the files.` : t`The files have ${millions(points)} million points, and this browser has room for ${millions(most)} million. Choose the part to open: ${wide} by ${deep}, in the unit of the file.`;
  const map = box.querySelector("svg");
  map.setAttribute("viewBox", `-1 -1 ${size[0] * scale + 2} ${size[1] * scale + 2}`);
  const outline = ({ low: [west, south], high: [east, north] }) => `<rect x="${(west - low[0]) * scale}" y="${(high[1] - north) * scale}" width="${(east - west) * scale}" height="${(north - south) * scale}" class="all"/>`;
  map.innerHTML = `${(tiles.length ? tiles : [{ low, high }]).map(outline).join("")}<rect width="${sides[0] * scale}" height="${sides[1] * scale}" class="window"/>`;
  const move = (to) => {
    [0, 1].forEach((i) => { corner[i] = Math.min(Math.max(to[i], low[i]), high[i] - sides[i]); });
    const rect = map.querySelector(".window");
    rect.setAttribute("x", (corner[0] - low[0]) * scale);
    rect.setAttribute("y", (high[1] - corner[1] - sides[1]) * scale);
    box.querySelector("output").textContent = t`${corner.map(Math.round).join(", ")} to ${corner.map((v, i) => Math.round(v + sides[i])).join(", ")}`;
  };
  const at = (event) => {
    const inverse = map.getScreenCTM().inverse();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(inverse);
    move([low[0] + x / scale - sides[0] / 2, high[1] - y / scale - sides[1] / 2]);
  };
  map.onpointerdown = (event) => { map.setPointerCapture(event.pointerId); at(event); };
  map.onpointermove = (event) => { if (event.buttons) at(event); };
  map.onkeydown = (event) => {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!by) return;
    event.preventDefault();
    move(corner.map((v, i) => v + by[i] * Math.max(sides[i] / 10, size[i] / 100)));
  };
  move(corner);
  box.querySelector("button").onclick = () => {
    if (!openPart([...corner, ...corner.map((v, i) => v + sides[i])])) return report(new Error(t`No tile of the catalogue lies there.`));
    box.hidden = true;
    $("start").hidden = true;
    $("progress").hidden = false;
  };
}

// Opens files, or those of a catalogue that a part needs.
function begin(files, whenOpen) {
  const crs = $("crs-typed").value.trim();
  const corners = $("window-typed").value.split(/[\s,;]+/).filter(Boolean).map(Number);
  if (corners.length && (corners.length !== 4 || corners.some(Number.isNaN))) {
    report(new Error(t`The window needs four numbers: west, south, east, north.`));
    return;
  }
  $("start").hidden = true;
  $("progress").hidden = false;
  page.failure = null;
  const reading = { up: $("up-chosen").value || "z", unit: $("unit-chosen").value || null, crs: crs || null };
  const options = { max_points: maxPoints(), reading, ...(corners.length ? { window: corners } : {}) };
  if (files.length === 1 && files[0].url && isCatalogue(files[0].url)) return beginCatalogue(files[0].url, options, whenOpen);
  const openPart = (window) => {
    open(files, { ...options, window }, () => {});
    return true;
  };
  open(files, options, (announced) => chooseWindow(openPart, announced));
  whenOpen();
}
async function beginCatalogue(url, options, whenOpen) {
  try {
    const tiles = await tilesOf(url);
    const openPart = (window) => {
      const files = meeting(tiles, window).map(({ address }) => ofAddress(address));
      if (!files.length) return false;
      open(files, { ...options, window }, () => {});
      whenOpen();
      return true;
    };
    if (!options.window) return chooseWindow(openPart, { ...extentOf(tiles), most: options.max_points });
    if (!openPart(options.window)) throw new Error(t`No tile of the catalogue lies there.`);
  } catch (error) {
    $("progress").hidden = true;
    $("start").hidden = false;
    report(error);
  }
}
// The end of an address is the name of the file there.
const ofAddress = (url) => ({ name: decodeURIComponent(new URL(url, location.href).pathname.split("/").pop()), url: new URL(url, location.href).href });

async function showKept() {
  const size = async (folder) => {
    let [scenes, bytes] = [0, 0];
    for await (const handle of folder.values()) {
      scenes += 1;
      bytes += (await handle.getFile()).size;
    }
    return [scenes, bytes];
  };
  try {
    const root = await navigator.storage.getDirectory();
    const [scenes, bytes] = await size(await root.getDirectoryHandle("scenes"));
    if (!scenes) return;
    const megabytes = Math.ceil(bytes / 1e6);
    $("kept").hidden = false;
    $("kept").querySelector("span").textContent = scenes === 1 ? t`1 scene is kept in this browser (${megabytes} MB): the same files open in a moment.` : t`${scenes} scenes are kept in this browser (${megabytes} MB): the same files open in a moment.`;
    $("kept").querySelector("button").onclick = async () => {
      await root.removeEntry("scenes", { recursive: true });
      $("kept").hidden = true;
    };
  } catch {
    // nothing was kept yet
  }
}

export function startScreen(whenOpen) {
  $("start").hidden = false;
  const languages = $("languages");
  languages.append(...Object.entries(LANGUAGES).map(([name, text]) => new Option(text, name)));
  languages.value = language;
  languages.onchange = () => setLanguage(languages.value);
  const take = (list) => {
    const files = [...list].map((file) => ({ name: file.name, file }));
    if (files.length) begin(files, whenOpen);
  };
  // all files may be chosen: phones know no type for most endings, and would let none be
  $("choose").onchange = () => take($("choose").files);
  // as a whole, so that it is there without a network too
  $("demo").onclick = async () => {
    try {
      begin([{ name: DEMO, file: await (await fetch(DEMO)).blob() }], whenOpen);
    } catch (error) {
      report(error);
    }
  };
  // a cloud that was put beside the page when it was built, under a name that says whose it is
  const tile = document.querySelector('meta[name="tile"]');
  if (tile) {
    const button = Object.assign(document.createElement("button"), { id: "tile", textContent: tile.content });
    $("demo").after(" ", button);
    button.onclick = () => {
      $("crs-typed").value = tile.dataset.crs;
      begin([ofAddress(tile.dataset.file)], whenOpen);
    };
  }
  $("address").onsubmit = (event) => {
    event.preventDefault();
    const words = { open: "address-typed", crs: "crs-typed", window: "window-typed", up: "up-chosen", unit: "unit-chosen" };
    const typed = Object.entries(words).map(([name, id]) => [name, $(id).value.trim()]).filter(([, value]) => value);
    // a link to all of it
    history.replaceState(null, "", `#${new URLSearchParams(typed)}`);
    begin([ofAddress($("address-typed").value.trim())], whenOpen);
  };
  $("cancel").hidden = $("open").hidden = false;
  // only the end of the worker ends what it computes, and frees its memory
  $("cancel").onclick = $("open").onclick = () => location.replace(location.pathname);
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    if (!$("start").hidden) take(event.dataTransfer.files);
  });
  showKept();
  const words = fromFragment();
  $("crs-typed").value = words.get("crs") ?? "";
  $("window-typed").value = words.get("window") ?? "";
  if (words.get("up") === "y") $("up-chosen").value = "y";
  $("unit-chosen").value = words.get("unit") ?? "";
  const isChosen = $("up-chosen").value || $("unit-chosen").value || $("crs-typed").value;
  if (isChosen && !words.get("open")) {
    $("address").parentElement.open = true;
    hint(t`Choose the files again: they are read as chosen below.`);
  }
  if (words.get("open")) begin([ofAddress(words.get("open"))], whenOpen);
}
// The program's parts are kept for use without a network, and the page may share memory between threads.
export async function stayOffline() {
  if (!navigator.serviceWorker) return;
  try {
    const registration = await navigator.serviceWorker.register("service-worker.js");
    // where the server does not send what shared memory needs, the service worker does, from the next load on
    if (!crossOriginIsolated && !navigator.serviceWorker.controller) {
      await navigator.serviceWorker.ready;
      if (registration.active && !sessionStorage.getItem("reloaded")) {
        sessionStorage.setItem("reloaded", "yes");
        location.reload();
      }
    }
  } catch {
    // a private window: the page works, but not without a network
  }
}
