// Messages and help.
import * as api from "./api.js";
import { escape } from "./charts.js";
import { $, page, TOOLS } from "./state.js";
import { IS_TOUCH } from "./tools.js";
import { LANGUAGES, language, setLanguage, t } from "./words.js";

export function lost(error) {
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>${t`Try again`}</button>`;
  $("message").querySelector("button").onclick = () => { $("message").hidden = true; page.watch(); };
}
export function report(error) {
  if (error instanceof api.Lost) return lost(error);
  $("message").hidden = false;
  $("message").innerHTML = `<strong>${escape(error.message)}</strong><br><button>${t`Close`}</button>`;
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
  [`1–${Math.min(TOOLS.length, 9)}${TOOLS.length > 9 ? ", 0" : ""}`, t`Choose a question`], ["Enter", t`Ask at the centre of the view`], ["Esc", t`Close the answer`], ["← → ↑ ↓", t`Turn`], ["W A S D, Q E", t`Move; down and up`],
  ["+ −", t`Zoom`], ["H", t`Whole scene`], ["T", t`From above`], ["C", t`Next colour`], ["M", t`Next way of moving`],
  ...(api.exported ? [] : [["V", t`Before, after, change of a plan`], ["B", t`Balls`], ["O", t`Edges`]]),
  ...(TOOLS.some(({ time }) => time === "hour") ? [[t`Space`, t`Play the day`], ["< >", t`Earlier or later`]] : []),
  ["R", t`Measure`], ["X", t`Show a part`], ["P", t`Save a picture`], ["L", t`Light or dark`], ["?", t`This help`],
];
const HOW = () => (api.exported
  ? t`Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same.`
  : t`Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.`);
const MOVING = () => `${IS_TOUCH ? t`Orbit: one finger turns, two fingers move and zoom.` : t`Orbit: drag to turn, right drag to move, wheel to zoom.`} ${t`Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.`}`;
export function help() {
  const box = $("keys");
  // what a page opened itself would be lost
  const options = Object.entries(LANGUAGES).map(([name, text]) => `<option value="${name}"${name === language ? " selected" : ""}>${text}</option>`).join("");
  const languages = api.opens ? "" : `<p><label>${t`Language`} <select>${options}</select></label></p>`;
  box.innerHTML = `<h2>Belvedere</h2><p>${HOW()}</p>`
    + `<table>${KEYS().map(([key, what]) => `<tr><td><kbd>${escape(key)}</kbd></td><td>${escape(what)}</td></tr>`).join("")}</table>`
    + `<p>${MOVING()}</p>${languages}<form method="dialog"><button autofocus>${t`Close`}</button></form>`;
  const chosen = box.querySelector("select");
  if (chosen) chosen.onchange = () => setLanguage(chosen.value);
  box.showModal();
}
