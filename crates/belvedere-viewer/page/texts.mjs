// The texts of the page, for tests: those in src/ and in index.html, as the tables of languages have them.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const sources = () => readdirSync(join(here, "src"), { recursive: true }).filter((name) => name.endsWith(".js") && !name.startsWith("words")).map((name) => readFileSync(join(here, "src", name), "utf8"));
const plain = (text) => text.replaceAll("&amp;", "&").trim();
const hasWords = (text) => /\p{L}{2}/u.test(text);

// Texts in t`…`, with {0} and so on for what is put in.
function ofSource(source) {
  return [...source.matchAll(/\bt`([^`]+)`/g)].map(([, text]) => {
    let number = 0;
    return text.replace(/\$\{[^}]*\}/g, () => `{${number++}}`);
  });
}
function ofPage(html) {
  const body = html.slice(html.indexOf("<body>"));
  return [...[...body.matchAll(/>([^<]+)</g)], ...[...body.matchAll(/(?:title|aria-label|placeholder)="([^"]+)"/g)]].map(([, text]) => plain(text)).filter(hasWords);
}
// Names and examples that are the same in all languages.
const NAMES = ["Belvedere", "EPSG:7415"];
export const texts = () => [...new Set([...sources().flatMap(ofSource), ...ofPage(readFileSync(join(here, "index.html"), "utf8"))])].filter((text) => !NAMES.includes(text)).sort();
// The number of what is put into a text, each once.
export const holes = (text) => [...new Set(text.match(/\{\w+\}/g) ?? [])].sort().join();

// All of the library, in which names of stages and remarks are looked for.
export function sourcesOfRust() {
  const crates = join(here, "../..");
  const below = (folder) => readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(".rs")).map((name) => readFileSync(join(folder, name), "utf8"));
  return readdirSync(crates).filter((name) => existsSync(join(crates, name, "src"))).flatMap((name) => below(join(crates, name, "src"))).join("\n");
}
