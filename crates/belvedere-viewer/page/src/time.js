// Date, time and zone of questions about the sun, and playing a day.
import * as api from "./api.js";
import { $, page } from "./state.js";
import { t, word } from "./words.js";
import { clockOf, zoneOf } from "./zones.js";

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
  $("play").textContent = on ? t`Pause` : t`Play`;
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
export const clockText = (minutes) => `${String(Math.floor(minutes / 60)).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
export function showClock() {
  $("hour").value = page.time.minutes;
  $("clock").textContent = clockText(page.time.minutes);
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
  const { longitude_deg: longitude, latitude_deg: latitude } = page.scene;
  const own = Intl.DateTimeFormat().resolvedOptions().timeZone;
  const isKnown = longitude !== null && longitude !== undefined;
  const { zone, why } = isKnown ? zoneOf(page.scene.zones, longitude, latitude, own) : { zone: own, why: t`this computer's` };
  page.time.zone = zone;
  page.time.zoneOf = { zone, why };
  page.time.date ||= clockOf(zone)?.date ?? new Date().toISOString().slice(0, 10);
  $("date").value = page.time.date;
  $("zone").value = page.time.zone;
  $("zones").innerHTML = (Intl.supportedValuesOf?.("timeZone") ?? []).map((zone) => `<option value="${zone}">`).join("");
  showClock();
}
// The sun this low sends shadows over all there is: it counts as night.
const LOW_DEG = 3;
// Takes the time of now at the place; where it is night there, the time of day at which the sun is highest.
export async function showNow(now = new Date()) {
  const { time } = page;
  const clock = clockOf(time.zone, now);
  if (!clock) return;
  const sun = await api.ask("daylight", { time: `${clock.date}T${clockText(clock.minutes)}`, zone: time.zone });
  const isNight = sun.elevation_deg < LOW_DEG;
  const noon = (Math.round(sun.noon_minutes / 10) * 10) % 1440;
  time.date = clock.date;
  time.minutes = isNight ? noon : Math.floor(clock.minutes / 10) * 10;
  $("date").value = time.date;
  showClock();
  const why = isNight ? t`It is ${clockText(clock.minutes)} there now, and the sun is down or near the horizon: this is noon, when it stands highest.` : t`This is now, by the clocks of the place.`;
  time.said = { date: time.date, minutes: time.minutes, zone: time.zone, why };
}
// How far the clocks of the zone are ahead of UTC at noon of the day, such as UTC+2.
page.ahead = () => {
  const { ahead } = clockOf(page.time.zone, new Date(`${page.time.date}T12:00Z`)) ?? {};
  if (ahead === undefined) return page.time.zone;
  const [hours, minutes] = [Math.floor(Math.abs(ahead) / 60), Math.abs(ahead) % 60];
  return `UTC${ahead < 0 ? "−" : "+"}${hours}${minutes ? `:${String(minutes).padStart(2, "0")}` : ""}`;
};
// What is to be said of the time that is shown: why it is this one, and where its zone is from.
page.ofTime = () => {
  const { date, minutes, zone, said, zoneOf: from } = page.time;
  const isSaid = page.tool.time === "hour" && said && said.date === date && said.minutes === minutes && said.zone === zone;
  return [...(isSaid ? [said.why] : []), from?.zone === zone ? t`Times are those of ${zone}: ${word(from.why)}.` : t`Times are those of ${zone}.`].join(" ");
};
export const again = () => { if (page.last || page.tool.places === 0) page.ask(); };
export const isPlaying = () => playing !== null;
