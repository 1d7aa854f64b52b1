// SPDX-License-Identifier: Apache-2.0
// Opens reports as a reader does, in headless Chromium, and checks what they show.
// node browse.mjs FOLDER_WITH_REPORTS SCREENSHOTS [REPORT...]
// Prints one line per finding and, at the end, JSON of what was measured; exit code 1 if there was a finding.
import { chromium } from "playwright-core";
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { createRequire } from "node:module";

const [, , root, screenshots, ...asked] = process.argv;
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const program = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync);
const pages = ["overview", "figures", "sweeps", "failures", "audit", "speed", "runs", "reproduction"];
// The steps to run; `STEPS=use node browse.mjs ...` runs only the step `use`.
const steps = (process.env.STEPS ?? "walk,axe,use").split(",");
const sizes = { laptop: { width: 1440, height: 900 }, phone: { width: 390, height: 844 } };
const findings = [];
const measured = { charts: 0, marks: 0, screenshots: 0 };
const expect = (holds, what) => {
  if (!holds) {
    findings.push(what);
    console.log(`FOUND ${what}`);
  }
};

/** A page that records every message and every request that leaves the folder. */
async function open(browser, report, options = {}) {
  const context = await browser.newContext({ viewport: sizes.laptop, ...options });
  const page = await context.newPage();
  const address = `file://${join(root, report)}/`;
  // The message ignored here comes from the software emulation of the GPU, not from the page.
  page.on("console", (message) => message.text().includes("GPU stall due to ReadPixels") || expect(false, `${report} ${page.url()}: console: ${message.text()}`));
  page.on("pageerror", (error) => expect(false, `${report} ${page.url()}: ${error.message}`));
  page.on("dialog", (dialog) => {
    expect(false, `${report}: a dialog opened: ${dialog.message()}`);
    void dialog.dismiss();
  });
  page.on("request", (request) => {
    const url = request.url();
    expect(
      url.startsWith(address) || url.startsWith("data:") || url.startsWith("blob:"),
      `${report}: asks for ${url.slice(0, 200)}`,
    );
  });
  return { context, page, go: (place) => visit(page, `${address}index.html#/${place}`) };
}

async function settled(page) {
  await page.waitForSelector("main", { timeout: 20000 });
  await page.waitForFunction(() => document.querySelector(".loading") === null, undefined, { timeout: 20000 });
  // Charts are drawn once their width is known.
  await page.waitForFunction(
    () => [...document.querySelectorAll(".plot-place")].every((place) => place.offsetParent === null || place.querySelector("svg")),
    undefined,
    { timeout: 20000 },
  );
}

async function visit(page, address) {
  await page.goto(address);
  await settled(page);
}

/** Charts whose number of marks differs from their data, and charts without marks. */
function countMarks(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll("figure.chart")].map((figure) => {
      const expected = JSON.parse(figure.dataset.marks);
      const drawn = {};
      for (const label of Object.keys(expected))
        drawn[label] = figure.querySelectorAll(`g.m-${label} :is(circle, path, rect, line, text)`).length;
      return { title: figure.querySelector("strong").textContent, expected, drawn, visible: figure.offsetParent !== null };
    }),
  );
}

async function checkCharts(page, where) {
  for (const { title, expected, drawn, visible } of await countMarks(page)) {
    if (!visible) continue;
    measured.charts += 1;
    for (const [label, count] of Object.entries(expected)) {
      measured.marks += drawn[label];
      expect(drawn[label] === count, `${where}: ${title}: ${drawn[label]} ${label} of ${count}`);
    }
    expect(Object.values(drawn).some((count) => count > 0), `${where}: ${title} is empty`);
  }
}

/** Every page in both sizes and, for the first report, in both themes: charts, width, an image. */
async function walk(browser, report, themesOf) {
  for (const [size, viewport] of Object.entries(sizes))
    for (const colorScheme of themesOf[size]) {
      const { context, page, go } = await open(browser, report, { colorScheme, viewport });
      const run = await firstRun(page, go);
      for (const place of run ? [...pages, run] : pages) {
        await go(place);
        const name = place.startsWith("run/") ? "run" : place;
        await checkCharts(page, `${report} ${name} ${size}`);
        if (name === "overview" && size === "laptop") await firstScreen(page, `${report} ${name}`);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
        expect(wide <= 0, `${report} ${name} ${size}: ${wide} px wider than the window`);
        mkdirSync(join(screenshots, report), { recursive: true });
        await page.screenshot({ path: join(screenshots, report, `${name}-${size}-${colorScheme}.png`), fullPage: true });
        measured.screenshots += 1;
      }
      await context.close();
    }
}

