// What all parts of the page share.
import * as api from "./api.js";
import { ASIDES, TOOLS as ALL } from "./tools.js";

export const $ = (id) => document.getElementById(id);
export const root = document.documentElement;
export const canvas = $("view");
// a page without a server answers what is stored in it
const isStored = ({ name }) => name === "look" || (name === "shadow" && api.exported.suns.length) || (name === "seen" && api.exported.viewpoints.length);
export const TOOLS = api.exported ? ALL.filter(isStored) : ALL;
export const toolOf = (name) => [...TOOLS, ...ASIDES].find((tool) => tool.name === name);
export const page = { scene: null, tool: TOOLS[0], places: [], marks: [], answer: null, time: { date: "", zone: "UTC", minutes: 780, trees: "opaque" }, isSure: false, compared: null, last: null };
window.belvedere = page;
