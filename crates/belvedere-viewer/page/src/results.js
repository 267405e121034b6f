// Results of other commands: chosen like colours, and lines that are always there.
import * as api from "./api.js";
import * as colors from "./colors.js";
import { report } from "./messages.js";
import { $, page } from "./state.js";
import { cloud, draw } from "./view.js";

const NONE = 255;

// Offers the files of results once the scene is ready.
export async function offer(files) {
  if (page.results || !files?.length) return;
  page.results = files;
  for (const [number, { name, columns }] of files.entries()) {
    for (const [i, column] of columns.entries()) $("color").add(new Option(column ? `${name}: ${column}` : name, `result ${number} ${i}`));
    if (columns.length) continue;
    try {
      const across = Math.hypot(...page.scene.low.map((v, k) => page.scene.high[k] - v));
      cloud.addLines(new Float32Array((await api.result(number)).body), Math.min(Math.max(across / 220, 0.2), 3));
      $("meshes").hidden = false;
      draw();
    } catch (error) {
      report(error);
    }
  }
  const first = files.findIndex((file) => file.is_shown_first);
  if (first >= 0 && page.tool.name === "look") {
    $("color").value = `result ${first} 0`;
    $("color").dispatchEvent(new Event("change"));
  }
}

function coloring(file, { name, least, greatest, are_codes: areCodes }) {
  const title = name ? `${file}: ${name}` : file;
  return areCodes ? colors.ofCodes(title, name, greatest ?? 1) : colors.ofValues(title, least ?? 0, greatest ?? 1);
}

// Shows a column of a file of results, and returns how it is coloured.
export async function showResult(value) {
  const [, number, column] = value.split(" ").map(Number);
  const file = page.results[number];
  file.answer ??= await api.result(number);
  const { count, low, step, size_m: size, columns, body } = file.answer;
  if ($("color").value !== value) return null;
  const values = new Uint8Array(body, 8 * count + column * count, count);
  const paint = coloring(file.name, columns[column]);
  if (count) cloud.layer(low, step, new Uint16Array(body, 0, 4 * count), values, size ? size * 1.5 : cloud.own.size.value, paint, NONE);
  cloud.scene.visible = !file.covers_cloud;
  return paint;
}
