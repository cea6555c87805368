#!/usr/bin/env python3
"""The program as its users call it: every option's good and bad use, exit codes, and what is written.

usage: command_line_test.py PATH_OF_LIGHTWELL [unittest's arguments]
"""

import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

LIGHTWELL = Path(sys.argv.pop(1)).resolve()
DONE, FAILED, WRONG_USAGE, BAD_INPUT, NO_DEVICE = 0, 1, 2, 3, 4
SMALL = ["--size", "48x32", "--indirect-size", "16", "--samples", "4"]


def png_size(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and data[12:16] == b"IHDR"
    return struct.unpack(">II", data[16:24])


def jpeg_size(path):
    data = path.read_bytes()
    assert data[:2] == b"\xff\xd8"
    at = 2
    while not 0xC0 <= data[at + 1] <= 0xC3:
        at += 2 + struct.unpack(">H", data[at + 2:at + 4])[0]
    height, width = struct.unpack(">HH", data[at + 5:at + 9])
    return width, height


def exr_attributes(path):
    """The attributes of an OpenEXR header: name -> raw bytes."""
    data = path.read_bytes()
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        kind_end = data.index(b"\0", name_end + 1)
        size = struct.unpack("<I", data[kind_end + 1:kind_end + 5])[0]
        attributes[data[at:name_end].decode()] = data[kind_end + 5:kind_end + 5 + size]
        at = kind_end + 5 + size
    return attributes


def exr_size(path):
    left, top, right, bottom = struct.unpack("<iiii", exr_attributes(path)["dataWindow"])
    return right - left + 1, bottom - top + 1


class CommandLineTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_lightwell(self, *arguments, code=DONE, env=None):
        run = subprocess.run([LIGHTWELL, *map(str, arguments)], capture_output=True, text=True, timeout=120,
                             env={**os.environ, **(env or {})}, cwd=self.folder, check=False)
        self.assertEqual(code, run.returncode, f"{' '.join(map(str, arguments))}\n{run.stdout}\n{run.stderr}")
        if code != DONE:
            self.assertNotEqual("", run.stderr.strip(), f"{arguments}: an error without a message")
        return run

    def render(self, file, *arguments, scene="builtin:cornell", **keywords):
        return self.run_lightwell("render", scene, "-o", file, *SMALL, *arguments, **keywords)

    def mean_light(self, file):
        run = self.run_lightwell("compare", file, file, "--json")
        return json.loads(run.stdout)["reference_mean"]


class HelpTest(CommandLineTest):
    def test_help_and_version(self):
        self.assertIn("render", self.run_lightwell("--help").stdout)
        self.assertIn("Exit codes", self.run_lightwell("--help").stdout)
        self.assertIn("lightwell ", self.run_lightwell("--version").stdout)
        for command, option in [("serve", "--port"), ("render", "--indirect-size"), ("devices", "--json"),
                                ("compare", "--heatmap"), ("bench", "thesis"),
                                ("figures", "--only")]:
            self.assertIn(option, self.run_lightwell(command, "--help").stdout)

    def test_serve_begins_with_realtime_and_render_with_thesis(self):
        for command, method, samples in [("serve", "realtime", 64), ("render", "thesis", 32)]:
            words = self.run_lightwell(command, "--help").stdout
            self.assertIn(f"={method}\n", words)
            self.assertIn(f"--samples N={samples} ", words)

    def test_wrong_commands(self):
        for arguments in [[], ["paint"], ["--nonsense"], ["devices", "extra"], ["bench"], ["bench", "none"], ["serve", "a.glb", "b.glb"]]:
            self.run_lightwell(*arguments, code=WRONG_USAGE)


class UsageTest(CommandLineTest):
    def test_bad_options_of_render(self):
        for wrong in [["--size", "48"], ["--size", "0x9"], ["--size", "16385x1"], ["--method", "magic"],
                      ["--samples", "0"], ["--samples", "4097"], ["--samples", "many"], ["--bounces", "-1"],
                      ["--bounces", "65"], ["--indirect-size", "7"], ["--estimator", "wrong"], ["--spp", "0"],
                      ["--patch", "3"], ["--patch", "0"], ["--patch", "17"], ["--triangle-groups", "0"],
                      ["--triangle-groups", "65"], ["--normal-threshold", "1.1"], ["--depth-threshold", "-0.1"],
                      ["--depth-threshold", "nan"], ["--firefly-clamp", "-1"], ["--firefly-clamp", "1000001"], ["--similarity", "none"], ["--view-index", "-1"],
                      ["--shadow-size", "63"], ["--shadow-filter", "4"], ["--time", "-1"], ["--time", "nan"],
                      ["--fps", "24"], ["--frames", "4:1"], ["--frames", "0:3"], ["--camera", "-1"],
                      ["--camera", "0", "--eye", "0,0,1", "--target", "0,0,0"], ["--eye", "0,0,1"],
                      ["--target", "0,0,1"], ["--yfov", "45"], ["--target", "0,0,1,5", "--eye", "0,0,1"],
                      ["--eye", "0,0,1", "--target", "0,0,0", "--yfov", "180"], ["--background", "1,1"],
                      ["--background", "-1,0,0"], ["--view", "sideways"], ["--exposure", "bright"],
                      ["--tone-map", "purple"], ["--seed", "-1"], ["--seed", "4294967296"], ["--device", "gpu"],
                      ["--environment-strength", "-1"], ["--environment-rotation", "north"],
                      ["--tracer", "magic"], ["--unknown"], ["--samples", "4", "--samples", "8"]]:
            run = self.run_lightwell("render", "builtin:cornell", "-o", "a.png", *wrong, code=WRONG_USAGE)
            self.assertTrue(any(word in run.stderr for word in wrong if word.startswith("--")), run.stderr)
        self.assertFalse((self.folder / "a.png").exists())

    def test_missing_arguments_of_render(self):
        self.run_lightwell("render", code=WRONG_USAGE)
        self.run_lightwell("render", "builtin:cornell", code=WRONG_USAGE)
        self.run_lightwell("render", "-o", "a.png", code=WRONG_USAGE)

    def test_bad_outputs(self):
        for file in ["a", "a.gif", "a.exr.txt"]:
            self.run_lightwell("render", "builtin:cornell", "-o", file, code=WRONG_USAGE)
        for file in ["a.png", "%s.png", "%d%d.png"]:
            self.run_lightwell("render", "builtin:cornell", "-o", file, "--frames", "0:1", code=WRONG_USAGE)
        run = self.run_lightwell("render", "builtin:cornell", "-o", "none/a.png", code=FAILED)
        self.assertIn("none", run.stderr)

    def test_bad_options_of_serve(self):
        for wrong in [["--port", "65536"], ["--port", "http"], ["--quality", "0"], ["--device", "gpu"],
                      ["--max-sessions", "0"], ["--max-upload", "0"], ["--web-client", "/no/such/folder"],
                      ["--session-idle", "0"], ["--samples", "0"]]:
            run = self.run_lightwell("serve", *wrong, code=WRONG_USAGE)
            self.assertIn(wrong[0], run.stderr, wrong)

    def test_a_camera_that_the_scene_lacks(self):
        run = self.render("a.png", "--camera", "99", code=WRONG_USAGE)
        self.assertIn("99", run.stderr)


class InputTest(CommandLineTest):
    def refuse(self, name, content=None):
        path = self.folder / name
        if content is not None:
            path.write_bytes(content)
        run = self.render("a.png", scene=path, code=BAD_INPUT)
        self.assertIn(name, run.stderr)
        self.assertFalse((self.folder / "a.png").exists())

    def test_scenes_that_are_not_there(self):
        self.refuse("none.glb")
        run = self.render("a.png", scene="builtin:nothing", code=BAD_INPUT)
        self.assertIn("cornell", run.stderr, "names the scenes that exist")

    def test_malformed_files(self):
        header = struct.pack("<4sII", b"glTF", 2, 5000)
        self.refuse("empty.glb", b"")
        self.refuse("noise.glb", bytes(range(256)) * 8)
        self.refuse("cut.glb", header)
        self.refuse("chunk.glb", header + struct.pack("<I4s", 0xFFFFFFFF, b"JSON") + b"{}")
        self.refuse("text.gltf", b"{ this is no JSON")
        self.refuse("list.gltf", b"[]")
        self.refuse("old.gltf", b'{"asset":{"version":"1.0"}}')
        self.refuse("outside.gltf", b'{"asset":{"version":"2.0"},"buffers":[{"uri":"../../etc/passwd","byteLength":9}]}')

    def test_environments_that_are_no_light(self):
        infinite = b"PF\n2 1\n-1.0\n" + struct.pack("<6f", 1, 1, 1, float("inf"), 1, 1)
        for name, content in [("none.hdr", None), ("text.hdr", b"no picture"), ("empty.exr", b""), ("sky.pfm", infinite)]:
            if content is not None:
                (self.folder / name).write_bytes(content)
            run = self.render("a.png", "--environment", name, code=BAD_INPUT)
            self.assertIn(name, run.stderr)
            self.assertFalse((self.folder / "a.png").exists())
            self.run_lightwell("serve", "builtin:cornell", "--port", "0", "--environment", name, code=BAD_INPUT)

    def test_a_folder_is_no_scene(self):
        (self.folder / "scene.glb").mkdir()
        self.refuse("scene.glb")

    def test_comparing_what_cannot_be_compared(self):
        self.render("a.png")
        self.render("b.exr")
        self.run_lightwell("render", "builtin:cornell", "-o", "c.png", *SMALL[2:], "--size", "32x32")
        (self.folder / "noise.png").write_bytes(b"\x89PNG\r\n\x1a\nnothing more")
        self.run_lightwell("compare", "a.png", "none.png", code=BAD_INPUT)
        self.run_lightwell("compare", "a.png", "noise.png", code=BAD_INPUT)
        self.assertIn("32x32", self.run_lightwell("compare", "a.png", "c.png", code=BAD_INPUT).stderr)
        self.assertIn("referred", self.run_lightwell("compare", "a.png", "b.exr", code=BAD_INPUT).stderr)
        self.run_lightwell("compare", "a.png", code=WRONG_USAGE)
        self.run_lightwell("compare", "a.png", "a.png", "--heatmap", "h.exr", code=WRONG_USAGE)
        self.run_lightwell("compare", "a.png", "a.png", "--heatmap", "none/h.png", code=FAILED)


class DeviceTest(CommandLineTest):
    NO_EGL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}

    def test_devices_says_what_and_why(self):
        run = self.run_lightwell("devices")
        self.assertIn("chosen:", run.stdout)
        report = json.loads(self.run_lightwell("devices", "--json").stdout)
        self.assertTrue(any(device["usable"] for device in report["devices"]))
        self.assertTrue(report["chosen"]["usable"])
        self.assertNotEqual("", report["chosen"]["why"])
        for device in report["devices"]:
            self.assertTrue(device["usable"] or device["reason"], device)

    def test_the_software_device_can_be_asked_for(self):
        report = json.loads(self.render("a.png", "--device", "software", "--json").stdout)
        self.assertTrue(report["device"]["software"])

    def test_a_device_that_is_not_there(self):
        run = self.render("a.png", "--device", "99", code=NO_DEVICE)
        self.assertIn("99", run.stderr)

    def test_no_egl_vendor_at_all(self):
        self.render("a.png", env=self.NO_EGL, code=NO_DEVICE)
        run = self.run_lightwell("devices", env=self.NO_EGL, code=NO_DEVICE)
        self.assertIn("none", run.stdout)
        report = json.loads(self.run_lightwell("devices", "--json", env=self.NO_EGL, code=NO_DEVICE).stdout)
        self.assertIsNone(report["chosen"])