/** A newcomer sees at once which system is better, what each system did, and the place. */
async function firstScreen(page, where) {
  if (!(await page.evaluate(() => globalThis.modelhouse.index.folders.some((folder) => folder.suite !== null)))) return;
  const seen = await page.evaluate(() => {
    const top = (selector) => document.querySelector(selector)?.getBoundingClientRect().top ?? 1e9;
    return {
      verdict: top(".verdict"),
      tiles: top(".tiles"),
      place: top(".first-screen figure"),
      ate: [...document.querySelectorAll(".tiles dt")].some((dt) => dt.textContent === "ATE"),
      text: document.querySelector(".verdict")?.textContent ?? "",
    };
  });
  for (const what of ["verdict", "tiles", "place"]) expect(seen[what] < sizes.laptop.height, `${where}: ${what} at ${seen[what]} px is below the first screen`);
  expect(seen.ate || where.includes("bare"), `${where}: no ATE among the tiles`);
  expect(!/Undecided/.test(seen.text), `${where}: ${seen.text}`);
  measured.first_screens = (measured.first_screens ?? 0) + 1;
}

async function firstRun(page, go) {
  await go("runs");
  const href = await page.evaluate(() => document.querySelector("td a")?.getAttribute("href") ?? null);
  return href ? href.slice(2) : null;
}

