#!/usr/bin/env python3
"""Checks that fewer than one pair of places per 1000 lines shares six or more lines: check_duplicates.py ROOT FOLDER...

Lines are compared without white space. Blank lines, lines of brackets alone, includes, using-declarations and
namespaces count neither as lines nor as a difference.
"""

import re
import sys
from collections import defaultdict
from itertools import combinations
from pathlib import Path

from source_files import source_files

WINDOW = 6
SUFFIXES = {".cpp", ".h", ".glsl"}
TRIVIAL = re.compile(r"[\W_]*|#include.*|#pragmaonce|using[\w:=]+;|}?//namespace.*|}?namespace.*|public:|private:")


def significant_lines(text):
    """Pairs of line number and line without white space."""
    for number, line in enumerate(text.splitlines(), 1):
        bare = re.sub(r"\s+", "", line)
        if not TRIVIAL.fullmatch(bare):
            yield number, bare


def shared_runs(files):
    """Pairs of places (file, line number) at which maximal runs of WINDOW or more equal lines begin."""
    places = defaultdict(list)
    for file, lines in files.items():
        for at in range(len(lines) - WINDOW + 1):
            places[tuple(text for _, text in lines[at:at + WINDOW])].append((file, at))
    for group in places.values():
        for (a, i), (b, j) in combinations(group, 2):
            overlaps = a == b and abs(i - j) < WINDOW
            continues = i > 0 and j > 0 and files[a][i - 1][1] == files[b][j - 1][1]
            if not overlaps and not continues:
                yield (a, files[a][i][0]), (b, files[b][j][0])


def main():
    root, folders = Path(sys.argv[1]), sys.argv[2:]
    files, total = {}, 0
    for path in source_files(root, folders, SUFFIXES):
        text = (root / path).read_text()
        total += len(text.splitlines())
        files[path] = list(significant_lines(text))
    pairs = sorted(shared_runs(files))
    for (a, i), (b, j) in pairs:
        print(f"{a}:{i} and {b}:{j} share {WINDOW} lines or more")
    limit = total / 1000
    print(f"{len(pairs)} pairs in {total} lines; fewer than {limit:.1f} are allowed")
    sys.exit(0 if len(pairs) < limit else 1)


if __name__ == "__main__":
    main()
