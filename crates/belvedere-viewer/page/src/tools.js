// The questions: what is clicked, what is sent to the server, and how the answer is shown.
import * as charts from "./charts.js";
import { escape, hours } from "./charts.js";
import * as colors from "./colors.js";

const icon = (d) => `<svg viewBox="0 0 24 24" aria-hidden="true">${d}</svg>`;
const EYE = '<path d="M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12z"/><circle cx="12" cy="12" r="3"/>';
const SUN = '<circle cx="12" cy="12" r="4"/><path d="M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M19 5l-2 2M7 17l-2 2"/>';
const count = (n) => n.toLocaleString("en");
const percent = (part, whole) => `${((100 * part) / Math.max(whole, 1)).toFixed(1)} %`;
const list = (rows) => `<dl>${rows.map(([name, value]) => `<dt>${escape(name)}</dt><dd>${escape(value)}</dd>`).join("")}</dl>`;

// A first answer is one for a sample: its shares are about right, and its counts are those of the sample times the
// points it represents.
const about = (answer) => (answer.isFirst ? "About " : "");
const FIRST = (answer) => `A first answer from a sample of ${count(answer.points)} points; the exact one follows …`;
const estimated = (n) => { const unit = 10 ** Math.max(Math.floor(Math.log10(n)) - 1, 0); return `about ${count(Math.round(n / unit) * unit)}`; };

function shares(answer, of, page) {
  const names = colors.ANSWERS();
  const rows = [[1, answer.visible], ...(answer.tells_unproven !== false ? [[2, answer.unproven]] : []), [0, answer.blocked]];
  const whole = rows.reduce((sum, [, n]) => sum + n, 0);
  return `<div class="shares">${rows.map(([code, n]) => `<span style="flex:${n} 0 0;background:${names[code][1]}"></span>`).join("")}</div>`
    + `<div class="key">${rows.map(([code, n]) => `<span><i class="swatch" style="background:${names[code][1]}"></i>${names[code][0]} ${percent(n, whole)}</span>`).join("")}</div>`
    + list(rows.map(([code, n]) => [`${of} ${names[code][0]}`, answer.isFirst && n ? estimated((n * page.scene.point_count) / answer.points) : count(n)]));
}

// How many answers are certain, where that is known.
const certainty = ({ certainty: sure }, [free, blocked]) => {
  if (!sure) return "";
  const { free: high, blocked: low, uncertain } = sure;
  const whole = high + low + uncertain;
  const name = `${Math.round(100 * sure.certain_from)} % sure`;
  return list([[`${name}: ${free}`, percent(high, whole)], [`${name}: ${blocked}`, percent(low, whole)], ["Less sure, or unproven", percent(uncertain, whole)]]);
};
const certainRows = ({ certainty: sure }) => (sure ? [["certain from", sure.certain_from], ["certainly free", sure.free], ["certainly blocked", sure.blocked], ["uncertain", sure.uncertain]] : []);

const UNPROVEN = "Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.";

// Whether fingers are the way to point.
export const IS_TOUCH = matchMedia("(pointer: coarse)").matches;

