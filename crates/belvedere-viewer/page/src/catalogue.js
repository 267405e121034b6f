// Catalogues of tiles on the web, of which a part is opened: virtual point clouds (.vpc) and collections of STAC items,
// which have the same form.

// Points of a square unit where a catalogue does not say how many a tile has: most surveys of countries have fewer.
const DENSITY = 20;
// Side of the part that is offered first, units.
const SIDE = 300;

export const isCatalogue = (url) => /\.(vpc|json|geojson)$/i.test(new URL(url, location.href).pathname);

// All corners and points, and the longest side of the part that is offered.
export const extentOf = (tiles) => ({
  points: tiles.reduce((sum, { points, low, high }) => sum + (points ?? DENSITY * (high[0] - low[0]) * (high[1] - low[1])), 0), side: SIDE, tiles,
  low: [0, 1].map((i) => tiles.reduce((least, { low }) => Math.min(least, low[i]), Infinity)), high: [0, 1].map((i) => tiles.reduce((most, { high }) => Math.max(most, high[i]), -Infinity)),
});
// The tiles that a window meets: west, south, east, north.
export const meeting = (tiles, [west, south, east, north]) => tiles.filter(({ low, high }) => low[0] <= east && high[0] >= west && low[1] <= north && high[1] >= south);
