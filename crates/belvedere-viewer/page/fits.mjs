// Finds texts of the page that are cut off, for tests: each question in each language on screens of three widths.

// Runs in the page: what does not fit into its own box, or sticks out of the window, in words.
export function cutOff() {
  const wide = (element, text) => {
    const context = document.createElement("canvas").getContext("2d");
    const style = getComputedStyle(element);
    context.font = style.font;
    const inner = element.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    // arrows of lists, measured in Chromium
    const arrow = element.tagName === "SELECT" || element.list ? 16 : 0;
    return context.measureText(text).width > inner - arrow + 1;
  };
  const isSeen = (element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true }) && element.getBoundingClientRect().width > 1;
  const scrolls = (element) => /auto|scroll/.test(getComputedStyle(element).overflowX);
  // rows that are moved aside by fingers on purpose
  const isRow = (element) => element.closest("#bar, #tools, #timebar") && innerWidth <= 560;
  const found = [];
  for (const element of document.querySelectorAll("#bar *, #tools, #tools *, #card, #card *, #timebar, #timebar *, #legend, #legend *, #status *, #keys[open], #keys[open] *, #message, #message *, #start > div:not([hidden]), #start > div:not([hidden]) *")) {
    if (!isSeen(element) || element.closest("svg, option, datalist, [aria-hidden=true]")) continue;
    const name = `${element.tagName.toLowerCase()}${element.id ? `#${element.id}` : ""}`;
    const said = (element.value ?? element.textContent).toString().trim().slice(0, 50);
    const box = element.getBoundingClientRect();
    if (element.tagName === "INPUT" && element.value && ["text", "number", "url"].includes(element.type) && wide(element, element.value)) found.push(`${name} cuts "${said}"`);
    if (element.tagName === "SELECT" && wide(element, element.selectedOptions[0]?.text ?? "")) found.push(`${name} cuts "${element.selectedOptions[0].text}"`);
    // the name of a file and of a reference system may be shortened
    if (element.id === "title" || element.id === "crs" || element.id === "drawn") continue;
    if (!isRow(element) && element.tagName !== "INPUT" && element.tagName !== "SELECT" && element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).display !== "inline") found.push(`${name} is wider than its box: "${said}"`);
    if (!isRow(element) && (box.right > innerWidth + 1 || box.left < -1)) found.push(`${name} sticks out: "${said}"`);
    const card = element.closest("#card");
    if (card && box.right > card.getBoundingClientRect().right + 1 && !scrolls(element)) found.push(`${name} sticks out of the card: "${said}"`);
  }
  return [...new Set(found)];
}

// Places of the questions: on the ground in the middle of the scene, and below the ridge of a high roof.
const places = () => {
  const [GROUND, BUILDING] = [2, 6];
  const points = belvedere.cloud.chunks.flatMap(({ low, step, places, count }) => Array.from({ length: count }, (_, i) => [places[4 * i + 3] & 255, ...[0, 1, 2].map((k) => low[k] + step[k] * places[4 * i + k])]));
  const place = (code, of, share) => {
    const own = points.filter(([own]) => own === code).sort((a, b) => of(a) - of(b));
    return own[Math.floor(share * own.length)].slice(1);
  };
  return [place(GROUND, ([, x, y]) => Math.hypot(x, y), 0), place(BUILDING, ([, , , z]) => -z, 0.05)];
};
const WIDTHS = [390, 768, 1280];
// Says of a page that is open what is cut off, question by question.
export async function unfitting(page, answered) {
  const found = [];
  const look = async (name) => {
    for (const width of WIDTHS) {
      await page.setViewportSize({ width, height: width < 500 ? 844 : 720 });
      await page.evaluate(() => new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go))));
      found.push(...(await page.evaluate(cutOff)).map((what) => `${name}, ${width} pixels: ${what}`));
    }
  };
  await look("first answer");
  const [ground, roof] = await page.evaluate(places);
  const [x, y, z] = ground;
  const area = [ground, [x + 8, y, z], [x, y + 8, z]];
  const questions = { look: [ground], seen: [ground], line: [ground, roof], sun: [roof], shadow: [], around: [ground], who: [roof], roof: [roof], sun_area: area, measure: area, cut: [], crs: [], plan: [] };
  for (const [name, clicked] of Object.entries(questions)) {
    await page.evaluate(([name, clicked]) => { belvedere.choose(name); clicked.forEach((place) => belvedere.pick(place)); if (name === "sun_area") belvedere.ask(); }, [name, clicked]);
    if (await page.evaluate(() => Boolean(belvedere.tool.ask))) await answered(page);
    await look(name);
    for (const button of name === "shadow" ? ["sure", "compare"] : []) {
      await page.click(`#${button}`);
      await page.waitForFunction((name) => belvedere.last?.[name === "sure" ? "certainty" : "before"] && document.querySelector("#took"), button);
      await look(button);
      await page.click(`#${button}`);
      await page.waitForFunction(() => belvedere.last && !belvedere.last.certainty && !belvedere.last.before && document.querySelector("#took"));
    }
  }
  await page.evaluate(([x, y, z]) => {
    const corners = [[x, y], [x + 8, y], [x + 8, y + 8]].map((corner) => belvedere.toFile([...corner, z]));
    return belvedere.changePlan((plan) => plan.buildings.push({ corners: corners.map(([x, y]) => [x, y]), base: corners[0][2], height_m: 9 }));
  }, ground);
  await page.waitForFunction(() => belvedere.planned);
  await look("planned building");
  await page.evaluate(() => { belvedere.setWhen("change"); belvedere.choose("shadow"); });
  await page.waitForFunction(() => belvedere.last?.before && document.querySelector("#took"));
  await look("change by the plan");
  await page.evaluate(() => belvedere.changePlan((plan) => { plan.buildings = []; }));
  await page.click("#help");
  await look("help");
  return found;
}
