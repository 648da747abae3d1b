#!/usr/bin/env python3
"""Names of the library and keys of scenes on the pages exist. Usage: check_names.py SOURCE_ROOT VIRGA"""
import glob
import re
import subprocess
import sys

import pages

root, virga = sys.argv[1:3]
report = pages.Report()
GROUPS = "meshes|environment|lights|camera|frames|preview|rain|ground|splash|glass"
FILES = (".c", ".h", ".ply", ".comp", ".vert", ".frag", ".glsl", ".yaml", ".png", ".mp4", ".exr")


def source(*patterns):
    return "\n".join(open(path, encoding="utf-8").read() for pattern in patterns
                     for path in glob.glob(f"{root}/{pattern}", recursive=True))


code = source("engine/**/*.[ch]", "shaders/**/*.*", "meson.build", "tests/**/*.h", "tests/**/*.c", "tools/test")
identifiers = set(re.findall(r"\w+", code))
labels = set(re.findall(r'"([a-z]+\.[a-z_]+)"', code))
known_keys = {}


def is_key(key):
    """Whether a scene may have the key; its value is of no interest."""
    if key not in known_keys:
        scene = f"{root}/assets/scenes/windshield.yaml"
        said = subprocess.run([virga, "check", scene, "--set", f"{key}=[]"], capture_output=True, text=True).stderr
        known_keys[key] = "unknown key" not in said
    return known_keys[key]


for page in pages.names(root):
    text = pages.read(root, page)
    listings = "\n".join(pages.blocks(text, "c"))
    for name in re.findall(r"\b(?:virga|VIRGA)_\w+", " ".join(pages.spans(text)) + listings):
        report.expect(name in identifiers or name.endswith("_"), f"{page}: the code has no {name}")
    for span in pages.spans(text):
        if re.fullmatch(rf"({GROUPS})(\.[a-z0-9_]+)+", span) and not span.endswith(FILES) and span not in labels:
            report.expect(is_key(span), f"{page}: a scene has no key {span}")
report.end("names and keys exist")
