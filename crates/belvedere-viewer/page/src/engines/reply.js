// What all engines reply with.
import { refusal } from "../words.js";

// No answer, in words.
export class Refused extends Error {
  constructor(text) {
    super(refusal(text));
  }
}
// Nobody answers any more.
export class Lost extends Error {}

// Named values, and a byte for each of many places as `body`.
export function split(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { ...head, body: bytes.slice(4 + length) };
}
