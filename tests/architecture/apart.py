#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""apart.py TARGETS ROOT: code that drives a robot cannot reach the truth.

Links: `robots` links, directly or through others, nothing but the core: no scene, no simulator, no
bench. Files: no file of `robots` includes a header of scenes, simulator or bench.
"""
import os
import re
import sys

from links import read_targets

MAY = {"robots", "core", "io"}
TRUTH = ("scenes/", "sim/", "bench/")


def linked(targets, name, found):
    """All targets that are linked, directly or indirectly, by linking `name`."""
    if name not in found:
        found.add(name)
        _, public, private = targets[name]
        for link in public + private:
            linked(targets, link, found)
    return found


def faults(targets, root):
    """One line for each path from the navigation to the truth."""
    found = [f"robots links {name}" for name in sorted(linked(targets, "robots", set()) - MAY)]
    folder = os.path.join(root, "robots/navigation")
    for file in sorted(os.listdir(folder)):
        with open(os.path.join(folder, file), encoding="utf-8") as text:
            for header in re.findall(r'^#include "([^"]+)"', text.read(), re.M):
                if header.startswith(TRUTH):
                    found.append(f"robots/navigation/{file} includes {header}")
    return found


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as made:
        lines = faults(read_targets(made.read()), sys.argv[2])
    print("\n".join(lines) or "the navigation cannot reach the truth")
    sys.exit(bool(lines))
