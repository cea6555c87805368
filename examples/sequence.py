#!/usr/bin/env python3
"""A turntable with Python's standard library: submits a sequence, follows it, and unpacks its frames.

    examples/sequence.py FOLDER [--scene NAME] [--frames N] [--format png|exr]

LIGHTWELL_URL (http://127.0.0.1:8080) is the server, LIGHTWELL_TOKEN the token if it asks for one.
"""
import argparse
import io
import json
import math
import os
import sys
import urllib.error
import urllib.request
import zipfile

URL = os.environ.get("LIGHTWELL_URL", "http://127.0.0.1:8080")
TOKEN = os.environ.get("LIGHTWELL_TOKEN", "")


def ask(method, path, body=None):
    """The open response; a refusal ends the program with the server's words."""
    request = urllib.request.Request(URL + path, method=method)
    if TOKEN:
        request.add_header("Authorization", "Bearer " + TOKEN)
    if body is not None:
        request.data = json.dumps(body).encode()
        request.add_header("Content-Type", "application/json")
    try:
        return urllib.request.urlopen(request, timeout=300)
    except urllib.error.HTTPError as error:
        problem = json.load(error)
        sys.exit(f"{problem['title']}: {problem['detail']} {problem.get('pointer', '')}".strip())


def turntable(scene, frames, picture_format):
    """Once round the scene, two metres away and slightly above it, at 24 frames a second."""
    turns = [2 * math.pi * i / 8 for i in range(9)]
    duration_s = frames / 24
    return {
        "scene": scene,
        "last_frame": frames - 1,
        "fps": 24,
        "width": 160,
        "height": 90,
        "format": picture_format,
        "views": ["final", "albedo"] if picture_format == "exr" else ["final"],
        "settings": {"samples": 8, "indirect_size": 32, "exposure_ev": -4},
        "camera": {"eye": [0, 1, 3], "target": [0, 1, 0]},
        "camera_keyframes": [{
            "path": "/eye",
            "times_s": [i * duration_s / 8 for i in range(9)],
            "values": [[3 * math.sin(turn), 1.3, 3 * math.cos(turn)] for turn in turns],
        }],
    }


def follow(sequence_id):
    """The sequence when it has ended, by server-sent events; a stream that breaks off is opened again."""
    while True:
        with ask("GET", f"/v1/sequences/{sequence_id}/events") as events:
            for line in events:
                if not line.startswith(b"data: "):
                    continue
                sequence = json.loads(line[len(b"data: "):])
                print(f"{sequence['state']}: {sequence['frames_done']} of {sequence['frames_total']} frames", flush=True)
                if sequence["state"] in ("done", "failed", "cancelled"):
                    return sequence


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--scene", default="cornell")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--format", choices=["png", "exr"], default="png")
    arguments = parser.parse_args()
    with ask("POST", "/v1/sequences", turntable(arguments.scene, arguments.frames, arguments.format)) as response:
        sequence_id = json.load(response)["id"]
    sequence = follow(sequence_id)
    if sequence["state"] != "done":
        sys.exit(f"{sequence['state']}: {sequence.get('problem', {}).get('detail', '')}")
    with ask("GET", f"/v1/sequences/{sequence_id}/archive") as response:
        zipfile.ZipFile(io.BytesIO(response.read())).extractall(arguments.folder)
    print(arguments.folder)


if __name__ == "__main__":
    main()
