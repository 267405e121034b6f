// The time zone of a place, by boxes around countries. Boxes overlap at borders: where clocks on both sides differ, the
// page says that the zone may be the other one.

// Zone, then boxes of west, south, east and north, degrees. Rounded outwards; islands far away have boxes of their own.
const BOXES = [
  ["Europe/Lisbon", [-9.6, 36.9, -7.4, 38.2], [-9.6, 38.2, -7, 39.6], [-9, 39.6, -6.8, 41], [-8.9, 41, -6.2, 42.2]], ["Atlantic/Azores", [-31.5, 36.8, -24.8, 39.8]],
  ["Atlantic/Madeira", [-17.4, 32.3, -16.1, 33.2]], ["Europe/Madrid", [-9.4, 41.7, 3.4, 43.9], [-7.1, 38, 4.4, 41.8], [-7.55, 35.9, -0.5, 38.1]], ["Atlantic/Canary", [-18.3, 27.5, -13.3, 29.5]],
  ["Europe/Paris", [-5.2, 42.3, 8.3, 51.1], [8.5, 41.3, 9.6, 43.1]], ["Europe/Brussels", [2.5, 49.5, 6.4, 51.5]], ["Europe/Amsterdam", [3.3, 50.75, 7.25, 53.6]],
  ["Europe/Luxembourg", [5.7, 49.4, 6.55, 50.2]], ["Europe/Berlin", [5.85, 47.25, 15.05, 55.1]], ["Europe/Zurich", [5.95, 45.8, 10.5, 47.85]], ["Europe/Vienna", [9.5, 46.35, 17.2, 49.05]],
  ["Europe/Rome", [6.6, 35.5, 18.6, 47.1]], ["Europe/Malta", [14.1, 35.7, 14.6, 36.1]], ["Europe/Copenhagen", [8, 54.5, 15.2, 57.8]], ["Europe/Oslo", [4.5, 57.9, 12.6, 64], [10, 63.5, 31.2, 71.3]],
  ["Europe/Stockholm", [10.9, 55.3, 19.4, 66], [14, 60, 24.2, 69.1]], ["Europe/Helsinki", [19.2, 59.7, 31.6, 70.1]], ["Europe/Tallinn", [21.7, 57.5, 28.2, 59.75]], ["Europe/Riga", [20.9, 55.65, 28.25, 58.1]],
  ["Europe/Vilnius", [20.9, 53.9, 26.85, 56.45]], ["Europe/Kaliningrad", [19.6, 54.3, 22.9, 55.3]], ["Europe/Warsaw", [14.1, 49, 24.15, 54.9]], ["Europe/Prague", [12.05, 48.55, 18.9, 51.1]],
  ["Europe/Bratislava", [16.8, 47.7, 22.6, 49.65]], ["Europe/Budapest", [16.1, 45.7, 22.9, 48.6]], ["Europe/Ljubljana", [13.4, 45.4, 16.6, 46.9]], ["Europe/Zagreb", [13.5, 42.4, 19.45, 46.6]],
  ["Europe/Sarajevo", [15.7, 42.55, 19.65, 45.3]], ["Europe/Belgrade", [18.8, 41.85, 23, 46.2]], ["Europe/Podgorica", [18.4, 41.8, 20.4, 43.6]], ["Europe/Tirane", [19.2, 39.6, 21.1, 42.7]],
  ["Europe/Skopje", [20.4, 40.8, 23.05, 42.4]], ["Europe/Athens", [19.4, 34.8, 26.7, 41.75], [26.5, 34.8, 28.3, 37]], ["Europe/Sofia", [22.35, 41.2, 28.65, 44.25]], ["Europe/Bucharest", [20.25, 43.6, 29.75, 48.3]],
  ["Europe/Chisinau", [26.6, 45.4, 30.2, 48.5]], ["Europe/Kyiv", [22.1, 44.3, 40.3, 52.4]], ["Europe/Minsk", [23.2, 51.2, 32.8, 56.2]], ["Europe/Moscow", [27.3, 41.2, 48, 70]],
  ["Europe/Istanbul", [25.6, 35.8, 44.9, 42.2]], ["Asia/Nicosia", [32.2, 34.5, 34.7, 35.75]], ["Europe/London", [-8.2, 49.8, 1.8, 60.9]], ["Europe/Dublin", [-10.6, 51.4, -5.95, 55.45]],
  ["Atlantic/Reykjavik", [-24.6, 63.3, -13.4, 66.6]], ["Atlantic/Faroe", [-7.7, 61.3, -6.2, 62.5]],
  // other continents: where open clouds are many
  ["America/Los_Angeles", [-124.8, 32.5, -114, 49]], ["America/Phoenix", [-114.85, 31.3, -109, 37]], ["America/Denver", [-115, 31.3, -102, 49]], ["America/Chicago", [-104, 25.8, -85, 49]],
  ["America/New_York", [-87.5, 24.5, -66.9, 47.5]], ["America/Anchorage", [-170, 54.5, -130, 71.5]], ["Pacific/Honolulu", [-160.3, 18.8, -154.7, 22.3]], ["America/Toronto", [-90, 41.6, -64, 62]], ["America/Halifax", [-66.5, 43.3, -59.7, 47.2]],
  ["Asia/Tokyo", [128.5, 30, 146, 45.6]], ["Asia/Seoul", [125.8, 33, 129.7, 38.7]], ["Asia/Singapore", [103.6, 1.15, 104.1, 1.5]], ["Asia/Hong_Kong", [113.8, 22.1, 114.5, 22.6]],
  ["Pacific/Auckland", [166, -47.5, 179, -34]], ["Australia/Perth", [112.9, -35.3, 129, -13.5]], ["Australia/Brisbane", [138, -29.2, 153.7, -10]], ["Australia/Sydney", [141, -37.6, 153.7, -28.1]],
  ["Australia/Melbourne", [141, -39.2, 150, -34]], ["Australia/Adelaide", [129, -38.2, 141, -26]], ["Africa/Johannesburg", [16.4, -35, 32.9, -22.1]],
];
// Boxes of what the first word of a zone's name covers.
const PARTS = {
  Europe: [-25, 34, 60, 72], Africa: [-20, -36, 52, 38], America: [-170, -56, -25, 84], Asia: [25, -12, 180, 80], Australia: [110, -45, 160, -9], Pacific: [-180, -50, 180, 30], Indian: [39, -50, 110, 20],
  Atlantic: [-65, -55, 0, 67],
};
const within = ([west, south, east, north], longitude, latitude) => longitude >= west && longitude <= east && latitude >= south && latitude <= north;
const area = ([west, south, east, north]) => (east - west) * (north - south);

