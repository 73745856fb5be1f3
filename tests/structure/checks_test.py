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

    def test_many_arrows_are_found(self):
        names = [f"r{i:02}" for i in range(15)]
        tree = {f"bake/{name}/a.h": "".join(f'#include "bake/{low}/a.h"\n' for low in names[:i]) for i, name in enumerate(names)}
        code, output = self.check("\n".join(f"bake/{name}" for name in names), tree)
        self.assertEqual(code, 1)
        self.assertIn("105 arrows between the folders of bake/", output)

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


class Callbacks(unittest.TestCase):
    def check(self, declaration, user="bake/high/b.cpp"):
        return run("check_callbacks.py", {"bake/low/a.h": declaration, user: '#include "bake/low/a.h"\n'})

    def test_function_that_another_room_passes_is_found(self):
        code, output = self.check("int f(const std::function<bool(int)>& is_enough);")
        self.assertEqual(code, 1)
        self.assertIn("bake/low/a.h:1: passes a function to another room (bake/high/b.cpp includes it)", output)

    def test_functions_of_one_room_are_its_own(self):
        self.assertEqual(self.check("int f(std::function<bool(int)> g);", "bake/low/b.cpp")[0], 0)

    def test_progress_and_mathematics_are_accepted(self):
        self.assertEqual(self.check("std::function<void(const Progress&)> on_progress;\n"
                                    "double f(const std::function<double(double)>& p);")[0], 0)


class OwnHeader(unittest.TestCase):
    def check(self, source):
        return run("check_own_header.py", {"bake/a.h": "", "bake/b.h": "", "bake/a.cpp": source, "bake/main.cpp": ""}, "bake")[0]

    def test_first_is_accepted_and_another_is_found(self):
        self.assertEqual(self.check('// why\n#include "bake/a.h"\n#include "bake/b.h"\n'), 0)
        self.assertEqual(self.check('#include "bake/b.h"\n#include "bake/a.h"\n'), 1)
        self.assertEqual(self.check("#include <vector>\n"), 1)


class EffectNames(unittest.TestCase):
    TABLE = {"bake/effects/single/single.cpp": 'return "single";\n', "bake/effects/effects.cpp": '{"single", &kSingle},\n'}

    def test_own_folder_and_table_are_accepted(self):
        self.assertEqual(run("check_effect_names.py", self.TABLE)[0], 0)
        self.assertEqual(run("check_effect_names.py", {**self.TABLE, "formats/a.cpp": '"single"'})[0], 0)

    def check(self, text, others=None):
        return run("check_effect_names.py", {**self.TABLE, **(others or {}), "bake/plan/rules.cpp": text})

    def test_name_in_quotes_is_found(self):
        for line in ['if (effect == "single")', 'plan("single.terms")', '"multiple,single"', 'R"(single)"', 'R"x(single)x"', "c == '\"' || single"]:
            code, output = self.check("\n" + line)
            self.assertEqual(code, 1, line)
            self.assertIn('bake/plan/rules.cpp:2: knows of the effect "single"', output)

    def test_identifier_is_found(self):
        for line in ["double single = 0;", "a.single", "kSingle", "calibrate_single(b);", "SingleBatch b;", "SINGLE_RATE", "case Effect::single:"]:
            self.assertEqual(self.check(line)[0], 1, line)

    def test_include_is_found(self):
        code, output = self.check('#include "bake/effects/single/rates.h"', {"bake/effects/single/rates.h": ""})
        self.assertEqual(code, 1)
        self.assertIn("includes bake/effects/single/rates.h", output)
        relative = {"bake/effects/single/rates.h": "", "bake/effects/other/a.cpp": '#include "../single/rates.h"'}
        self.assertEqual(run("check_effect_names.py", {**self.TABLE, **relative})[0], 1)

    def test_file_name_is_found(self):
        self.assertEqual(run("check_effect_names.py", {**self.TABLE, "bake/plan/rule_single.h": ""})[0], 1)

    def test_other_words_comments_and_prose_are_accepted(self):
        for line in ["redirectsingles(singled);", "// single", "/* a\n single */ int x;", 'help("scattered a single time")', "thread_local int x;",
                     '"singles" "single-sided"']:
            tree = {"bake/effects/local/a.cpp": "", "bake/effects/direct/a.cpp": ""}
            self.assertEqual(self.check(line, tree), (0, "3 effects, each known to its folder and to the table alone\n"), line)

    def test_words_of_the_format_are_accepted_where_it_is_included(self):
        format = {"formats/terms.h": "enum class TermSet { single };", "bake/low/a.h": '#include "formats/terms.h"'}
        self.assertEqual(self.check('#include "bake/low/a.h"\nTermSet::single', format)[0], 0)
        self.assertEqual(self.check('#include "bake/low/a.h"\nEffect::single', format)[0], 1)
        self.assertEqual(self.check('#include "bake/low/a.h"\nkSingle', format)[0], 1)
        self.assertEqual(self.check("TermSet::single", format)[0], 1)

    def test_a_name_of_several_words_is_found_in_any_spelling(self):
        for line in ['"volume-single"', '"volume_single"', "kVolumeSingle"]:
            tree = {"bake/effects/volume_single/a.cpp": "", "bake/plan/rules.cpp": line}
            self.assertEqual(run("check_effect_names.py", tree)[0], 1, line)

    def test_a_name_of_a_subject_is_found_outside_its_constant(self):
        tree = {**self.TABLE, "bake/effects/volumes/volume_effects.h": 'inline constexpr std::string_view kOnce = "volume-once";\n'}
        self.assertEqual(run("check_effect_names.py", {**tree, "bake/pipeline/costs.cpp": "payer(kOnce)"})[0], 0)
        code, output = run("check_effect_names.py", {**tree, "bake/pipeline/costs.cpp": '\npayer("volume-once")'})
        self.assertEqual(code, 1)
        self.assertIn('bake/pipeline/costs.cpp:2: writes "volume-once", a constant of bake/effects/volumes/volume_effects.h', output)


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


