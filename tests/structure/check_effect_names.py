#!/usr/bin/env python3
"""Checks that bake/ names an effect in its own folder and in the table alone: check_effect_names.py ROOT.

The effects are the folders of bake/effects/. The name of one, and of its parts ("single.terms"), is written in
quotes nowhere else in bake/. What stands outside bake/ (the format, the runtime, tests) may name effects.
"""

import re
import sys
from pathlib import Path

from source_files import source_files

EFFECTS = Path("bake/effects")
TABLE = EFFECTS / "effects.cpp"


def faults(root, names):
    for file in source_files(root, ["bake"]):
        if file == TABLE:
            continue
        for number, line in enumerate((root / file).read_text().splitlines(), 1):
            for name in names:
                spelling = re.escape(name).replace("_", "[_-]")
                if EFFECTS / name not in file.parents and re.search(rf'"{spelling}[". ]', line):
                    yield f'{file}:{number}: names the effect "{name}": {line.strip()}'


def main():
    root = Path(sys.argv[1])
    names = sorted(path.name for path in (root / EFFECTS).glob("*/"))
    if not names:
        print("SKIPPED: there is no folder in bake/effects")
        return
    found = list(faults(root, names))
    print("\n".join(found) or f"{len(names)} effects, each named in its folder and in the table alone")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
