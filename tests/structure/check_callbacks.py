#!/usr/bin/env python3
"""Checks that no function is passed from one room of bake/ to another as data: check_callbacks.py ROOT.

Rooms are here the folders of bake/. A header that a file of another room includes declares no std::function, but for
  - progress: a function named on_... that returns nothing, and one that makes such a function;
  - functions of mathematics: a number or a place becomes a number.
"""

import re
import sys
from pathlib import Path

from check_rooms import INCLUDE, included_file
from source_files import source_files

FUNCTION = re.compile(r"std::function<")
PROGRESS = re.compile(r"std::function<void\([^()]*\)>&?\s+(on_\w+\b|make_\w+\()")
NUMBER = re.compile(r"std::function<(double|float)\((double|float|const glm::d?vec3&)\)>")


def faults(root):
    sources = {file: (root / file).read_text() for file in source_files(root, ["bake"])}
    users = {}
    for file, text in sources.items():
        for name in INCLUDE.findall(text):
            users.setdefault(included_file(root, file, name), set()).add(file)
    for file, text in sources.items():
        others = sorted(user for user in users.get(file, set()) if user.parts[1] != file.parts[1])
        if not others:
            continue
        for number, line in enumerate(text.splitlines(), 1):
            code = line.split("//")[0]
            if FUNCTION.search(code) and not PROGRESS.search(code) and not NUMBER.search(code):
                yield f"{file}:{number}: passes a function to another room ({others[0]} includes it)"


def main():
    found = list(faults(Path(sys.argv[1])))
    print("\n".join(found) or "rooms pass data to each other, no functions")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
