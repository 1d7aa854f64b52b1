#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of links.py on made-up trees."""
import os
import tempfile
import unittest

from apart import faults
from links import folder_circle, read_targets, violations

TARGETS = """low|a/low.cpp|Eigen3::Eigen|
inner|b/inner.cpp||mh::low
high|c/high.cpp;c/deep/more.cpp|mh::low|mh::inner
"""


class Violations(unittest.TestCase):
    def found(self, files, targets=TARGETS):
        with tempfile.TemporaryDirectory() as root:
            for file, header in files.items():
                os.makedirs(os.path.join(root, os.path.dirname(file)), exist_ok=True)
                with open(os.path.join(root, file), "w", encoding="utf-8") as text:
                    text.write(f'#pragma once\n#include "{header}"\n#include <{header}>\n')
            return violations(read_targets(targets), root)

    def test_what_is_linked_may_be_included(self):
        self.assertEqual(self.found({"c/high.cpp": "a/low.hpp", "c/deep/more.hpp": "b/only.hpp",
                                     "b/inner.hpp": "a/low.hpp", "a/low.cpp": "a/low.hpp",
                                     "a/low.hpp": "elsewhere/other.hpp"}), [])

    def test_an_include_against_a_link_line_is_found(self):
        self.assertEqual(self.found({"a/low.hpp": "b/inner.hpp", "a/only.hpp": "c/deep/only.hpp",
                                     "b/inner.cpp": "a/low.hpp"}),
                         ["a/low.hpp of low includes b/inner.hpp of inner",
                          "a/only.hpp of low includes c/deep/only.hpp of high"])

    def test_a_private_link_hands_nothing_on(self):
        targets = TARGETS + "top|d/top.cpp|mh::high|\n"
        self.assertEqual(self.found({"d/top.cpp": "b/inner.hpp"}, targets),
                         ["d/top.cpp of top includes b/inner.hpp of inner"])

    def test_of_a_folder_with_two_targets_a_header_is_the_one_that_may(self):
        targets = TARGETS + "shared|a/shared.cpp|mh::high|\n"
        self.assertEqual(self.found({"a/only.hpp": "c/high.hpp"}, targets), [])
        self.assertEqual(len(self.found({"a/low.hpp": "c/high.hpp"}, targets)), 1)

    def test_a_circle_of_links_is_found(self):
        targets = TARGETS.replace("Eigen3::Eigen|", "Eigen3::Eigen|mh::high")
        self.assertEqual(self.found({}, targets), ["circle: low -> high -> low"])

    def test_a_navigation_that_reaches_the_truth_is_found(self):
        apart = "core|a.cpp||\nscenes|b.cpp|mh::core|\nrobots|c.cpp|mh::core|\n"
        with tempfile.TemporaryDirectory() as root:
            os.makedirs(os.path.join(root, "robots/navigation"))
            drive = os.path.join(root, "robots/navigation/drive.cpp")
            with open(drive, "w", encoding="utf-8") as text:
                text.write('#include "slam/core/se3.hpp"\n')
            self.assertEqual(faults(read_targets(apart), root), [])
            targets = read_targets(apart.replace("c.cpp|mh::core|", "c.cpp||mh::scenes"))
            self.assertEqual(faults(targets, root), ["robots links scenes"])
            with open(drive, "w", encoding="utf-8") as text:
                text.write('#include "scenes/scene.hpp"\n')
            self.assertEqual(faults(targets, root)[1:],
                             ["robots/navigation/drive.cpp includes scenes/scene.hpp"])

    def test_a_circle_of_folders_is_found(self):
        with tempfile.TemporaryDirectory() as root:
            for file, header in (("slam/a/x.hpp", "slam/b/y.hpp"), ("slam/b/y.hpp", "slam/c/z.hpp"),
                                 ("slam/c/z.cpp", "slam/c/w.hpp")):
                os.makedirs(os.path.join(root, os.path.dirname(file)), exist_ok=True)
                with open(os.path.join(root, file), "w", encoding="utf-8") as text:
                    text.write(f'#include "{header}"\n')
            self.assertEqual(folder_circle(root), [])
            with open(os.path.join(root, "slam/c/z.cpp"), "a", encoding="utf-8") as text:
                text.write('#include "slam/a/x.hpp"\n')
            self.assertEqual(folder_circle(root), ["slam/a", "slam/b", "slam/c", "slam/a"])


if __name__ == "__main__":
    unittest.main()
