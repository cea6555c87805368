#!/usr/bin/env python3
"""The commands that make the thesis' tables and figures anew, as their users call them, at a tiny size.

usage: thesis_commands_test.py PATH_OF_LIGHTWELL [unittest's arguments]
"""

import json
import unittest
import xml.etree.ElementTree

from command_line_test import CommandLineTest, FAILED, WRONG_USAGE, jpeg_size, png_size


class BenchThesisTest(CommandLineTest):
    def bench(self, *arguments, **keywords):
        return self.run_lightwell("bench", "thesis", "--side", "64", "--frames", "2", *arguments, **keywords)

    def test_rows_and_cost_as_text_json_and_plot(self):
        run = self.bench("--rows", "1,21", "--most-triangles", "6000", "--json", "b.json", "--plot", "b.svg")
        for part in ["Table 6.1", "Table 6.2", "11.98", "8.53", "2 rows", "Cost against triangles", "5832", "by brute force"]:
            self.assertIn(part, run.stdout)
        found = json.loads((self.folder / "b.json").read_text())
        self.assertEqual([(1, 64), (21, 16)], [(row["row"], row["indirect_size"]) for row in found["rows"]])
        for row in found["rows"]:
            self.assertEqual(2, row["frames"])
            self.assertAlmostEqual(row["ratio"], row["frames_per_s"] / row["printed_frames_per_s"])
            pixels = row["indirect_size"] ** 2
            self.assertAlmostEqual(row["rays_resolved_per_s"], pixels * row["samples"] * row["frames_per_s"], delta=1)
            self.assertGreaterEqual(row["rays_resolved_per_s"], row["rays_traced_per_s"])
            self.assertGreater(row["rays_traced_per_s"], 0)
            self.assertIn("trace", [stage["name"] for stage in row["stages"]])
        self.assertEqual([1458, 5832], [one["triangles"] for one in found["cost_against_triangles"]])
        curves = xml.etree.ElementTree.parse(self.folder / "b.svg").findall(".//{*}polyline")
        self.assertEqual(7, len(curves))
        brute_force = [one["brute_force"] for one in found["cost_against_triangles"]]
        self.assertTrue(all(one["tracing_ms"] > 0 for one in brute_force))

    def test_a_spent_budget_leaves_one_frame(self):
        self.bench("--rows", "3", "--most-triangles", "0", "--budget", "0", "--json", "b.json")
        found = json.loads((self.folder / "b.json").read_text())
        self.assertEqual([1], [row["frames"] for row in found["rows"]])
        self.assertEqual([], found["cost_against_triangles"])

    def test_settings_reach_the_renderer(self):
        self.bench("--rows", "3", "--most-triangles", "0", "--bounces", "0", "--json", "b.json")
        row = json.loads((self.folder / "b.json").read_text())["rows"][0]
        self.assertEqual(0, row["rays_traced_per_s"])

    def test_wrong_usage(self):
        for wrong in [["--rows", "37"], ["--rows", "x"], ["--side", "31"], ["--frames", "0"], ["--budget", "-1"],
                      ["--plot", "b.png"], ["--samples", "4"], ["--bounces", "inf"],
                      ["--tracer", "magic"], ["--most-triangles", "-1"]]:
            run = self.bench(*wrong, code=WRONG_USAGE)
            self.assertIn(wrong[0], run.stderr)
        self.assertIn("none", self.bench("--json", "none/b.json", code=FAILED).stderr)


class FiguresTest(CommandLineTest):
    def figures(self, *arguments, **keywords):
        return self.run_lightwell("figures", *arguments, "--side", "64", **keywords)

    def test_single_pictures_and_sheets(self):
        run = self.figures("new/folder", "--only", "6.1,6.6")
        self.assertIn("2 figures in new/folder", run.stderr)
        folder = self.folder / "new/folder"
        expected = ["figure-6.1-direct.png", "figure-6.1.png", "figure-6.1-small.jpg", "figure-6.6.png",
                    "figure-6.6-small.jpg"]
        expected += [f"figure-6.1-{samples}-samples-indirect-{side}.png" for samples in [32, 64]
                     for side in [512, 256, 128]]
        expected += [f"figure-6.6-{moment}s-{part}.png" for moment in [0, 3, 6, 9]
                     for part in ["direct", "indirect", "both"]]
        self.assertEqual(sorted(expected), sorted(path.name for path in folder.iterdir()))
        self.assertEqual((64, 64), png_size(folder / "figure-6.1-direct.png"))
        width, height = png_size(folder / "figure-6.1.png")
        self.assertGreater(width, 3 * 64)
        self.assertGreater(height, 3 * 64)
        self.assertEqual((width, height), jpeg_size(folder / "figure-6.1-small.jpg"))

    def test_all_pictures_of_a_figure_are_exposed_alike(self):
        # Direct and indirect light add up to both only where no picture has an exposure of its own.
        self.figures("out", "--only", "6.5", "--shadow-size", "64")
        light = {part: self.mean_light(f"out/figure-6.5-6s-{part}.png") for part in ["direct", "indirect", "both"]}
        for channel in range(3):
            self.assertLess(light["direct"][channel], light["both"][channel])
            self.assertLess(light["indirect"][channel], light["both"][channel])

    def test_more_indirect_light_with_more_bounces(self):
        for bounces in [0, 3]:
            self.figures(f"out{bounces}", "--only", "6.3", "--bounces", bounces)
        name = "figure-6.3-32-samples-indirect-128.png"
        direct = (self.folder / "out0/figure-6.3-direct.png").read_bytes()
        self.assertEqual(direct, (self.folder / "out0" / name).read_bytes(), "without bounces only direct light is left")
        self.assertNotEqual(direct, (self.folder / "out3" / name).read_bytes())

    def test_wrong_usage(self):
        for wrong in [["--only", "6.7"], ["--samples", "4"], ["--bounces", "inf"], ["--tracer", "magic"]]:
            self.assertIn(wrong[0], self.figures("out", *wrong, code=WRONG_USAGE).stderr)
        self.run_lightwell("figures", code=WRONG_USAGE)
        self.run_lightwell("figures", "out", "--side", "5000", code=WRONG_USAGE)
        (self.folder / "file").write_text("")
        self.assertIn("file", self.figures("file", code=FAILED).stderr)


if __name__ == "__main__":
    unittest.main()
