// What the graphics card computes: points, balls and meshes into colours and depths, and those into the picture.

const PACK = `
vec4 packed(float d) { float v = clamp(d, 0.0, 0.9999999) * 16777215.0; float h = floor(v / 65536.0); float m = floor((v - h * 65536.0) / 256.0);
  return vec4(h, m, v - h * 65536.0 - m * 256.0, 255.0) / 255.0; }`;

// Discs lie in the surface at their point. It faces who sees it, is brighter the more it faces the sky and the sun, and
// so walls, roofs and ground differ. Points of no surface, such as leaves, are small balls.
// Size of points of no surface, in that of others.
const LOOSE = 0.6;
export const POINT_VERTEX = `precision highp float; precision highp int;
#define LOOSE ${LOOSE}
in uvec4 place; in uint value; in uvec4 shape;
#ifdef COLORED
in uint rgb565;
#else
const uint rgb565 = 0u;
#endif
uniform mat4 modelViewMatrix, projectionMatrix; uniform vec3 low, step3, sun, cutLow, cutHigh; uniform vec2 heights; uniform int mode, cleared, layered; uniform float size, pixels, most, light;
uniform sampler2D table; flat out vec4 color; flat out vec2 slope; flat out vec3 range;
void main() {
  vec3 local = low + vec3(place.xyz) * step3;
  vec4 view = modelViewMatrix * vec4(local, 1.0);
  bool isCut = any(lessThan(local, cutLow)) || any(greaterThan(local, cutHigh));
  gl_Position = int(value) == cleared || isCut ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * view;
  bool isSurface = shape.y + shape.z + shape.w > 0u;
  float wide = size * float(shape.x) / 64.0 * pixels / max(-view.z, 0.01);
  // single points near the eye would stand before all else
  gl_PointSize = isSurface ? clamp(wide, 1.6, most) : clamp(LOOSE * wide, min(max(wide, 1.6), 6.0), 0.1 * most);
  range = vec3(-view.z, 0.5 * gl_PointSize * max(-view.z, 0.01) / pixels, isSurface ? 0.0 : smoothstep(2.5, 6.0, gl_PointSize));
  slope = vec2(0.0);
  float shine = 0.9;
  if (isSurface) {
    vec3 n = normalize(vec3(shape.yzw) - 128.0);
    vec3 seen = mat3(modelViewMatrix) * n;
    if (dot(seen, view.xyz) > 0.0) { seen = -seen; n = -n; }
    float facing = max(-dot(seen, normalize(view.xyz)), 0.3);
    // small discs stay round: what is thinner than a pixel has gaps
    slope = seen.xy / facing * smoothstep(2.5, 6.0, gl_PointSize);
    shine = 0.55 + 0.1 * (1.0 + n.z) + 0.38 * max(dot(n, sun), 0.0);
  }
  float index = 0.0;
  if (mode == 0) index = float(place.w & 255u); else if (mode == 1) index = float(place.w >> 8u);
  else if (mode == 2) index = clamp((local.z - heights.x) / max(heights.y - heights.x, 0.001), 0.0, 1.0) * 255.0; else index = float(value);
  float own = mix(1.0, shine, light);
  vec3 said = mode == 3 ? vec3(float(rgb565 >> 11u) / 31.0, float((rgb565 >> 5u) & 63u) / 63.0, float(rgb565 & 31u) / 31.0)
    : texture(table, vec2((index + 0.5) / 256.0, 0.5)).rgb;
  // answers become layers, for which light and answer stay apart: half of one, the place of the other in the table
  color = layered == 1 && value < 255u ? vec4(vec3(0.5 * own), index / 255.0) : vec4(said * own, 1.0);
}`;
export const POINT_FRAGMENT = `precision highp float; flat in vec4 color; flat in vec2 slope; flat in vec3 range; uniform mat4 projectionMatrix; uniform float far;
layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec2 o = gl_PointCoord * 2.0 - 1.0; o.y = -o.y; float rise = dot(slope, o); float q = dot(o, o) + rise * rise; if (q > 1.05) discard;
  float ball = range.z * sqrt(max(1.0 - q, 0.0)), d = range.x + range.y * (rise - 0.7 * ball);
  shown = vec4(color.rgb * mix(1.0, 0.72 + 0.26 * ball + 0.12 * o.y, range.z), color.a); far24 = packed(d / far);
  // discs that touch part their surface between them
  gl_FragDepth = clamp(0.5 - 0.5 * projectionMatrix[2][2] + 0.5 * projectionMatrix[3][2] / max(d + 0.3 * range.y * q, 1e-4), 0.0, 1.0); }`;

