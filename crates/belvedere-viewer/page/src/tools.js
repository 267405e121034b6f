// The questions: what is clicked, what is sent to the server, and how the answer is shown.
import * as charts from "./charts.js";
import { escape, hours } from "./charts.js";
import * as colors from "./colors.js";
import { count, fixed, metres, t } from "./words.js";

const icon = (d) => `<svg viewBox="0 0 24 24" aria-hidden="true">${d}</svg>`;
const EYE = '<path d="M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12z"/><circle cx="12" cy="12" r="3"/>';
const SUN = '<circle cx="12" cy="12" r="4"/><path d="M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M19 5l-2 2M7 17l-2 2"/>';
const percent = (part, whole) => `${fixed((100 * part) / Math.max(whole, 1), 1)} %`;
// A row of the numbers between which the truth lies nine times in ten, where they are known.
const interval = (ends, shown, unit) => (ends ? [[t`In nine of ten cases`, `${t`${shown(ends[0])} to ${shown(ends[1])}`} ${unit}`]] : []);
// A time of day, with the zone that it is in.
const clock = (value, page) => (value === null ? hours(value) : `${hours(value)} (${page.ahead()})`);
const list = (rows) => `<dl>${rows.map(([name, value]) => `<dt>${escape(name)}</dt><dd>${escape(value)}</dd>`).join("")}</dl>`;

// A first answer is one for a sample: its shares are about right, and its counts are those of the sample times the
// points it represents.
const about = (answer) => (answer.isFirst ? `${t`About`} ` : "");
const FIRST = (answer) => t`A first answer from a sample of ${count(answer.points)} points; the exact one follows …`;
const estimated = (n) => { const unit = 10 ** Math.max(Math.floor(Math.log10(n)) - 1, 0); return t`about ${count(Math.round(n / unit) * unit)}`; };

function shares(answer, of, page) {
  const names = colors.ANSWERS();
  const rows = [[1, answer.visible], ...(answer.tells_unproven !== false ? [[2, answer.unproven]] : []), [0, answer.blocked]];
  const whole = rows.reduce((sum, [, n]) => sum + n, 0);
  return `<div class="shares">${rows.map(([code, n]) => `<span style="flex:${n} 0 0;background:${names[code][1]}"></span>`).join("")}</div>`
    + `<div class="key">${rows.map(([code, n]) => `<span><i class="swatch" style="background:${names[code][1]}"></i>${names[code][0]} ${percent(n, whole)}</span>`).join("")}</div>`
    + list(rows.map(([code, n]) => [`${of}: ${names[code][0]}`, answer.isFirst && n ? estimated((n * page.scene.point_count) / answer.points) : count(n)]));
}

// How many answers are certain, where that is known.
const shareOf = (value) => `${fixed(value, 1)} %`;
const certainty = ({ certainty: sure }, [free, blocked]) => {
  if (!sure) return "";
  const name = t`${Math.round(100 * sure.certain_from)} % sure`;
  return list([[`${name}: ${free}`, shareOf(sure.certainly_visible_percent)], [`${name}: ${blocked}`, shareOf(sure.certainly_blocked_percent)], [t`Less sure, or unproven`, shareOf(sure.uncertain_percent)]]);
};
const certainRows = ({ certainty: sure }) => (sure ? Object.entries(sure) : []);

const UNPROVEN = t`Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.`;

const BY_PLAN = (n) => t`by the plan, of ${n} points of the cloud.`;
// What a surface of the survey is a part of.
const SURFACES = { roof: t`roof`, wall: t`wall`, parapet: t`parapet`, step: t`step of a roof`, box: t`structure on a roof`, inside: t`inside of a building`, slab: t`deck, canopy or balcony` };

// Whether fingers are the way to point.
export const IS_TOUCH = matchMedia("(pointer: coarse)").matches;

