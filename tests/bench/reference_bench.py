#!/usr/bin/env python3
"""The method reference to a given error, process start included: error, seconds, paths and segments a second.

    reference_bench.py LIGHTWELL [SCENE...] [--truth-spp N] [--runs N] [--lamp-gap METRES] [--folder DIR]

Scenes: `box` (34 triangles, a square lamp), `ceiling` (all of it emits) and `gold` (a sphere of 36100 triangles beside
the lamp's box). 256 x 256, 8 bounces, no light but what emits. The aims are another path tracer's errors at 64 samples on
four cores; how far its lamp hangs below the ceiling is not known, and matters: a lamp emits on both sides, and the wider
the gap, the more of the light from its back comes out as a bright seam around it that no sample of the lights finds.
"""
import argparse
import base64
import json
import math
import os
import statistics
import struct
import subprocess
import tempfile
import time

# What nothing here can be quicker than: each segment is traced, and so is a shadow ray from its surface, at the rate of
# rays/s of the Embree tracer on four free cores of the software device (tests/bench/results); and each moves these bytes
# between shaders, tracer and memory (ray, hit, state and pixel, shadow ray, pending light, radiance).
RAYS_PER_S = 20e6
BYTES_PER_SEGMENT = 32 * 4 + 20 * 2 + 20 * 2 + 16 * 2 + 32
BYTES_PER_S = 10e9

AIMS = {"box": (0.017, 1.9), "ceiling": (0.0086, 2.0), "gold": (0.047, 2.4)}


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def block(center, half, height, angle, bottom):
    """A box on the floor, turned about +Y."""
    def corner(x, y, z):
        s, c = math.sin(angle), math.cos(angle)
        return (center[0] + half * (c * x + s * z), y * height, center[1] + half * (c * z - s * x))
    top = [corner(-1, 1, 1), corner(1, 1, 1), corner(1, 1, -1), corner(-1, 1, -1)]
    floor = [corner(-1, 0, 1), corner(1, 0, 1), corner(1, 0, -1), corner(-1, 0, -1)]
    triangles = quad(*top)
    for i in range(4):
        j = (i + 1) % 4
        triangles += quad(floor[i], floor[j], top[j], top[i])
    return triangles + (quad(floor[3], floor[2], floor[1], floor[0]) if bottom else [])


def sphere(center, radius, columns, rows):
    def point(i, j):
        theta, phi = math.pi * j / rows, 2 * math.pi * i / columns
        return (center[0] + radius * math.sin(theta) * math.sin(phi), center[1] + radius * math.cos(theta),
                center[2] + radius * math.sin(theta) * math.cos(phi))
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)
            if j > 0:
                triangles.append((a, c, d))
            if j + 1 < rows:
                triangles.append((a, b, c))
    return triangles


def box_scene(name, lamp_gap_m):
    """Parts: triangles, colour, emission, metallic, roughness, smooth about a centre (or None)."""
    white, red, green = (0.73, 0.73, 0.73), (0.65, 0.05, 0.05), (0.12, 0.45, 0.15)
    parts = [(quad((-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)), white),
             (quad((-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)), white),
             (quad((-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)), red),
             (quad((1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)), green)]
    ceiling = quad((-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1))
    if name == "ceiling":
        parts.append((ceiling, white, (1.5, 1.5, 1.5)))
    else:
        y = 2 - lamp_gap_m
        lamp = quad((-0.25, y, -0.25), (0.25, y, -0.25), (0.25, y, 0.25), (-0.25, y, 0.25))
        parts += [(ceiling, white), (lamp, (0, 0, 0), (17, 12, 4))]
    parts.append((block((-0.35, -0.3), 0.3, 1.2, 0.3, True), white))
    if name == "gold":
        center = (0.4, 0.4, 0.35)
        parts.append((sphere(center, 0.4, 190, 96), (1.0, 0.77, 0.34), (0, 0, 0), 1.0, 0.2, center))
    else:
        parts.append((block((0.35, 0.35), 0.3, 0.6, -0.3, name == "ceiling"), white))
    return parts


