"""The source files that the structure tests read."""

from pathlib import Path

CODE = {".h", ".hpp", ".c", ".cpp", ".glsl"}


def source_files(root, folders, suffixes=CODE):
    """Paths below `folders` of `root`, relative to `root`, in a fixed order."""
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and path.suffix in suffixes:
                yield path.relative_to(root)