class Documents(unittest.TestCase):
    TREE = {"README.md": "see bake/README.md and https://example.org/other.md", "bake/README.md": "../README.md, low/README.md",
            "bake/low/README.md": "", "bake/low/a.h": "// README.md, bake/README.md"}

    def test_names_from_root_and_folder_are_accepted(self):
        self.assertEqual(run("check_documents.py", self.TREE)[0], 0)

    def test_a_document_that_stands_elsewhere_is_found(self):
        code, output = run("check_documents.py", {**self.TREE, "bake/low/b.cpp": "\n// (theory.md 3)"})
        self.assertEqual(code, 1)
        self.assertIn("bake/low/b.cpp:2: names theory.md", output)

    def test_a_test_that_is_none_is_found(self):
        tests = {**self.TREE, "tests/a_test.cpp": "TEST(Body, IsRound) {\n}\nTEST_F(Body,\n       IsDense) {"}
        good = {**tests, "tests/README.md": "| Body.IsRound, low: Body.Is*, Body.* | Body.IsDense, Body.IsRound; see README.md |"}
        self.assertEqual(run("check_documents.py", good)[0], 0)
        for name in ["Body.WasRound", "Ball.IsRound", "Body.IsRou", "Body.Was*"]:
            code, output = run("check_documents.py", {**tests, "tests/README.md": f"one\n| {name} |"})
            self.assertEqual(code, 1, name)
            self.assertIn("tests/README.md:2: names " + name.rstrip("*"), output)


class TypeNames(unittest.TestCase):
    FIRST = {"bake/a/a.h": "namespace o::bake {\nstruct Node {\n    int x;\n};\n}\n"}

    def check(self, text):
        return run("check_type_names.py", {**self.FIRST, "bake/b/b.h": text}, "bake")

    def test_like_names_of_one_namespace_are_found(self):
        for text in ["namespace o::bake { class Node final { }; }", "namespace o { namespace bake {\nenum class Node : int { a };\n} }",
                     "namespace o::bake { void f() { } template <class T> struct alignas(8) Node : Base<T> { }; }"]:
            code, output = self.check(text)
            self.assertEqual(code, 1, text)
            self.assertIn("o::bake::Node is defined at bake/a/a.h:2 and bake/b/b.h:", output)

    def test_others_are_accepted(self):
        for text in ["namespace o::formats { struct Node { }; }", "namespace o::bake { namespace { struct Node { }; } }",
                     "namespace o::bake { struct Node; struct Tree { struct Node { }; }; }", "namespace o::bake { Node f(struct Node* n) { return *n; } }",
                     "// namespace o::bake { struct Node { }; }", 'namespace o::bake { auto s = "struct Node { }"; }']:
            self.assertEqual(self.check(text)[0], 0, text)


if __name__ == "__main__":
    unittest.main()
