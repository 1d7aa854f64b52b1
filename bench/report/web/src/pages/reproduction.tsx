// SPDX-License-Identifier: Apache-2.0
import type { JSX } from "preact";
import { useState } from "preact/hooks";
import type { Overview } from "../data";
import { putOnClipboard } from "../view/copy";
import { Facts, Missing, PerFolder, Piece } from "../view/parts";

interface Reproduction {
  command: string;
  commit: string;
  code: string;
  build_and_machine: Record<string, unknown>;
  seeds: number[];
  inputs: Record<string, Record<string, string>>;
}

function Command({ text }: { text: string }): JSX.Element {
  const [said, setSaid] = useState("");
  return (
    <div class="command">
      <pre tabIndex={0}>{text}</pre>
      <button type="button" onClick={() => void putOnClipboard(text).then((done) => setSaid(done ? "Copied." : "The browser denied the clipboard."))}>
        Copy the command
      </button>{" "}
      <span role="status">{said}</span>
    </div>
  );
}

function shown(value: unknown): string {
  return typeof value === "string" ? value : JSON.stringify(value);
}

export function ReproductionPage(): JSX.Element {
  return (
    <>
      <h1>Reproduction</h1>
      <PerFolder points="all">
        {(folder, place) => (
          <>
            <Piece<Reproduction | null> piece={`${place}/reproduction`}>
              {(made) =>
                made === null ? (
                  <Missing>{folder.damaged.includes("reproduction.json") ? "reproduction.json is damaged" : "This folder holds no reproduction.json"}, so that command, commit and machine are unknown.</Missing>
                ) : (
                  <>
                    <Command text={made.command} />
                    <Facts
                      facts={[
                        ["commit", made.commit || "unknown"],
                        ["digest of the code", made.code],
                        ["seeds", made.seeds.join(", ")],
                        ...Object.entries(made.build_and_machine).map(([key, value]): [string, string] => [key.replaceAll("_", " "), shown(value)]),
                      ]}
                    />
                    <h2>Digests of the inputs</h2>
                    {Object.entries(made.inputs).map(([environment, inputs]) => (
                      <details key={environment} open={Object.keys(made.inputs).length < 3}>
                        <summary>{environment}</summary>
                        <Facts facts={Object.entries(inputs)} />
                      </details>
                    ))}
                  </>
                )
              }
            </Piece>
            {folder.suite !== null && (
              <Piece<Overview> piece={`${place}/overview`}>
                {(overview) => (
                  <details>
                    <summary>The suite with all its settings</summary>
                    <pre tabIndex={0}>{JSON.stringify(overview.suite?.settings, null, 2)}</pre>
                  </details>
                )}
              </Piece>
            )}
          </>
        )}
      </PerFolder>
    </>
  );
}
