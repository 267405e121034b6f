// Points on the screen: chunks in random order drawn up to a budget, and shading by depth (eye-dome lighting).
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, Frustum, GLSL3, Matrix4, Mesh, NearestFilter, OrthographicCamera, Points, RawShaderMaterial, RGBAFormat,
  Scene, Sphere, UnsignedByteType, Vector2, Vector3, WebGLRenderTarget,
} from "three";

const PACK = `
vec4 packed(float d) { float v = clamp(d, 0.0, 0.9999999) * 16777215.0; float h = floor(v / 65536.0); float m = floor((v - h * 65536.0) / 256.0);
  return vec4(h, m, v - h * 65536.0 - m * 256.0, 255.0) / 255.0; }`;

const VERTEX = `precision highp float; precision highp int;
in uvec4 place; in uint value;
#ifdef COLORED
in uint rgb565;
#else
const uint rgb565 = 0u;
#endif
uniform mat4 modelViewMatrix, projectionMatrix; uniform vec3 low, step3; uniform vec2 heights; uniform int mode, cleared; uniform float size, pixels, far, most;
uniform sampler2D table; out vec3 color; out float depth;
void main() {
  vec3 local = low + vec3(place.xyz) * step3;
  vec4 view = modelViewMatrix * vec4(local, 1.0);
  gl_Position = int(value) == cleared ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * view;
  depth = -view.z / far;
  gl_PointSize = clamp(size * pixels / max(-view.z, 0.01), 1.6, most);
  float index = 0.0;
  if (mode == 0) index = float(place.w & 255u); else if (mode == 1) index = float(place.w >> 8u);
  else if (mode == 2) index = clamp((local.z - heights.x) / max(heights.y - heights.x, 0.001), 0.0, 1.0) * 255.0; else index = float(value);
  color = mode == 3 ? vec3(float(rgb565 >> 11u) / 31.0, float((rgb565 >> 5u) & 63u) / 63.0, float(rgb565 & 31u) / 31.0)
    : texture(table, vec2((index + 0.5) / 256.0, 0.5)).rgb;
}`;
const FRAGMENT = `precision highp float; in vec3 color; in float depth; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec2 o = gl_PointCoord - 0.5; if (dot(o, o) > 0.26) discard; shown = vec4(color, 1.0); far24 = packed(depth); }`;

const BALL_VERTEX = `precision highp float; in vec4 ball; uniform mat4 modelViewMatrix, projectionMatrix; uniform float pixels;
out vec3 middle; out float radius;
void main() { vec4 view = modelViewMatrix * vec4(ball.xyz, 1.0); middle = view.xyz; radius = ball.w;
  gl_Position = projectionMatrix * view; gl_PointSize = clamp(2.15 * ball.w * pixels / max(-view.z, 0.01), 1.5, 1000.0); }`;
const BALL_FRAGMENT = `precision highp float; in vec3 middle; in float radius; uniform mat4 projectionMatrix; uniform float far; uniform vec3 tint;
layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec2 o = (gl_PointCoord - 0.5) * 2.15; o.y = -o.y; float h = 1.0 - dot(o, o); if (h < 0.0) discard; vec3 n = vec3(o, sqrt(h));
  vec3 at = middle + radius * n; vec4 clip = projectionMatrix * vec4(at, 1.0); gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
  shown = vec4(tint * (0.45 + 0.55 * max(dot(n, normalize(vec3(0.3, 0.6, 0.75))), 0.0)), 1.0); far24 = packed(-at.z / far); }`;

const MESH_VERTEX = `precision highp float; in vec3 corner; uniform mat4 modelViewMatrix, projectionMatrix; out vec3 at;
void main() { vec4 view = modelViewMatrix * vec4(corner, 1.0); at = view.xyz; gl_Position = projectionMatrix * view; }`;
const MESH_FRAGMENT = `precision highp float; in vec3 at; uniform float far; uniform vec3 tint; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec3 n = normalize(cross(dFdx(at), dFdy(at))); shown = vec4(tint * (0.5 + 0.5 * abs(dot(n, normalize(vec3(0.3, 0.6, 0.75))))), 1.0); far24 = packed(-at.z / far); }`;

const SHADE = `precision highp float; uniform sampler2D shown, far24; uniform vec2 texel; uniform vec3 ground; uniform float far, strength, radius; in vec2 uv; out vec4 color;
float at(vec2 p) { vec4 t = texture(far24, p); return t.a < 0.5 ? -1.0 : log2(max(dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far, 0.01)); }
void main() { float d = at(uv); vec3 c = texture(shown, uv).rgb; if (d < -0.99 && texture(far24, uv).a < 0.5) { color = vec4(ground, 1.0); return; }
  float sum = 0.0; for (int i = 0; i < 8; i++) { float a = float(i) * 0.7853982; vec2 p = uv + vec2(cos(a), sin(a)) * radius * texel; vec4 t = texture(far24, p);
    if (t.a >= 0.5) sum += clamp(d - at(p), 0.0, 1.0); }
  color = vec4(c * max(exp(-strength * sum / 8.0), 0.3), 1.0); }`;