def normals_of(triangle, center):
    if center:
        return [tuple((p[k] - center[k]) / math.dist(p, center) for k in range(3)) for p in triangle]
    u = [triangle[1][k] - triangle[0][k] for k in range(3)]
    v = [triangle[2][k] - triangle[0][k] for k in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return [tuple(x / math.hypot(*n) for x in n)] * 3


def write_gltf(name, path, lamp_gap_m):
    data, views, accessors, meshes, materials, nodes = b"", [], [], [], [], []
    parts = box_scene(name, lamp_gap_m)
    for triangles, color, *rest in parts:
        emission, metallic, roughness, center = (list(rest) + [(0, 0, 0), 0.0, 1.0, None][len(rest):])
        points = [p for triangle in triangles for p in triangle]
        normals = [n for triangle in triangles for n in normals_of(triangle, center)]
        for values in (points, normals):
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 12 * len(values)})
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(values),
                              "type": "VEC3", "min": [min(v[k] for v in values) for k in range(3)],
                              "max": [max(v[k] for v in values) for k in range(3)]})
            data += b"".join(struct.pack("<3f", *v) for v in values)
        strength = max(max(emission), 1e-9)
        material = {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic,
                                             "roughnessFactor": roughness},
                    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}},
                    "emissiveFactor": [e / strength for e in emission]}
        if metallic == 0.0:
            material["extensions"]["KHR_materials_specular"] = {"specularFactor": 0.0}  # Lambert
        materials.append(material)
        meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 2, "NORMAL": len(accessors) - 1},
                                       "material": len(materials) - 1}]})
        nodes.append({"mesh": len(meshes) - 1})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    gltf = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength",
                                                            "KHR_materials_specular"],
            "buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views, "accessors": accessors,
            "meshes": meshes, "materials": materials, "nodes": nodes,
            "scenes": [{"nodes": list(range(len(nodes)))}], "scene": 0}
    with open(path, "w", encoding="utf-8") as file:
        json.dump(gltf, file)
    return sum(len(part[0]) for part in parts)


def render(program, scene, output, spp, seed=0):
    start = time.monotonic()
    run = subprocess.run([program, "render", scene, "-o", output, "--method", "reference", "--bounces", "8", "--size",
                          "256x256", "--eye", "0,1,3.4", "--target", "0,1,0", "--yfov", "46", "--spp", str(spp),
                          "--environment-strength", "0", "--seed", str(seed), "--json"], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return time.monotonic() - start, json.loads(run.stdout)


def rel_mse(program, picture, truth):
    run = subprocess.run([program, "compare", picture, truth, "--json"], check=True, stdout=subprocess.PIPE)
    return json.loads(run.stdout)["rel_mse"]


def share(picture, names):
    total = sum(stage["ms"] for stage in picture["stages"])
    return sum(stage["ms"] for stage in picture["stages"] if stage["name"] in names) / total


def measure(arguments, name, folder):
    scene, truth, picture = (os.path.join(folder, name + end) for end in (".gltf", "-truth.exr", "-picture.exr"))
    triangles = write_gltf(name, scene, arguments.lamp_gap)
    if not os.path.exists(truth):
        render(arguments.program, scene, truth, arguments.truth_spp, seed=1 << 30)
    aim, aim_s = AIMS[name]
    print(f"{name}: {triangles} triangles; the aim is relMSE {aim} in less than {aim_s} s")
    print("   spp   relMSE  seconds  median   start   paths/s  segments/s  tracer  shading    floor: rays   bytes")
    for spp in arguments.spp:
        runs = [render(arguments.program, scene, picture, spp) for _ in range(arguments.runs)]
        error = rel_mse(arguments.program, picture, truth)
        seconds = sorted(run[0] for run in runs)
        best = min((run[1]["pictures"][0] for run in runs), key=lambda made: made["total_ms"])
        rate = 1e3 / best["total_ms"]
        start = min(run[0] - run[1]["pictures"][0]["total_ms"] / 1e3 for run in runs)
        print(f"{spp:6d} {error:8.5f} {seconds[0]:8.2f} {statistics.median(seconds):7.2f} {start:7.2f}"
              f" {256 * 256 * spp * rate / 1e6:7.2f} M {best['rays'] * rate / 1e6:9.2f} M"
              f" {100 * share(best, {'trace', 'shadows'}):6.0f}% {100 * share(best, {'surfaces', 'pack'}):7.0f}%"
              f" {2 * best['rays'] / RAYS_PER_S:12.2f} s {best['rays'] * BYTES_PER_SEGMENT / BYTES_PER_S:5.2f} s",
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="*", default=[])
    parser.add_argument("--truth-spp", type=int, default=4096)
    parser.add_argument("--spp", type=int, nargs="+", default=[16, 32, 64, 128])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--lamp-gap", type=float, default=0.001, help="metres between lamp and ceiling")
    parser.add_argument("--folder", help="keeps scenes and converged pictures; without it all is made anew")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        for name in arguments.scenes or list(AIMS):
            measure(arguments, name, arguments.folder or temporary)


if __name__ == "__main__":
    main()
