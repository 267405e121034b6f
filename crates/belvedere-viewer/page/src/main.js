// The page: mouse, keys and buttons, and its start.
import * as api from "./api.js";
import * as colors from "./colors.js";
import { toggleBalls, toggleOutlines, watch } from "./loading.js";
import { help, report } from "./messages.js";
import { paint, setColor } from "./paint.js";
import { setWhen } from "./plan.js";
import { ask, choose, click, snapshot } from "./questions.js";
import { save } from "./save.js";
import { $, canvas, page, root, TOOLS } from "./state.js";
import { ASIDES } from "./tools.js";
import { startScreen, stayOffline } from "./start.js";
import { ofViewpoints } from "./viewpoints.js";
import { remember } from "./address.js";
import { again, isPlaying, setPlaying, showClock, step } from "./time.js";
import { t, translate } from "./words.js";
import { cloud, draw, mover, open, placeAt, resize, showAll, shownPlace, toFile, whenDrawn } from "./view.js";

function theme(name) {
  root.dataset.theme = name;
  $("theme").textContent = name === "dark" ? t`Light` : t`Dark`;
  if (page.last && page.tool.name === "seen" && !page.last.certainty) page.answer = colors.ofAnswers(page.last, page.last.viewpoint);
  paint();
}
// Buttons to go with, for those without keys.
function showSteps() {
  $("steps").hidden = mover.kind === "orbit";
  $("steps").querySelectorAll("[data-fly]").forEach((button) => { button.hidden = mover.kind !== "fly"; });
}
page.showSteps = showSteps;
// Panels stand below the bar and above the time, however many lines these take.
page.placePanels = () => {
  root.style.setProperty("--bar", `${$("bar").offsetHeight}px`);
  root.style.setProperty("--time", `${$("timebar").offsetHeight}px`);
};
function listen() {
  let down = null;
  canvas.addEventListener("pointerdown", (event) => {
    // a second finger makes it no click
    down = event.isPrimary ? [event.clientX, event.clientY] : null;
    $("crosshair").hidden = true;
  });
  canvas.addEventListener("pointerup", (event) => {
    const reach = event.pointerType === "touch" ? 12 : 5;
    if (down && event.button === 0 && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < reach && page.scene) click(event.clientX, event.clientY);
    down = null;
  });
  canvas.addEventListener("pointercancel", () => { down = null; });
  canvas.addEventListener("dblclick", () => { if (page.tool.places === Infinity && page.places.length >= 3) ask(); });
  let hovering = false;
  canvas.addEventListener("pointermove", (event) => {
    if (hovering || event.buttons || !page.scene) return;
    hovering = true;
    whenDrawn(() => {
      hovering = false;
      const place = placeAt(event.clientX, event.clientY);
      $("where").textContent = place ? shownPlace(toFile(place)) : "";
    });
  });
  $("color").onchange = () => { page.isColorChosen = true; setColor($("color").value); };
  $("when").onchange = () => setWhen($("when").value);
  $("motion").onchange = () => { mover.setKind($("motion").value); showSteps(); };
  for (const button of $("steps").querySelectorAll("button")) {
    let timer;
    const go = () => mover.go(...button.dataset.go.split(",").map(Number));
    // a held button keeps going
    button.onpointerdown = () => { go(); timer = setInterval(go, 60); };
    button.onpointerup = button.onpointerleave = button.onpointercancel = () => clearInterval(timer);
    button.oncontextmenu = (event) => event.preventDefault();
    button.onclick = (event) => { if (event.detail === 0) go(); };
  }
  $("home").onclick = () => { $("motion").value = "orbit"; showAll(); showSteps(); };
  $("top").onclick = () => { $("motion").value = "orbit"; showAll(true); showSteps(); };
  $("theme").onclick = () => theme(root.dataset.theme === "dark" ? "light" : "dark");
  $("picture").onclick = async () => save(`${page.scene.title.replace(/\..*$/, "")}.png`, await snapshot());
  for (const { name } of ASIDES) $(name).onclick = () => page.scene && page.choose(page.tool.name === name ? TOOLS[0].name : name);
  $("balls").onclick = toggleBalls;
  $("outlines").onclick = toggleOutlines;
  $("meshes").onclick = () => {
    const on = $("meshes").getAttribute("aria-pressed") !== "true";
    $("meshes").setAttribute("aria-pressed", on);
    cloud.meshes.forEach((mesh) => { mesh.visible = on; });
    draw();
  };
  $("help").onclick = help;
  $("play").onclick = () => setPlaying(!isPlaying());
  $("date").onchange = () => { page.time.date = $("date").value; again(); };
  $("hour").oninput = () => { page.time.minutes = Number($("hour").value); showClock(); again(); };
  $("trees").querySelector("select").onchange = (event) => { page.time.trees = event.target.value; again(); };
  $("zone").onchange = () => { page.time.zone = $("zone").value.trim(); again(); };
  addEventListener("resize", resize);
  const heights = new ResizeObserver(page.placePanels);
  heights.observe($("bar"));
  heights.observe($("timebar"));
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
  const presses = { h: "home", t: "top", b: "balls", o: "outlines", p: "picture", l: "theme", r: "measure", x: "cut", "?": "help" };
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (on && (name === "Enter" || name === " ")) return;
  if (turns[name]) mover.turn(...turns[name]);
  else if (goes[name]) mover.go(...goes[name]);
  else if (presses[name]) { if (!$(presses[name]).hidden) $(presses[name]).click(); }
  else if (name === "+" || name === "=") mover.zoom(0.85);
  else if (name === "-") mover.zoom(1.18);
  else if (name === "c") cycle($("color"));
  else if (name === "m") cycle($("motion"));
  else if (name === "v" && !$("plan").hidden) cycle($("when"));
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
  } else if (/^[0-9]$/.test(name) && TOOLS[(Number(name) + 9) % 10]) choose(TOOLS[(Number(name) + 9) % 10]);
  else return;
  event.preventDefault();
}

function start() {
  translate(document.body);
  $("tools").innerHTML = `<h2>${t`Questions`}</h2>${TOOLS.map((tool, i) => `<button data-tool="${tool.name}" aria-pressed="false" title="${tool.title} (${(i + 1) % 10})">${tool.icon}<span>${tool.title}</span><small aria-hidden="true">${tool.short}</small><kbd aria-hidden="true">${(i + 1) % 10}</kbd></button>`).join("")}<p></p>`;
  for (const button of $("tools").querySelectorAll("button")) button.onclick = () => page.choose(button.dataset.tool);
  if (api.exported) {
    $("balls").hidden = true;
    const seen = TOOLS.find(({ name }) => name === "seen");
    if (seen) Object.assign(seen, ofViewpoints({ ...seen }));
  }
  if (matchMedia("(prefers-color-scheme: dark)").matches) theme("dark");
  try {
    open();
  } catch {
    report(new Error(t`This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration.`));
    return;
  }
  listen();
  resize();
  choose(TOOLS[0]);
  if (api.opens) {
    startScreen(watch);
    stayOffline();
  } else watch();
  if (!api.exported) remember();
}
start();
