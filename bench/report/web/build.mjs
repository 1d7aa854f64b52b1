// SPDX-License-Identifier: Apache-2.0
// Writes the bundle that `modelhouse report` copies: node build.mjs [FOLDER]
// (default: bench/report/pages/bundle). The second line of each script holds a digest of everything
// that the bundle is made from.
import { build } from "esbuild";
import { mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, "../pages/bundle"));

/** Every file below a folder except installed packages, as paths from it. */
function filesBelow(folder, from = "") {
  return readdirSync(join(folder, from)).flatMap((name) => {
    const path = from === "" ? name : `${from}/${name}`;
    if (path === "node_modules") return [];
    return statSync(join(folder, path)).isDirectory() ? filesBelow(folder, path) : [path];
  });
}

/** FNV-1a, 64 bits: bench/report/pages/write.cpp computes the same. */
function digestOfSources() {
  let sum = 0xcbf29ce484222325n;
  const add = (bytes) => {
    for (const byte of bytes) sum = ((sum ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  };
  const names = filesBelow(here).sort((a, b) => (a < b ? -1 : 1));
  for (const name of names) {
    add(Buffer.from(`${name}\n`));
    add(readFileSync(join(here, name)));
  }
  return sum.toString(16).padStart(16, "0");
}

/** The licenses of the packages that a bundle holds parts of. */
function licensesOf(inputs) {
  const packages = new Set();
  for (const input of inputs) {
    const found = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input);
    if (found) packages.add(found[1]);
  }
  return [...packages].sort().map((name) => {
    const folder = join(here, "node_modules", name);
    const about = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = readdirSync(folder).find((f) => /^licen[cs]e/i.test(f));
    const text = file ? readFileSync(join(folder, file), "utf8").trim() : "";
    return `${name} ${about.version}: ${about.license}\n\n${text}\n`;
  });
}

const digest = digestOfSources();
mkdirSync(out, { recursive: true });
const made = await build({
  absWorkingDir: here,
  entryPoints: { app: "src/main.tsx", replay: "src/replay.ts" },
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  outdir: out,
  metafile: true,
  banner: { js: `// SPDX-License-Identifier: Apache-2.0\n// sources: ${digest}` },
});
const css = await build({
  absWorkingDir: here,
  entryPoints: ["src/app.css"],
  bundle: true,
  minify: true,
  outdir: out,
  banner: { css: "/* SPDX-License-Identifier: Apache-2.0 */" },
});
if (css.errors.length > 0) process.exit(1);
writeFileSync(join(out, "index.html"), readFileSync(join(here, "src/index.html")));
writeFileSync(
  join(out, "LICENSES.txt"),
  `The bundle holds parts of these packages.\n\n${licensesOf(Object.keys(made.metafile.inputs)).join("\n")}`,
);
