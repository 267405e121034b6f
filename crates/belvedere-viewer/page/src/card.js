// The card beside the view, and what several cards say.
import { escape } from "./charts.js";
import { $, page, TOOLS } from "./state.js";
import { remarkText, t } from "./words.js";

// The field of the height above the first place.
function field() {
  const { tool } = page;
  if (!tool.height) return "";
  tool.above ??= tool.height[1];
  return `<div class="field"><label for="above">${tool.height[0]}</label><span><input id="above" type="number" step="0.1" value="${tool.above}"> m</span></div>`;
}
// Shows a card of the tool; `after` gets its box.
export function card(html, after) {
  const box = $("card");
  box.hidden = false;
  box.innerHTML = `<header><h2>${escape(page.tool.title)}</h2><button aria-label="${t`Close`}" title="${t`Close`} (Esc)">×</button></header>${field()}${html}`;
  box.querySelector("header button").onclick = () => page.choose(TOOLS[0].name);
  const above = box.querySelector("#above");
  if (above) above.onchange = () => {
    const value = Number.parseFloat(above.value);
    if (!Number.isFinite(value)) return;
    page.tool.above = value;
    page.places.forEach((place, i) => { if (i === 0) place.local = lifted(place.clicked, value); });
    if (page.last) page.ask();
  };
  after?.(box);
}
// A place above a clicked one.
export const lifted = ([x, y, z], above) => [x, y, z + above];
// How many corners were clicked, and what to do next.
export const corners = ({ length }) => `${length === 1 ? t`1 corner.` : t`${length} corners.`} ${length < 3 ? t`Click more.` : t`Click more, or go on with these.`}`;

// What must be known beside an answer, in the words of all faces.
export const remarks = ({ remarks: all = [] }) => all.map((remark) => {
  const { key, severity } = remark;
  const text = remarkText(remark);
  // names of files stay as they are
  const sentence = /^\S+\.\w+:/.test(text) ? text : text[0].toUpperCase() + text.slice(1);
  return `<p class="remark ${severity}" data-key="${escape(key)}">${severity === "warning" ? "⚠ " : ""}${escape(sentence)}.</p>`;
}).join("");
