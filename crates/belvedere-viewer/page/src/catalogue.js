// Catalogues of tiles on the web, of which a part is opened: virtual point clouds (.vpc) and collections of STAC items,
// which have the same form.
import { t } from "./words.js";

// Points of a square unit where a catalogue does not say how many a tile has: most surveys of countries have fewer.
const DENSITY = 20;
// Side of the part that is offered first, units.
const SIDE = 300;

export const isCatalogue = (url) => /\.(vpc|json|geojson)$/i.test(new URL(url, location.href).pathname);

// The tiles of a catalogue: address, corners on the map and number of points of each.
export async function tilesOf(url) {
  const response = await fetch(url).catch(() => null);
  const features = response?.ok ? (await response.json().catch(() => null))?.features : null;
  if (!Array.isArray(features) || !features.length) throw new Error(t`The catalogue cannot be read: ${url}`);
  return features.map(({ properties = {}, assets = {} }) => {
    const file = (assets.data ?? Object.values(assets).find(({ href }) => /\.la[sz]$/i.test(href ?? "")))?.href;
    const box = properties["proj:bbox"];
    if (!file || !Array.isArray(box)) throw new Error(t`The catalogue does not say where a tile lies, or which file it is (proj:bbox, assets): ${url}`);
    const half = box.length / 2;
    const [low, high] = [box.slice(0, 2), box.slice(half, half + 2)];
    return { url: new URL(file, new URL(url, location.href)).href, low, high, points: properties["pc:count"] ?? DENSITY * (high[0] - low[0]) * (high[1] - low[1]) };
  });
}
// All corners and points, and the longest side of the part that is offered.
export const extentOf = (tiles) => ({
  points: tiles.reduce((sum, { points }) => sum + points, 0), side: SIDE, tiles,
  low: [0, 1].map((i) => Math.min(...tiles.map(({ low }) => low[i]))), high: [0, 1].map((i) => Math.max(...tiles.map(({ high }) => high[i]))),
});
// The tiles that a window meets: west, south, east, north.
export const meeting = (tiles, [west, south, east, north]) => tiles.filter(({ low, high }) => low[0] <= east && high[0] >= west && low[1] <= north && high[1] >= south);
