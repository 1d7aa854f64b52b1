# SPDX-License-Identifier: Apache-2.0
"""sizes.py ROOT: no file of production code has more than 400 lines, and no function more than six
parameters. Finds parameter lists by their look; what it takes for one by mistake is named in its
message."""
import pathlib
import re
import sys

MOST_LINES, MOST_PARAMETERS = 400, 6
FOLDERS = ("slam", "scenes", "robots", "sim", "bench", "include")


def without_comments(text):
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.DOTALL)
    text = re.sub(r"//[^\n]*", "", text)
    return re.sub(r'"(\\.|[^"\\\n])*"', '""', text)


def parameter_lists(text):
    """Yields name, number of parameters of what looks like a function's declaration."""
    for match in re.finditer(r"\b([A-Za-z_]\w*)\s*\(", text):
        begin = at = match.end()
        depth, angles, count = 1, 0, 1
        while at < len(text) and depth:
            c = text[at]
            depth += c in "([{"
            depth -= c in ")]}"
            if c == "<":
                angles += 1
            elif c == ">" and text[at - 1] != "-":
                angles = max(0, angles - 1)
            count += c == "," and depth == 1 and angles == 0
            at += 1
        before = text[max(0, match.start() - 60):match.start()].rstrip()
        after = text[at:at + 40].strip()
        is_declared = (re.search(r"[\w>&*]$", before)
                       and not re.search(r"\b(return|throw|else)$", before)
                       and after.startswith(("{", "const", "override", ";", "noexcept", "->", ":"))
                       and re.match(r"\s*(const\s+)?[A-Za-z_:<>]+[\s&*]+\w", text[begin:at - 1]))
        if is_declared:
            yield match.group(1), count


def main(root):
    faults = []
    for folder in FOLDERS:
        for file in sorted(pathlib.Path(root, folder).rglob("*.[ch]*")):
            if file.suffix not in (".cpp", ".hpp", ".h") or "node_modules" in file.parts:
                continue
            text = file.read_text()
            lines = text.count("\n")
            name = file.relative_to(root)
            if lines > MOST_LINES:
                faults.append(f"{name}: {lines} lines, {MOST_LINES} at most")
            for function, count in parameter_lists(without_comments(text)):
                if count > MOST_PARAMETERS:
                    faults.append(f"{name}: {function}() has {count} parameters, "
                                  f"{MOST_PARAMETERS} at most")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
