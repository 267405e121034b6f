// Points on the screen: chunks in random order drawn up to a budget.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Frustum, GLSL3, Matrix4, Mesh, Points, RawShaderMaterial, RGBAFormat, Scene, Sphere, UnsignedByteType, Vector2, Vector3,
} from "three";
import { Screen, target, uniforms } from "./screen.js";
import { BALL_FRAGMENT, BALL_VERTEX, LINE_FRAGMENT, LINE_VERTEX, MESH_FRAGMENT, MESH_VERTEX, POINT_FRAGMENT, POINT_VERTEX } from "./shaders.js";
import { measure, unknown } from "./surface.js";

// Classes that people walk on: ground, roads, bridges.
const GROUND = [2, 11, 17];
// Value of a point that a plan clears: it is not drawn.
const CLEARED = 254;
const integers = (array, size) => Object.assign(new BufferAttribute(array, size), { gpuType: 1013 });
// A hole of the picture lies so many sizes of a point behind what is around it.
const GAP = 2;
// Widest hole between points that is closed, in sizes of a point.
const WIDEST = 1.6;
// How far answers of points reach in a layer of them, in sizes of a point.
const SPREAD = 1.3;
// Side of the squares of the map that chunks lie in, metres.
const SQUARE = 128;
// Light where no question has a sun: from the south and half up, so that walls differ from each other and from roofs.
export const DAYLIGHT = new Vector3(0.25, -0.75, 0.75).normalize();
// Width of outlines, pixels.
const LINE = 2.5;
// Between these all is shown.
const ALL = { low: [-1e9, -1e9, -1e9], high: [1e9, 1e9, 1e9] };
// How much of the light is seen in each way of colouring: photographs have their own, and answers must be known by
// their colours.
const LIGHTS = [1, 0.7, 1, 0.5, 0.8];

// Frames that add points to a picture at rest may take so many times as long as one that moves.
export const AT_REST = 3;

export class Cloud {
  constructor(renderer) {
    this.renderer = renderer;
    this.scene = new Scene();
    this.extra = new Scene();
    this.chunks = [];
    // most points that one frame draws
    this.budget = 1e6;
    this.table = new DataTexture(new Uint8Array(1024), 256, 1, RGBAFormat, UnsignedByteType);
    this.own = uniforms({ table: this.table, mode: 2, layered: 0, heights: new Vector2(), size: 0.3, pixels: 1, far: 1000, most: 40, cleared: CLEARED, light: 1, sun: DAYLIGHT.clone(), cutLow: new Vector3(...ALL.low), cutHigh: new Vector3(...ALL.high) });
    // what lines need to be as wide on every screen
    Object.assign(this, { lineScreen: { value: new Vector2(1, 1) }, lineWidth: { value: LINE } });
    this.target = target();
    this.screen = new Screen(renderer);
    // whether whole pictures take no longer than those that move may
    this.isQuick = false;
    this.isRough = false;
    // whether the sun of the light is one that is seen
    this.isSunny = false;
    this.frustum = new Frustum();
    // points in view that the picture holds, and that are still to be added to it
    this.drawn = this.left = 0;
  }

