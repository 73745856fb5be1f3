#!/usr/bin/env python3
"""Checks that no two types of one namespace share a name: check_type_names.py ROOT FOLDER...

Two definitions of a type in one program are undefined behaviour unless they are the same text, and no compiler or
linker says so while no source includes both: each room's inline functions may then be taken for the other's. Types of
anonymous namespaces and types within types are left alone.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

from check_effect_names import split
from source_files import source_files

TOKEN = re.compile(
    r"(?P<space>(?:inline\s+)?\bnamespace(?:\s+(?P<name>[\w:]+))?\s*\{)"
    r"|(?P<c>\bextern\s*\{)"
    r"|\b(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?:alignas\([^)]*\)\s+)?(?P<type>[A-Za-z_]\w*)(?:\s+final)?\s*(?::(?!:)[^;{]*)?\{"
    r"|(?P<open>\{)|(?P<close>\})")


def types_of(text):
    """(namespace, name, line) of each type defined at the scope of a named namespace."""
    code, _ = split(text)
    stack = []  # names of namespaces, "" for an anonymous one, None for any other brace
    for match in TOKEN.finditer(code):
        if match["close"]:
            if stack:
                stack.pop()
            continue
        if match["type"] and all(stack):
            yield "::".join(stack), match["type"], code.count("\n", 0, match.start()) + 1
        stack.append((match["name"] or "") if match["space"] else "extern" if match["c"] else None)


def faults(root, folders):
    places = defaultdict(list)
    for file in source_files(root, folders, {".h", ".hpp", ".c", ".cpp"}):
        for space, name, line in types_of((root / file).read_text()):
            places[space, name].append(f"{file}:{line}")
    for (space, name), where in sorted(places.items()):
        if len(where) > 1:
            yield f"{space}::{name} is defined at {' and '.join(where)}: give one of them another name"


def main():
    found = list(faults(Path(sys.argv[1]), sys.argv[2:]))
    print("\n".join(found) or "every type of a namespace has a name of its own")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
