#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""apart.py ROOMS ROOT: what drives a robot cannot reach the truth.

By the link lines: `navigation` links, directly or through others, nothing but the robot's own model
and the core: no scene, no simulator, no bench. By its files: none includes a header of those.
"""
import os
import re
import sys

from rooms import read_rooms

MAY = {"navigation", "robots", "core"}
TRUTH = ("scenes/", "sim/", "bench/")
OF_THE_TRUTH = {"floor_grid.hpp", "floor_grid.cpp"}  # of the library `floor`


def linked(rooms, name, found):
    """Every target that a link to `name` brings along."""
    if name not in found:
        found.add(name)
        _, public, private = rooms[name]
        for link in public + private:
            linked(rooms, link, found)
    return found


def faults(rooms, root):
    """A line for each way from the navigation to the truth."""
    found = [f"navigation links {name}" for name in sorted(linked(rooms, "navigation", set()) - MAY)]
    folder = os.path.join(root, "robots/navigation")
    for file in sorted(set(os.listdir(folder)) - OF_THE_TRUTH):
        with open(os.path.join(folder, file), encoding="utf-8") as text:
            for header in re.findall(r'^#include "([^"]+)"', text.read(), re.M):
                if header.startswith(TRUTH) or os.path.basename(header) in OF_THE_TRUTH:
                    found.append(f"robots/navigation/{file} includes {header}")
    return found


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as made:
        lines = faults(read_rooms(made.read()), sys.argv[2])
    print("\n".join(lines) or "the navigation cannot reach the truth")
    sys.exit(bool(lines))