// What clocks of a zone show at an instant: date, minutes of the day, and minutes ahead of UTC. Nothing of an unknown
// zone.
export function clockOf(zone, instant = new Date()) {
  const fixed = /^([+-])(\d\d):?(\d\d)$/.exec(zone);
  let ahead;
  if (zone === "UTC" || zone === "Z") ahead = 0;
  else if (fixed) ahead = (fixed[1] === "-" ? -1 : 1) * (60 * Number(fixed[2]) + Number(fixed[3]));
  else {
    try {
      const parts = new Intl.DateTimeFormat("en", { timeZone: zone, hourCycle: "h23", year: "numeric", month: "numeric", day: "numeric", hour: "numeric", minute: "numeric" }).formatToParts(instant);
      const part = (name) => Number(parts.find(({ type }) => type === name).value);
      const shown = Date.UTC(part("year"), part("month") - 1, part("day"), part("hour"), part("minute"));
      ahead = Math.round((shown - instant.getTime()) / 60_000);
    } catch {
      return null;
    }
  }
  const shown = new Date(instant.getTime() + 60_000 * ahead);
  return { date: shown.toISOString().slice(0, 10), minutes: shown.getUTCHours() * 60 + shown.getUTCMinutes(), ahead };
}

// Texts that stay English here: time.js puts them into the language of the page.
const t = ([text]) => text;
// The zone of a place, and in words where it is from. `own` is that of this computer.
export function zoneOf(longitude, latitude, own, instant = new Date()) {
  const found = BOXES.flatMap(([zone, ...boxes]) => boxes.filter((box) => within(box, longitude, latitude)).map((box) => ({ zone, area: area(box) })));
  found.sort((a, b) => a.area - b.area);
  const ahead = ({ zone }) => clockOf(zone, instant)?.ahead;
  const isSure = found.every((one) => ahead(one) === ahead(found[0]));
  if (found.some(({ zone }) => zone === own)) return { zone: own, why: isSure ? t`this computer's, which fits the place` : t`this computer's, which fits the place; a border with other clocks is near, so look whether it is right` };
  if (found.length) return { zone: found[0].zone, why: isSure ? t`that of the place` : t`that of the place; a border with other clocks is near, so look whether it is right` };
  const hours = longitude / 15;
  const part = PARTS[own?.split("/")[0]];
  if (part && within(part, longitude, latitude) && Math.abs(clockOf(own, instant)?.ahead / 60 - hours) <= 2) return { zone: own, why: t`this computer's, which may fit the place` };
  const whole = Math.round(hours);
  const zone = `${whole < 0 ? "-" : "+"}${String(Math.abs(whole)).padStart(2, "0")}:00`;
  return { zone, why: t`by the longitude of the place, without summer time: look whether it is right` };
}
