// The up axis and the unit of a cloud that does not name them: both are offered where they are in doubt.
import * as api from "./api.js";
import { report } from "./messages.js";
import { card, remarks } from "./questions.js";
import { $, page } from "./state.js";
import { t } from "./words.js";

const UNITS = () => [["metre", t`metres`], ["foot", t`feet`], ["centimetre", t`centimetres`], ["millimetre", t`millimetres`]];
const DOUBTS = ["y-looks-up", "unit-of-room", "unit-of-survey"];
const said = (key) => Boolean(page.remarks?.some((remark) => remark.key === key));

// The choices of a card; nothing where the files tell all of it.
export function readingChoices() {
  const { reading, scene } = page;
  if (!reading) return "";
  const isTurned = reading.up === "y";
  const turn = isTurned || said("y-looks-up") || reading.unit ? `<button id="up" data-up="${isTurned ? "z" : "y"}">${isTurned ? t`Read it with z up` : t`Read it with y up`}</button>` : "";
  const isOpen = reading.unit || !scene.tells_unit;
  const options = UNITS().map(([unit, text]) => `<option value="${unit}"${unit === (reading.unit ?? "metre") ? " selected" : ""}>${text}</option>`).join("");
  const unit = isOpen ? `<label>${t`Unit, which the files do not name`} <select id="unit">${options}</select></label>` : "";
  return turn || unit ? `<div class="row" id="reading">${turn}${unit}</div>` : "";
}
export function listenToReading(box) {
  const read = (change) => api.readAgain({ ...page.reading, ...change }).catch(report);
  const up = box.querySelector("#up");
  if (up) up.onclick = () => read({ up: up.dataset.up });
  const unit = box.querySelector("#unit");
  if (unit) unit.onchange = () => read({ unit: unit.value });
}
// Shows what is in doubt before anybody asks.
export function offerReading() {
  const doubts = page.remarks.filter(({ key }) => DOUBTS.includes(key));
  if (!page.reading || !doubts.length || page.tool.name !== "look" || !$("card").hidden) return;
  card(`${remarks({ remarks: doubts })}${readingChoices()}`, listenToReading);
}
