#!/usr/bin/env python3
"""What a ctest run found: tests that failed, and those skipped, by reason.

summarise_results.py RESULTS.xml, as written by ctest --output-junit with --test-output-size-passed large enough
that no output is cut. Exit code 1 where a test failed.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import defaultdict

# GoogleTest prints "FILE:LINE: Skipped", the reason, and the name of the test.
GOOGLETEST_SKIP = re.compile(r": Skipped\n(.*?)\n+\[  SKIPPED \] (\S+) \(", re.DOTALL)
SCRIPT_SKIP = re.compile(r"^SKIPPED: (.*)", re.MULTILINE)


def skipped_cases(test):
    """Yields (name, reason). A program that runs many cases names each of them."""
    output = test.findtext("system-out") or ""
    found = GOOGLETEST_SKIP.findall(output)
    for reason, name in found:
        yield name, reason.strip()
    if not found and test.get("status") in ("notrun", "disabled"):
        said = SCRIPT_SKIP.search(output)
        yield test.get("name"), said.group(1) if said else "not run"


def main():
    tests = list(ElementTree.parse(sys.argv[1]).getroot().iter("testcase"))
    failed = [test.get("name") for test in tests if test.get("status") == "fail"]
    skipped = defaultdict(list)
    for test in tests:
        for name, reason in skipped_cases(test):
            skipped[reason].append(name)

    count = sum(map(len, skipped.values()))
    print(f"{len(tests)} tests: {len(failed)} failed, {count} skipped{':' if skipped else '.'}")
    for reason, names in sorted(skipped.items()):
        print(f"  {reason}:")
        for name in names:
            print(f"    {name}")
    for name in failed:
        print(f"  FAILED: {name}")
    sys.exit(1 if failed else 0)


main()
