#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds words that the project has replaced. Usage: check.py SOURCES

One word for one thing, in the field's terms and in American spelling. Prints file, line and what to
write for each find; exit code 1 where there is one."""
import pathlib
import re
import sys

# What stood here once -> what to write.
REPLACED = {
    r"\bcolour|\bgrey\b|\bneighbour|\bmetres?\b|\bcentre|\bbehaviour|\b(?:optim|normal|initial)is(?:e|ation|ing)":
        "American spelling",
    r"\bpictures?\b|[pP]icture(?=[A-Z_])|(?<=[a-z_])[pP]icture": "image",
    r"\bis handed\b|\bare handed\b": "receives",
    r"\bis told of\b": "receives, is reported",
    r"\bis gone on with\b|goes on with the same bits": "is resumed, resumes bit-identically",
    r"\ba thirtieth of a second\b": "1/30 s",
    r"\bdear to\b": "expensive",
    r"\bthat (?:is|are) none\b": "is not a ...",
    r"\bsittings?\b": "session_start, session",
    r"\bcarry_out\b": "execute_run",
    r"\bwork_off\b": "run_pending",
    r"\bsay_what_is_gone\b": "warn_missing_outputs",
    r"\bcheck_places\b": "validate_inputs",
    r"\btold_above\b": "already_shown",
    r"\blacking\b": "missing, incomplete",
    r"\bis_told\b": "reports_stage, is_explicit",
    r"\bfigures_alone\b|--figures-alone": "metrics_only",
    r"\bneed_later\b": "require_increasing_stamp",
    r"\bstanding\(|\bonlookers\b": "live_keyframe, observing_keyframes",
    r"\bwalkers?\b": "pedestrian",
}
# A picture may hang on a wall: a class of NYU40 and a kind of furniture.
WALL = re.compile(r"""["'`]picture["'`]|kind: picture|build::picture|picture\(Piece|\| picture \||"""
                  r"picture, pillow|a picture move|\(pictures, books|[pP]ictures ?(?:OfOneRule|<|=|;|\)|,)")
ENDINGS = {".cpp", ".hpp", ".c", ".h", ".md", ".py", ".sh", ".yaml", ".yml", ".patch"}
LEFT_OUT = {"build", "out", ".git", "scenarios", "levels", "words", "node_modules"}  # hashed, or this


def files(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if path.suffix in ENDINGS and not LEFT_OUT.intersection(parts) and path.is_file():
            if path.name not in ("CHANGELOG.md",) and "survivors" not in path.name:
                yield path


def main():
    root = pathlib.Path(sys.argv[1])
    finds = 0
    for path in files(root):
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            for word, instead in REPLACED.items():
                for match in re.finditer(word, line):
                    if "icture" in match[0] and WALL.search(line):
                        continue
                    print(f"{path.relative_to(root)}:{number}: '{match[0]}': write {instead}")
                    finds += 1
    return 1 if finds else 0


sys.exit(main())
