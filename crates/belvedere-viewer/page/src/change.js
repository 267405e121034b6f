// What a plan changes, or another time: an answer before and after.
import { escape } from "./charts.js";
import * as colors from "./colors.js";
import { count, fixed, t } from "./words.js";

const list = (rows) => `<dl>${rows.map(([name, value]) => `<dt>${escape(name)}</dt><dd>${escape(value)}</dd>`).join("")}</dl>`;
const CLEARED = 254;

// Points by what becomes of them: 0 not before and not after, 1 both, 2 gained, 3 lost.
function ofPoints({ title, names, gain, loss, of }, answer, page) {
  const [before, after] = [answer.before, answer].map(({ body }) => new Uint8Array(body));
  // light that pulses do not prove is light; a view that they do not prove is none
  const is = (code) => code === 1 || (code === 2 && answer.lit !== undefined);
  const codes = after.map((now, i) => (now === CLEARED ? now : is(now) ? (is(before[i]) ? 1 : 2) : is(before[i]) ? 3 : 0));
  const counts = [0, 0, 0, 0];
  for (const code of codes) if (code !== CLEARED) counts[code] += 1;
  page.answer = colors.ofChange(title, names);
  page.values(codes);
  const number = (n) => (answer.isFirst ? t`about ${count(n)}` : count(n));
  const first = answer.isFirst ? ` ${t`A first answer from a sample of them; the exact one follows …`}` : "";
  return `<p class="verdict">${loss(number(counts[3]))}, ${gain(number(counts[2]))}</p><p class="note">${escape(of(count(codes.length), answer))}${first}</p>`;
}
function ofCells(answer, page) {
  const rows = ({ body }) => { const v = new Float32Array(body); return Array.from({ length: v.length / 4 }, (_, i) => v.subarray(4 * i, 4 * i + 4)); };
  const hours = new Map(rows(answer.before).map(([x, y, , h]) => [`${x},${y}`, h]));
  const found = rows(answer).filter(([x, y]) => hours.has(`${x},${y}`)).map(([x, y, z, h]) => [x, y, z, h - hours.get(`${x},${y}`)]);
  page.changedCells(found, answer.cell_m);
  const area = (is) => `${count(Math.round(found.filter((row) => is(row[3])).length * answer.cell_m ** 2))} m²`;
  // a minute of sun
  const LEAST = 1 / 60;
  const mean = found.reduce((sum, row) => sum + row[3], 0) / Math.max(found.length, 1);
  return `<p class="verdict">${mean < 0 ? "−" : "+"}${t`${fixed(Math.abs(mean), 2)} hours of sun`}</p><p class="note">${t`on average on ${escape(page.time.date)}, on the ground that is free before and after.`}</p>`
    + list([[t`Loses sun`, area((h) => h < -LEAST)], [t`Gains sun`, area((h) => h > LEAST)], [t`Greatest loss`, `${fixed(Math.max(0, -Math.min(0, ...found.map((row) => row[3]))), 1)} h`], [t`Greatest gain`, `${fixed(Math.max(0, ...found.map((row) => row[3])), 1)} h`]]);
}
// The card of a change, and the commands that give the same.
export function changed(tool, answer, page) {
  const named = (command, name) => command.replace(/-o \S+(\.\w+)$/, `-o ${name}$1`);
  const command = [named(answer.before.command, "before"), named(answer.command, "after"), ...(tool.name === "sun_area" ? ["belvedere difference before.tif after.tif -o change.tif -o change.png"] : [])].join("\n");
  return { html: tool.name === "sun_area" ? ofCells(answer, page) : ofPoints(answer.isPlanned ? tool.change : tool.between, answer, page), command };
}