/** Accessibility; the content security policy is bypassed so that axe can run. */
async function accessible(browser, report) {
  for (const colorScheme of ["light", "dark"]) {
    const { context, page, go } = await open(browser, report, { bypassCSP: true, colorScheme });
    const run = await firstRun(page, go);
    for (const place of run ? [...pages, run] : pages) {
      await go(place);
      await page.evaluate(axe);
      const faults = await page.evaluate(async () => {
        const found = await globalThis.axe.run(document, { resultTypes: ["violations"], preload: false });
        return found.violations
          .filter((v) => v.impact === "serious" || v.impact === "critical")
          .map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 140)} (${v.nodes.length})`);
      });
      for (const fault of faults) expect(false, `${report} ${place} ${colorScheme}: axe: ${fault}`);
    }
    await context.close();
  }
}

const cells = (page, column) =>
  page.evaluate((name) => {
    const table = [...document.querySelectorAll("section.table")].at(-1);
    const heads = [...table.querySelectorAll("th")].map((th) => th.textContent.replace(/ [▾▴]$/, ""));
    const at = heads.indexOf(name);
    return [...table.querySelectorAll("tbody tr")].map((row) => row.children[at]?.textContent ?? "");
  }, column);

/** What a reader does: sort, filter, copy, change the theme, follow and reload links. */
async function use(browser, report) {
  const { context, page, go } = await open(browser, report, { acceptDownloads: true });
  await go("runs");
  const table = page.locator("section.table").last();  // the last folder's table, which cells() reads, too
  const before = await cells(page, "run");
  await table.getByRole("button", { name: /^ATE m/ }).click();
  const falling = (await cells(page, "ATE m")).filter(Boolean).map(Number);
  expect(falling.length > 1 && falling.every((v, i) => i === 0 || v <= falling[i - 1]), `${report}: sorting down by ATE`);
  await table.getByRole("button", { name: /^ATE m/ }).click();
  const rising = (await cells(page, "ATE m")).filter(Boolean).map(Number);
  expect(rising.every((v, i) => i === 0 || v >= rising[i - 1]), `${report}: sorting up by ATE`);
  await page.reload();
  await settled(page);
  expect(JSON.stringify((await cells(page, "ATE m")).filter(Boolean).map(Number)) === JSON.stringify(rising), `${report}: a sorted table has no link`);
  await table.getByRole("searchbox").fill("system:semantic");
  const systems = await cells(page, "system");
  expect(systems.length > 0 && systems.length < before.length && systems.every((s) => s === "semantic"), `${report}: filtering by system`);
  expect(page.url().includes("q="), `${report}: a filter has no link`);
  await table.getByRole("searchbox").fill("ate_m:9999");
  expect((await cells(page, "ATE m")).length === 0, `${report}: filtering by a column with a blank in its name`);
  await table.getByRole("searchbox").fill("system:semantic");
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  for (const [format, sign] of [["CSV", /^run,/], ["Markdown", /^\| run /], ["LaTeX", /^\\begin\{tabular\}/]]) {
    await table.getByRole("button", { name: format, exact: true }).click();
    await page.waitForFunction((word) => document.body.textContent.includes(`copied as ${word}`), format);
    const text = await page.evaluate(() => navigator.clipboard.readText());
    expect(sign.test(text) && text.includes("semantic"), `${report}: copied as ${format}: ${text.slice(0, 60)}`);
  }
  const dark = () => page.evaluate(() => document.documentElement.dataset.theme);
  const first = await dark();
  await page.getByRole("button", { name: /theme$/ }).click();
  expect((await dark()) !== first, `${report}: the theme does not change`);
  await page.reload();
  await settled(page);
  expect((await dark()) !== first, `${report}: the theme is forgotten`);
  // With the keyboard only, follow the second link of the navigation.
  await go("overview");
  await page.getByRole("link", { name: "Figures" }).focus();
  await page.keyboard.press("Enter");
  const followed = await page.waitForFunction(() => document.querySelector("h1").textContent === "Figures of the paper", undefined, { timeout: 20000 }).then(() => true, () => false);
  expect(followed, `${report}: Enter follows no link`);
  await settled(page);
  // A failing query opens its run with that query selected.
  await go("failures");
  const link = page.locator("td a").first();
  if ((await link.count()) > 0) {
    const frame = await link.textContent();
    await link.click();
    await page.waitForSelector(".query h2");
    await settled(page);
    expect((await page.locator(".query h2").textContent()).includes(`frame ${frame}`), `${report}: opens another query`);
    await page.reload();
    await page.waitForSelector(".query h2");
    await settled(page);
    await checkCharts(page, `${report} query`);
  }
  await replay(page, go, report);
  await views(page, go, report);
  await colors(page, go, report);
  await links(page, go, report);
  await go("overview");
  const zeros = await page.evaluate(() => [...document.querySelectorAll("details section.table")].flatMap((table) => {
    const heads = [...table.querySelectorAll("th")].map((th) => th.textContent);
    return [...table.querySelectorAll("tbody tr")].map((row) => row.children[heads.indexOf("p")]?.textContent ?? "").filter((text) => text !== "" && Number(text) === 0);
  }));
  expect(zeros.length === 0, `${report}: a p of ${zeros[0]}`);
  await go("figures");
  if ((await page.locator("figure.chart").count()) > 0)
    for (const kind of ["SVG", "PNG"]) {
      const [file] = await Promise.all([
        page.waitForEvent("download"),
        page.locator("figure.chart").last().getByRole("button", { name: new RegExp(`as ${kind}$`) }).click(),
      ]);
      const bytes = readFileSync(await file.path());
      const good = kind === "SVG" ? bytes.toString().startsWith("<svg") : bytes.subarray(1, 4).toString() === "PNG";
      expect(good && bytes.length > 1500, `${report}: saved ${kind} is ${bytes.length} bytes`);
    }
  await context.close();
}

/** A report with damaged data: every page that needs them says so. */
async function damaged(browser, report) {
  const copy = join(screenshots, "damaged");
  rmSync(copy, { recursive: true, force: true });
  cpSync(join(root, report), copy, { recursive: true });
  const file = join(copy, "data", "0-runs.js");
  const text = readFileSync(file, "utf8");
  writeFileSync(file, text.replace(/"values":\s*\[/, '"values":null,"lost":['));
  const run = (await firstRunOf(browser, report)) ?? "";
  const context = await browser.newContext({ viewport: sizes.laptop });
  const page = await context.newPage();
  for (const place of ["runs", run]) {
    await visit(page, `file://${copy}/index.html#/${place}`);
    const said = await page.evaluate(() => document.querySelector("main").textContent);
    expect(/damaged/.test(said), `${report} ${place}: damaged data are not told: ${said.slice(0, 120)}`);
    measured.damaged = (measured.damaged ?? 0) + 1;
  }
  await context.close();
}

async function firstRunOf(browser, report) {
  const { context, page, go } = await open(browser, report);
  const run = await firstRun(page, go);
  await context.close();
  return run;
}

/** A choice on Figures survives a reload, and a link to a different state of an open page is followed. */
async function links(page, go, report) {
  await go("figures");
  const picked = () => page.locator("label.choice", { hasText: /^Run/ }).last().locator("select");
  if ((await picked().count()) > 0 && (await picked().locator("option").count()) > 1) {
    await picked().selectOption("1");
    await page.reload();
    await settled(page);
    expect((await picked().inputValue()) === "1", `${report}: a picked run has no link`);
    await picked().selectOption("0");
    expect((await picked().inputValue()) === "0", `${report}: a choice of a link cannot be taken back`);
    measured.picked = (measured.picked ?? 0) + 1;
  }
  await page.evaluate(() => (location.hash = "#/runs"));
  await page.waitForSelector("section.table");
  await settled(page);
  const place = await page.evaluate(() => globalThis.modelhouse.index.folders.length - 1);
  await page.evaluate((at) => (location.hash = `#/runs?runs-${at}.q=system:semantic`), place);
  const followed = await page
    .waitForFunction(() => [...document.querySelectorAll("section.table input[type=search]")].at(-1).value === "system:semantic", undefined, { timeout: 5000 })
    .then(() => true, () => false);
  expect(followed, `${report}: a link into an open page is not followed`);
}

/** A system has one color on all pages. */
async function colors(page, go, report) {
  const known = new Map();
  const systems = await page.evaluate(() => globalThis.modelhouse.index.folders.flatMap((folder) => folder.arms.map((arm) => arm.system)));
  for (const place of ["figures", "failures"]) {
    await go(place);
    const legends = await page.evaluate(() =>
      [...document.querySelectorAll(".folder .legend li")].map((li) => [
        li.textContent.trim(),
        li.querySelector("line, path, circle, rect")?.getAttribute("stroke") ?? li.querySelector("[fill]")?.getAttribute("fill"),
      ]),
    );
    for (const [name, color] of legends) {
      if (!systems.some((system) => name === system || name.startsWith(`${system}, `))) continue;
      expect(color && (known.get(name) ?? color) === color, `${report} ${place}: ${name} is ${color}, elsewhere ${known.get(name)}`);
      known.set(name, color);
      const other = [...known].find(([n, c]) => c === color && n !== name);
      expect(!other, `${report} ${place}: ${name} has the color of ${other?.[0]}`);
      measured.colors = (measured.colors ?? 0) + 1;
    }
  }
}

/** The number of marks that a picture declares, by kind. */
const marksOf = (page) => page.locator("canvas.picture").first().evaluate((canvas) => JSON.parse(canvas.dataset.marks));
/** Whether anything is drawn apart from the gap between two pictures. */
const isDrawn = (page) =>
  page.locator("canvas.picture").first().evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const colors = new Set();
    for (let i = 0; i < data.length; i += 4) colors.add(data[i] * 65536 + data[i + 1] * 256 + data[i + 2]);
    return colors.size > 3;
  });

