// How the cloud was read, and its up axis, unit and reference system: they are offered where they are in doubt, and all
// of them in a card of the cloud.
import * as api from "./api.js";
import { card, remarks } from "./card.js";
import { escape } from "./charts.js";
import { report } from "./messages.js";
import { $, page } from "./state.js";
import { count, metres, t } from "./words.js";

const UNITS = () => [["metre", t`metres`], ["foot", t`feet`], ["centimetre", t`centimetres`], ["millimetre", t`millimetres`]];
const DOUBTS = ["y-looks-up", "unit-of-room", "unit-of-survey"];
const said = (key) => Boolean(page.remarks?.some((remark) => remark.key === key));

const turn = () => {
  const isTurned = page.reading.up === "y";
  return `<button id="up" data-up="${isTurned ? "z" : "y"}">${isTurned ? t`Read it with z up` : t`Read it with y up`}</button>`;
};
const unit = () => {
  const options = UNITS().map(([unit, text]) => `<option value="${unit}"${unit === (page.reading.unit ?? "metre") ? " selected" : ""}>${text}</option>`).join("");
  return `<label>${t`Unit, which the files do not name`} <select id="unit">${options}</select></label>`;
};
const system = () => `<form id="system"><label>${t`Reference system`} <input id="system-typed" placeholder="EPSG:7415" size="12" value="${escape(page.reading.crs ?? "")}"></label> <button>${t`Read it again`}</button></form>`;
const hasOpenUnit = () => page.reading.unit || (!page.scene.tells_unit && !page.reading.crs);
const row = (parts) => (parts.some(Boolean) ? `<div class="row" id="reading">${parts.filter(Boolean).join("")}</div>` : "");

// The choices of the card of an answer; nothing where the files tell all of it.
export function readingChoices() {
  const { reading } = page;
  if (!reading) return "";
  return row([(reading.up === "y" || said("y-looks-up") || reading.unit) && turn(), hasOpenUnit() && unit()]);
}
export function listenToReading(box) {
  const read = (change) => api.readAgain({ ...page.reading, ...change }).catch(report);
  const up = box.querySelector("#up");
  if (up) up.onclick = () => read({ up: up.dataset.up });
  const unit = box.querySelector("#unit");
  if (unit) unit.onchange = () => read({ unit: unit.value });
  const system = box.querySelector("#system");
  if (system) system.onsubmit = (event) => {
    event.preventDefault();
    read({ crs: $("system-typed").value.trim() || null });
  };
}
// Shows what is in doubt before anybody asks.
export function offerReading() {
  const doubts = page.remarks.filter(({ key }) => DOUBTS.includes(key));
  if (!page.reading || !doubts.length || page.tool.name !== "look" || !$("card").hidden) return;
  card(`${remarks({ remarks: doubts })}${readingChoices()}`, listenToReading);
}
// The card of the cloud.
export function cloudPanel() {
  const { scene, reading, remarks: said = [] } = page;
  const rows = [[t`Points`, count(scene.point_count)], [t`Reference system`, scene.crs], [t`Size`, scene.low.map((v, i) => metres(scene.high[i] - v, 1)).join(" × ")]];
  const fixed = api.exported ? "" : `<p class="note">${t`To read it with another reference system or up axis, end the program and start it with --crs or --up.`}</p>`;
  card(`<dl>${rows.map(([name, value]) => `<dt>${name}</dt><dd>${escape(value)}</dd>`).join("")}</dl>${reading ? row([turn(), system(), hasOpenUnit() && unit()]) : page.ready ? fixed : ""}${remarks({ remarks: said })}`, listenToReading);
}
