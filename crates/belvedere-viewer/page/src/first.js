// What the page answers before anybody asks: the shadows of now at the place, with the word that places can be clicked.
import * as api from "./api.js";
import { $, page, TOOLS } from "./state.js";
import { IS_TOUCH } from "./tools.js";
import { showNow } from "./time.js";
import { showAll } from "./view.js";
import { t } from "./words.js";

// Says what to do until something is clicked or another question is chosen.
function invite() {
  const box = Object.assign(document.createElement("div"), { id: "invite", textContent: IS_TOUCH ? t`Tap anywhere to ask` : t`Click anywhere to ask` });
  document.body.append(box);
}
export const invited = () => $("invite")?.remove();

// Answers unless the file has no points, its place on earth is not known, or something else is shown already.
export async function firstAnswer(results) {
  const isKnown = api.exported || (page.scene.latitude_deg !== null && page.scene.point_count);
  const isFree = page.tool.name === "look" && $("card").hidden && !page.pending && !results?.some((file) => file.is_shown_first);
  if (!isKnown || !isFree || !TOOLS.some(({ name }) => name === "shadow")) return;
  if (!api.exported) await showNow();
  // somebody may have been quicker
  if (page.tool.name !== "look" || !$("card").hidden) return;
  page.choose("shadow");
  // the card of the answer takes a part of the view, as soon as it has its place above the time
  page.whenShown = () => requestAnimationFrame(async () => {
    page.placePanels();
    await Promise.allSettled($("card").getAnimations().map(({ finished }) => finished));
    if (!page.isMoved) showAll();
  });
  if (!api.exported) invite();
}
