#!/usr/bin/env python3
"""Checks that bake/ knows of an effect in its own folder and in the table alone: check_effect_names.py ROOT.

The effects are folders of bake/effects/. Elsewhere in bake/, comments and prose (a string of several words) aside:
  - no file and no identifier is called NAME or has NAME as a word of its own (kSingle, SingleBatch, add_single), except
    identifiers of a header of formats/ or runtime/ that the file includes (TermSet::single, material.gloss);
  - no string is NAME, a part of it ("single.terms") or a list with it ("multiple,single");
  - no header of the effect's folder is included.
What stands outside bake/ (the format, the runtime, tests) may name effects.

Effects of volumes, cloud layers and emitters have no folder each: a name is a constant (std::string_view kNAME = "...") of a header
named *_effects.h or plan_*.h in its room. These rooms and the pipeline write the name itself nowhere else.
"""

import re
import sys
from functools import cache
from pathlib import Path

from check_rooms import INCLUDE, included_file
from source_files import source_files

EFFECTS = Path("bake/effects")
NO_EFFECTS = {"volumes", "layers", "emitters", "rows"}  # subjects of their own, and effects at work
SUBJECT_ROOMS = ["bake/effects/volumes", "bake/effects/layers", "bake/exchange/lamps", "bake/effects/emitters"]
CONSTANT = re.compile(r'constexpr std::string_view k\w+ = "([^"]+)";')
TABLE = EFFECTS / "effects.h", EFFECTS / "effects.cpp"
SHARED = {"formats", "runtime"}  # their words are theirs, whoever uses them
COMMENT_OR_STRING = re.compile(r"""//[^\n]*|/\*.*?\*/|'(?:\\.|[^'\\\n])'|R"(\w*)\((.*?)\)\1"|"((?:\\.|[^"\\\n])*)\"""", re.DOTALL)
# Words of C++, of oneTBB (enumerable_thread_specific) and of nanoflann.
FOREIGN = re.compile(r"\bthread_local\b|\.local\(\)|\bnanoflann::\w+")
IDENTIFIER = re.compile(r"(?:\bEffect\s*::\s*)?\b[A-Za-z_]\w*")
WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


def words_of(identifier):
    """kSingleBatch -> {k, single, batch}."""
    return {word.lower() for word in WORD.findall(identifier)}


def has_word(identifier, name):
    return all(part in words_of(identifier) for part in name.split("_"))


def split(text):
    """The code without comments and strings, and pairs of offset and string. Offsets stay."""
    strings = []

    def blank(match):
        if match.re is COMMENT_OR_STRING and match.lastindex:
            strings.append((match.start(), match[match.lastindex]))
        return re.sub(r"[^\n]", " ", match[0])
    return FOREIGN.sub(blank, COMMENT_OR_STRING.sub(blank, text)), strings


def names_effect(string, name):
    """Whether a string that is no prose is the name, a part of it or a list with it."""
    spelling = re.escape(name).replace("_", "[_-]")
    return " " not in string and any(re.fullmatch(rf"{spelling}(\..*)?", word) for word in re.split("[,|]", string))


class Tree:
    def __init__(self, root):
        self.root = root
        self.text = cache(lambda file: (root / file).read_text())
        self.headers = cache(self._headers)
        self.identifiers = cache(lambda file: {m.split("::")[-1].strip() for m in IDENTIFIER.findall(split(self.text(file))[0])})

    def _headers(self, file):
        """What a file includes, directly."""
        found = (included_file(self.root, file, name) for name in INCLUDE.findall(self.text(file)))
        return {header for header in found if header}

    def shared_identifiers(self, file):
        """Those of the headers of formats/ and runtime/ that a file includes, directly or not."""
        seen, todo = set(), [file]
        while todo:
            new = self.headers(todo.pop()) - seen
            seen |= new
            todo += new
        return set().union(*(self.identifiers(header) for header in seen if header.parts[0] in SHARED))


def faults_of(tree, file, names):
    text = tree.text(file)
    code, strings = split(text)
    for name in names:
        if has_word(file.stem, name):
            yield 1, name, "is called so"
    for match in INCLUDE.finditer(text):
        header = included_file(tree.root, file, match[1])
        for name in names:
            if header and EFFECTS / name in header.parents:
                yield text.count("\n", 0, match.start(1)) + 1, name, f"includes {header}"
    for offset, string in strings:
        for name in names:
            if names_effect(string, name):
                yield text.count("\n", 0, offset) + 1, name, f'"{string}"'
    shared = None
    for match in IDENTIFIER.finditer(code):
        for name in names:
            if has_word(match[0].split("::")[-1], name):
                shared = tree.shared_identifiers(file) if shared is None else shared
                if match[0] not in shared:
                    yield code.count("\n", 0, match.start()) + 1, name, match[0]


def faults(root, names):
    tree = Tree(root)
    for file in source_files(root, ["bake"]):
        if file not in TABLE:
            others = [name for name in names if EFFECTS / name not in file.parents]
            for number, name, what in sorted(set(faults_of(tree, file, others))):
                yield f'{file}:{number}: knows of the effect "{name}": {what}'


def faults_of_subjects(root):
    texts = {file: (root / file).read_text() for file in source_files(root, [*SUBJECT_ROOMS, "bake/pipeline"])}
    homes = {name: file for file, text in texts.items() if re.fullmatch(r"(.*_effects|plan_.*)\.h", file.name)
             for name in CONSTANT.findall(text)}
    for file, text in texts.items():
        for offset, string in split(text)[1]:
            if homes.get(string, file) != file:
                number = text.count("\n", 0, offset) + 1
                yield f'{file}:{number}: writes "{string}", a constant of {homes[string]}'


def main():
    root = Path(sys.argv[1])
    names = sorted(path.name for path in (root / EFFECTS).glob("*/") if path.name not in NO_EFFECTS)
    if not names:
        print("SKIPPED: there is no folder in bake/effects")
        return
    found = [*faults(root, names), *faults_of_subjects(root)]
    print("\n".join(found) or f"{len(names)} effects, each known to its folder and to the table alone")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
