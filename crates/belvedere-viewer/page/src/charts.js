// Diagrams of answers as SVG.
import { fixed, language, t } from "./words.js";

const W = 356;
export const escape = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
const svg = (height, label, content) =>
  `<svg viewBox="0 0 ${W} ${height}" width="${W}" height="${height}" role="img" aria-label="${escape(label)}" xmlns="http://www.w3.org/2000/svg">${content}</svg>`;
export const hours = (value) => {
  if (value === null || value === undefined) return t`none`;
  const minutes = Math.round((((value % 24) + 24) % 24) * 60);
  return `${String(Math.floor(minutes / 60) % 24).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
};

// Paths of the sun over the horizon of a place: what is lit of the day is yellow.
export function sunPaths(answer, date) {
  const H = 214, left = 26, bottom = 190, top = 8;
  const highest = Math.max(30, ...answer.months.flatMap((month) => month.path.map((p) => p[2])), ...answer.path.map((p) => p[2]));
  const most = Math.min(90, Math.ceil(highest / 10) * 10 + 5);
  const south = answer.latitude_deg < 0;
  const x = (azimuth) => left + (((azimuth + (south ? 180 : 0)) % 360) / 360) * (W - left - 6);
  const y = (elevation) => bottom - (Math.max(elevation, 0) / most) * (bottom - top);
  const steps = answer.horizon_deg.length;
  const order = Array.from({ length: steps + 1 }, (_, i) => i).map((i) => (i === steps ? 359.99 : (i * 360) / steps));
  const at = (azimuth) => answer.horizon_deg[Math.floor((((azimuth + (south ? 180 : 0)) % 360) / 360) * steps) % steps] ?? 0;
  const outline = order.map((azimuth) => [left + (azimuth / 360) * (W - left - 6), y(at(azimuth))]);
  const broken = (points) => {
    const parts = [[]];
    points.forEach(([, azimuth, elevation], i) => {
      if (i && Math.abs(x(azimuth) - x(points[i - 1][1])) > W / 3) parts.push([]);
      parts.at(-1).push([x(azimuth), y(elevation)]);
    });
    return parts.map(path).join("");
  };
  let content = `<rect x="${left}" y="${top}" width="${W - left - 6}" height="${bottom - top}" fill="#dcebf9"/>`;
  for (let e = 0; e <= most; e += 15) content += `<path d="M${left} ${y(e)}H${W - 6}" stroke="#8aa" stroke-opacity=".35"/><text x="${left - 4}" y="${y(e) + 4}" text-anchor="end">${e}°</text>`;
  for (const month of [6, 3, 12]) {
    const found = answer.months[month - 1];
    content += `<path d="${broken(found.path)}" fill="none" stroke="#7d8794" stroke-dasharray="3 3"/>`;
  }
  content += `<path d="${path(outline)}L${W - 6} ${bottom}L${left} ${bottom}Z" fill="#5f6b78"/>`;
  answer.path.forEach(([, azimuth, elevation], i) => {
    const color = answer.lit[i] ? "#f5a300" : "#2f3d73";
    content += `<circle cx="${x(azimuth).toFixed(1)}" cy="${y(elevation).toFixed(1)}" r="3.1" fill="${color}"/>`;
  });
  let last = -99;
  for (const [hour, azimuth, elevation] of answer.path) {
    const whole = Math.round(hour);
    if (Math.abs(hour - whole) > 0.09 || whole % 3 || whole === last) continue;
    last = whole;
    content += `<text x="${x(azimuth).toFixed(1)}" y="${(y(elevation) - 8).toFixed(1)}" text-anchor="middle" style="paint-order:stroke;stroke:#fff;stroke-width:3px;fill:#1c2530">${whole} h</text>`;
  }
  [t`N`, t`E`, t`S`, t`W`].forEach((name, i) => { content += `<text x="${x(i * 90 + 0.01)}" y="${bottom + 15}" text-anchor="middle">${name}</text>`; });
  return svg(H, t`The sun on ${date} over the horizon of the place`, content);
}

// First letter of a month.
const initial = (month) => new Date(Date.UTC(2026, month, 15)).toLocaleString(language, { month: "narrow", timeZone: "UTC" });
// Hours of sun on the 21st of each month: what is possible, and what arrives.
export function months(answer) {
  const H = 116, base = 96, scale = 84 / 18, width = W / 12;
  return svg(H, t`Hours of sun on the 21st of each month`, answer.months.map(({ sun_hours: sun, possible_hours: possible }, i) => {
    const x = i * width + 4;
    return `<rect x="${x}" y="${base - possible * scale}" width="${width - 8}" height="${possible * scale}" fill="#8d97a5" opacity=".35"/>`
      + `<rect x="${x}" y="${base - sun * scale}" width="${width - 8}" height="${sun * scale}" fill="#f5a300"/>`
      + `<text x="${x + width / 2 - 4}" y="${H - 5}" text-anchor="middle">${initial(i)}</text>`
      + `<text x="${x + width / 2 - 4}" y="${base - possible * scale - 3}" text-anchor="middle" style="font-size:10px">${fixed(sun, 1)}</text>`;
  }).join(""));
}

// Solar energy of each month.
export function energy(values) {
  const H = 112, base = 94, scale = 76 / Math.max(...values, 1), width = W / 12;
  return svg(H, t`Solar energy received in each month`, values.map((value, i) => {
    const x = i * width + 4;
    return `<rect x="${x}" y="${base - value * scale}" width="${width - 8}" height="${value * scale}" fill="#f5a300"/>`
      + `<text x="${x + width / 2 - 4}" y="${H - 5}" text-anchor="middle">${initial(i)}</text>`
      + `<text x="${x + width / 2 - 4}" y="${base - value * scale - 3}" text-anchor="middle" style="font-size:10px">${value.toFixed(0)}</text>`;
  }).join(""));
}

// The ground, what stands on it, and the line of sight.
export function profile({ distance_m: distances, ground, line, solid, blocked_at_m: blocked }, unit) {
  const H = 190, left = 38, bottom = 166, top = 10;
  const all = [...ground, ...line, ...solid.flat(2)].filter((v) => v !== null);
  const tops = [...line, ...ground].filter((v) => v !== null);
  const low = Math.min(...tops) - 1.5, high = Math.min(Math.max(...all), Math.max(...tops) + 25) + 1.5;
  const far = distances.at(-1) || 1;
  const x = (d) => left + (d / far) * (W - left - 6);
  const y = (z) => bottom - ((Math.max(low, Math.min(high, z)) - low) / (high - low)) * (bottom - top);
  const width = Math.max((W - left - 6) / distances.length, 0.6) + 0.3;
  let content = solid.map((pieces, i) => pieces.filter(([, to]) => to > low).map(([from, to]) =>
    `<rect x="${x(distances[i]).toFixed(1)}" y="${y(to).toFixed(1)}" width="${width.toFixed(2)}" height="${Math.max(y(from) - y(to), 0.4).toFixed(1)}" fill="#98a1ad"/>`).join("")).join("");
  const known = distances.map((d, i) => [d, ground[i]]).filter(([, z]) => z !== null).map(([d, z]) => [x(d), y(z)]);
  if (known.length) content += `<path d="${path(known)}" fill="none" stroke="#8a6d3b" stroke-width="2"/>`;
  const of = (from, to) => distances.map((d, i) => [d, line[i]]).filter(([d]) => d >= from && d <= to).map(([d, z]) => [x(d), y(z)]);
  content += `<path d="${path(of(0, blocked ?? far))}" fill="none" stroke="#f5a300" stroke-width="2.4"/>`;
  if (blocked !== null) {
    content += `<path d="${path(of(blocked, far))}" fill="none" stroke="#2f3d73" stroke-width="1.6" stroke-dasharray="4 3"/>`;
    const at = line[distances.findIndex((d) => d >= blocked)] ?? line.at(-1);
    content += `<circle cx="${x(blocked)}" cy="${y(at)}" r="4.5" fill="#d1495b" stroke="#fff"/>`;
  }
  [high - 1.5, low + 1.5].forEach((z) => { content += `<text x="${left - 5}" y="${y(z) + 4}" text-anchor="end">${z.toFixed(0)} ${unit}</text>`; });
  content += `<text x="${left}" y="${H - 8}">A</text><text x="${W - 6}" y="${H - 8}" text-anchor="end">B, ${fixed(far, 1)} m</text>`;
  return svg(H, t`Profile of the line of sight`, `<path d="M${left} ${bottom}H${W - 6}" stroke="#8aa" stroke-opacity=".5"/>${content}`);
}

// The visible space in plan, north up.
export function plan({ plan: corners, isovist }) {
  const H = 240, most = Math.max(...corners.map(([, range]) => range), 1);
  const scale = 104 / most;
  const points = corners.map(([azimuth, range]) => {
    const a = (azimuth * Math.PI) / 180;
    return [W / 2 + Math.sin(a) * range * scale, H / 2 - Math.cos(a) * range * scale];
  });
  const ring = 10 ** Math.floor(Math.log10(most));
  const rings = [1, 2, 5].map((k) => k * ring).filter((r) => r <= most);
  let content = `<path d="${path(points)}Z" fill="#f5a300" fill-opacity=".35" stroke="#f5a300" stroke-width="1.5"/>`;
  content += rings.map((r) => `<circle cx="${W / 2}" cy="${H / 2}" r="${r * scale}" fill="none" stroke="#8aa" stroke-opacity=".6" stroke-dasharray="2 3"/><text x="${W / 2 + r * scale * 0.71}" y="${H / 2 - r * scale * 0.71}">${r} m</text>`).join("");
  content += `<circle cx="${W / 2}" cy="${H / 2}" r="3.5" fill="#1d4e89"/><text x="${W / 2}" y="11" text-anchor="middle">${t`N`}</text>`;
  return svg(H, t`Plan of the visible space, ${isovist.plan_area_m2} square metres`, content);
}

// Ranges all around, sky in blue: a picture of width by height pixels.
export function panorama(bytes, { width, height }) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height: Math.round(height * 0.75) });
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", t`Panorama of distances around the place, north at both ends`);
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  for (let i = 0; i < bytes.length; i++) {
    const v = bytes[i] / 255;
    const color = bytes[i] === 0 ? [190, 222, 250] : [60 + 150 * v, 52 + 140 * v, 66 + 110 * v];
    image.data.set([...color, 255], 4 * i);
  }
  context.putImageData(image, 0, -Math.round(height * 0.06));
  return canvas;
}