class RenderTest(CommandLineTest):
    def test_sizes_of_all_formats(self):
        self.render("a.png")
        self.render("a.jpg")
        self.render("a.exr")
        self.assertEqual((48, 32), png_size(self.folder / "a.png"))
        self.assertEqual((48, 32), jpeg_size(self.folder / "a.jpg"))
        self.assertEqual((48, 32), exr_size(self.folder / "a.exr"))
        self.run_lightwell("render", "builtin:cornell", "-o", "tiny.png", "--size", "1x1", "--samples", "1")
        self.assertEqual((1, 1), png_size(self.folder / "tiny.png"))

    def test_exr_is_light_and_png_what_a_display_shows(self):
        for exposure in ["-3", "2"]:
            self.render(f"light{exposure}.exr", "--exposure", exposure)
            self.render(f"shown{exposure}.png", "--exposure", exposure)
        self.assertEqual(self.mean_light("light-3.exr"), self.mean_light("light2.exr"))
        self.assertLess(sum(self.mean_light("shown-3.png")), 0.5 * sum(self.mean_light("shown2.png")))

    def test_the_linear_tone_map_shows_the_light_itself(self):
        # Dark enough that nothing clips; the 8-bit file rounds.
        self.render("light.exr")
        self.render("shown.png", "--exposure", "-6", "--tone-map", "linear")
        for light, shown in zip(self.mean_light("light.exr"), self.mean_light("shown.png")):
            self.assertAlmostEqual(light / 64, shown, delta=0.01)

    def test_the_header_tells_how_the_picture_was_made(self):
        self.render("a.exr", "--seed", "7", "--bounces", "2", "--estimator", "literal")
        text = b" ".join(key.encode() + b"=" + value for key, value in exr_attributes(self.folder / "a.exr").items())
        for part in [b"builtin:cornell", b"thesis", b"literal"]:
            self.assertIn(part, text)

    def test_the_same_seed_gives_the_same_bytes(self):
        for file, seed in [("a.png", 1), ("b.png", 1), ("c.png", 2)]:
            self.render(file, "--seed", seed)
        content = {name: (self.folder / name).read_bytes() for name in ["a.png", "b.png", "c.png"]}
        self.assertEqual(content["a.png"], content["b.png"])
        self.assertNotEqual(content["a.png"], content["c.png"])

    def test_every_choice_renders(self):
        for option in [["--bounces", "0"], ["--bounces", "3"], ["--estimator", "literal"], ["--denoise"],
                       ["--patch", "4"], ["--patch", "2", "--triangle-groups", "3", "--no-trace-missed"], ["--patch", "2", "--brute-force"],
                       ["--patch", "8", "--similarity", "literal", "--normal-threshold", "0.5", "--depth-threshold", "1"],
                       ["--view", "bounce", "--view-index", "1"], ["--view", "patch", "--patch", "4"],
                       ["--multiple-scattering"], ["--method", "realtime", "--temporal-antialiasing"], ["--method", "realtime", "--firefly-clamp", "10"],
                       ["--method", "realtime", "--target-fps", "30"], ["--environment-rotation", "90", "--environment-strength", "2"],
                       ["--shadow-size", "64", "--shadow-filter", "1"], ["--background", "0.1,0.2,0.3"],
                       ["--camera", "0"], ["--eye", "0,1,3", "--target", "0,1,0", "--yfov", "60"],
                       ["--tracer", "embree"], ["--tracer", "compute"], ["--time", "1.5"]]:
            self.render("a.png", *option)
            self.assertEqual((48, 32), png_size(self.folder / "a.png"), option)
            (self.folder / "a.png").unlink()

    def test_every_view_is_another_picture(self):
        pictures = set()
        views = ["final", "direct", "indirect", "albedo", "normal", "depth", "occlusion-distance"]
        for view in views:
            self.render("a.png", "--view", view)
            pictures.add((self.folder / "a.png").read_bytes())
        self.assertEqual(len(views), len(pictures))

    def test_every_built_in_scene(self):
        for scene in ["atrium", "cornell", "helicopters", "venus"]:
            report = json.loads(self.render("a.png", "--json", scene=f"builtin:{scene}").stdout)
            self.assertGreater(report["pictures"][0]["triangles"], 10)
            self.assertGreater(sum(self.mean_light("a.png")), 0.01, f"{scene} is black")

    def test_report(self):
        report = json.loads(self.render("a.png", "--json", "--spp", "3").stdout)
        self.assertEqual(["48", "32"], [str(report["width"]), str(report["height"])])
        self.assertIn(report["tracer"], ["embree", "compute"])
        self.assertNotEqual("", report["device"]["gl_renderer"])
        picture = report["pictures"][0]
        self.assertEqual(3, picture["accumulated"])
        self.assertGreater(picture["rays"], 0)
        self.assertTrue(all(stage["ms"] >= 0 for stage in picture["stages"]))
        self.assertEqual(0, picture["clamped_share"])

    def test_the_firefly_clamp_tells_what_it_takes(self):
        report = json.loads(self.render("a.exr", "--json", "--method", "realtime", "--firefly-clamp", "0.5").stdout)
        self.assertGreater(report["pictures"][0]["clamped_share"], 0.05)
        self.assertLess(report["pictures"][0]["clamped_share"], 1)

    def test_more_samples_come_closer(self):
        self.render("reference.exr", "--spp", "64", "--seed", "9")
        errors = []
        for spp in [1, 16]:
            self.render("a.exr", "--spp", spp)
            run = self.run_lightwell("compare", "a.exr", "reference.exr", "--json")
            errors.append(json.loads(run.stdout)["rel_mse"])
        self.assertLess(errors[1], errors[0])

    def test_sequences(self):
        (self.folder / "out").mkdir()
        run = self.render("out/%04d.png", "--frames", "8:10", "--fps", "4", "--json", scene="builtin:helicopters")
        files = sorted(path.name for path in (self.folder / "out").iterdir())
        self.assertEqual(["0008.png", "0009.png", "0010.png"], files)
        self.assertEqual([2.0, 2.25, 2.5], [picture["time_s"] for picture in json.loads(run.stdout)["pictures"]])
        self.assertNotEqual((self.folder / "out/0008.png").read_bytes(), (self.folder / "out/0010.png").read_bytes())


class CompareTest(CommandLineTest):
    def test_measures_and_heatmap(self):
        self.render("a.exr", "--seed", "1")
        self.render("b.exr", "--seed", "2")
        equal = json.loads(self.run_lightwell("compare", "a.exr", "a.exr", "--json").stdout)
        self.assertEqual([0.0, 0.0, 0.0], [equal["rel_mse"], equal["flip"], equal["hdr_flip"]])
        self.assertIsNone(equal["psnr_db"])
        other = json.loads(self.run_lightwell("compare", "a.exr", "b.exr", "--json", "--heatmap", "h.png").stdout)
        self.assertGreater(other["rel_mse"], 0.0)
        self.assertLess(other["ssim"], 1.0)
        self.assertGreater(other["hdr_flip"], 0.0)
        self.assertEqual((48, 32), png_size(self.folder / "h.png"))
        text = self.run_lightwell("compare", "a.exr", "b.exr").stdout
        for measure in ["relMSE", "SSIM", "FLIP", "HDR-FLIP", "PSNR"]:
            self.assertIn(measure, text)


if __name__ == "__main__":
    unittest.main()
