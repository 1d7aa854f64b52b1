#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""draw.py TARGETS [FILE PAGE]: the targets and their links as SVG, on standard output.

With FILE: compares instead, and fails if FILE contains a different image or if PAGE does not mention
a target. TARGETS is as for links.py.
A link that follows from others is left out. A target is above all targets that it links, in the
column of its folder.
"""
import sys

from links import read_targets

COLUMNS = [("slam", 3, "#dbe9f6"), ("scenes", 2, "#e3f1dc"), ("robots", 1, "#fbeed2"),
           ("sim", 2, "#f9e0d6"), ("bench", 5, "#e8e2f2"), ("python", 1, "#eceff1")]  # width, in boxes
BOX_W, BOX_H, STEP_X, STEP_Y, MARGIN = 104, 30, 122, 58, 24


def needed_links(targets):
    """{target: its links, without links that follow from other links}"""
    links = {name: set(public + private) for name, (_, public, private) in targets.items()}

    def below(name):
        return links[name].union(*map(below, links[name]))

    return {name: sorted(l for l in ls if not any(l in below(o) for o in ls))
            for name, ls in links.items()}


def folder(targets, name):
    return targets[name][0][0].split("/")[0]


def places(targets, links):
    """{target: [x, y]} in boxes from the left and rows from below."""
    def row(name):
        return 1 + max(map(row, links[name]), default=-1)

    slots, left = {}, 0
    for name, width, _ in COLUMNS:
        slots[name] = [left + k / 2 for k in range(2 * width - 1)]
        left += width
    place, taken = {}, {}
    for name in sorted(targets, key=lambda n: (row(n), n)):
        y, here = row(name), slots[folder(targets, name)]
        near = taken.setdefault((folder(targets, name), y), [])
        x = next(x for x in here if all(abs(x - other) >= 1 for other in near))
        near.append(x)
        place[name] = [x, y]
    edges = [(a, b) for a in sorted(links) for b in links[a]]

    def hidden(a, b, box):
        """Whether a line passes behind a box other than those at its ends."""
        (ax, ay), (bx, by), (x, y) = place[a], place[b], place[box]
        ends = [ax + (bx - ax) * (ay - edge) / (ay - by) for edge in (y - 0.3, y + 0.3)]
        return by < y < ay and min(ends) < x + 0.45 and max(ends) > x - 0.45

    def cost(name):
        mine = [e for e in edges if name in e]
        lines = sum(abs(place[a][0] - place[b][0]) for a, b in mine)
        return lines + 9 * (sum(hidden(*e, box) for e in mine for box in targets) +
                            sum(hidden(*e, name) for e in edges if name not in e))

    for _ in range(6):  # moves each box to the place with the lowest cost, the first of equal ones
        for name in sorted(targets):
            best = None
            for x in slots[folder(targets, name)]:
                if all(n == name or place[n][1] != place[name][1] or abs(place[n][0] - x) >= 1
                       for n in targets):
                    old, place[name][0] = place[name][0], x
                    if best is None or cost(name) < best[0]:
                        best = (cost(name), x)
                    place[name][0] = old
            place[name][0] = best[1]
    return place


def draw(targets):
    links = needed_links(targets)
    place = places(targets, links)
    top = max(y for _, y in place.values())
    at = {name: (MARGIN + STEP_X * (x + 0.5), 2 * MARGIN + BOX_H / 2 + STEP_Y * (top - y))
          for name, (x, y) in place.items()}
    width = 2 * MARGIN + STEP_X * sum(columns for _, columns, _ in COLUMNS)
    height = 3 * MARGIN + BOX_H + STEP_Y * top
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="sans-serif">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    left = MARGIN
    for name, columns, color in COLUMNS:
        svg += [f'<rect x="{left + 3}" y="10" width="{STEP_X * columns - 6}" '
                f'height="{height - 20}" rx="8" fill="{color}" fill-opacity="0.5"/>',
                f'<text x="{left + 14}" y="32" font-size="15" fill="#666">{name}/</text>']
        left += STEP_X * columns
    for name in targets:
        for link in links[name]:
            (x, y), (to_x, to_y) = at[name], at[link]
            svg.append(f'<path d="M{x:g} {y + BOX_H / 2:g}L{to_x:g} {to_y - BOX_H / 2:g}" '
                       'fill="none" stroke="#888" stroke-width="1.2"/>')
    colors = {name: color for name, _, color in COLUMNS}
    for name, (x, y) in at.items():
        svg += [f'<rect x="{x - BOX_W / 2:g}" y="{y - BOX_H / 2:g}" width="{BOX_W}" '
                f'height="{BOX_H}" rx="5" fill="{colors[folder(targets, name)]}" stroke="#555"/>',
                f'<text x="{x:g}" y="{y + 5:g}" font-size="14" text-anchor="middle">{name}</text>']
    return "\n".join([*svg, "</svg>", ""])


def main(made, file=None, page=None):
    with open(made, encoding="utf-8") as text:
        targets = read_targets(text.read())
    if file is None:
        sys.stdout.write(draw(targets))
        return 0
    with open(file, encoding="utf-8") as drawn, open(page, encoding="utf-8") as text:
        same, told = drawn.read() == draw(targets), text.read()
    if not same:
        print(f"{file} is not what the link lines say: python3 {sys.argv[0]} {made} > {file}")
    left_out = [name for name in targets if f"`{name}`" not in told]
    if left_out:
        print(f"{page} leaves out {', '.join(left_out)}")
    return not same or bool(left_out)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
