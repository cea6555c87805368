#!/usr/bin/env python3
"""Holds the OpenAPI document against the sources: every reason for which the server refuses something is shown there.

usage: check_refusals.py ROOT

A reason is the text that a refusing call is given: its literals, with anything between them. That the server gives what
is shown is for the tests of refusals, which provoke each. Prints each reason that is not shown, and each exemption that
exempts nothing, and exits with 1 if there is any.
"""

import json
import re
import sys
from pathlib import Path

FOLDERS = ["server", "protocol", "renderer/scene/gltf", "renderer/image_io"]

# Calls that refuse, and which of their arguments is the reason.
CALLS = {"make_problem": 1, "unprocessable": 1, "invalid_input": 1, "fail": 1, "Error": 2, "Refusal": 1, "busy": 0,
         "refuse": 1, "refuse_child": 2, "require": 3, "check_array": 2, "bad_message": 0, "queue_end": 1,
         "animation_values": 0, "encoded_image_bytes": 0, "decoded_image_bytes": 0, "vertices": 0, "triangles": 0}
METHODS = {"fail": 0, "reading.fail": 1, "end": 1}  # after a dot or an arrow

# Files whose refusals are nobody's answer: how they are told, or what is answered in their place.
NOT_SERVED = {
    "server/command_line/": "told at the command line",
    "server/data/database.cpp": "logged; the server failed to answer this request",
    "server/access/token_list.cpp": "told when the server starts",
    "server/data/frame_files.cpp": "logged; the frame's file is gone, or could not be kept",
    "server/video/": "logged; video cannot be encoded any more, or the film breaks off",
    "server/stream/frame_encoders.cpp": "logged; the picture could not be made",
    "server/render/picture_source.cpp": "logged; the graphics device is not available",
    "server/sequences/film_stream.cpp": "logged; the film breaks off",
    "renderer/image_io/image_io.cpp": "told at the command line",
    "renderer/image_io/codecs/encode_image.cpp": "logged; the picture could not be made",
    "renderer/image_io/codecs/label.cpp": "told at the command line",
    "renderer/image_io/codecs/read_image.cpp": "told at the command line",
    "renderer/image_io/environment_file.cpp": "told at the command line",
    "renderer/image_io/exr_header.cpp": "told at the command line",
}

# Reasons that no request can bring about.
READ_BEFORE = "who reads the request refuses it before"
ON_DISK = "an uploaded file has no folder: only scenes from the command line get so far"
UNREACHABLE = {
    "the server stops": "its connections are closed by then",
    "the client is gone": "nobody is there to hear it",
    "nobody watched for long": "a session with viewers is not idle",
    "binary values are not JSON": "the parser's interface has them, JSON does not",
    "more than * bytes of JSON": "bodies and messages have smaller limits",
    "a header field holds a control character": "who looks for the end of the head refuses it before",
    "a JSON Patch is an array, not *": READ_BEFORE,
    "a patch has at most * edits": READ_BEFORE,
    "has no path": READ_BEFORE,
    "has no value": READ_BEFORE,
    'op must be "add", "remove", "replace" or "test", not *': READ_BEFORE,
    "is no JSON pointer: it begins with no slash": READ_BEFORE,
    "is no JSON pointer: a ~ without 0 or 1": READ_BEFORE,
    "the file does not begin with 'glTF'": READ_BEFORE,
    "* bytes are more than the * allowed": READ_BEFORE,
    "* is not a data: URI": READ_BEFORE,
    "the asset's files are too large in all": READ_BEFORE,
    "there is not enough memory to load the file": "the limits are there to prevent it",
    "the file cannot be loaded: *": "an error of the program's own",
    "OpenImageIO cannot read *": "an installation without its plugins",
    "the image's headers contradict each other": "two readers of the same bytes agree",
    "cannot be understood": "the library that reads glTF gives a reason",
    "* has a '%' without two hexadecimal digits": ON_DISK,
    "* hides a separator behind a '%'": ON_DISK,
    "the URI is empty": ON_DISK,
    "* is absolute; files must lie in the asset's own folder": ON_DISK,
    "* has a scheme; only data: and files in the asset's own folder can be read": ON_DISK,
    "* holds a character that no file name should have": ON_DISK,
    "* has '..' in it; files must lie in the asset's own folder": ON_DISK,
    "there is no file *": ON_DISK,
    "* is not a file": ON_DISK,
    "* cannot be read: *": ON_DISK,
    "* cannot be read": ON_DISK,
    "* has * bytes; at most * are allowed": ON_DISK,
    "the asset's folder cannot be opened: *": ON_DISK,
    "* cannot be opened: *": ON_DISK,
    "* leads out of the asset's own folder": ON_DISK,
}


