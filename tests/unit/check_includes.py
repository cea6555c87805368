#!/usr/bin/env python3
"""Holds every #include against the floors of the house: web_client -> protocol <- server -> renderer.

usage: check_includes.py ROOT

Prints each include that crosses a border, with the rule it breaks, and exits with 1 if there is any.
"""

import re
import sys
from pathlib import Path

# Folder of the including file (the longest that fits decides) -> what it may include of the project's own files.
# A path that ends in "/" is a folder with all it holds.
OWN = {
    "renderer/": ["renderer/"],
    "renderer/scene/": ["renderer/scene/", "renderer/error.h", "renderer/check.h"],
    "renderer/scene/gltf/": ["renderer/scene/", "renderer/image_io/", "renderer/error.h", "renderer/check.h"],
    "renderer/image_io/": ["renderer/image_io/", "renderer/modules/", "renderer/scene/", "renderer/error.h",
                           "renderer/check.h"],
    "renderer/modules/": ["renderer/modules/", "renderer/error.h"],
    "renderer/image_metrics/": ["renderer/image_metrics/", "renderer/error.h", "renderer/check.h"],
    "renderer/gl/": ["renderer/gl/", "renderer/error.h", "renderer/check.h"],
    "renderer/tracing/": ["renderer/tracing/", "renderer/gl/", "renderer/scene/", "renderer/error.h",
                          "renderer/check.h"],
    "protocol/": ["protocol/"],
    "web_client/": ["web_client/"],
    "server/": ["server/", "renderer/", "protocol/", "web_client/"],
    "tests/": ["tests/", "server/", "renderer/", "protocol/", "web_client/"],
}

# The renderer's core links GL and GLM alone: nothing of it may include what lives in these targets of their own.
BESIDE_CORE = ["renderer/scene/gltf/", "renderer/image_io/", "renderer/image_metrics/", "renderer/modules/",
               "renderer/tracing/embree/"]

# Header -> the folders that may include it. Tests may include anything.
LIBRARIES = [
    ("EGL", r"EGL/", ["renderer/gl/"]),
    ("OpenGL", r"(GL|GLES\d?|KHR)/", ["renderer/"]),
    ("Embree", r"embree\d?/", ["renderer/tracing/embree/"]),
    ("OpenImageIO", r"(OpenImageIO|Imath|OpenEXR)/", ["renderer/image_io/"]),
    ("tinygltf", r"tiny_gltf\.h", ["renderer/scene/gltf/"]),
    ("nlohmann-json", r"nlohmann/", ["renderer/scene/gltf/", "protocol/", "server/"]),
    ("cpp-httplib", r"httplib\.h", ["server/"]),
    ("Boost", r"boost/", ["server/"]),
    ("OpenSSL", r"openssl/", ["server/"]),
    ("sockets", r"(sys/(socket|epoll|un)\.h|netinet/|arpa/|netdb\.h)", ["server/"]),
    ("libjpeg-turbo", r"(turbojpeg|jpeglib)\.h", ["server/"]),
    ("libavcodec", r"(libavcodec|libavformat|libavutil|libswscale)/", ["server/video/codecs/"]),
    ("spdlog", r"spdlog/", ["server/"]),
    ("CLI11", r"CLI/", ["server/command_line/"]),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SOURCES = {".h", ".hpp", ".cpp", ".cc", ".c"}


def within(path, folders):
    return any(path == folder or (folder.endswith("/") and path.startswith(folder)) for folder in folders)


def broken_rule(includer, quote, included):
    """The rule that this include breaks, as a sentence, or None. Paths are relative to the project's root."""
    for name, pattern, allowed in LIBRARIES:
        if re.match(pattern, included):
            if within(includer, allowed) or includer.startswith("tests/"):
                return None
            return f"{name} is for {', '.join(allowed)} only"
    if quote == "<":
        return "the project's own headers are included with quotes" if within(included, OWN) else None
    floor = max((folder for folder in OWN if includer.startswith(folder)), key=len)
    if not within(included, OWN):
        return "an own header is included by its path from the project's root"
    if not within(included, OWN[floor]):
        return f"{floor} may include only {', '.join(OWN[floor])}"
    core = includer.startswith("renderer/") and not within(includer, BESIDE_CORE)
    if core and within(included, BESIDE_CORE):
        return f"the renderer's core may not include {', '.join(BESIDE_CORE)}"
    return None


def check_tree(root):
    """All broken rules below root as (file, line number, included, rule), and the number of includes seen."""
    broken, seen = [], 0
    for floor in sorted({folder.split("/")[0] for folder in OWN}):
        for path in sorted((root / floor).rglob("*")):
            if path.suffix not in SOURCES or "node_modules" in path.parts:
                continue
            includer = path.relative_to(root).as_posix()
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
                if match := INCLUDE.match(line):
                    seen += 1
                    if rule := broken_rule(includer, match[1], match[2]):
                        broken.append((includer, number, match[2], rule))
    return broken, seen


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    broken, seen = check_tree(Path(sys.argv[1]).resolve())
    for includer, number, included, rule in broken:
        print(f"{includer}:{number}: includes {included}, but {rule}")
    print(f"{seen} includes, {len(broken)} against the rules")
    return 1 if broken or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
