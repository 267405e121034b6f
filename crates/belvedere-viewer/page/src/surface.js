// The surface at each point, from the points around it: how far apart they lie, and which way it faces. Points are
// then drawn as discs that lie in walls, roofs and ground, as large as the gaps between them, in soft light.

// Side of a cell in spacings of the cloud: some nine points of a surface fall into it.
const SIDE = 3;
// Cells with fewer points are taken together with those around them.
const FEW = 6;
// A surface is as thin as this share of its width, and no line.
const THIN = 0.06;
const LINE = 0.02;
// Least and greatest distance of points in spacings of the cloud, and the greatest where there is no surface, as in
// crowns: large discs would hide what is between the leaves.
const [LEAST, GREATEST, GREATEST_LOOSE] = [0.6, 1.8, 1.1];
// One spacing in the bytes of a point: distance, and normal in steps from 128 or zeros.
export const ONE = 64;
export const unknown = (count) => {
  const bytes = new Uint8Array(4 * count);
  for (let i = 0; i < bytes.length; i += 4) bytes[i] = ONE;
  return bytes;
};

// Sums of a cell: count, x, y, z, xx, xy, xz, yy, yz, zz.
const SUMS = 10;

// Normal of points with such sums and whether they lie in a surface: of the covariance, the direction of least spread.
function surfaceOf(sums, at) {
  const n = sums[at];
  if (n < 4) return null;
  const [x, y, z] = [sums[at + 1] / n, sums[at + 2] / n, sums[at + 3] / n];
  const [a, b, c, d, e, f] = [sums[at + 4] / n - x * x, sums[at + 5] / n - x * y, sums[at + 6] / n - x * z, sums[at + 7] / n - y * y, sums[at + 8] / n - y * z, sums[at + 9] / n - z * z];
  // eigenvalues of a symmetric matrix in closed form
  const mean = (a + d + f) / 3;
  const p = Math.sqrt(Math.max(((a - mean) ** 2 + (d - mean) ** 2 + (f - mean) ** 2 + 2 * (b * b + c * c + e * e)) / 6, 1e-18));
  const [A, D, F, B, C, E] = [(a - mean) / p, (d - mean) / p, (f - mean) / p, b / p, c / p, e / p];
  const half = (A * (D * F - E * E) - B * (B * F - E * C) + C * (B * E - D * C)) / 2;
  const angle = Math.acos(Math.max(-1, Math.min(1, half))) / 3;
  const most = mean + 2 * p * Math.cos(angle), least = mean + 2 * p * Math.cos(angle + (2 * Math.PI) / 3);
  const between = 3 * mean - most - least;
  if (!(least < THIN * between) || between < LINE * most) return null;
  // the rows of the matrix less the least value lie in the surface
  const rows = [[a - least, b, c], [b, d - least, e], [c, e, f - least]];
  let normal = null, longest = 0;
  for (const [i, j] of [[0, 1], [0, 2], [1, 2]]) {
    const [r, s] = [rows[i], rows[j]];
    const v = [r[1] * s[2] - r[2] * s[1], r[2] * s[0] - r[0] * s[2], r[0] * s[1] - r[1] * s[0]];
    const length = Math.hypot(...v);
    if (length > longest) [longest, normal] = [length, v.map((w) => w / length)];
  }
  return normal;
}

// Sets the surfaces of the points of chunks that lie in one square of the map.
export function measure(chunks, spacing) {
  const low = [0, 1, 2].map((axis) => chunks.reduce((v, chunk) => Math.min(v, chunk.low[axis]), Infinity));
  const side = Math.max(SIDE * spacing, 1e-3);
  const ROW = 1 << 17;
  const numbers = new Map();
  let sums = new Float64Array(SUMS * 4096);
  let count = 0;
  const cellsOf = chunks.map((chunk) => new Int32Array(chunk.count));
  chunks.forEach(({ low: corner, step, places, count: points }, which) => {
    const cells = cellsOf[which];
    for (let i = 0; i < points; i++) {
      const x = corner[0] - low[0] + places[4 * i] * step[0], y = corner[1] - low[1] + places[4 * i + 1] * step[1], z = corner[2] - low[2] + places[4 * i + 2] * step[2];
      const key = (Math.floor(x / side) * ROW + Math.floor(y / side)) * ROW + Math.floor(z / side);
      let cell = numbers.get(key);
      if (cell === undefined) {
        cell = count++;
        numbers.set(key, cell);
        if (SUMS * count > sums.length) {
          const more = new Float64Array(2 * sums.length);
          more.set(sums);
          sums = more;
        }
      }
      cells[i] = cell;
      const at = SUMS * cell;
      sums[at] += 1; sums[at + 1] += x; sums[at + 2] += y; sums[at + 3] += z;
      sums[at + 4] += x * x; sums[at + 5] += x * y; sums[at + 6] += x * z; sums[at + 7] += y * y; sums[at + 8] += y * z; sums[at + 9] += z * z;
    }
  });
  const shapes = new Uint8Array(4 * count);
  const whole = new Float64Array(SUMS);
  const add = (key) => {
    const cell = numbers.get(key);
    if (cell !== undefined) for (let k = 0; k < SUMS; k++) whole[k] += sums[SUMS * cell + k];
  };
  for (const [key, cell] of numbers) {
    const at = SUMS * cell, n = sums[at];
    whole.set(sums.subarray(at, at + SUMS));
    // a surface near a side of its cell goes on in the next one
    let best = 0.25, next = null;
    for (const [axis, by] of [[0, ROW * ROW], [1, ROW], [2, 1]]) {
      const share = (sums[at + 1 + axis] / n / side) % 1;
      const away = Math.min(share, 1 - share);
      if (away < best) [best, next] = [away, share < 0.5 ? -by : by];
    }
    if (next !== null) add(key + next);
    const near = whole[0];
    let normal = surfaceOf(whole, 0);
    if (!normal && near < FEW) {
      whole.fill(0);
      for (const i of [-1, 0, 1]) for (const j of [-1, 0, 1]) for (const k of [-1, 0, 1]) add(key + (i * ROW + j) * ROW + k);
      normal = surfaceOf(whole, 0);
    }
    const apart = Math.min(Math.max(side / Math.sqrt(near) / spacing, LEAST), normal ? GREATEST : GREATEST_LOOSE);
    shapes[4 * cell] = Math.round(ONE * apart);
    if (normal) normal.forEach((v, axis) => { shapes[4 * cell + 1 + axis] = Math.round(128 + 127 * v); });
  }
  chunks.forEach(({ geometry, count: points }, which) => {
    const shape = geometry.getAttribute("shape");
    for (let i = 0; i < points; i++) for (let k = 0; k < 4; k++) shape.array[4 * i + k] = shapes[4 * cellsOf[which][i] + k];
    shape.needsUpdate = true;
  });
}
