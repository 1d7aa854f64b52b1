// SPDX-License-Identifier: Apache-2.0
import { colorOf, kDashes } from "../theme";

/** Color and dash of the i-th line of a chart. */
export function armStyle(i: number): { color: string; dash: string } {
  return { color: colorOf(i), dash: kDashes[i % kDashes.length] ?? "0" };
}
