// From the server to the scene: points, meshes and balls, and how far it is prepared.
import * as api from "./api.js";
import { recall } from "./address.js";
import * as colors from "./colors.js";
import { firstAnswer } from "./first.js";
import { report } from "./messages.js";
import { loadColors, offerColors, paint, scaleHeights, setColor } from "./paint.js";
import { restore } from "./plan.js";
import { offerReading } from "./reading.js";
import { offer } from "./results.js";
import { $, page } from "./state.js";
import { startTime } from "./time.js";
import { cloud, draw, drawNext, renderer, showAll } from "./view.js";
import { count, stage, t } from "./words.js";

// of heights, by the metres in one; feet differ in the sixth digit
const UNITS = { 1: "m", 0.01: "cm", 0.001: "mm" };
async function load(shown) {
  const { scene } = page;
  showAll();
  cloud.own.size.value = Math.min(Math.max(scene.spacing * 1.7, 0.02), 5);
  cloud.own.most.value = 180 * renderer.getPixelRatio();
  cloud.own.heights.value.set(scene.low[2], scene.high[2]);
  let next = 0;
  const one = async () => {
    while (next < scene.chunks.length) {
      const number = next++;
      const { low, step, first } = scene.chunks[number];
      const part = { chunk: cloud.add(low, step, await api.points(number), null, first), number };
      page.loaded.push(part);
      drawNext();
      if (page.hasColors) await loadColors(part);
    }
  };
  await Promise.all([one(), one(), one()]);
  await cloud.measure(scene.spacing);
  scaleHeights();
  if (!page.isMoved) showAll();
  page.isLoaded = true;
  drawNext();
}
function begin(state) {
  const shown = state.shown;
  const [, , up] = shown.metres_per_unit;
  page.scene = {
    ...shown, title: state.title, unit: UNITS[up] ?? "ft", latitude_deg: null,
    heights: [shown.low, shown.high].map((corner) => (corner[2] + shown.origin[2]) / up),
  };
  if (!shown.point_count && state.scene) Object.assign(page.scene, { low: state.scene.low, high: state.scene.high, spacing: 0.3 });
  $("title").textContent = document.title = state.title;
  document.title = `${state.title} – Belvedere`;
  $("facts").textContent = shown.point_count ? t`${count(shown.point_count)} points` : t`ball file`;
  $("crs").textContent = shown.crs;
  page.loaded = [];
  const ways = [["height", t`Height`], ...(shown.classes.length > 1 ? [["class", t`Class`]] : []), ...(shown.has_intensity ? [["intensity", t`Intensity`]] : []), ["none", t`Plain`]];
  $("color").replaceChildren(...ways.map(([value, text]) => new Option(text, value)));
  setColor(!shown.point_count ? "none" : shown.classes.length > 1 ? "class" : "height");
  page.colorsKnown = offerColors().catch(report);
  return load(shown);
}
export async function watch() {
  try {
    const state = await api.state();
    $("message").hidden = true;
    if (state.shown && !page.scene && (state.shown.point_count || state.scene)) begin(state).catch(report);
    if (state.failure) {
      $("progress").hidden = true;
      page.failure = state.failure;
      // another file may be chosen
      if (api.opens && !page.scene) $("start").hidden = false;
      throw new api.Refused(state.failure);
    }
    for (page.meshes ??= 0; page.scene && page.meshes < (state.mesh_count ?? 0); page.meshes++) {
      api.mesh(page.meshes).then((values) => { cloud.addMesh(values); $("meshes").hidden = false; draw(); }).catch(report);
    }
    if (state.scene && page.scene && !page.ready) {
      Object.assign(page.scene, { ...state.scene, low: page.scene.low, high: page.scene.high });
      page.ready = true;
      page.remarks = state.remarks;
      page.reading = state.reading;
      startTime();
      if (!state.shown.point_count) toggleBalls();
      $("trees").hidden = !state.scene.has_vegetation;
      $("outlines").hidden = api.exported || !state.scene.roof_count;
      const first = () => recall() || firstAnswer(state.results);
      (api.exported ? Promise.resolve() : restore().catch(report)).then(first).then(offerReading).catch(report);
      if (page.pending) page.ask();
      offer(state.results).catch(report);
    }
    $("progress").hidden = page.ready === true;
    const bar = $("progress").querySelector("progress");
    $("progress").querySelector("p").textContent = state.stage ? t`Preparing: ${stage(state.stage)}` : t`Preparing`;
    if (state.total > 0) Object.assign(bar, { max: state.total, value: state.done });
    else bar.removeAttribute("value");
    if (!api.exported || !page.ready) setTimeout(watch, page.ready ? 4000 : 250);
  } catch (error) {
    report(error);
  }
}
export async function toggleBalls() {
  const on = $("balls").getAttribute("aria-pressed") !== "true";
  $("balls").setAttribute("aria-pressed", on);
  try {
    if (on && !cloud.balls) cloud.addBalls(await api.balls());
  } catch (error) {
    return report(error);
  }
  // it may have been pressed again while the balls were on their way
  if (cloud.balls) cloud.balls.visible = $("balls").getAttribute("aria-pressed") === "true";
  draw();
}
// Lines on which surfaces of buildings end, as they were found.
export async function toggleOutlines() {
  const on = $("outlines").getAttribute("aria-pressed") !== "true";
  $("outlines").setAttribute("aria-pressed", on);
  try {
    if (on && !page.outlines) {
      page.outlines = api.ask("surfaces", {});
      const { edges, ridges, walls, body } = await page.outlines;
      const numbers = new Float32Array(body);
      let first = 0;
      [edges, ridges, walls].forEach((count, i) => {
        cloud.addOutlines(numbers.subarray(6 * first, 6 * (first += count)), colors.OUTLINES[i][0]);
      });
    }
  } catch (error) {
    page.outlines = null;
    $("outlines").setAttribute("aria-pressed", false);
    return report(error);
  }
  const isShown = $("outlines").getAttribute("aria-pressed") === "true";
  cloud.outlines?.forEach((lines) => { lines.visible = isShown; });
  paint();
}
page.watch = watch;