export const TOOLS = [
  {
    name: "look", short: t`Look`, title: t`Look around`, icon: icon('<path d="M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500"/>'),
    hint: IS_TOUCH ? t`One finger turns, two fingers move and zoom. Tap a point for its coordinates.` : t`Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.`, places: 1,
  },
  {
    name: "seen", short: t`Seen`, title: t`What is seen from here`, icon: icon(EYE), height: [t`Eye above the clicked point`, 1.7], places: 1,
    hint: t`Click where somebody stands: ground, balcony or roof.`,
    samples: true,
    ask: ([place]) => ["seen", { place }],
    change: { title: t`What the plan changes`, names: [t`not visible before and after`, t`visible before and after`, t`visible only after`, t`visible only before`], gain: (n) => t`${n} points come into view`, loss: (n) => t`${n} points are hidden`, of: BY_PLAN },
    show(answer, page) {
      page.answer = answer.certainty ? colors.ofProbability(t`How likely it is visible`, ["0 %", "100 %"]) : colors.ofAnswers(answer, answer.viewpoint);
      page.values(new Uint8Array(answer.probabilities ?? answer.body));
      const whole = answer.visible + answer.blocked + answer.unproven;
      return `<p class="verdict">${about(answer)}${t`${percent(answer.visible, whole)} is visible`}</p><p class="note">${t`of the points of the cloud.`} ${answer.isFirst ? FIRST(answer) : answer.tells_unproven ? UNPROVEN : ""}</p>${shares(answer, t`Points`, page)}${certainty(answer, [t`visible`, t`blocked`])}`;
    },
    rows: (answer) => [["answer", "points"], ["visible", answer.visible], ["unproven", answer.unproven], ["blocked", answer.blocked], ...certainRows(answer)],
    properties: ({ visible, unproven, blocked }) => ({ visible, unproven, blocked }),
  },
  {
    name: "line", short: t`A to B`, title: t`Is B seen from A`, icon: icon('<circle cx="5" cy="18" r="2.500"/><circle cx="19" cy="6" r="2.500"/><path d="M7 16 17 8"/>'),
    height: [t`Eye above A`, 1.7], places: 2, hint: t`Click A, where the eye is, then B.`,
    ask: ([observer, target]) => ["line", { observer, target }],
    show(answer, page) {
      const block = answer.first_block;
      page.line(answer);
      const text = { visible: t`B is visible from A`, blocked: t`B is blocked`, unproven: t`B is unproven`, "outside the cloud": t`No answer: outside the cloud`, "inside an obstacle": t`No answer: A or B is inside an obstacle` }[answer.answer];
      const range = block && metres(block.range_m, 1);
      const met = block?.surface ? t`The line meets a surface of the survey (${SURFACES[block.surface]}) ${range} from A.` : t`The line meets an obstacle ${range} from A.`;
      const note = block ? met : answer.answer === "unproven" ? UNPROVEN : t`Nothing stands in the line.`;
      return `<p class="verdict">${text}</p><p class="note">${note}</p>`
        + (answer.profile ? `<figure>${charts.profile(answer.profile, page.scene.unit)}<figcaption>${t`Ground (brown), obstacles (grey) and the line of sight`}</figcaption></figure>` : "")
        + list([[t`Length of the line`, metres(answer.length_m)], ...(block ? [[t`Blocked after`, metres(block.range_m)], [t`Blocked at`, block.place.map((v) => v.toFixed(2)).join(", ")]] : []),
          ...(answer.unproven_m !== null && !block ? [[t`Unproven length`, metres(answer.unproven_m)]] : []),
          ...(answer.probability != null ? [[t`Probability that B is visible`, `${fixed(100 * answer.probability, 0)} %`]] : [])]);
    },
    rows: ({ profile }) => profile ? [["distance_m", "ground", "line", "solid"], ...profile.distance_m.map((d, i) => [d, profile.ground[i], profile.line[i], profile.solid[i].map((p) => p.join("..")).join(" ")])] : null,
    properties: (answer) => ({ answer: answer.answer, length_m: answer.length_m, first_block_range_m: answer.first_block?.range_m ?? null, probability: answer.probability }),
    geometry: (places) => ["LineString", places],
  },
  {
    name: "sun", short: t`Sun`, title: t`Sun here`, icon: icon(SUN), height: [t`Height above the clicked point`, 0.1], places: 1, time: "date",
    hint: t`Click a place to see when the sun reaches it.`,
    ask: ([place], { date, zone, trees }) => ["sun", { place, date, zone, trees }],
    show: (answer, page) => `<p class="verdict">${t`${fixed(answer.sun_hours, 1)} hours of sun`}</p><p class="note">${t`on ${escape(page.time.date)}, of ${fixed(answer.possible_hours, 1)} hours between sunrise and sunset.`}</p>`
      + `<figure>${charts.sunPaths(answer, page.time.date)}<figcaption><i class="swatch" style="background:#f5a300"></i>${t`lit`} <i class="swatch" style="background:#2f3d73;margin-left:10px"></i>${t`in shadow`} <i class="swatch" style="background:#5f6b78;margin-left:10px"></i>${t`horizon; dashed: 21 June, March, December`}</figcaption></figure>`
      + list([...interval(answer.interval_hours, (v) => fixed(v, 1), "h"), [t`First light`, clock(answer.first_light, page)], [t`Last light`, clock(answer.last_light, page)], [t`Longest stretch`, `${fixed(answer.longest, 1)} h`], [t`Share of possible sun`, percent(answer.sun_share ?? 0, 1)]])
      + `<h3>${t`Hours of sun on the 21st of each month`}</h3><figure>${charts.months(answer)}</figure>`,
    rows: (answer) => [["hour", "azimuth_deg", "elevation_deg", "lit"], ...answer.path.map((p, i) => [...p, answer.lit[i] ? 1 : 0])],
    properties: (answer) => ({ sun_hours: answer.sun_hours, first_light: answer.first_light, last_light: answer.last_light, possible_hours: answer.possible_hours }),
  },
  {
    name: "shadow", short: t`Shadow`, title: t`Shadow at a time`, icon: icon('<circle cx="17" cy="6" r="3"/><path d="M4 20h16M9 20V10h5v10M9 20l-5-3"/>'), places: 0, time: "hour",
    hint: t`Move the time, or play the day.`,
    samples: true,
    ask: (_, { date, clock, zone, trees }) => ["shadow", { time: `${date}T${clock}`, zone, trees }],
    change: { title: t`What the plan changes`, names: [t`in shadow before and after`, t`lit before and after`, t`lit only after`, t`lit only before`], gain: (n) => t`${n} points gain the sun`, loss: (n) => t`${n} points lose the sun`, of: BY_PLAN },
    between: { title: t`Between the two times`, names: [t`in shadow at both times`, t`lit at both times`, t`lit only at the second time`, t`lit only at the first time`], gain: (n) => t`${n} points gain the sun`, loss: (n) => t`${n} points lose the sun`, of: (n, { before, time }) => t`from ${before.time.replace("T", " ")} to ${time.replace("T", " ")}, of ${n} points of the cloud.` },
    show(answer, page) {
      page.answer = answer.certainty ? colors.ofProbability(t`How likely it is lit`, ["0 %", "100 %"]) : colors.ofLight(answer);
      page.light(answer);
      page.values(new Uint8Array(answer.probabilities ?? answer.body));
      answer.lit_share = answer.lit / Math.max(answer.points, 1);
      const up = answer.elevation_deg > 0;
      return `<p class="verdict">${up ? about(answer) + t`${percent(answer.lit, answer.points)} is lit` : t`The sun is below the horizon`}</p><p class="note">${t`of the points of the cloud, ${escape(answer.time.replace("T", " "))}.`} ${answer.isFirst ? FIRST(answer) : ""}</p>`
        + list([...(answer.tells_unproven && up ? [[t`Lit, but unproven`, percent(answer.unproven, answer.points)]] : []), [t`Azimuth of the sun`, `${fixed(answer.azimuth_deg, 1)}°`], [t`Elevation of the sun`, `${fixed(answer.elevation_deg, 1)}°`]])
        + certainty(answer, [t`lit`, t`in shadow`]);
    },
    rows: (answer) => [["time", "azimuth_deg", "elevation_deg", "lit_share"], [answer.time, answer.azimuth_deg, answer.elevation_deg, answer.lit_share], ...certainRows(answer)],
  },
  {
    name: "around", short: t`Sky`, title: t`Sky and space here`, icon: icon('<path d="M3 18a9 9 0 0 1 18 0"/><path d="M3 18h4v-5h4v5h3v-8h4v8h3"/>'), height: [t`Height above the clicked point`, 1.7], places: 1,
    hint: t`Click a place to measure its sky view and the space that is visible from it.`,
    ask: ([place]) => ["around", { place }],
    show(answer) {
      const { isovist: v } = answer;
      return { html: `<p class="verdict">${t`Sky view factor ${fixed(answer.sky_view_factor, 2)}`}</p><p class="note">${t`1 under a free sky, 0 without any sky.`}</p><figure id="panorama"><figcaption>${t`Panorama from north to north: sky blue, near dark, far light`}</figcaption></figure>`
        + `<figure>${charts.plan(answer)}<figcaption>${t`Plan of the visible space at the height of the eye`}</figcaption></figure>`
        + list([[t`Sky openness`, fixed(answer.sky_openness, 3)], [t`Visible area in plan`, `${count(Math.round(v.plan_area_m2))} m²`], [t`Visible volume up to obstacles`, `${count(Math.round(v.blocked_volume_m3))} m³`], ...(v.openness > 0 ? [[t`With open directions, up to ${fixed(v.range_max_m, 0)} m`, `${count(Math.round(v.volume_m3))} m³`], [t`Share of open directions`, percent(v.openness, 1)]] : []), [t`Farthest view in plan`, metres(v.plan_range_max_m, 1)], [t`Nearest obstacle in plan`, metres(v.plan_range_min_m, 1)]]),
        after: (card) => card.querySelector("#panorama").prepend(charts.panorama(new Uint8Array(answer.body), answer.panorama)) };
    },
    rows: (answer) => [["measure", "value"], ["sky_view_factor", answer.sky_view_factor], ["sky_openness", answer.sky_openness], ...Object.entries(answer.isovist)],
    properties: (answer) => ({ sky_view_factor: answer.sky_view_factor, sky_openness: answer.sky_openness, ...answer.isovist }),
  },
  {
    name: "who", short: t`Seen from`, title: t`Who sees this`, icon: icon('<circle cx="12" cy="12" r="2.500"/><path d="M4 7V4h3M20 7V4h-3M4 17v3h3M20 17v3h-3M12 5v3M12 16v3M5 12h3M16 12h3"/>'), height: [t`Height above the clicked point`, 0.1], places: 1,
    hint: t`Click a target to see from where people can see it.`,
    ask: ([place]) => ["who", { place }],
    show(answer, page) {
      page.cells(answer);
      const verdict = answer.visible ? t`Seen from ${count(Math.round(answer.visible_m2))} m²` : t`No ground is known that sees it`;
      const unproven = answer.unproven ? `${t`From ${count(answer.unproven)} cells nothing is in the way, but no pulse proves it.`} ` : "";
      const note = answer.visible ? t`of ground, by eyes 1.7 m above it.` : unproven + t`Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.`;
      return `<p class="verdict">${verdict}</p><p class="note">${note}</p>${shares(answer, t`Cells`)}`;
    },
    rows: (answer) => [["answer", "cells"], ["visible", answer.visible], ["unproven", answer.unproven], ["blocked", answer.blocked]],
    properties: ({ visible_m2, visible, unproven, blocked }) => ({ visible_m2, visible, unproven, blocked }),
  },
  {
    name: "roof", short: t`Roof`, title: t`Solar energy of a roof`, icon: icon('<path d="M3 19 8 7h13l-5 12z"/><path d="M5.500 13h13M10 19l5-12"/>'), places: 1,
    hint: t`Click a roof to see what sun and sky send to its plane in a year of clear sky.`,
    ask: ([place]) => ["roof", { place }],
    show(answer, page) {
      page.plane(answer);
      return `<p class="verdict">${t`${count(Math.round(answer.radiation_kwh / 100) * 100)} kWh a year`}</p><p class="note">${t`is the solar energy received by ${fixed(answer.panel_area_m2, 0)} m² of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.`}</p>`
        + list([[t`Received by a square metre`, `${count(Math.round(answer.kwh_m2))} kWh`], ...interval(answer.interval_kwh_m2, (v) => count(Math.round(v)), "kWh"), [t`Without any shade`, `${count(Math.round(answer.free_kwh_m2))} kWh`], [t`Lost by shade, each panel for itself`, percent(answer.min_loss, 1)], [t`Lost by shade, panels in strings`, percent(answer.max_loss, 1)],
          [t`Tilt`, `${fixed(answer.tilt_deg, 0)}°`], [t`Faces`, answer.azimuth_deg === null ? t`up` : t`${fixed(answer.azimuth_deg, 0)}° from north`], [t`Area of the plane`, `${fixed(answer.area_m2, 1)} m²`], [t`Plane`, t`${answer.plane} of ${answer.planes}`]])
        + `<h3>${t`Solar energy received in each month, kWh/m²`}</h3><figure>${charts.energy(answer.months_kwh_m2)}</figure>`;
    },
    rows: (answer) => [["month", "kwh_m2"], ...answer.months_kwh_m2.map((v, i) => [i + 1, v])],
    properties: ({ plane, radiation_kwh, kwh_m2, free_kwh_m2, min_loss, max_loss, tilt_deg, azimuth_deg, area_m2 }) => ({ plane, radiation_kwh, kwh_m2, free_kwh_m2, min_loss, max_loss, tilt_deg, azimuth_deg, area_m2 }),
  },
  {
    name: "sun_area", short: t`Sun hours`, title: t`Sun hours of an area`, change: true, icon: icon('<path d="M4 8 13 4l7 8-5 8-9-3z"/><circle cx="12.500" cy="11.500" r="2"/>'), places: Infinity, time: "date",
    hint: t`Click the corners of the area.`,
    ask: (places, { date, zone, trees }) => ["sun_area", { corners: places.map(([x, y]) => [x, y]), date, zone, trees }],
    show(answer, page) {
      page.hourCells(answer);
      return `<p class="verdict">${t`${fixed(answer.mean_hours, 1)} hours of sun`}</p><p class="note">${t`on average on ${escape(page.time.date)}, of ${fixed(answer.possible_hours, 1)} possible hours.`}</p>`
        + list([[t`Least`, `${fixed(answer.min_hours, 1)} h`], [t`Most`, `${fixed(answer.max_hours, 1)} h`], [t`Ground in the area`, `${count(answer.area_m2)} m²`], [t`Cells`, t`${count(answer.cells)} of ${answer.cell_m} m`]]);
    },
    rows: (answer, page) => {
      const v = new Float32Array(answer.body);
      return [["x", "y", "z", "sun_hours"], ...Array.from({ length: v.length / 4 }, (_, i) => [...page.toFile([v[4 * i], v[4 * i + 1], v[4 * i + 2]]), v[4 * i + 3].toFixed(3)])];
    },
    properties: ({ mean_hours, min_hours, max_hours, area_m2 }) => ({ mean_hours, min_hours, max_hours, area_m2 }),
    geometry: (places) => ["Polygon", [[...places, places[0]]]],
  },
  {
    name: "plan", short: t`Plan`, title: t`Plan buildings`, icon: icon('<path d="M4 20V9l6-4 6 4v11zM8 20v-5h4v5M19 4v6M16 7h6"/>'), places: Infinity,
    hint: t`Draw or load what is planned, clear what goes; then ask again.`,
  },
];

// What needs no answer: tools of the bar.
export const ASIDES = [
  { name: "measure", title: t`Measure`, places: Infinity, hint: t`Click places to measure between them.` },
  { name: "cut", title: t`Show a part`, places: 2, hint: t`Click two corners, or move the heights.` },
  { name: "crs", title: t`The cloud, and how it is read`, places: 0, hint: "" },
];
