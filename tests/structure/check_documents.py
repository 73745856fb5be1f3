#!/usr/bin/env python3
"""Checks that every .md file that a source or a document names stands in this repository: check_documents.py ROOT.

A name may begin at the root, at any folder, or at the folder of the file that names it.
"""

import re
import sys
from pathlib import Path, PurePosixPath

from source_files import CODE, source_files

FOLDERS = ["bake", "formats", "runtime", "examples", "tests"]
NAME = re.compile(r"[\w./-]*\w\.md\b(?!\w)")
ADDRESS = re.compile(r"\w+://\S+")


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
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
