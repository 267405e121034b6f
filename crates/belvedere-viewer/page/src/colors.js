// Tables of 256 colours for the values of points, and their legends.
import { fixed, t } from "./words.js";

// Different also for those who see no difference of red and green: ground light, plants bluish green and darker the
// higher, buildings red, water blue.
export const CLASSES = {
  0: [t`never classified`, "#a9aeb5"], 1: [t`unclassified`, "#c3c8ce"], 2: [t`ground`, "#dcc9a0"], 3: [t`low vegetation`, "#a9d8a0"],
  4: [t`medium vegetation`, "#55ae7f"], 5: [t`high vegetation`, "#136a52"], 6: [t`building`, "#d4694a"], 7: [t`low noise`, "#e04fd0"],
  9: [t`water`, "#2f7fd6"], 10: [t`rail`, "#6f5b9e"], 11: [t`road surface`, "#7d828b"], 14: [t`wire`, "#f2c200"], 15: [t`pylon`, "#9c6b00"],
  17: [t`bridge`, "#b592e0"], 18: [t`high noise`, "#e04fd0"], 26: [t`civil structure`, "#8a5a3c"],
};

// Lines on which surfaces of buildings end: edges of roofs, ridges and valleys, walls. Known from each other and from
// the colours of classes also without red and green.
export const OUTLINES = [[[150, 0, 70], t`edge of a roof`], [[250, 200, 0], t`ridge or valley`], [[0, 70, 190], t`wall`]];

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
const VIRIDIS = ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"].map(rgb);
const SUN = ["#1b2a5a", "#3a3f86", "#6a4c93", "#a4508b", "#d95f69", "#f28e4b", "#f9bf45", "#fdf3a0"].map(rgb);
const GREY = ["#202328", "#f4f5f7"].map(rgb);

function ramp(stops) {
  return Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (stops.length - 1);
    const k = Math.min(Math.floor(at), stops.length - 2);
    return stops[k].map((v, c) => v + (stops[k + 1][c] - v) * (at - k));
  });
}

const css = (color) => `rgb(${color.map(Math.round).join(",")})`;
const gradient = (stops) => `linear-gradient(90deg, ${stops.map(css).join(",")})`;

export const ANSWERS = () => {
  const dark = document.documentElement.dataset.theme === "dark";
  return {
    0: [t`blocked`, dark ? "#59616d" : "#8f969f"], 1: [t`visible`, "#ffb000"], 2: [t`unproven`, dark ? "#6ea5ff" : "#3f7be0"],
    3: [t`no answer`, "#30343a"], 4: [t`outside the cloud`, "#30343a"], 5: [t`inside an obstacle`, "#30343a"], 255: [t`no answer`, "#30343a"],
  };
};
export const LIGHT = { 0: [t`in shadow`, "#33406f"], 1: [t`lit`, "#ffdf9c"], 2: [t`lit, unproven`, "#6ea5ff"], 255: [t`no answer`, "#777777"] };

const named = (names, others) => {
  const table = Array.from({ length: 256 }, () => rgb(others));
  for (const [code, [, color]] of Object.entries(names)) table[code] = rgb(color);
  return table;
};
export const classTable = () => named(CLASSES, "#b4b8bd");
const keys = (names, codes) => codes.map((code) => ({ color: names[code]?.[1] ?? "#b4b8bd", text: names[code]?.[0] ?? t`class ${code}` }));

// A way of colouring: `mode` is the number that the shader knows, `table` its 256 colours, `legend` what they mean.
export function coloring(name, scene, answer) {
  switch (name) {
    case "class":
      return { mode: 0, table: classTable(), legend: { title: t`Class`, keys: keys(CLASSES, scene.classes.map(([code]) => code)) } };
    case "intensity":
      return { mode: 1, table: ramp(GREY), legend: { title: t`Intensity`, gradient: gradient(GREY), ends: [t`weak`, t`strong`] } };
    case "height": {
      const ends = scene.heights.map((z, i) => `${i ? "≥" : "≤"} ${fixed(z, 1)} ${scene.unit}`);
      return { mode: 2, table: ramp(VIRIDIS), legend: { title: t`Height`, gradient: gradient(VIRIDIS), ends } };
    }
    case "color":
      return { mode: 3, table: ramp(GREY), legend: null };
    case "answer":
      return answer;
    default:
      return { mode: 4, table: named({}, "#b9bfc7"), legend: null };
  }
}

export const ofAnswers = (counts, title = t`From the clicked place`) => {
  const names = ANSWERS();
  const codes = [1, ...(counts.tells_unproven ? [2] : []), 0];
  return { mode: 4, table: named(names, "#30343a"), legend: { title, keys: keys(names, codes) } };
};
export const ofLight = (answer) => ({ mode: 4, table: named(LIGHT, "#777777"), legend: { title: t`Sun`, keys: keys(LIGHT, [1, ...(answer?.tells_unproven ? [2] : []), 0]) } });
const SURE = ["#33406f", "#8d93ad", "#efece4", "#f7cf74", "#ffb000"].map(rgb);
// Probabilities, of which bytes up to 200 tell: what is not known pales.
export const ofProbability = (title, ends) => {
  const table = ramp(SURE);
  const of = (i) => (i <= 200 ? table[Math.round((i / 200) * 255)] : rgb("#777777"));
  return { mode: 4, table: table.map((_, i) => of(i)), legend: { title, gradient: gradient(SURE), ends } };
};
export const ofHours = (low, high) => ({
  mode: 4, table: ramp(SUN), legend: { title: t`Hours of sun on the day`, gradient: gradient(SUN), ends: [low, high].map((v) => `${fixed(v, 1)} h`) },
});
// Changes: gains orange, losses blue, as in maps of `belvedere difference`.
export const ofChange = (title, [neither, both, gain, loss]) => {
  const names = { 0: [neither, "#8b929b"], 1: [both, "#dde0e4"], 2: [gain, "#e8710a"], 3: [loss, "#1f5fbf"] };
  return { mode: 4, table: named(names, "#30343a"), legend: { title, keys: keys(names, [2, 3, 1, 0]) } };
};
const CHANGE = ["#0b3c8c", "#1f5fbf", "#86aee0", "#dde0e4", "#f5b27a", "#e8710a", "#9c4400"].map(rgb);
export const ofHoursChange = (most) => ({
  mode: 4, table: ramp(CHANGE), legend: { title: t`Change of the hours of sun`, gradient: gradient(CHANGE), ends: [`−${fixed(most, 1)} h`, `+${fixed(most, 1)} h`] },
});
// Results of other commands: codes have colours of their own, measures a ramp.
export const ofCodes = (title, name, greatest) => {
  const names = name === "answer" ? ANSWERS() : name === "lit" ? LIGHT : Object.fromEntries(["#8f969f", "#ffb000", "#3f7be0", "#3d8c47", "#a4508b"].map((color, code) => [code, [`${code}`, color]]));
  return { mode: 4, table: named(names, "#30343a"), legend: { title, keys: keys(names, Array.from({ length: greatest + 1 }, (_, code) => code)) } };
};
const short = (v) => (Math.abs(v) >= 100 ? v.toFixed(0) : Number(v.toPrecision(3)).toString());
export const ofValues = (title, least, greatest) => {
  // the greatest value is byte 253
  const table = ramp(SUN);
  return { mode: 4, table: table.map((_, i) => table[Math.min(Math.round((i * 255) / 253), 255)]), legend: { title, gradient: gradient(SUN), ends: [short(least), short(greatest)] } };
};
export const plain = (dark) => ({ mode: 4, table: named({}, dark ? "#5d6570" : "#b3bac3"), legend: null });
