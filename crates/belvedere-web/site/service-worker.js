// Keeps the page for use without a network, and lets it share memory between threads where the server of its files
// does not say so. Only files of the page itself are kept.

const NAME = "belvedere @VERSION@";
const FILES = ["./", "index.html", "style.css", "page.js", "icon.svg", "engine-worker.js", "engine.wasm", "demo.laz"];

addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)).then(() => skipWaiting()));
});
addEventListener("activate", (event) => {
  const old = (names) => names.filter((name) => name.startsWith("belvedere ") && name !== NAME);
  event.waitUntil(caches.keys().then((names) => Promise.all(old(names).map((name) => caches.delete(name)))).then(() => clients.claim()));
});
function isolated(response) {
  const headers = new Headers(response.headers);
  headers.set("Cross-Origin-Opener-Policy", "same-origin");
  headers.set("Cross-Origin-Embedder-Policy", "require-corp");
  return new Response(response.body, { status: response.status, statusText: response.statusText, headers });
}
addEventListener("fetch", (event) => {
  const { request } = event;
  // parts of files pass by
  if (request.method !== "GET" || request.headers.has("Range") || new URL(request.url).origin !== location.origin) return;
  const answer = async () => {
    const kept = await (await caches.open(NAME)).match(request, { ignoreSearch: true });
    return isolated(kept ?? await fetch(request));
  };
  event.respondWith(answer());
});