export const TOOLS = [
  {
    name: "look", short: "Look", title: "Look around", icon: icon('<path d="M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500"/>'),
    hint: IS_TOUCH ? "One finger turns, two fingers move and zoom. Tap a point for its coordinates." : "Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.", places: 1,
  },
  {
    name: "seen", short: "Seen", title: "What is seen from here", icon: icon(EYE), height: ["Eye above the clicked point", 1.7], places: 1,
    hint: "Click where somebody stands: ground, balcony or roof.",
    samples: true,
    ask: ([place]) => ["seen", { place }],
    change: { title: "What the plan changes", names: ["not visible before and after", "visible before and after", "visible only after", "visible only before"], gain: "come into view", loss: "are hidden" },
    show(answer, page) {
      page.answer = answer.certainty ? colors.ofProbability("How likely it is visible", ["0 %", "100 %"]) : colors.ofAnswers(answer, answer.viewpoint);
      page.values(new Uint8Array(answer.probabilities ?? answer.body));
      const whole = answer.visible + answer.blocked + answer.unproven;
      return `<p class="verdict">${about(answer)}${percent(answer.visible, whole)} is visible</p><p class="note">of the points of the cloud. ${answer.isFirst ? FIRST(answer) : answer.tells_unproven ? UNPROVEN : ""}</p>${shares(answer, "Points", page)}${certainty(answer, ["visible", "blocked"])}`;
    },
    rows: (answer) => [["answer", "points"], ["visible", answer.visible], ["unproven", answer.unproven], ["blocked", answer.blocked], ...certainRows(answer)],
    properties: ({ visible, unproven, blocked }) => ({ visible, unproven, blocked }),
  },
  {
    name: "line", short: "A to B", title: "Is B seen from A", icon: icon('<circle cx="5" cy="18" r="2.500"/><circle cx="19" cy="6" r="2.500"/><path d="M7 16 17 8"/>'),
    height: ["Eye above A", 1.7], places: 2, hint: "Click A, where the eye is, then B.",
    ask: ([observer, target]) => ["line", { observer, target }],
    show(answer, page) {
      const block = answer.first_block;
      page.line(answer);
      const text = { visible: "B is visible from A", blocked: "B is blocked", unproven: "B is unproven", "outside the cloud": "No answer: outside the cloud", "inside an obstacle": "No answer: A or B is inside an obstacle" }[answer.answer];
      const met = block?.surface ? `a surface of the survey (${block.surface})` : "an obstacle";
      const note = block ? `The line meets ${met} ${block.range_m.toFixed(1)} m from A.` : answer.answer === "unproven" ? UNPROVEN : "Nothing stands in the line.";
      return `<p class="verdict">${text}</p><p class="note">${note}</p>`
        + (answer.profile ? `<figure>${charts.profile(answer.profile, page.scene.unit)}<figcaption>Ground (brown), obstacles (grey) and the line of sight</figcaption></figure>` : "")
        + list([["Length of the line", `${answer.length_m.toFixed(2)} m`], ...(block ? [["Blocked after", `${block.range_m.toFixed(2)} m`], ["Blocked at", block.place.map((v) => v.toFixed(2)).join(", ")]] : []),
          ...(answer.unproven_m !== null && !block ? [["Unproven length", `${answer.unproven_m.toFixed(2)} m`]] : []),
          ...(answer.probability != null ? [["Probability that B is visible", `${(100 * answer.probability).toFixed(0)} %`]] : [])]);
    },
    rows: ({ profile }) => profile ? [["distance_m", "ground", "line", "solid"], ...profile.distance_m.map((d, i) => [d, profile.ground[i], profile.line[i], profile.solid[i].map((p) => p.join("..")).join(" ")])] : null,
    properties: (answer) => ({ answer: answer.answer, length_m: answer.length_m, first_block_range_m: answer.first_block?.range_m ?? null, probability: answer.probability }),
    geometry: (places) => ["LineString", places],
  },
  {
    name: "sun", short: "Sun", title: "Sun here", icon: icon(SUN), height: ["Height above the clicked point", 0.1], places: 1, time: "date",
    hint: "Click a place to see when the sun reaches it.",
    ask: ([place], { date, zone, trees }) => ["sun", { place, date, zone, trees }],
    show: (answer, page) => `<p class="verdict">${answer.sun_hours.toFixed(1)} hours of sun</p><p class="note">on ${escape(page.time.date)}, of ${answer.possible_hours.toFixed(1)} hours between sunrise and sunset.</p>`
      + `<figure>${charts.sunPaths(answer, page.time.date)}<figcaption><i class="swatch" style="background:#f5a300"></i>lit <i class="swatch" style="background:#2f3d73;margin-left:10px"></i>in shadow <i class="swatch" style="background:#5f6b78;margin-left:10px"></i>horizon; dashed: 21 June, March, December</figcaption></figure>`
      + list([["First light", hours(answer.first_light)], ["Last light", hours(answer.last_light)], ["Longest stretch", `${answer.longest.toFixed(1)} h`], ["Share of possible sun", percent(answer.sun_share ?? 0, 1)]])
      + `<h3>Hours of sun on the 21st of each month</h3><figure>${charts.months(answer)}</figure>`,
    rows: (answer) => [["hour", "azimuth_deg", "elevation_deg", "lit"], ...answer.path.map((p, i) => [...p, answer.lit[i] ? 1 : 0])],
    properties: (answer) => ({ sun_hours: answer.sun_hours, first_light: answer.first_light, last_light: answer.last_light, possible_hours: answer.possible_hours }),
  },
  {
    name: "shadow", short: "Shadow", title: "Shadow at a time", icon: icon('<circle cx="17" cy="6" r="3"/><path d="M4 20h16M9 20V10h5v10M9 20l-5-3"/>'), places: 0, time: "hour",
    hint: "Move the time, or play the day.",
    samples: true,
    ask: (_, { date, clock, zone, trees }) => ["shadow", { time: `${date}T${clock}`, zone, trees }],
    change: { title: "What the plan changes", names: ["in shadow before and after", "lit before and after", "lit only after", "lit only before"], gain: "gain the sun", loss: "lose the sun" },
    show(answer, page) {
      page.answer = answer.certainty ? colors.ofProbability("How likely it is lit", ["0 %", "100 %"]) : colors.ofLight(answer);
      page.light(answer);
      page.values(new Uint8Array(answer.probabilities ?? answer.body));
      answer.lit_share = answer.lit / Math.max(answer.points, 1);
      const up = answer.elevation_deg > 0;
      return `<p class="verdict">${up ? `${about(answer)}${percent(answer.lit, answer.points)} is lit` : "The sun is below the horizon"}</p><p class="note">of the points of the cloud, ${escape(answer.time.replace("T", " "))}. ${answer.isFirst ? FIRST(answer) : ""}</p>`
        + list([...(answer.tells_unproven && up ? [["Lit, but unproven", percent(answer.unproven, answer.points)]] : []), ["Azimuth of the sun", `${answer.azimuth_deg.toFixed(1)}°`], ["Elevation of the sun", `${answer.elevation_deg.toFixed(1)}°`]])
        + certainty(answer, ["lit", "in shadow"]);
    },
    rows: (answer) => [["time", "azimuth_deg", "elevation_deg", "lit_share"], [answer.time, answer.azimuth_deg, answer.elevation_deg, answer.lit_share], ...certainRows(answer)],
  },
  {
    name: "around", short: "Sky", title: "Sky and space here", icon: icon('<path d="M3 18a9 9 0 0 1 18 0"/><path d="M3 18h4v-5h4v5h3v-8h4v8h3"/>'), height: ["Height above the clicked point", 1.7], places: 1,
    hint: "Click a place to measure its sky view and the space that is visible from it.",
    ask: ([place]) => ["around", { place }],
    show(answer) {
      const { isovist: v } = answer;
      return { html: `<p class="verdict">Sky view factor ${answer.sky_view_factor.toFixed(2)}</p><p class="note">1 under a free sky, 0 without any sky.</p><figure id="panorama"><figcaption>Panorama from north to north: sky blue, near dark, far light</figcaption></figure>`
        + `<figure>${charts.plan(answer)}<figcaption>Plan of the visible space at the height of the eye</figcaption></figure>`
        + list([["Sky openness", answer.sky_openness.toFixed(3)], ["Visible area in plan", `${count(Math.round(v.plan_area_m2))} m²`], ["Visible volume", `${count(Math.round(v.volume_m3))} m³`], ["Of it before something", `${count(Math.round(v.blocked_volume_m3))} m³`], ["Farthest view in plan", `${v.plan_range_max_m.toFixed(1)} m`], ["Nearest obstacle in plan", `${v.plan_range_min_m.toFixed(1)} m`]]),
        after: (card) => card.querySelector("#panorama").prepend(charts.panorama(new Uint8Array(answer.body), answer.panorama)) };
    },
    rows: (answer) => [["measure", "value"], ["sky_view_factor", answer.sky_view_factor], ["sky_openness", answer.sky_openness], ...Object.entries(answer.isovist)],
    properties: (answer) => ({ sky_view_factor: answer.sky_view_factor, sky_openness: answer.sky_openness, ...answer.isovist }),
  },
  {
    name: "who", short: "Seen from", title: "Who sees this", icon: icon('<circle cx="12" cy="12" r="2.500"/><path d="M4 7V4h3M20 7V4h-3M4 17v3h3M20 17v3h-3M12 5v3M12 16v3M5 12h3M16 12h3"/>'), height: ["Height above the clicked point", 0.1], places: 1,
    hint: "Click a target to see from where people can see it.",
    ask: ([place]) => ["who", { place }],
    show(answer, page) {
      page.cells(answer);
      const verdict = answer.visible ? `Seen from ${count(Math.round(answer.visible_m2))} m²` : "No ground is known that sees it";
      const note = answer.visible ? "of ground, by eyes 1.7 m above it." : `${answer.unproven ? `From ${count(answer.unproven)} cells nothing is in the way, but no pulse proves it. ` : ""}Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.`;
      return `<p class="verdict">${verdict}</p><p class="note">${note}</p>${shares(answer, "Cells")}`;
    },
    rows: (answer) => [["answer", "cells"], ["visible", answer.visible], ["unproven", answer.unproven], ["blocked", answer.blocked]],
    properties: ({ visible_m2, visible, unproven, blocked }) => ({ visible_m2, visible, unproven, blocked }),
  },
  {
    name: "roof", short: "Roof", title: "Solar energy of a roof", icon: icon('<path d="M3 19 8 7h13l-5 12z"/><path d="M5.500 13h13M10 19l5-12"/>'), places: 1,
    hint: "Click a roof to see what sun and sky send to its plane in a year of clear sky.",
    ask: ([place]) => ["roof", { place }],
    show(answer, page) {
      page.plane(answer);
      return `<p class="verdict">${count(Math.round(answer.kwh / 100) * 100)} kWh a year</p><p class="note">is the solar energy received by ${answer.panel_area_m2.toFixed(0)} m² of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.</p>`
        + list([["Received by a square metre", `${count(Math.round(answer.kwh_m2))} kWh`], ["Without any shade", `${count(Math.round(answer.free_kwh_m2))} kWh`], ["Lost by shade, each panel for itself", percent(answer.min_loss, 1)], ["Lost by shade, panels in strings", percent(answer.max_loss, 1)],
          ["Tilt", `${answer.tilt_deg.toFixed(0)}°`], ["Faces", `${answer.azimuth_deg === null ? "up" : `${answer.azimuth_deg.toFixed(0)}° from north`}`], ["Area of the plane", `${answer.area_m2.toFixed(1)} m²`], ["Plane", `${answer.plane} of ${answer.planes}`]])
        + `<h3>Solar energy received in each month, kWh/m²</h3><figure>${charts.energy(answer.months_kwh_m2)}</figure>`;
    },
    rows: (answer) => [["month", "kwh_m2"], ...answer.months_kwh_m2.map((v, i) => [i + 1, v])],
    properties: ({ plane, kwh, kwh_m2, free_kwh_m2, min_loss, max_loss, tilt_deg, azimuth_deg, area_m2 }) => ({ plane, kwh, kwh_m2, free_kwh_m2, min_loss, max_loss, tilt_deg, azimuth_deg, area_m2 }),
  },
  {
    name: "sun_area", short: "Sun hours", title: "Sun hours of an area", change: true, icon: icon('<path d="M4 8 13 4l7 8-5 8-9-3z"/><circle cx="12.500" cy="11.500" r="2"/>'), places: Infinity, time: "date",
    hint: "Click the corners of the area.",
    ask: (places, { date, zone, trees }) => ["sun_area", { corners: places.map(([x, y]) => [x, y]), date, zone, trees }],
    show(answer, page) {
      page.hourCells(answer);
      return `<p class="verdict">${answer.mean_hours.toFixed(1)} hours of sun</p><p class="note">on average on ${escape(page.time.date)}, of ${answer.possible_hours.toFixed(1)} possible hours.</p>`
        + list([["Least", `${answer.min_hours.toFixed(1)} h`], ["Most", `${answer.max_hours.toFixed(1)} h`], ["Ground in the area", `${count(answer.area_m2)} m²`], ["Cells", `${count(answer.cells)} of ${answer.cell_m} m`]]);
    },
    rows: (answer, page) => {
      const v = new Float32Array(answer.body);
      return [["x", "y", "z", "sun_hours"], ...Array.from({ length: v.length / 4 }, (_, i) => [...page.toFile([v[4 * i], v[4 * i + 1], v[4 * i + 2]]), v[4 * i + 3].toFixed(3)])];
    },
    properties: ({ mean_hours, min_hours, max_hours, area_m2 }) => ({ mean_hours, min_hours, max_hours, area_m2 }),
    geometry: (places) => ["Polygon", [[...places, places[0]]]],
  },
  {
    name: "plan", short: "Plan", title: "Plan buildings", icon: icon('<path d="M4 20V9l6-4 6 4v11zM8 20v-5h4v5M19 4v6M16 7h6"/>'), places: Infinity,
    hint: "Draw or load what is planned, clear what goes; then ask again.",
  },
];

// What needs no answer: tools of the bar.
export const ASIDES = [
  { name: "measure", title: "Measure", places: Infinity, hint: "Click places to measure between them." },
  { name: "cut", title: "Show a part", places: 2, hint: "Click two corners, or move the heights." },
];
