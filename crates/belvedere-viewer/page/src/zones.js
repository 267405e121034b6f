// Clocks of time zones, and the zone of a place.

// Boxes of what the first word of a zone's name covers.
const PARTS = {
  Europe: [-25, 34, 60, 72], Africa: [-20, -36, 52, 38], America: [-170, -56, -25, 84], Asia: [25, -12, 180, 80], Australia: [110, -45, 160, -9], Pacific: [-180, -50, 180, 30], Indian: [39, -50, 110, 20],
  Atlantic: [-65, -55, 0, 67],
};
const within = ([west, south, east, north], longitude, latitude) => longitude >= west && longitude <= east && latitude >= south && latitude <= north;

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
// The zone of a place, and in words where it is from. `near` are zones of the place, the first of most of it, the
// others with other clocks; `own` is that of this computer.
export function zoneOf(near, longitude, latitude, own, instant = new Date()) {
  if (near.length) {
    const isBorder = near.length > 1;
    if (near.includes(own)) return { zone: own, why: isBorder ? t`this computer's, which fits the place; a border with other clocks is near, so look whether it is right` : t`this computer's, which fits the place` };
    return { zone: near[0], why: isBorder ? t`that of the place; a border with other clocks is near, so look whether it is right` : t`that of the place` };
  }
  const hours = longitude / 15;
  const part = PARTS[own?.split("/")[0]];
  if (part && within(part, longitude, latitude) && Math.abs(clockOf(own, instant)?.ahead / 60 - hours) <= 2) return { zone: own, why: t`this computer's, which may fit the place` };
  const whole = Math.round(hours);
  const zone = `${whole < 0 ? "-" : "+"}${String(Math.abs(whole)).padStart(2, "0")}:00`;
  return { zone, why: t`by the longitude of the place, without summer time: look whether it is right` };
}
