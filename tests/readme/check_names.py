#!/usr/bin/env python3
"""Names in code font, and keys of scenes, exist. Usage: check_names.py SOURCE_ROOT VIRGA

A name is a word with an underscore, as functions, fields and keys have it. It must occur in the code. A name like
`rain.glow` must be a key that a scene may have, or the label of a pass.
"""
import os
import re
import subprocess
import sys

import pages

root, virga = sys.argv[1:3]
report = pages.Report()
GROUPS = "meshes|environment|lights|camera|frames|preview|rain|ground|splash|glass"
CODE = (".c", ".cpp", ".h", ".glsl", ".comp", ".vert", ".frag", ".py", ".sh", ".yaml", "meson.build", "tools/test")
OUTPUTS = (".ply", ".png", ".mp4", ".exr", ".rdc")
OTHERS = ("GLM_", "VK_")  # names of other projects
SCENE = f"{root}/assets/scenes/windshield.yaml"
known_keys = {}


def files_of_project():
    for folder in ("engine", "shaders", "tools", "tests", "assets"):
        for path, _, files in os.walk(f"{root}/{folder}"):
            yield from (f"{path}/{name}" for name in files)


def is_key(key):
    """Whether a scene may have the key. Its value does not matter."""
    if key not in known_keys:
        said = subprocess.run([virga, "check", SCENE, "--set", f"{key}=[]"], capture_output=True, text=True).stderr
        known_keys[key] = "unknown key" not in said
    return known_keys[key]


identifiers, labels = set(), set()
for path in files_of_project():
    identifiers.add(os.path.basename(path).split(".")[0])
    text = open(path, encoding="utf-8").read() if path.endswith(CODE) else ""
    identifiers |= set(re.findall(r"\w+", text))
    labels |= set(re.findall(r'"([a-z]+\.[a-z_]+)"', text))

for page in pages.names(root):
    text = pages.read(root, page).split("\n## Renamed before 1.0\n")[0]  # behind it are names that are no more
    for span in pages.spans(text):
        if span.startswith(("http", "$", "-", "VIRGA_SPIRV(") + OTHERS) or " " in span or span.endswith(".rdc"):
            continue
        for name in re.findall(r"\b[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)+\b", span):
            report.expect(name in identifiers, f"{page}: the code has no {name}")
        if re.fullmatch(rf"({GROUPS})(\.[a-z0-9_]+)+", span) and not span.endswith(OUTPUTS + CODE):
            report.expect(span in labels or is_key(span), f"{page}: a scene has no key {span}")
report.end("names and keys exist")
