// The view: drawing the scene, from places to pixels and back, and what is drawn over it.
import { Vector3, WebGLRenderer } from "three";
import { Mover } from "./camera.js";
import { escape } from "./charts.js";
import { AT_REST, Cloud } from "./cloud.js";
import { $, canvas, page, root } from "./state.js";
import { count, t } from "./words.js";

export let renderer, cloud, mover;

// Time of a frame within which moving looks smooth, and the time after the last movement when a view counts as at rest,
// ms.
const SMOOTH = 33;
const REST = 350;
let isDue = false;
let isDrawing = false;
let afterFrame = null;
let moved = -Infinity;
let rest;
// Draws the scene anew as soon as the frame before is done.
export function draw() {
  isDue = true;
  drawNext();
}
// A new picture if one is due; else, at rest, more points for the one that is there.
export function drawNext() {
  if (isDrawing || !cloud || !(isDue || ((cloud.left || cloud.isRough) && performance.now() - moved >= REST))) return;
  isDrawing = true;
  requestAnimationFrame(() => {
    const isNew = isDue;
    isDue = false;
    const start = performance.now();
    cloud.render(mover.camera, root.dataset.theme, isNew, start - moved < REST);
    overlay();
    page.frames = (page.frames ?? 0) + 1;
    drawn(() => {
      const spent = performance.now() - start;
      const wanted = isNew ? SMOOTH : AT_REST * SMOOTH;
      if (!cloud.isRough) cloud.isQuick = spent < SMOOTH;
      // what makes a picture fine takes as long with few points: rough ones tell how many there may be
      const tells = cloud.isRough || cloud.isQuick;
      if (tells && spent > 1.5 * wanted) cloud.budget = Math.max(1e5, cloud.budget * Math.max(0.5, wanted / spent));
      else if (tells && spent < 0.7 * wanted && cloud.left) cloud.budget = Math.min(2e7, cloud.budget * 1.3);
      isDrawing = false;
      afterFrame?.();
      afterFrame = null;
      drawNext();
    });
  });
}
// Waits for the graphics processor without blocking the page: a frame takes as long as it takes there.
function drawn(then) {
  const gl = renderer.getContext();
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  const look = () => {
    if (fence && !gl.isContextLost() && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) return setTimeout(look, 2);
    gl.deleteSync(fence);
    then();
  };
  setTimeout(look, 0);
}
// Looks at the picture when no frame is under way, for which reading a pixel would wait.
export function whenDrawn(look) {
  if (isDrawing) afterFrame = look;
  else look();
}
// The picture with all points; where things keep moving, that after some time.
export function complete(patience_ms = 5000) {
  const start = performance.now();
  return new Promise((done) => {
    const look = () => ((isDrawing || isDue || cloud.left || cloud.isRough) && performance.now() - start < patience_ms ? setTimeout(look, 20) : done());
    look();
  });
}
page.complete = complete;
export function changed() {
  moved = performance.now();
  page.isMoved = true;
  draw();
  clearTimeout(rest);
  rest = setTimeout(drawNext, REST + 10);
}
export function resize() {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(width, height, false);
  cloud.resize(canvas.width, canvas.height);
  mover.camera.aspect = width / height;
  mover.camera.updateProjectionMatrix();
  draw();
}

// The part of the page that no panel covers: of each panel the side is cut that leaves most.
function free() {
  let area = [0, $("bar").offsetHeight, canvas.clientWidth, canvas.clientHeight - $("status").offsetHeight];
  const size = ([left, top, right, bottom]) => Math.max(right - left, 0) * Math.max(bottom - top, 0);
  for (const name of ["tools", "card", "timebar", "legend"]) {
    const panel = $(name).getBoundingClientRect();
    const [left, top, right, bottom] = area;
    if (!panel.width || panel.right <= left || panel.left >= right || panel.bottom <= top || panel.top >= bottom) continue;
    const cuts = [[panel.right, top, right, bottom], [left, top, panel.left, bottom], [left, panel.bottom, right, bottom], [left, top, right, panel.top]];
    area = cuts.reduce((a, b) => (size(b) > size(a) ? b : a));
  }
  return area;
}
// Air around the scene, share of the picture.
const AIR = 0.015;
// All of the scene where no panel covers it.
export function showAll(flat = false) {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const [left, top, right, bottom] = free();
  const across = [left, right].map((x) => (2 * x) / width - 1), upright = [bottom, top].map((y) => 1 - (2 * y) / height);
  const inner = [across, upright].flatMap(([from, to]) => { const air = Math.min(AIR * 2, (to - from) / 4); return [from + air, to - air]; });
  // a tower fills the boxes of its own place on the map only
  const boxes = cloud.boxes();
  mover.show(boxes.length ? boxes : [[page.scene.low, page.scene.high]], flat, inner);
  page.isMoved = false;
}

