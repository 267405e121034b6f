// Messages and help.
import * as api from "./api.js";
import { escape } from "./charts.js";
import { $, page, TOOLS } from "./state.js";
import { IS_TOUCH } from "./tools.js";

export function lost(error) {
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>Try again</button>`;
  $("message").querySelector("button").onclick = () => { $("message").hidden = true; page.watch(); };
}
export function report(error) {
  if (error instanceof api.Lost) return lost(error);
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>Close</button>`;
  $("message").querySelector("button").onclick = () => { $("message").hidden = true; };
}
let fading;
// Says for some seconds what to do instead.
export function hint(text) {
  clearTimeout(fading);
  $("message").hidden = false;
  $("message").innerHTML = `<span id="hint" role="status">${escape(text)}</span>`;
  fading = setTimeout(() => { if ($("hint")) $("message").hidden = true; }, 5000);
}
const KEYS = () => [
  [`1 to ${Math.min(TOOLS.length, 9)}${TOOLS.length > 9 ? ", 0" : ""}`, "Choose a question"], ["Enter", "Ask at the centre of the view"], ["Esc", "Close the answer"], ["Arrow keys", "Turn"], ["W A S D, Q E", "Move; down and up"],
  ["+ and −", "Zoom"], ["H", "Whole scene"], ["T", "From above"], ["C", "Next colour"], ["M", "Next way of moving"],
  ...(api.exported ? [] : [["V", "Before, after, change of a plan"], ["B", "Balls"]]),
  ...(TOOLS.some(({ time }) => time === "hour") ? [["Space", "Play the day"], ["< and >", "Earlier or later"]] : []),
  ["R", "Measure"], ["X", "Show a part"], ["P", "Save a picture"], ["L", "Light or dark"], ["?", "This help"],
];
const HOW = () => (api.exported
  ? "Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same."
  : "Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.");
const MOVING = () => `${IS_TOUCH ? "Orbit: one finger turns, two fingers move and zoom." : "Orbit: drag to turn, right drag to move, wheel to zoom."} Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.`;
export function help() {
  const box = $("keys");
  box.innerHTML = `<h2>Belvedere</h2><p>${HOW()}</p>`
    + `<table>${KEYS().map(([key, what]) => `<tr><td><kbd>${escape(key)}</kbd></td><td>${escape(what)}</td></tr>`).join("")}</table>`
    + `<p>${MOVING()}</p><form method="dialog"><button autofocus>Close</button></form>`;
  box.showModal();
}
