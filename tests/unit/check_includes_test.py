#!/usr/bin/env python3
"""Plants wrong includes, one at a time, and sees each found; right ones must pass."""

import sys
import tempfile
import unittest
from pathlib import Path

from check_includes import check_tree

WRONG = [
    ("renderer/renderer.cpp", '#include "protocol/messages.h"'),
    ("renderer/passes/gather.cpp", '#include "server/serve.h"'),
    ("renderer/gl/device.cpp", '#include "web_client/files.h"'),
    ("renderer/renderer.cpp", "#include <httplib.h>"),
    ("renderer/tracing/tracer.cpp", "#include <boost/asio.hpp>"),
    ("renderer/scene/pose.cpp", "#include <nlohmann/json.hpp>"),
    ("renderer/passes/gather.cpp", "  #  include <OpenImageIO/imageio.h>"),
    ("renderer/scene/gltf/load_gltf.cpp", "#include <OpenImageIO/imageio.h>"),
    ("renderer/tracing/compute_tracer.cpp", "#include <embree3/rtcore.h>"),
    ("server/serve.cpp", "#include <embree3/rtcore.h>"),
    ("renderer/scene/builtin.cpp", "#include <tiny_gltf.h>"),
    ("renderer/renderer.cpp", "#include <EGL/egl.h>"),
    ("renderer/scene/pose.cpp", '#include "renderer/gl/buffer.h"'),
    ("renderer/gl/buffer.cpp", '#include "renderer/scene/scene.h"'),
    ("renderer/methods/thesis.cpp", '#include "renderer/image_io/image_io.h"'),
    ("renderer/renderer.cpp", '#include "renderer/tracing/embree/embree_tracer.h"'),
    ("protocol/messages.cpp", '#include "renderer/renderer.h"'),
    ("protocol/messages.cpp", '#include "server/serve.h"'),
    ("protocol/messages.cpp", "#include <sys/socket.h>"),
    ("protocol/messages.cpp", "#include <boost/beast.hpp>"),
    ("server/net/listener.cpp", "#include <GL/glcorearb.h>"),
    ("server/net/listener.cpp", "#include <CLI/CLI.hpp>"),
    ("server/serve.cpp", '#include "../renderer/renderer.h"'),
    ("server/serve.cpp", '#include "serve.h"'),
    ("server/serve.cpp", "#include <renderer/renderer.h>"),
]

RIGHT = [
    ("renderer/renderer.cpp", '#include "renderer/scene/scene.h"'),
    ("renderer/gl/device.cpp", "#include <EGL/egl.h>"),
    ("renderer/passes/gather.cpp", "#include <GL/glcorearb.h>"),
    ("renderer/scene/gltf/edit.h", "#include <nlohmann/json.hpp>"),
    ("renderer/scene/gltf/load_gltf.cpp", '#include "renderer/image_io/image_io.h"'),
    ("renderer/tracing/embree/embree_tracer.cpp", "#include <embree3/rtcore.h>"),
    ("protocol/messages.h", "#include <nlohmann/json.hpp>"),
    ("server/serve.cpp", '#include "protocol/messages.h"'),
    ("server/net/listener.cpp", "#include <boost/asio.hpp>"),
    ("server/command_line/arguments.cpp", "#include <CLI/CLI.hpp>"),
    ("tests/gl/device_test.cpp", "#include <EGL/egl.h>"),
    ("renderer/renderer.cpp", "// #include <EGL/egl.h>"),
    ("renderer/renderer.cpp", "#include <vector>"),
]


def check_one(includer, line):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / includer
        path.parent.mkdir(parents=True)
        path.write_text(f"#pragma once\n{line}\n", encoding="utf-8")
        return check_tree(Path(folder))[0]


class CheckIncludesTest(unittest.TestCase):
    def test_finds_each_planted_wrong_include(self):
        for includer, line in WRONG:
            with self.subTest(includer=includer, line=line):
                broken = check_one(includer, line)
                self.assertEqual([(includer, 2)], [(found[0], found[1]) for found in broken])

    def test_lets_right_includes_pass(self):
        for includer, line in RIGHT:
            with self.subTest(includer=includer, line=line):
                self.assertEqual([], check_one(includer, line))


if __name__ == "__main__":
    sys.exit(unittest.main())
