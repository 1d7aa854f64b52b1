#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""keys.py DECIDES ROOT: checks the rules for keys of results (cmake/code_version.cmake).

DECIDES lists, for each key, the files that decide it. Files included by a deciding file decide, too. A changed byte
in a deciding file changes the key; a changed byte in a test, a page, a report, the command line or CMake's
own files changes no key.
"""
import fnmatch
import os
import re
import shutil
import subprocess
import sys
import tempfile

CHANGES = {  # file: the keys that a change in it affects
    "slam/io/yaml.cpp": {"LIGHT", "DETECT", "RUN"},
    "slam/core/digest.hpp": {"LIGHT", "DETECT", "RUN"},
    "slam/semantics/candidate_selection.hpp": {"RUN"},
    "slam/optimize/bundle.cpp": {"RUN"},
    "slam/detect/heads.cpp": {"DETECT", "RUN"},
    "scenes/generate/categories/office.yaml": {"LIGHT", "RUN"},
    "scenes/recordings/tum_folder.cpp": {"LIGHT", "RUN"},
    "robots/navigation/plan.cpp": {"RUN"},
    "sim/render/bake.cpp": {"LIGHT", "RUN"},
    "sim/sensors/develop.cpp": {"RUN"},
    "bench/suite/environment.hpp": {"RUN"},
    "bench/protocol/query.cpp": {"RUN"},
    "bench/protocol/query_means.cpp": {"RUN"},
    "bench/systems/hiding.cpp": {"RUN"},
    "bench/run/one/run_one.cpp": {"RUN"},
    "bench/protocol/episodes/judge.cpp": {"RUN"},
    "bench/audit/trials.cpp": {"AUDIT"},
    "include/modelhouse/system.h": {"RUN"},
    "python/modelhouse/system.py": {"RUN"},
    "python/slam.cpp": set(),
    "bench/run/pool.cpp": set(),
    "bench/results/rows.cpp": set(),
    "bench/report/results_table.cpp": set(),
    "bench/report/pages/tables.cpp": set(),
    "bench/cli/bench.cpp": set(),
    "bench/lab/sheets.cpp": set(),
    "tests/slam/core/se3_test.cpp": set(),
    "tests/CMakeLists.txt": set(),
    "docs/protocol.md": set(),
    "CMakeLists.txt": set(),
}


def read(decides):
    with open(decides, encoding="utf-8") as text:
        return [line.rstrip("\n").split("|") for line in text if not line.startswith("BITS|")]


def not_held(patterns, root):
    """One line for each of our headers that a deciding file of runs includes but no key covers. Files that only
    name or print a key need not be covered."""
    run = [pattern for key, pattern in patterns if key == "RUN"]
    held = lambda file: any(fnmatch.fnmatch(os.path.join(root, file), pattern) for pattern in run)
    for top in ("slam", "scenes", "robots", "sim", "bench"):
        for folder, _, files in os.walk(os.path.join(root, top)):
            for file in sorted(f for f in files if f.endswith((".cpp", ".hpp"))):
                file = os.path.relpath(os.path.join(folder, file), root)
                if not held(file):
                    continue
                with open(os.path.join(root, file), encoding="utf-8") as text:
                    for header in re.findall(r'^#include "(\w+/[^"]+)"', text.read(), re.M):
                        if not held(header) and not header.startswith("made/"):
                            yield f"{file} includes {header}, which no key of runs holds"


def keys(root, decides):
    made = decides + ".hpp"
    subprocess.run(["cmake", f"-DROOT={root}", f"-DOUT={made}", f"-DDECIDES={decides}",
                    "-P", os.path.join(root, "cmake/code_version.cmake")], check=True)
    with open(made, encoding="utf-8") as text:
        return dict(re.findall(r'MH_CODE_(\w+) "(\w+)"', text.read()))


def byte_faults(patterns, root):
    with tempfile.TemporaryDirectory() as copy:
        for folder in ("slam", "scenes", "robots", "sim", "bench", "include", "cmake", "python"):
            shutil.copytree(os.path.join(root, folder), os.path.join(copy, folder),
                            ignore=shutil.ignore_patterns("node_modules", "*.png"))
        decides = os.path.join(copy, "decides.txt")
        with open(decides, "w", encoding="utf-8") as text:
            text.write("BITS|-O2\n")
            text.writelines(f"{key}|{pattern.replace(root, copy, 1)}\n" for key, pattern in patterns)
        before = keys(copy, decides)
        if set(before) != {"LIGHT", "DETECT", "RUN", "AUDIT"}:
            yield f"there are keys {sorted(before)}"
        for file, wanted in CHANGES.items():
            place = os.path.join(copy, file)
            if os.path.exists(place):
                with open(place, "rb") as text:
                    content = text.read()
            else:
                os.makedirs(os.path.dirname(place), exist_ok=True)
                with open(os.path.join(root, file), "rb") as text:
                    content = text.read()
            with open(place, "wb") as text:
                text.write(content + b"\n")
            after = keys(copy, decides)
            changed = {key for key in before if after[key] != before[key]}
            if changed != wanted:
                yield f"a byte in {file} changes {sorted(changed)}, not {sorted(wanted)}"
            with open(place, "wb") as text:
                text.write(content)


def main(decides, root):
    patterns = read(decides)
    found = [*not_held(patterns, root), *byte_faults(patterns, root)]
    print("\n".join(found) or "every key holds what decides it, and nothing else")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