  // Adds points: four numbers of 16 bits each, steps along the axes from `low`, class and intensity. `first` is their
  // place in the order of all points.
  add(low, step, places, values, first = 0, shared = this.own, scene = this.scene) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("place", integers(places, 4));
    geometry.setAttribute("value", integers(values ?? new Uint8Array(places.length / 4), 1));
    geometry.setAttribute("shape", integers(unknown(places.length / 4), 4));
    // without an attribute called position, three.js does not know how many points there are
    geometry.setDrawRange(0, places.length / 4);
    const high = low.map((v, i) => v + step[i] * 65535);
    const middle = new Vector3(...low.map((v, i) => (v + high[i]) / 2));
    geometry.boundingSphere = new Sphere(middle, middle.distanceTo(new Vector3(...high)));
    const material = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: POINT_VERTEX, fragmentShader: POINT_FRAGMENT, uniforms: { ...shared, ...uniforms({ low: new Vector3(...low), step3: new Vector3(...step) }) },
    });
    const object = new Points(geometry, material);
    scene.add(object);
    const chunk = { object, geometry, low, step, places, first, count: places.length / 4, drawn: 0 };
    if (scene === this.scene) {
      this.chunks.push(chunk);
      this.left += chunk.count;
      this.setChunkValues(chunk);
    }
    return chunk;
  }

  // Finds out how points lie in surfaces, square by square of the map, and lets the page go on in between.
  async measure(spacing) {
    const squares = new Map();
    for (const chunk of this.chunks) {
      const key = `${Math.floor(chunk.low[0] / SQUARE)} ${Math.floor(chunk.low[1] / SQUARE)}`;
      squares.set(key, [...(squares.get(key) ?? []), chunk]);
    }
    for (const chunks of squares.values()) {
      measure(chunks, spacing);
      await new Promise((go) => setTimeout(go, 0));
    }
  }

  // Local heights below which shares of the points lie, to a thousandth of the whole; the first points of a chunk are a
  // fair sample of it.
  heights(shares) {
    const MOST = 20_000, BINS = 2000;
    const low = Math.min(...this.chunks.map((chunk) => chunk.low[2])), high = Math.max(...this.chunks.map((chunk) => chunk.low[2] + 65535 * chunk.step[2]));
    const bins = new Float64Array(BINS);
    let whole = 0;
    for (const { low: [, , foot], step: [, , step], places, count } of this.chunks) {
      const taken = Math.min(count, MOST);
      for (let i = 0; i < taken; i++) bins[Math.min(Math.floor(((foot + places[4 * i + 2] * step - low) / (high - low || 1)) * BINS), BINS - 1)] += count / taken;
      whole += count;
    }
    return shares.map((share) => {
      let bin = 0;
      for (let sum = bins[0]; bin < BINS - 1 && sum < share * whole; sum += bins[bin]) bin += 1;
      return low + ((bin + (share > 0.5 ? 1 : 0)) / BINS) * (high - low);
    });
  }

  // The direction to the sun that lights the scene; without any, daylight.
  setSun(direction) {
    this.isSunny = direction !== null;
    this.own.sun.value.set(...(direction ?? DAYLIGHT));
  }

  // Shows only what lies between two corners, local metres; without any, all.
  setCut(cut) {
    const { low, high } = cut ?? ALL;
    this.own.cutLow.value.set(...low);
    this.own.cutHigh.value.set(...high);
  }

  // Answers of the points in their order; without any, only which of them a plan clears (`cleared`).
  setValues(bytes) {
    this.values = bytes ?? this.cleared?.map((is) => is * CLEARED) ?? null;
    this.chunks.forEach((chunk) => this.setChunkValues(chunk));
  }

  setChunkValues({ geometry, first, count }) {
    const value = geometry.getAttribute("value");
    if (this.values) value.copyArray(this.values.subarray(first, first + count));
    else value.array.fill(0);
    value.needsUpdate = true;
  }

  setColors({ geometry, object }, values) {
    geometry.setAttribute("rgb565", integers(values, 1));
    object.material.defines = { COLORED: 1 };
    object.material.needsUpdate = true;
  }

  // Answers of points are drawn as layers, those of cells are some.
  paint({ mode, table, legend, light = LIGHTS[mode] }, own = this.own) {
    own.layered.value = mode === 4 && legend && own === this.own ? 1 : 0;
    if (own === this.own) this.isOfKinds = Boolean(legend?.keys);
    table.forEach((color, i) => own.table.value.image.data.set([...color.map(Math.round), 255], 4 * i));
    own.table.value.needsUpdate = true;
    own.mode.value = mode;
    own.light.value = light;
  }

  // A set of points of its own, such as cells, painted apart.
  layer(low, step, places, values, size, paint, none = -1) {
    this.clearLayer();
    const table = new DataTexture(new Uint8Array(1024), 256, 1, RGBAFormat, UnsignedByteType);
    const shared = { ...this.own, ...uniforms({ table, mode: 4, layered: 0, size, cleared: none, light: 0 }) };
    this.add(low, step, places, values, 0, shared, this.extra);
    this.paint({ ...paint, light: 0 }, shared);
    this.layerOwn = shared;
  }

  clearLayer() {
    for (const object of [...this.extra.children].filter((object) => object.isPoints && !object.isBalls)) {
      object.geometry.dispose();
      this.extra.remove(object);
    }
  }

  addBalls(values) {
    const geometry = new BufferGeometry().setAttribute("ball", new BufferAttribute(values, 4));
    geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    const own = { pixels: this.own.pixels, far: this.own.far, ...uniforms({ tint: new Color(0.42, 0.62, 0.86) }) };
    this.balls = new Points(geometry, new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: BALL_VERTEX, fragmentShader: BALL_FRAGMENT, uniforms: own }));
    this.balls.isBalls = true;
    this.balls.frustumCulled = false;
    geometry.setDrawRange(0, values.length / 4);
    this.extra.add(this.balls);
  }

  // Triangles beside the cloud: nine numbers each.
  addMesh(values) {
    (this.meshes ??= []).push(this.mesh(values, new Color(0.86, 0.84, 0.9)));
  }

  // Lines beside the cloud, six numbers each, as bands of a width: lines of the graphics card are a pixel wide.
  addLines(values, width) {
    const corners = [];
    const band = (a, b, aside) => { const [p, q, r, t] = [a.map((v, i) => v - aside[i]), a.map((v, i) => v + aside[i]), b.map((v, i) => v - aside[i]), b.map((v, i) => v + aside[i])]; corners.push(...p, ...q, ...r, ...q, ...t, ...r); };
    for (let i = 0; i < values.length; i += 6) {
      const [a, b] = [[...values.subarray(i, i + 3)], [...values.subarray(i + 3, i + 6)]];
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]], flat = Math.hypot(dx, dy), half = width / 2;
      if (flat > 1e-3) band(a, b, [(-dy / flat) * half, (dx / flat) * half, 0]);
      band(a, b, flat > 1e-3 ? [0, 0, half] : [half, 0, 0]);
      if (flat <= 1e-3) band(a, b, [0, half, 0]);
    }
    (this.meshes ??= []).push(this.mesh(new Float32Array(corners), new Color(0.85, 0.05, 0.4)));
  }

  // Lines of one colour, six numbers each, that stay as wide on the screen.
  addOutlines(values, [red, green, blue]) {
    const count = values.length / 6;
    const [corner, other] = [new Float32Array(count * 12), new Float32Array(count * 12)];
    const side = new Float32Array(count * 4), index = new Uint32Array(count * 6);
    for (let i = 0; i < count; i++) {
      for (let k = 0; k < 4; k++) {
        const [own, far] = k < 2 ? [0, 3] : [3, 0];
        corner.set(values.subarray(6 * i + own, 6 * i + own + 3), 12 * i + 3 * k);
        other.set(values.subarray(6 * i + far, 6 * i + far + 3), 12 * i + 3 * k);
        // seen from the other end, left is right
        side[4 * i + k] = (k % 2 ? 1 : -1) * (k < 2 ? 1 : -1);
      }
      index.set([0, 1, 2, 1, 3, 2].map((k) => 4 * i + k), 6 * i);
    }
    const geometry = new BufferGeometry().setIndex(new BufferAttribute(index, 1));
    for (const [name, array, size] of [["corner", corner, 3], ["other", other, 3], ["side", side, 1]]) geometry.setAttribute(name, new BufferAttribute(array, size));
    const own = { far: this.own.far, pixels: this.own.pixels, lift: this.own.size, screen: this.lineScreen, wide: this.lineWidth, ...uniforms({ tint: new Color(red / 255, green / 255, blue / 255) }) };
    const lines = new Mesh(geometry, new RawShaderMaterial({ glslVersion: GLSL3, side: DoubleSide, vertexShader: LINE_VERTEX, fragmentShader: LINE_FRAGMENT, uniforms: own }));
    lines.frustumCulled = false;
    this.extra.add(lines);
    (this.outlines ??= []).push(lines);
  }

  // Triangles of a plan, instead of those before.
  setPlan(values) {
    this.plan?.geometry.dispose();
    if (this.plan) this.extra.remove(this.plan);
    this.plan = values?.length ? this.mesh(values, new Color(0.87, 0.55, 0.75)) : null;
  }

  mesh(values, tint) {
    const geometry = new BufferGeometry().setAttribute("corner", new BufferAttribute(values, 3));
    geometry.setDrawRange(0, values.length / 3);
    const own = { far: this.own.far, ...uniforms({ tint }) };
    const mesh = new Mesh(geometry, new RawShaderMaterial({ glslVersion: GLSL3, side: DoubleSide, vertexShader: MESH_VERTEX, fragmentShader: MESH_FRAGMENT, uniforms: own }));
    mesh.frustumCulled = false;
    this.extra.add(mesh);
    return mesh;
  }

  resize(width, height) {
    this.target.setSize(width, height);
    this.screen.resize(width, height);
    this.lineScreen.value.set(width, height);
    this.lineWidth.value = LINE * this.renderer.getPixelRatio();
  }

  // Draws the scene with as many points in view as the budget allows. A picture that is not new keeps what it holds,
  // and the next points are added to it. It stays rough as long as points are missing, and where `isMoving` unless the
  // graphics card has shown to be quick.
  render(camera, theme, isNew, isMoving) {
    const { own, target, renderer } = this;
    own.far.value = camera.far;
    own.pixels.value = target.height / (2 * Math.tan((camera.fov * Math.PI) / 360));
    if (isNew) this.chunks.forEach((chunk) => { chunk.drawn = 0; });
    this.share(camera, isNew ? this.budget : AT_REST * this.budget);
    renderer.setRenderTarget(target);
    renderer.autoClear = false;
    if (isNew) {
      renderer.setClearColor(0, 0);
      renderer.clear();
    }
    renderer.render(this.scene, camera);
    if (isNew) renderer.render(this.extra, camera);
    this.isRough = !this.isQuick && (isMoving || this.left > 0);
    const smooth = { table: this.table, reach: SPREAD * own.size.value, kinds: this.isOfKinds };
    this.screen.show(target, camera, { smooth, isLayer: own.layered.value === 1, isRough: this.isRough, theme, pixels: own.pixels.value, gap: GAP * own.size.value, widest: WIDEST * own.size.value, sun: own.sun.value, glow: this.isSunny && own.sun.value.z > 0 ? 1 : 0 });
    renderer.autoClear = true;
  }

  // Shares a budget of points among the chunks in view: those that look larger get more.
  share(camera, budget) {
    camera.updateMatrixWorld();
    this.frustum.setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const seen = this.chunks.filter(({ object, geometry }) => { object.visible = false; return this.frustum.intersectsSphere(geometry.boundingSphere); });
    const want = seen.map(({ count, drawn, geometry: { boundingSphere: { center, radius } } }) => {
      const range = Math.max(camera.position.distanceTo(center) - radius, 1);
      return (count - drawn) * Math.min(1, (radius / range) ** 2 + 0.02);
    });
    const whole = want.reduce((a, b) => a + b, 0);
    const left = seen.reduce((sum, { count, drawn }) => sum + count - drawn, 0);
    this.drawn = this.left = 0;
    seen.forEach((chunk, i) => {
      const rest = chunk.count - chunk.drawn;
      const count = left <= budget ? rest : Math.min(rest, Math.ceil((want[i] * budget) / whole));
      chunk.object.visible = count > 0;
      chunk.geometry.setDrawRange(chunk.drawn, count);
      chunk.drawn += count;
      this.drawn += chunk.drawn;
      this.left += chunk.count - chunk.drawn;
    });
  }

  // Distance along the view of what is drawn nearest to a pixel, looking around it; null where nothing is.
  depthAt(x, y, reach = 4) {
    const side = 2 * reach + 1;
    const bytes = new Uint8Array(4 * side * side);
    const corner = [x - reach, this.target.height - 1 - y - reach].map(Math.round);
    this.renderer.readRenderTargetPixels(this.target, ...corner, side, side, bytes, undefined, 1);
    let best = null;
    for (let i = 0; i < side * side; i++) {
      if (bytes[4 * i + 3] < 128) continue;
      const away = ((i % side) - reach) ** 2 + (Math.floor(i / side) - reach) ** 2;
      const depth = ((bytes[4 * i] * 65536 + bytes[4 * i + 1] * 256 + bytes[4 * i + 2]) / 16777215) * this.own.far.value;
      if (!best || away < best.away) best = { away, depth };
    }
    return best?.depth ?? null;
  }

  // The point nearest to a local place.
  nearest([x, y, z]) {
    let best = null;
    const [least, most] = [this.own.cutLow, this.own.cutHigh].map(({ value }) => value.toArray());
    for (const { low, step, places, count, first } of this.chunks) {
      const reach = best ? Math.sqrt(best.away) : 3;
      if ([x, y, z].some((v, i) => v < low[i] - reach || v > low[i] + step[i] * 65535 + reach)) continue;
      for (let i = 0; i < count; i++) {
        const dx = low[0] + places[4 * i] * step[0] - x, dy = low[1] + places[4 * i + 1] * step[1] - y, dz = low[2] + places[4 * i + 2] * step[2] - z;
        const away = dx * dx + dy * dy + dz * dz;
        if ((!best || away < best.away) && [x + dx, y + dy, z + dz].every((v, k) => v >= least[k] && v <= most[k])) best = { away, place: [x + dx, y + dy, z + dz], class: places[4 * i + 3] & 255, value: this.values?.[first + i] };
      }
    }
    return best;
  }

  // The boxes that points lie in, low and high corner each: an eighth of a chunk long, or those of many chunks.
  boxes() {
    const FEW = 40;
    return this.chunks.flatMap(({ low, step, places, count }) => {
      const side = this.chunks.length > FEW ? 65536 : 8192;
      const cells = new Set();
      for (let i = 0; i < 4 * count; i += 4) cells.add((Math.floor(places[i] / side) * 8 + Math.floor(places[i + 1] / side)) * 8 + Math.floor(places[i + 2] / side));
      return [...cells].map((cell) => [cell >> 6, (cell >> 3) & 7, cell & 7]).map((cell) => [0, 1].map((end) => low.map((v, k) => v + (cell[k] + end) * side * step[k])));
    });
  }

  // A place on the ground near one on the map, on which a person who walks stands: the lowest point within a metre, or
  // within some more where there is none. Where points are classified as ground, one of them.
  groundAt(x, y) {
    // the first points of a chunk are a fair sample of it
    const MOST = 40_000;
    const isGround = ({ places, count }, i) => i < 4 * Math.min(count, MOST) && GROUND.includes(places[i + 3] & 255);
    this.hasGround ??= this.chunks.some((chunk) => chunk.places.some((_, i) => i % 4 === 0 && isGround(chunk, i)));
    for (const reach of [1, 3, 9, 27]) {
      let lowest = null;
      for (const chunk of this.chunks) {
        const { low, step, places, count } = chunk;
        const [left, right] = [x - reach - low[0], x + reach - low[0]].map((v) => v / step[0]);
        const [south, north] = [y - reach - low[1], y + reach - low[1]].map((v) => v / step[1]);
        if (right < 0 || left > 65535 || north < 0 || south > 65535) continue;
        for (let i = 0; i < 4 * Math.min(count, MOST); i += 4) {
          if (places[i] < left || places[i] > right || places[i + 1] < south || places[i + 1] > north || (this.hasGround && !isGround(chunk, i))) continue;
          const z = low[2] + places[i + 2] * step[2];
          if (!lowest || z < lowest[2]) lowest = reach > 1 ? [low[0] + places[i] * step[0], low[1] + places[i + 1] * step[1], z] : [x, y, z];
        }
      }
      if (lowest) return lowest;
    }
    return null;
  }
}
