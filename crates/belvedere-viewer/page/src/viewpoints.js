// What is seen from the viewpoints of a page without a server, where no other question can be answered.
import * as api from "./api.js";
import { escape } from "./charts.js";
import { $ } from "./state.js";
import { shownPlace, toLocal } from "./view.js";
import { t } from "./words.js";

let chosen = 0;
const name = (number) => t`Viewpoint ${number + 1}`;

// The question about a clicked place, for a viewpoint of the file.
export function ofViewpoints(tool) {
  return {
    ...tool, height: null, places: 0, samples: false, hint: t`Choose a viewpoint: its view is in this file.`,
    ask: () => ["seen", { viewpoint: chosen }],
    show(answer, page) {
      const { viewpoints } = api.exported;
      page.marks = viewpoints.map(({ place }, i) => ({ at: toLocal(place), label: i === chosen ? t`${name(i)}, shown` : name(i), color: i === chosen ? "#d1495b" : undefined }));
      answer.viewpoint = t`From viewpoint ${chosen + 1}`;
      const options = viewpoints.map((_, i) => `<option value="${i}"${i === chosen ? " selected" : ""}>${name(i)}</option>`).join("");
      return {
        html: `<div class="field"><label for="viewpoint">${t`Viewpoint`}</label><select id="viewpoint">${options}</select></div>`
          + `<p class="note">${escape(shownPlace(answer.place))}</p>${tool.show(answer, page)}`,
        after() { $("viewpoint").onchange = () => { chosen = Number($("viewpoint").value); page.ask(); }; },
      };
    },
    geometry: () => ["Point", api.exported.viewpoints[chosen].place],
  };
}
