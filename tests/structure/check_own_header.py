#!/usr/bin/env python3
"""Checks that a source includes the header of its own name before any other: check_own_header.py ROOT FOLDER...

A header that stands first needs nothing from whoever includes it. tests/headers compiles each header by itself.
"""

import re
import sys
from pathlib import Path

from source_files import source_files


def main():
    root = Path(sys.argv[1])
    faults = []
    for file in source_files(root, sys.argv[2:], {".cpp"}):
        own = file.with_suffix(".h")
        if not (root / own).exists():
            continue
        first = re.search(r'^#include\s+(\S+)', (root / file).read_text(), re.MULTILINE)
        if first is None or first[1] != f'"{own}"':
            faults.append(f'{file}: the first include is {first[1] if first else "none"} (make it "{own}")')
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


main()
