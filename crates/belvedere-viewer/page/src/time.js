// Date, time and zone of questions about the sun, and playing a day.
import * as api from "./api.js";
import { $, page } from "./state.js";

let playing = null;
// Goes to the next time of the slider, and on to its beginning.
export function step(sign = 1) {
  const { min, max, step: by } = $("hour");
  const next = page.time.minutes + sign * Number(by);
  page.time.minutes = next > Number(max) ? Number(min) : next < Number(min) ? Number(max) - (Number(max) % Number(by)) : next;
}
export function setPlaying(on) {
  clearTimeout(playing);
  playing = null;
  $("play").setAttribute("aria-pressed", on);
  $("play").textContent = on ? "Pause" : "Play";
  if (!on) {
    if (page.last?.isFirst) page.ask();
    return;
  }
  const next = async () => {
    step();
    showClock();
    await page.ask(true);
    // nothing to see at night: on to the morning
    for (let i = 0; page.last?.elevation_deg < -6 && i < 6; i++) step();
    if ($("play").getAttribute("aria-pressed") === "true") playing = setTimeout(next, 60);
  };
  playing = setTimeout(next, 0);
}
export function showClock() {
  $("hour").value = page.time.minutes;
  $("clock").textContent = `${String(Math.floor(page.time.minutes / 60)).padStart(2, "0")}:${String(page.time.minutes % 60).padStart(2, "0")}`;
}
export function startTime() {
  if (api.exported) {
    Object.assign(page.time, { date: api.exported.date ?? "", zone: api.exported.zone ?? "" });
    const minutes = api.exported.suns.map((sun) => sun.minutes);
    if (minutes.length) Object.assign($("hour"), { min: minutes[0], max: minutes.at(-1), step: 60 });
    page.time.minutes = minutes[Math.floor(minutes.length / 2)] ?? 720;
    $("date").value = page.time.date;
    $("zone").value = page.time.zone;
    $("date").disabled = $("zone").disabled = true;
    return showClock();
  }
  const own = Intl.DateTimeFormat().resolvedOptions().timeZone;
  const longitude = page.scene.longitude_deg ?? 0;
  const ahead = -new Date().getTimezoneOffset() / 60;
  const sun = Math.round(longitude / 15);
  // the clocks of this computer, unless the scene lies elsewhere on earth
  page.time.zone = Math.abs(ahead - sun) <= 2.5 ? own : `${sun < 0 ? "-" : "+"}${String(Math.abs(sun)).padStart(2, "0")}:00`;
  page.time.date ||= new Date().toISOString().slice(0, 10);
  $("date").value = page.time.date;
  $("zone").value = page.time.zone;
  $("zones").innerHTML = (Intl.supportedValuesOf?.("timeZone") ?? []).map((zone) => `<option value="${zone}">`).join("");
  showClock();
}
export const again = () => { if (page.last || page.tool.places === 0) page.ask(); };
export const isPlaying = () => playing !== null;
