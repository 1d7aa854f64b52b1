// SPDX-License-Identifier: Apache-2.0
// The report's frame: pages by the address, navigation, theme.
import { type JSX, render } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { folders } from "./data";
import { AuditPage } from "./pages/audit";
import { FailuresPage } from "./pages/failures";
import { FiguresPage } from "./pages/figures";
import { OverviewPage } from "./pages/overview";
import { ReproductionPage } from "./pages/reproduction";
import { RunPage, RunsPage } from "./pages/runs";
import { SpeedPage } from "./pages/speed";
import { SweepsPage } from "./pages/sweeps";
import { type Route, linkTo, useRoute } from "./route";
import { toggleTheme, useTheme } from "./theme";
import { Missing } from "./view/parts";

const kPages: [string, string, (props: { route: Route }) => JSX.Element][] = [
  ["overview", "Overview", OverviewPage],
  ["figures", "Figures", FiguresPage],
  ["sweeps", "Sweeps", SweepsPage],
  ["failures", "Failures", FailuresPage],
  ["audit", "Audit", AuditPage],
  ["speed", "Speed and memory", SpeedPage],
  ["runs", "Runs", RunsPage],
  ["reproduction", "Reproduction", ReproductionPage],
];

function App(): JSX.Element {
  const route = useRoute();
  const theme = useTheme();
  const main = useRef<HTMLElement>(null);
  const here = route.page[0] ?? "overview";
  const found = kPages.find(([key]) => key === here);
  const Page = here === "run" ? RunPage : found?.[2];
  const names = folders.map((folder) => folder.name).join(", ");
  const path = route.page.join("/");
  useEffect(() => {
    document.title = `${found?.[1] ?? route.page[2] ?? "Report"}: ${names}`;
  }, [path]);
  useEffect(() => {
    // A phone shows only part of the navigation: this part must contain the open page.
    document.querySelector("nav [aria-current]")?.scrollIntoView({ inline: "center", block: "nearest" });
  }, [path]);
  const first = useRef(true);
  useEffect(() => {
    if (!first.current) {
      scrollTo(0, 0);
      main.current?.focus({ preventScroll: true });
    }
    first.current = false;
  }, [path]);
  return (
    <>
      <a
        class="skip"
        href={location.hash || "#/"}
        onClick={(event) => {
          event.preventDefault();
          main.current?.focus();
        }}
      >
        To the content
      </a>
      <header>
        <a class="home" href={linkTo(["overview"])}>
          Modelhouse report
        </a>
        <nav aria-label="Pages">
          <ul>
            {kPages.map(([key, title]) => (
              <li key={key}>
                <a href={linkTo([key])} aria-current={key === here || (key === "runs" && here === "run") ? "page" : undefined}>
                  {title}
                </a>
              </li>
            ))}
          </ul>
        </nav>
        <button type="button" class="theme" onClick={toggleTheme} aria-label={theme === "dark" ? "Light theme" : "Dark theme"}>
          {theme === "dark" ? "☀" : "☾"}
        </button>
      </header>
      <main ref={main} tabIndex={-1} data-page={here}>
        {folders.length === 0 ? (
          <Missing>The data of this report are missing: the folder data must stand beside this page.</Missing>
        ) : Page ? (
          <Page key={path} route={route} />
        ) : (
          <Missing>There is no such page.</Missing>
        )}
      </main>
      <footer>Made by modelhouse report from {names}. Opens without a network.</footer>
    </>
  );
}

const root = document.getElementById("app");
if (root) render(<App />, root);