/** For a run with recorded views: its last keyframe, and its queries next to their candidates. */
async function views(page, go, report) {
  const run = await firstRun(page, go);
  await go(`${run}?t=1000`);
  if (!(await page.evaluate(() => globalThis.modelhouse.index.folders[0].views.length > 0))) return;
  await page.waitForSelector(".replay .views", { timeout: 20000 });
  const last = page.locator(".replay .views");
  expect((await last.getAttribute("data-keyframe")) === "0", `${report}: another keyframe than the last one is shown`);
  expect((await marksOf(page)).keypoints === 2, `${report}: a keyframe shows ${JSON.stringify(await marksOf(page))}`);
  await page.getByLabel("Moment of the tour, ms").fill("2000");
  expect((await last.getAttribute("data-keyframe")) === "1", `${report}: the keyframe does not follow the moment`);
  await page.locator("td a").first().click();
  await page.waitForSelector(".query canvas.picture");
  const first = await marksOf(page);
  expect(first.pairs === 2 && first.right === 1 && first.wrong === 1, `${report}: a query shows ${JSON.stringify(first)}`);
  await page.waitForTimeout(200);
  expect(await isDrawn(page), `${report}: a query's picture stays empty`);
  await page.locator(".query .views select").selectOption("1");
  expect((await marksOf(page)).pairs === 0, `${report}: the second candidate shows the first one's matches`);
  measured.views = (measured.views ?? 0) + 1;
}

