// Asks the server that the page came from.
import { t } from "../words.js";
import { Lost, Refused, split } from "./reply.js";

const LOST = t`The connection to Belvedere is lost. Is the program still running?`;

async function get(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Lost(LOST);
  }
  if (!response.ok) {
    const reply = await response.json().catch(() => ({}));
    throw new Refused(reply.error ?? t`The server answers with ${response.status}.`);
  }
  return response;
}
const post = (type, body, signal) => ({ method: "POST", headers: { "Content-Type": type }, body, signal });

export const http = {
  state: async () => (await get("state")).json(),
  part: async (path) => (await get(path)).arrayBuffer(),
  result: async (number) => split(await (await get(`results/${number}`)).arrayBuffer()),
  ask: async (path, values, signal) => split(await (await get(path, post("application/json", JSON.stringify(values), signal))).arrayBuffer()),
  readAgain: async (choice) => {
    await get("reading", post("application/json", JSON.stringify(choice)));
    // places and views are those of the cloud as it was read
    location.replace(location.pathname);
  },
  loadMesh: async (file) => split(await (await get(`plan-meshes/${encodeURIComponent(file.name)}`, post("application/octet-stream", file))).arrayBuffer()),
};
