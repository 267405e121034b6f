// Answers as files.

export function save(name, content, kind) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type: kind }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export const csv = (rows) => rows.map((row) => row.map((cell) => {
  const text = cell === null || cell === undefined ? "" : String(cell);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}).join(",")).join("\n") + "\n";

// Features in the reference system of the scene, named as GDAL and QGIS read it (GeoJSON 2008), because GeoJSON
// promises another.
export const geojson = (name, features, scene) => JSON.stringify({
  type: "FeatureCollection", name, coordinate_reference_system: scene.crs,
  crs: { type: "name", properties: { name: scene.crs_name } },
  features: features.map(([kind, coordinates, properties]) => ({ type: "Feature", geometry: { type: kind, coordinates }, properties })),
}, null, 1);

// The whole page as a picture: the scene with marks, legend, scale and north.
export async function picture(canvas, marks, legend, title, status) {
  const scale = canvas.width / canvas.clientWidth;
  const page = document.createElement("canvas");
  Object.assign(page, { width: canvas.width, height: canvas.height });
  const context = page.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const copy = marks.cloneNode(true);
  const style = getComputedStyle(document.documentElement);
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", canvas.clientWidth);
  copy.setAttribute("height", canvas.clientHeight);
  copy.querySelectorAll("text").forEach((text) => text.setAttribute("style", `font:600 13px sans-serif;fill:${style.getPropertyValue("--text")}`));
  const image = new Image();
  image.src = `data:image/svg+xml;utf8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  await image.decode().catch(() => {});
  context.drawImage(image, 0, 0, page.width, page.height);
  context.scale(scale, scale);
  context.font = "600 14px sans-serif";
  context.fillStyle = style.getPropertyValue("--text");
  context.fillText(title, 14, canvas.clientHeight - 30);
  context.font = "12px sans-serif";
  context.fillText(status, 14, canvas.clientHeight - 12);
  legend.forEach(({ color, text }, i) => {
    context.fillStyle = color;
    context.fillRect(14, 14 + 20 * i, 13, 13);
    context.fillStyle = style.getPropertyValue("--text");
    context.fillText(text, 34, 25 + 20 * i);
  });
  return new Promise((done) => page.toBlob(done, "image/png"));
}

// A diagram of the card as a picture.
export async function diagram(svg) {
  const { width, height } = svg.viewBox.baseVal;
  const copy = svg.cloneNode(true);
  copy.querySelectorAll("text").forEach((text) => { text.style.font = "11px sans-serif"; text.style.fill = "#333"; });
  const image = new Image();
  image.src = `data:image/svg+xml;utf8,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: 3 * width, height: 3 * height });
  const context = canvas.getContext("2d");
  context.fillStyle = "#fff";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}