/** Play, step, scrub, and a link to a point in time. */
async function replay(page, go, report) {
  const run = await firstRun(page, go);
  await go(run);
  await page.locator("button.open").click();
  await page.waitForSelector(".replay canvas[data-engine]", { timeout: 20000 });
  await page.keyboard.press("ArrowRight");
  const stepped = await page.waitForFunction(() => Number(document.querySelector(".replay").dataset.ms) > 0, undefined, { timeout: 5000 }).then(() => true, () => false);
  expect(stepped, `${report}: an arrow key does not step a replay that was just opened`);
  const noted = await page.evaluate(() => location.hash.endsWith(`t=${document.querySelector(".replay").dataset.ms}`));
  expect(noted, `${report}: the address does not hold the step that is shown`);
  await go(`${run}?t=1000`);
  await page.waitForSelector(".replay canvas[data-engine]", { timeout: 20000 });
  const moment = async () => Number(await page.locator(".replay").getAttribute("data-ms"));
  expect((await moment()) === 1000, `${report}: a link to a moment opens another: ${await moment()}`);
  await page.getByRole("button", { name: "Step forward" }).click();
  const next = await moment();
  expect(next > 1000 && next < 1300, `${report}: one step leads to ${next}`);
  await page.getByRole("button", { name: "Step back" }).click();
  expect((await moment()) <= 1000, `${report}: a step back leads to ${await moment()}`);
  await page.getByLabel("Moment of the tour, ms").fill("2000");
  expect((await moment()) === 2000, `${report}: scrubbing leads to ${await moment()}`);
  // The address changes once the frame is drawn.
  const linked = await page.waitForURL(/t=2000/, { timeout: 5000 }).then(() => true, () => false);
  expect(linked, `${report}: a moment has no link`);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => Number(document.querySelector(".replay").dataset.ms) > 2100, undefined, { timeout: 20000 });
}

/** A large study: how long it takes until its table shows, and how much memory. */
async function large(browser, report) {
  const { context, page, go } = await open(browser, report);
  const session = await context.newCDPSession(page);
  await session.send("Performance.enable");
  const start = Date.now();
  await go("runs");
  measured.large_open_s = (Date.now() - start) / 1000;
  const { metrics } = await session.send("Performance.getMetrics");
  measured.large_work_s = metrics.find(({ name }) => name === "TaskDuration").value;
  for (const place of ["overview", "figures", "failures", "speed"]) {
    const from = Date.now();
    await go(place);
    measured[`large_${place}_s`] = (Date.now() - from) / 1000;
  }
  await session.send("HeapProfiler.collectGarbage");
  const { usedSize } = await session.send("Runtime.getHeapUsage");
  measured.large_heap_mb = usedSize / 1e6;
  // Times are printed, not judged: they depend on the load of the machine.
  expect(measured.large_heap_mb < 300, `${report}: takes ${measured.large_heap_mb} MB`);
  await context.close();
}

const browser = await chromium.launch({
  executablePath: program,
  // Without the flags, pages would be drawn through a software emulation of a GPU: 20 times slower.
  args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader"],
});
measured.chromium = browser.version();
for (const report of asked.length > 0 ? asked : readdirSync(root).sort()) {
  if (!existsSync(join(root, report, "index.html"))) continue;
  if (report === "large") {
    await large(browser, report);
    continue;
  }
  const whole = report === "rooms" || asked.length > 0;
  if (steps.includes("walk")) await walk(browser, report, {
    laptop: whole ? ["light", "dark"] : ["light"],
    phone: whole ? ["light", "dark"] : ["dark"],
  });
  if (steps.includes("axe")) await accessible(browser, report);
  if (steps.includes("use") && !report.startsWith("odd")) await use(browser, report);
  if (steps.includes("use") && report === "rooms") await damaged(browser, report);
}
await browser.close();
console.log(JSON.stringify(measured));
process.exit(findings.length > 0 ? 1 : 0);
