// The words of the page in the language of the browser, or in one that was chosen. Texts are found by their English
// ones, in which {0}, {1} and so on are put in. What a table lacks stays English.
import { de } from "./words/de.js";
import { fr } from "./words/fr.js";
import { nl } from "./words/nl.js";

const TABLES = { de, fr, nl };
export const LANGUAGES = { en: "English", nl: "Nederlands", de: "Deutsch", fr: "Français" };
const KEPT = "language";
function chosen() {
  try {
    const kept = localStorage.getItem(KEPT);
    if (LANGUAGES[kept]) return kept;
  } catch {
    // nothing may be kept
  }
  return navigator.languages.map((name) => name.slice(0, 2)).find((name) => LANGUAGES[name]) ?? "en";
}
export const language = chosen();
const table = TABLES[language];

export function setLanguage(name) {
  try {
    localStorage.setItem(KEPT, name);
  } catch {
    // it stays as it is
  }
  location.reload();
}
const put = (text, values) => text.replace(/\{(\w+)\}/g, (_, name) => values[name]);
export const t = (parts, ...values) => put(word(parts.slice(1).reduce((text, part, i) => `${text}{${i}}${part}`, parts[0])), values);
// A whole text that is data.
export const word = (text) => table?.texts[text] ?? text;
// What the engine says: why it does not answer, the name of a stage, and a remark with its numbers.
export const refusal = (text) => table?.refusals[text] ?? text;
export const stage = (name) => table?.stages[name] ?? name;
export function remarkText({ key, text, numbers }) {
  const own = table?.remarks[key];
  if (!own) return text;
  return put(own, Object.fromEntries(Object.entries(numbers ?? {}).map(([name, v]) => [name, v.toLocaleString(language, { maximumFractionDigits: 2 })])));
}

export const count = (n) => n.toLocaleString(language);
// As `toFixed`, with the decimal sign of the language.
export const fixed = (v, digits) => (v + 0).toLocaleString(language, { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

export const metres = (v, digits = 2) => `${fixed(v, digits)} m`;

const NAMED = ["title", "aria-label", "placeholder"];
// Puts what stands in the page itself into the language.
export function translate(root) {
  document.documentElement.lang = language;
  const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const own = texts.currentNode.data.trim();
    if (own && word(own) !== own) texts.currentNode.data = texts.currentNode.data.replace(own, word(own));
  }
  for (const name of NAMED) for (const one of root.querySelectorAll(`[${name}]`)) one.setAttribute(name, word(one.getAttribute(name)));
}
