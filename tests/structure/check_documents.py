#!/usr/bin/env python3
"""Checks that what documents name is there: check_documents.py ROOT.

Every .md file that a source or a document names stands in this repository; a name may begin at the root, at any folder,
or at the folder of the file that names it. Every test (Suite.Name, Suite.Part*) that a document below tests/ names is one.
"""

import re
import sys
from pathlib import Path, PurePosixPath

from source_files import CODE, source_files

FOLDERS = ["bake", "formats", "runtime", "examples", "tests"]
NAME = re.compile(r"[\w./-]*\w\.md\b(?!\w)")
ADDRESS = re.compile(r"\w+://\S+")
TEST = re.compile(r"^TEST(?:_[FP])?\((\w+),\s*(\w+)\)", re.MULTILINE)
NAME_OF_TEST = re.compile(r"\b([A-Z]\w+\.(?:[A-Z]\w+|(?=\*(?!\*))))(\*?)")


def check_tests(root):
    """Number of tests that documents name and that are none."""
    sources = (root / path for path in source_files(root, ["tests"], {".cpp"}))
    tests = {".".join(name) for source in sources for name in TEST.findall(source.read_text(errors="replace"))}
    missing = 0
    for path in source_files(root, ["tests"], {".md"}):
        for number, line in enumerate((root / path).read_text(errors="replace").splitlines(), 1):
            for name, open_end in NAME_OF_TEST.findall(line):
                if name not in tests and not (open_end and any(test.startswith(name) for test in tests)):
                    print(f"{path}:{number}: names {name}, which is no test")
                    missing += 1
    return missing


def main():
    root = Path(sys.argv[1])
    files = [*source_files(root, FOLDERS, CODE | {".md", ".py", ".sh", ".txt"}), Path("README.md")]
    documents = ["/" + str(path) for path in [*source_files(root, FOLDERS, {".md"}), Path("README.md")]]
    missing = 0
    for path in files:
        if path.parts[:2] == ("tests", "structure") or not (root / path).is_file():
            continue
        for number, line in enumerate((root / path).read_text(errors="replace").splitlines(), 1):
            for name in NAME.findall(ADDRESS.sub("", line)):
                bare = PurePosixPath("/", *(part for part in PurePosixPath(name).parts if part not in {"..", "."}))
                if (root / path.parent / name).is_file() or any(d.endswith(str(bare)) for d in documents):
                    continue
                print(f"{path}:{number}: names {name}, which is not in the repository")
                missing += 1
    print(f"{len(documents)} documents; {missing} names of others")
    wrong = check_tests(root)
    print(f"{wrong} names of tests that are none")
    sys.exit(1 if missing or wrong else 0)


if __name__ == "__main__":
    main()
