#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""links.py check TARGETS ROOT: files include only what their target links; there is no circle of targets, nor
of folders that share a target (except in scenes/: a scene is loaded by its formats, which make scenes).

TARGETS is made/targets.txt of the build folder, which CMake writes: NAME|SOURCES|PUBLIC|PRIVATE.
"""
import os
import re
import sys


def read_targets(text):
    """{target: (sources, public links, private links)}; links to other projects are left out."""
    targets = {}
    for line in text.splitlines():
        name, sources, *links = line.split("|")
        ours = ([link[4:] for link in part.split(";") if link.startswith("mh::")] for part in links)
        targets[name] = (sources.split(";"), *ours)
    return targets


def circle(targets, name, path=()):
    """The first circle of links found on paths from a target; empty if there is none."""
    if name in path:
        return [*path[path.index(name):], name]
    _, public, private = targets[name]
    return next(filter(None, (circle(targets, l, (*path, name)) for l in public + private)), [])


def reach(targets, name):
    """The targets whose headers come with a link to `name`."""
    return {name}.union(*(reach(targets, link) for link in targets[name][1]))


def violations(targets, root):
    """A line for each include that goes against the link lines."""
    for name in targets:
        if found := circle(targets, name):
            return ["circle: " + " -> ".join(found)]
    owner = {source: name for name, (sources, *_) in targets.items() for source in sources}
    folders = {}
    for source, name in owner.items():
        folders.setdefault(os.path.dirname(source), set()).add(name)
    may = {name: {name}.union(*(reach(targets, link) for link in public + private))
           for name, (_, public, private) in targets.items()}

    def owners(file):  # for a header: the target of the source with its name, otherwise all targets of its folder
        source = os.path.splitext(file)[0] + ".cpp"
        return {owner[source]} if source in owner else folders.get(os.path.dirname(file), set())

    found = []
    for folder in sorted(f for f in folders if os.path.isdir(os.path.join(root, f))):
        for file in sorted(os.listdir(os.path.join(root, folder))):
            if not file.endswith((".hpp", ".cpp")):
                continue
            file = os.path.join(folder, file)
            with open(os.path.join(root, file), encoding="utf-8") as text:
                headers = re.findall(r'^#include "([^"]+)"', text.read(), re.M)
            wrong = {n: [h for h in headers if owners(h) and not owners(h) & may[n]]
                     for n in owners(file)}
            best = min(sorted(wrong), key=lambda n: len(wrong[n]))
            found += [f"{file} of {best} includes {h} of {' or '.join(sorted(owners(h)))}"
                      for h in wrong[best]]
    return found


def folder_circle(root, tops=("bench", "robots", "sim", "slam")):
    """The first circle of includes among folders; empty if there is none."""
    edges = {}
    for top in tops:
        for folder, _, files in os.walk(os.path.join(root, top)):
            here = os.path.relpath(folder, root)
            for file in sorted(f for f in files if f.endswith((".hpp", ".cpp"))):
                with open(os.path.join(folder, file), encoding="utf-8") as text:
                    to = map(os.path.dirname, re.findall(r'^#include "([^"]+)"', text.read(), re.M))
                    edges.setdefault(here, set()).update(t for t in to if t not in ("", here))
    done = set()

    def walk(folder, path):
        if folder in path:
            return [*path[path.index(folder):], folder]
        if folder in done:
            return []
        found = next(filter(None, (walk(f, (*path, folder)) for f in sorted(edges.get(folder, ())))), [])
        done.add(folder)
        return found

    return next(filter(None, (walk(f, ()) for f in sorted(edges))), [])


def main(task, made, root):
    assert task == "check"
    with open(made, encoding="utf-8") as text:
        found = violations(read_targets(text.read()), root)
    if circle_of := folder_circle(root):
        found.append("circle of folders: " + " -> ".join(circle_of))
    print("\n".join(found) or "every include follows a link line")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