def end_of_literal(text, start):
    at = start + 1
    while text[at] != text[start]:
        at += 2 if text[at] == "\\" else 1
    return at + 1


def tokens(text):
    """Literals whole, comments not at all, everything else letter by letter."""
    at = 0
    while at < len(text):
        end = at + 1
        if text.startswith("//", at):
            at = text.find("\n", at)
            continue
        if text[at] == '"' or (text[at] == "'" and not text[at - 1].isalnum()):
            end = end_of_literal(text, at)
        yield text[at:end]
        at = end


def arguments(letters, at):
    """The tokens between the brackets that open at `at`, split at the commas."""
    depth, parts = 0, [[]]
    while True:
        letter = letters[at]
        depth += (letter in "([{") - (letter in ")]}")
        if depth == 0:
            return parts
        if letter == "," and depth == 1:
            parts.append([])
        elif len(parts[-1]) or depth > 1 or letter not in "([{":
            parts[-1].append(letter)
        at += 1


def reasons(argument):
    """What an expression may say: literals, with * for what stands between them; one for each branch of a ? and :."""
    argument = list("\x01".join(["", *argument, ""]).replace("\x01".join("std::string("), "\x02").split("\x01"))
    branches, depth = [""], 0
    for at, letter in enumerate(argument):
        if letter in ("(", "[", "{"):
            depth += 1
        elif letter in (")", "]", "}"):
            depth = max(depth - 1, 0)  # that of std::string closes what was not opened
        elif depth == 0 and letter == "?":
            branches = [""]  # what stood before is the condition
        elif depth == 0 and letter == ":" and ":" not in (argument[at - 1], argument[min(at + 1, len(argument) - 1)]):
            branches.append("")
        elif depth == 0 and len(letter) > 1:
            branches[-1] += json.loads('"' + letter[1:-1].replace("\\'", "'") + '"') if letter[0] == '"' else letter[1:-1]
        elif depth == 0 and letter not in "\x02+ \n" and not branches[-1].endswith("*"):
            branches[-1] += "*"
    return [branch for branch in branches if re.sub(r"[* ]", "", branch)]


def pattern_of(reason):
    return ".*".join(re.escape(part) for part in reason.split("*"))


def refusals_of(path):
    """All reasons in a source, with their lines."""
    letters = list(tokens(path.read_text()))
    text = "".join(letter if len(letter) == 1 else "\x00" for letter in letters)  # as long as `letters`
    names = "|".join(CALLS)
    for call in re.finditer(rf"(?<![\w.>])({names})\s*[({{]|(?:\.|->)(\w+)\s*\(", text):
        method = call[2]
        if method and text[:call.start()].endswith("reading") and method == "fail":
            which = METHODS["reading.fail"]
        elif method:
            which = METHODS.get(method)
        else:
            which = CALLS[call[1]]
        if which is None:
            continue
        parts = arguments(letters, call.end() - 1)
        if len(parts) > which:
            for reason in reasons(parts[which]):
                yield "".join(letters[:call.start()]).count("\n") + 1, reason


def shown_in(document):
    """Every detail of a problem, and every reason of a farewell."""
    if isinstance(document, dict):
        for name, member in document.items():
            if name in ("detail", "bye") and isinstance(member, str):
                yield member
            yield from shown_in(member)
    elif isinstance(document, list):
        for member in document:
            yield from shown_in(member)


def main(root):
    shown = "\n".join(shown_in(json.loads((root / "protocol/openapi.json").read_text())))
    complaints, used, count = [], set(), 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            name = path.relative_to(root).as_posix()
            exempt = [prefix for prefix in NOT_SERVED if name.startswith(prefix)]
            if path.suffix not in (".cpp", ".h"):
                continue
            for line, reason in refusals_of(path):
                count += 1
                if re.search(pattern_of(reason), shown):
                    continue
                if exempt or reason in UNREACHABLE:
                    used.update(exempt or [reason])
                    continue
                complaints.append(f"{name}:{line}: the OpenAPI document does not show {reason!r}")
    for exemption in (NOT_SERVED | UNREACHABLE).keys() - used:
        complaints.append(f"check_refusals.py: nothing needs the exemption {exemption!r}")
    if count < 250:
        complaints.append(f"only {count} reasons were found: the calls that refuse have other names now")
    print("\n".join(sorted(complaints)) or f"{count} reasons")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
