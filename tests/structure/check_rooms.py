#!/usr/bin/env python3
"""Checks that includes between the rooms of bake/, formats/ and runtime/ go one way: check_rooms.py ROOT [ROOMS].

rooms.txt lists the rooms from the lowest to the highest. Because a room includes earlier ones alone,
the graph has no circle. Between the folders of bake/ go fewer than MOST_ARROWS arrows.
"""

import os
import re
import sys
from pathlib import Path

from source_files import source_files

FOLDERS = ["formats", "runtime", "bake"]
MOST_ARROWS = 90  # one for each pair of folders of bake/ of which one includes the other
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def read_rooms(path):
    """Room -> the rooms that it may include, itself among them; in the order of the file."""
    rooms = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        room, rule = words[0], words[1:]
        if room in rooms:
            sys.exit(f"{path}:{number}: {room} is listed twice")
        if rule and rule[0] != "only":
            sys.exit(f"{path}:{number}: expected 'only' after {room}, found '{rule[0]}'")
        for allowed in rule[1:]:
            if allowed not in rooms:
                sys.exit(f"{path}:{number}: {room} may only use rooms above it, not {allowed}")
        rooms[room] = {room, *(rule[1:] if rule else rooms)}
    return rooms


def room_of(file, rooms):
    """The longest room that `file` lies in: a folder, or the start of the file's name."""
    def holds(room):
        rest = file.as_posix().removeprefix(room)
        return rest != file.as_posix() and rest[0] in "/._"
    return max(filter(holds, rooms), key=len, default=None)


def included_file(root, file, name):
    """The file of ours that `#include "name"` in `file` means, or None for a library's."""
    for candidate in (Path(os.path.normpath(file.parent / name)), Path(name)):
        if (root / candidate).is_file():
            return candidate
    return None


def faults(root, rooms):
    used = set()
    for file in source_files(root, FOLDERS):
        room = room_of(file, rooms)
        if room is None or (room in FOLDERS and file.parent.as_posix() != room):
            yield f"{file}: its folder is not listed"
            continue
        used.add(room)
        for name in INCLUDE.findall((root / file).read_text()):
            target = included_file(root, file, name)
            if target is None or target.parts[0] not in FOLDERS:
                continue
            other = room_of(target, rooms)
            if other is not None and other not in rooms[room]:
                yield f"{file}: {room} may not include {target} ({other})"
    for room in rooms:
        if room not in used:
            yield f"{room} is listed and has no file"


def arrows(root):
    """Pairs of folders of bake/, the first of which includes the second."""
    pairs = set()
    for file in source_files(root, ["bake"]):
        for name in INCLUDE.findall((root / file).read_text()):
            target = included_file(root, file, name)
            if target is not None and target.parts[0] == "bake" and target.parts[1] != file.parts[1]:
                pairs.add((file.parts[1], target.parts[1]))
    return pairs


def main():
    root = Path(sys.argv[1])
    rooms = read_rooms(Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).parent / "rooms.txt")
    found = list(faults(root, rooms))
    count = len(arrows(root))
    if count >= MOST_ARROWS:
        found.append(f"{count} arrows between the folders of bake/, not fewer than {MOST_ARROWS}")
    print("\n".join(found) or f"{len(rooms)} rooms, {count} arrows between folders of bake/, every include goes down")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