export const BALL_VERTEX = `precision highp float; in vec4 ball; uniform mat4 modelViewMatrix, projectionMatrix; uniform float pixels;
out vec3 middle; out float radius;
void main() { vec4 view = modelViewMatrix * vec4(ball.xyz, 1.0); middle = view.xyz; radius = ball.w;
  gl_Position = projectionMatrix * view; gl_PointSize = clamp(2.15 * ball.w * pixels / max(-view.z, 0.01), 1.5, 1000.0); }`;
export const BALL_FRAGMENT = `precision highp float; in vec3 middle; in float radius; uniform mat4 projectionMatrix; uniform float far; uniform vec3 tint;
layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec2 o = (gl_PointCoord - 0.5) * 2.15; o.y = -o.y; float h = 1.0 - dot(o, o); if (h < 0.0) discard; vec3 n = vec3(o, sqrt(h));
  vec3 at = middle + radius * n; vec4 clip = projectionMatrix * vec4(at, 1.0); gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
  shown = vec4(tint * (0.45 + 0.55 * max(dot(n, normalize(vec3(0.3, 0.6, 0.75))), 0.0)), 1.0); far24 = packed(-at.z / far); }`;

export const MESH_VERTEX = `precision highp float; in vec3 corner; uniform mat4 modelViewMatrix, projectionMatrix; out vec3 at;
void main() { vec4 view = modelViewMatrix * vec4(corner, 1.0); at = view.xyz; gl_Position = projectionMatrix * view; }`;
export const MESH_FRAGMENT = `precision highp float; in vec3 at; uniform float far; uniform vec3 tint; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { vec3 n = normalize(cross(dFdx(at), dFdy(at))); shown = vec4(tint * (0.5 + 0.5 * abs(dot(n, normalize(vec3(0.3, 0.6, 0.75))))), 1.0); far24 = packed(-at.z / far); }`;

// Lines so many pixels wide, and half a metre from far away, where they would hide what is between them. They are moved
// towards the eye by the size of points, which would hide a part of them.
export const LINE_VERTEX = `precision highp float; in vec3 corner, other; in float side; uniform mat4 modelViewMatrix, projectionMatrix; uniform vec2 screen; uniform float wide, lift, pixels; out vec3 at;
vec4 lifted(vec3 place) { vec4 view = modelViewMatrix * vec4(place, 1.0); float range = length(view.xyz); view.xyz *= max(1.0 - lift / range, 0.5); return view; }
void main() { vec4 view = lifted(corner), p = projectionMatrix * view, q = projectionMatrix * lifted(other); at = view.xyz;
  // an end behind the eye has no place on the screen
  if (q.w < 0.1 && p.w > 0.1) q = mix(p, q, (p.w - 0.1) / (p.w - q.w));
  vec2 way = (q.xy / q.w - p.xy / p.w) * screen; way /= max(length(way), 1e-6);
  float own = clamp(0.5 * pixels / max(p.w, 0.1), 0.4 * wide, wide); gl_Position = p + vec4(side * own * vec2(-way.y, way.x) / screen * p.w, 0.0, 0.0); }`;
export const LINE_FRAGMENT = `precision highp float; in vec3 at; uniform float far; uniform vec3 tint; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${PACK}
void main() { shown = vec4(tint, 1.0); far24 = packed(-at.z / far); }`;

export const SCREEN_VERTEX = "precision highp float; in vec3 position; out vec2 uv; void main() { uv = position.xy * 0.5 + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }";

// Smooths over the places within `reach` metres, nearer ones counting more: colours and depths over a third of it, for
// points near the eye are large. Answers become layers, over `least` pixels or more: of kinds, that of most places, of
// measures, the mean. Points alone are steps and spots as wide as they lie apart.
export const SMOOTH = `precision highp float; precision highp int; uniform sampler2D shown, far24, table; uniform float far, reach, pixels, least; uniform bool kinds; uniform int taps;
layout(location = 0) out vec4 color; layout(location = 1) out vec4 depth;${PACK}
float at(vec4 t) { return dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far; }
vec3 said(float index) { return texture(table, vec2((index * 255.0 + 0.5) / 256.0, 0.5)).rgb; }
void main() { ivec2 p = ivec2(gl_FragCoord.xy), most = textureSize(far24, 0) - 1; vec4 own = texelFetch(shown, p, 0); depth = texelFetch(far24, p, 0);
  color = own; if (depth.a < 0.5) return;
  bool isAnswer = own.a < 0.998;
  float d = at(depth), span = isAnswer ? max(reach, least * d / pixels) : 0.5 * reach, wide = min(span * pixels / max(d, 0.01), 60.0);
  if (!isAnswer && wide < 1.5) return;
  vec2 from = vec2(p) - 0.5 * vec2(most); float kind[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0); kind[min(int(own.a * 255.0 + 0.5), 7)] = 1.0;
  vec3 sum = said(own.a), light = own.rgb; float whole = 1.0, near = 1.0, depths = d;
  int count = isAnswer ? taps : taps / 2;
  for (int i = 0; i < count; i++) {
    float a = float(i) * 2.3999632, r = sqrt((float(i) + 0.5) / float(count)) * wide; ivec2 q = clamp(p + ivec2(round(r * vec2(cos(a), sin(a)))), ivec2(0), most);
    vec4 other = texelFetch(shown, q, 0), z = texelFetch(far24, q, 0); if ((other.a < 0.998) != isAnswer || z.a < 0.5) continue;
    float e = at(z); vec3 to = vec3(((vec2(q) - 0.5 * vec2(most)) * e - from * d) / pixels, e - d); float apart = dot(to, to), w = exp(-2.0 * apart / (span * span)), v = exp(-9.0 * apart / (reach * reach));
    kind[min(int(other.a * 255.0 + 0.5), 7)] += w; sum += w * said(other.a); whole += w; light += v * other.rgb; depths += v * e; near += v; }
  light /= near; depth = packed(depths / near / far); color = vec4(light, 1.0); if (!isAnswer) return;
  vec3 answer = sum / whole;
  if (kinds) { int first = 0, second = -1; for (int k = 1; k < 8; k++) if (kind[k] > kind[first]) first = k;
    for (int k = 0; k < 8; k++) if (k != first && (second < 0 || kind[k] > kind[second])) second = k;
    // a line of a pixel or two between both
    answer = mix(said(float(second) / 255.0), said(float(first) / 255.0), 0.5 + 0.5 * smoothstep(0.0, 0.2, (kind[first] - kind[second]) / whole)); }
  color = vec4(2.0 * light * answer, 1.0); }`;