// Value of a point that a plan clears: it is not drawn.
const CLEARED = 254;
const integers = (array, size) => Object.assign(new BufferAttribute(array, size), { gpuType: 1013 });
const uniforms = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));

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
    this.own = uniforms({ table: this.table, mode: 2, heights: new Vector2(), size: 0.3, pixels: 1, far: 1000, most: 40, cleared: CLEARED });
    this.target = new WebGLRenderTarget(1, 1, { count: 2, magFilter: NearestFilter, minFilter: NearestFilter });
    this.shade = new RawShaderMaterial({
      glslVersion: GLSL3, depthTest: false, depthWrite: false, fragmentShader: SHADE,
      vertexShader: "precision highp float; in vec3 position; out vec2 uv; void main() { uv = position.xy * 0.5 + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      uniforms: uniforms({ shown: this.target.textures[0], far24: this.target.textures[1], texel: new Vector2(), ground: new Color(), far: 1000, strength: 40, radius: 1.6 }),
    });
    const screen = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.screen = new Mesh(screen, this.shade);
    this.screen.frustumCulled = false;
    this.flat = new OrthographicCamera();
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
    // without an attribute called position, three.js does not know how many points there are
    geometry.setDrawRange(0, places.length / 4);
    const high = low.map((v, i) => v + step[i] * 65535);
    const middle = new Vector3(...low.map((v, i) => (v + high[i]) / 2));
    geometry.boundingSphere = new Sphere(middle, middle.distanceTo(new Vector3(...high)));
    const material = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { ...shared, ...uniforms({ low: new Vector3(...low), step3: new Vector3(...step) }) },
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

  paint({ mode, table }, own = this.own) {
    table.forEach((color, i) => own.table.value.image.data.set([...color.map(Math.round), 255], 4 * i));
    own.table.value.needsUpdate = true;
    own.mode.value = mode;
  }

  // A set of points of its own, such as cells, painted apart.
  layer(low, step, places, values, size, paint, none = -1) {
    this.clearLayer();
    const table = new DataTexture(new Uint8Array(1024), 256, 1, RGBAFormat, UnsignedByteType);
    const shared = { ...this.own, ...uniforms({ table, mode: 4, size, cleared: none }) };
    this.add(low, step, places, values, 0, shared, this.extra);
    this.paint(paint, shared);
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
    this.shade.uniforms.texel.value.set(1 / width, 1 / height);
  }

  // Draws the scene with as many points in view as the budget allows. A picture that is not new keeps what it holds,
  // and the next points are added to it.
  render(camera, ground, isNew) {
    const { own, shade, target, renderer } = this;
    own.far.value = shade.uniforms.far.value = camera.far;
    own.pixels.value = target.height / (2 * Math.tan((camera.fov * Math.PI) / 360));
    shade.uniforms.ground.value.setStyle(ground, "");
    shade.uniforms.radius.value = 1.3 * renderer.getPixelRatio();
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
    renderer.setRenderTarget(null);
    renderer.render(this.screen, this.flat);
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
    for (const { low, step, places, count } of this.chunks) {
      const reach = best ? Math.sqrt(best.away) : 3;
      if ([x, y, z].some((v, i) => v < low[i] - reach || v > low[i] + step[i] * 65535 + reach)) continue;
      for (let i = 0; i < count; i++) {
        const dx = low[0] + places[4 * i] * step[0] - x, dy = low[1] + places[4 * i + 1] * step[1] - y, dz = low[2] + places[4 * i + 2] * step[2] - z;
        const away = dx * dx + dy * dy + dz * dz;
        if (!best || away < best.away) best = { away, place: [x + dx, y + dy, z + dz], class: places[4 * i + 3] & 255 };
      }
    }
    return best;
  }

  // The lowest point around a place on the map: what a person who walks stands on.
  groundAt(x, y) {
    const REACH = 1;
    // the first points of a chunk are a fair sample of it
    const MOST = 40_000;
    let lowest;
    for (const { low, step, places, count } of this.chunks) {
      const [left, right] = [x - REACH - low[0], x + REACH - low[0]].map((v) => v / step[0]);
      const [south, north] = [y - REACH - low[1], y + REACH - low[1]].map((v) => v / step[1]);
      if (right < 0 || left > 65535 || north < 0 || south > 65535) continue;
      for (let i = 0; i < 4 * Math.min(count, MOST); i += 4) {
        if (places[i] < left || places[i] > right || places[i + 1] < south || places[i + 1] > north) continue;
        const z = low[2] + places[i + 2] * step[2];
        if (!(lowest <= z)) lowest = z;
      }
    }
    return lowest;
  }
}
