// SPDX-License-Identifier: Apache-2.0
// node browse.mjs NODE_MODULES URL [SCREENSHOTS]: tests the page of `modelhouse live` in a browser: keys drive, the
// picture moves, a kidnapped robot gets lost and relocalizes, the console stays empty.
import { createRequire } from "node:module";

const [modules, url, shots] = process.argv.slice(2);
const { chromium } = createRequire(modules + "/x.js")("playwright-core");
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const findings = [];
const expect = (is, what) => { if (!is) findings.push(what); };
const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
page.on("console", (message) => findings.push(`console: ${message.text()}`));
page.on("pageerror", (error) => findings.push(`error: ${error.message}`));
await page.goto(url);
await page.waitForSelector("[data-fact=keypoints]", { timeout: 60000 });
const fact = (name) => page.textContent(`[data-fact="${name}"]`);
const status = () => page.textContent("#status");
const until = async (is, what) => {
  for (let k = 0; k < 1200; ++k) {
    if (await is()) return;
    await page.waitForTimeout(50);
  }
  findings.push(`never: ${what}`);
};
const shoot = async (name, width, height, colorScheme) => {
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ colorScheme });
  await page.waitForTimeout(400);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  expect(!wide, `${name}: is wider than the window`);
  if (shots) await page.screenshot({ path: `${shots}/${name}.png`, fullPage: width < 800 });
};

const first = await page.getAttribute("#color", "src");
await page.keyboard.down("q");
await until(async () => Number(await fact("keyframes")) >= 6, "six keyframes while it turns");
expect(await page.getAttribute("#color", "src") !== first, "the picture does not move");
await until(async () => Number((await fact("time")).split(" ")[0]) >= 11, "eleven seconds, all around");
await page.keyboard.up("q");
await page.keyboard.down("w");
await page.waitForTimeout(700);
await page.keyboard.up("w");
await page.fill("#goal", "chair");
await page.click("#errand button");
await until(async () => (await page.textContent("#errand_is")).startsWith("chair"), "an errand to a chair");
await page.waitForTimeout(1500);
for (const scheme of ["light", "dark"]) {
  await shoot(`wide_${scheme}`, 1440, 900, scheme);
  await shoot(`phone_${scheme}`, 390, 844, scheme);
}
await page.setViewportSize({ width: 1440, height: 900 });
await page.click("#kidnap");
await until(async () => await status() === "dark", "dark while it is carried");
await page.keyboard.down("ArrowLeft");
await until(async () => ["relocalized", "tracked"].includes(await status()), "found after kidnapping");
await page.keyboard.up("ArrowLeft");
await page.fill("#gamma", "3");
await until(async () => await page.textContent("#gamma_is") === "3.00", "gamma 3");
await page.click("#light");
await until(async () => await status() === "dark", "dark without light");
await browser.close();
for (const finding of findings) console.log(finding);
process.exit(findings.length > 0 ? 1 : 0);