// Closes holes: where most pixels around one are nearer than it by `gap` metres or more, it takes the furthest of them.
// Of pixels that lie more than `free` from it, those within `widest` metres count.
export const FILL = `precision highp float; precision highp int; uniform sampler2D shown, far24; uniform float far, gap, widest, pixels; uniform int reach, free;
layout(location = 0) out vec4 color; layout(location = 1) out vec4 depth;
float at(ivec2 p) { vec4 t = texelFetch(far24, p, 0); return t.a < 0.5 ? 1e9 : dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far; }
void main() { ivec2 p = ivec2(gl_FragCoord.xy), most = textureSize(far24, 0) - 1; float own = at(p);
  float limit = own - gap - 0.004 * min(own, 1e6); float furthest = 0.0; int count = 0; ivec2 taken = p;
  // without any at the corners there are no five
  for (int i = 0; i < 8; i++) { if (i == 4 && count == 0) break;
    ivec2 q = clamp(p + reach * (i < 4 ? ivec2(2 * (i & 1) - 1, (i & 2) - 1) : i < 6 ? ivec2(2 * (i & 1) - 1, 0) : ivec2(0, 2 * (i & 1) - 1)), ivec2(0), most); float d = at(q);
    if (d < limit && (reach <= free || float(reach) * d < widest * pixels)) { count++; if (d > furthest) { furthest = d; taken = q; } } }
  if (count < 5) taken = p; color = texelFetch(shown, taken, 0); depth = texelFetch(far24, taken, 0); }`;

// Darkens what lies behind its surroundings, softly at two distances (eye-dome lighting), and paints the sky where
// nothing is.
export const SHADE = `precision highp float; uniform sampler2D shown, far24; uniform vec2 texel, slopes; uniform vec3 zenith, horizon, below, sun; uniform mat4 turned; uniform float far, strength, ratio, glow; uniform int rings;
in vec2 uv; out vec4 color;
float at(vec4 t) { return log2(max(dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far, 0.01)); }
vec3 sky() { vec3 ray = normalize(mat3(turned) * vec3((uv * 2.0 - 1.0) * slopes, -1.0));
  vec3 c = ray.z > 0.0 ? mix(horizon, zenith, 1.0 - pow(1.0 - ray.z, 2.5)) : mix(horizon, below, smoothstep(0.0, 0.2, -ray.z));
  float to = dot(ray, sun); return mix(c, vec3(1.0, 0.96, 0.84), glow * min(0.35 * pow(max(to, 0.0), 60.0) + smoothstep(0.9992, 0.9996, to), 1.0)); }
void main() { vec4 own = texture(far24, uv); if (own.a < 0.5) { color = vec4(sky(), 1.0); return; }
  float d = at(own), sum = 0.0;
  for (int i = 0; i < 8; i++) { float a = float(i) * 0.7853982 + 0.2; vec2 to = vec2(cos(a), sin(a)) * texel * ratio;
    for (int k = 0; k < rings; k++) { vec4 t = texture(far24, uv + (k == 0 ? 1.3 : 4.0) * to); if (t.a >= 0.5) sum += clamp(d - at(t), 0.0, 0.05); } }
  color = vec4(texture(shown, uv).rgb * max(exp(-strength * sum / float(8 * rings)), 0.6), 1.0); }`;
