#!/usr/bin/env python3
"""The structure checks find what they look for: each is run on small trees that hold a fault, and on ones that do not."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).parent


def run(check, files, *arguments):
    """Exit code and output of a check on a tree of files (path -> text)."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            file = Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        done = subprocess.run([sys.executable, HERE / check, folder, *(a.replace("ROOT", folder) for a in arguments)],
                              capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class Rooms(unittest.TestCase):
    def check(self, rooms, files):
        sources = {"rooms.txt": rooms, **files}
        return run("check_rooms.py", sources, "ROOT/rooms.txt")

    TREE = {"bake/low/a.h": "", "bake/high/b.cpp": '#include "bake/low/a.h"\n#include <vector>\n'}

    def test_downward_is_accepted(self):
        self.assertEqual(self.check("bake/low\nbake/high", self.TREE)[0], 0)

    def test_upward_is_found(self):
        code, output = self.check("bake/high\nbake/low", self.TREE)
        self.assertEqual(code, 1)
        self.assertIn("bake/high/b.cpp: bake/high may not include bake/low/a.h", output)

    def test_include_relative_to_the_file_is_found(self):
        tree = {"bake/low/a.h": '#include "../high/b.h"\n', "bake/high/b.h": ""}
        self.assertEqual(self.check("bake/low\nbake/high", tree)[0], 1)

    def test_only_narrows(self):
        tree = {"formats/gltf/a.h": "", "runtime/b.h": '#include "formats/gltf/a.h"\n'}
        self.assertEqual(self.check("formats/gltf\nruntime", tree)[0], 0)
        self.assertEqual(self.check("formats/gltf\nruntime only", tree)[0], 1)

    def test_one_file_may_stand_elsewhere(self):
        tree = {"bake/low/a.h": "", "bake/low/late.h": '#include "bake/high/b.h"\n', "bake/high/b.h": '#include "bake/low/a.h"\n'}
        self.assertEqual(self.check("bake/low\nbake/high", tree)[0], 1)
        self.assertEqual(self.check("bake/low\nbake/high\nbake/low/late", tree)[0], 0)

    def test_unlisted_and_empty_rooms_are_found(self):
        self.assertEqual(self.check("bake\nbake/low", {**self.TREE, "bake/c.h": ""})[0], 1)
        self.assertEqual(self.check("bake/low\nbake/high\nbake/gone", self.TREE)[0], 1)


class EffectNames(unittest.TestCase):
    TABLE = {"bake/effects/single/single.cpp": 'return "single";\n', "bake/effects/effects.cpp": '{"single", &kSingle},\n'}

    def test_own_folder_and_table_are_accepted(self):
        self.assertEqual(run("check_effect_names.py", self.TABLE)[0], 0)
        self.assertEqual(run("check_effect_names.py", {**self.TABLE, "formats/a.cpp": '"single"'})[0], 0)

    def test_name_elsewhere_is_found(self):
        for line in ['if (effect == "single")', 'plan("single.terms")']:
            code, output = run("check_effect_names.py", {**self.TABLE, "bake/plan/rules.cpp": line})
            self.assertEqual(code, 1)
            self.assertIn("bake/plan/rules.cpp:1", output)

    def test_dash_and_underscore_are_one_name(self):
        tree = {"bake/effects/volume_single/a.cpp": "", "bake/plan/rules.cpp": '"volume-single"'}
        self.assertEqual(run("check_effect_names.py", tree)[0], 1)


class Duplicates(unittest.TestCase):
    SIX = "".join(f"int value_{i} = {i};\n" for i in range(6))

    def test_six_lines_are_found_whatever_their_indent(self):
        code, output = run("check_duplicates.py", {"bake/a.cpp": self.SIX, "bake/b.cpp": self.SIX.replace("int", "  int ")}, "bake")
        self.assertEqual(code, 1)
        self.assertIn("bake/a.cpp:1 and bake/b.cpp:1", output)

    def test_a_longer_run_is_one_pair(self):
        text = self.SIX + "\n" + self.SIX.replace("value", "other")
        self.assertIn("1 pairs in", run("check_duplicates.py", {"bake/a.cpp": text, "bake/b.cpp": text}, "bake")[1])

    def test_five_lines_and_includes_are_not(self):
        five = "".join(self.SIX.splitlines(True)[:5])
        includes = "".join(f'#include "bake/{i}.h"\n' for i in range(9))
        tree = {"bake/a.cpp": includes + five, "bake/b.cpp": includes + five}
        self.assertIn("0 pairs in", run("check_duplicates.py", tree, "bake")[1])


if __name__ == "__main__":
    unittest.main()