// ---- coordinates ----
export const toFile = (local) => local.map((v, i) => Number(((v + page.scene.origin[i]) / page.scene.metres_per_unit[i]).toFixed(3)));
export const toLocal = (file) => file.map((v, i) => v * page.scene.metres_per_unit[i] - page.scene.origin[i]);
page.toFile = toFile;
export const shownPlace = (file) => file.map((v) => v.toFixed(2)).join("  ");

function onScreen(local) {
  const v = new Vector3(...local).project(mover.camera);
  return v.z > 1 || v.z < -1 ? null : [((v.x + 1) / 2) * canvas.clientWidth, ((1 - v.y) / 2) * canvas.clientHeight];
}
// The place that is drawn at a pixel of the page.
export function placeAt(x, y) {
  const ratio = canvas.width / canvas.clientWidth;
  const depth = cloud.depthAt(x * ratio, y * ratio, Math.round(5 * ratio));
  if (depth === null) return null;
  const { camera } = mover;
  const ray = new Vector3((x / canvas.clientWidth) * 2 - 1, 1 - (y / canvas.clientHeight) * 2, 0.5).unproject(camera).sub(camera.position).normalize();
  const range = depth / ray.dot(camera.getWorldDirection(new Vector3()));
  return camera.position.clone().addScaledVector(ray, range).toArray();
}
page.placeAt = placeAt;
page.onScreen = onScreen;

// ---- marks, scale, north ----
function overlay() {
  const parts = [];
  const dot = ({ at: local, label, color = "#1d4e89", down = -8, radius = 6 }) => {
    const at = onScreen(local);
    if (at) parts.push(`${radius ? `<circle cx="${at[0]}" cy="${at[1]}" r="${radius}" fill="${color}" stroke="#fff" stroke-width="2"/>` : ""}${label ? `<text x="${at[0] + 10}" y="${at[1] + down}">${escape(label)}</text>` : ""}`);
  };
  const line = (a, b, style) => {
    const [p, q] = [onScreen(a), onScreen(b)];
    if (p && q) parts.push(`<path d="M${p}L${q}" fill="none" ${style}/>`);
  };
  for (const mark of page.marks) {
    if (mark.line) line(...mark.line, mark.style);
    else dot(mark);
  }
  $("marks").innerHTML = parts.join("");
  const forward = mover.camera.getWorldDirection(new Vector3());
  const up = new Vector3(0, 1, 0).applyQuaternion(mover.camera.quaternion);
  const facing = Math.hypot(forward.x, forward.y) > 0.02 ? Math.atan2(forward.x, forward.y) : Math.atan2(up.x, up.y);
  const north = facing + ((page.scene?.grid_north_deg ?? 0) * Math.PI) / 180;
  $("needle").setAttribute("transform", `rotate(${(-north * 180) / Math.PI})`);
  const middle = mover.kind === "orbit" ? mover.camera.position.distanceTo(mover.orbit.target) : 20;
  const metre = canvas.clientHeight / (2 * middle * Math.tan((mover.camera.fov * Math.PI) / 360));
  const nice = [1, 2, 5].flatMap((k) => [0.01, 0.1, 1, 10, 100, 1000, 10000].map((t) => k * t)).sort((a, b) => a - b).filter((m) => m * metre <= 150).at(-1) ?? 0.01;
  $("scale").firstElementChild.textContent = nice >= 1000 ? `${nice / 1000} km` : nice >= 1 ? `${nice} m` : `${nice * 100} cm`;
  $("scale").lastElementChild.style.width = `${nice * metre}px`;
  if (page.scene) $("drawn").textContent = t`${count(cloud.drawn)} of ${count(page.scene.point_count)} points drawn`;
}

// Fails where the browser has no WebGL 2.
export function open() {
  renderer = new WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true });
  cloud = page.cloud = new Cloud(renderer);
  mover = page.mover = new Mover(canvas, changed);
  mover.groundAt = (x, y) => cloud.groundAt(x, y);
  canvas.addEventListener("webglcontextrestored", draw);
}
