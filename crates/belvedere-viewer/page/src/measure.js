// Lengths, heights and areas between clicked places.
import { card } from "./card.js";
import { csv, geojson, save } from "./save.js";
import { page } from "./state.js";
import { draw, toFile } from "./view.js";
import { fixed, metres, t } from "./words.js";

const LINE = 'stroke="#1d4e89" stroke-width="2.5"';
const CLOSING = `${LINE} stroke-dasharray="6 5"`;
const minus = (a, b) => a.map((v, i) => v - b[i]);
const squares = (v) => `${fixed(v, 1)} m²`;

// What is between places in metres: along all of them in space and on the map, from the first up to the last; for three
// and more the area they surround on the map and in their plane (Newell's normal).
export function measured(places) {
  const legs = places.slice(1).map((place, i) => minus(place, places[i]));
  const length = legs.reduce((sum, leg) => sum + Math.hypot(...leg), 0);
  const flat = legs.reduce((sum, [x, y]) => sum + Math.hypot(x, y), 0);
  const rise = places.length ? places.at(-1)[2] - places[0][2] : 0;
  // from the first place: coordinates may be large
  const corners = places.map((place) => minus(place, places[0]));
  const normal = [0, 0, 0];
  corners.forEach(([x, y, z], i) => {
    const [u, v, w] = corners[(i + 1) % corners.length];
    normal[0] += y * w - z * v;
    normal[1] += z * u - x * w;
    normal[2] += x * v - y * u;
  });
  return { length, flat, rise, area: Math.abs(normal[2]) / 2, inPlane: Math.hypot(...normal) / 2 };
}
// Shows the places that were clicked and what is between them.
export function measurePanel() {
  const places = page.places.map(({ clicked }) => clicked);
  const { length, flat, rise, area, inPlane } = measured(places);
  const legs = places.slice(1).map((place, i) => {
    const from = places[i];
    return [{ line: [from, place], style: LINE }, { at: place.map((v, k) => (v + from[k]) / 2), label: metres(Math.hypot(...minus(place, from))), radius: 0 }];
  });
  page.marks = [...legs.flat(), ...(places.length > 2 ? [{ line: [places.at(-1), places[0]], style: CLOSING }] : []), ...places.map((at) => ({ at }))];
  const row = (name, value) => `<dt>${name}</dt><dd>${value}</dd>`;
  const between = row(t`Length`, metres(length)) + row(t`Length on the map`, metres(flat)) + row(t`Height of the last above the first`, `${rise < 0 ? "−" : ""}${metres(Math.abs(rise))}`)
    + (places.length === 2 ? row(t`Slope`, flat > 0 ? `${fixed((Math.atan2(rise, flat) * 180) / Math.PI, 1)}°` : t`upright`) : "");
  const around = places.length < 3 ? "" : row(t`Area on the map`, squares(area)) + row(t`Area in its plane`, squares(inPlane));
  card(`<p class="note">${places.length < 2 ? t`Click two places for a length, more for an area.` : t`Click more places for a longer line or an area.`}</p>`
    + (places.length < 2 ? "" : `<dl>${between}${around}</dl><div class="row"><button id="anew">${t`Start again`}</button><button id="table">${t`Table`} (.csv)</button><button id="map">${t`Map`} (.geojson)</button></div>`), (box) => {
    if (places.length < 2) return;
    const values = { length_m: length, map_length_m: flat, rise_m: rise, ...(places.length > 2 ? { map_area_m2: area, plane_area_m2: inPlane } : {}) };
    const file = places.map(toFile);
    box.querySelector("#anew").onclick = () => { page.places = []; measurePanel(); };
    box.querySelector("#table").onclick = () => save("measured.csv", csv([["x", "y", "z"], ...file]), "text/csv");
    box.querySelector("#map").onclick = () => {
      const shape = places.length > 2 ? ["Polygon", [[...file, file[0]]]] : ["LineString", file];
      save("measured.geojson", geojson("measured", [[...shape, values]], page.scene), "application/geo+json");
    };
  });
  draw();
}
