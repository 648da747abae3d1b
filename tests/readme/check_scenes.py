#!/usr/bin/env python3
"""Scenes on the pages are good, and assets/README.md shows each of ours. Usage: check_scenes.py SOURCE_ROOT VIRGA

A YAML block that begins with `virga:` is a whole scene. Another one is a part, which is checked as a part of a scene.
"""
import os
import re
import subprocess
import sys
import tempfile

import pages

root, virga = sys.argv[1:3]
report = pages.Report()
VERSION = "virga: 1\n"
CAMERA = "camera: {keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, -5]}]}\n" # for parts without one

NO_PARTICLES = ("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                "property float z\nend_header\n")

with tempfile.TemporaryDirectory() as work:
    os.symlink(os.path.abspath(f"{root}/assets/environments"), f"{work}/environments")
    os.mkdir(f"{work}/scenes")
    for name in os.listdir(f"{root}/assets/scenes"):
        os.symlink(os.path.abspath(f"{root}/assets/scenes/{name}"), f"{work}/scenes/{name}")
    for page in pages.names(root):
        for block in pages.blocks(pages.read(root, page), "yaml"):
            scene = f"{work}/scenes/page.yaml"
            # Particles of a simulation are the reader's own: two empty files stand for them.
            for files in re.findall(r"files: (\S+%04d\.ply)", block):
                for number in (0, 20):
                    with open(f"{work}/scenes/{files % number}", "w") as file:
                        file.write(NO_PARTICLES)
            # Poses of a camera too: one stands for them.
            for poses in re.findall(r"file: (\S+\.txt)", block):
                with open(f"{work}/scenes/{poses}", "w") as file:
                    file.write("1 0 0 0 0 1 0 0 0 0 1 0\n")
            # And its calibration, as KITTI has it.
            for calibration in re.findall(r"calibration: {file: (\S+\.txt)", block):
                with open(f"{work}/scenes/{calibration}", "w") as file:
                    file.write("S_02: 9 9\nS_rect_02: 9 9\nP_rect_02: 9 0 4 0 0 9 4 0 0 0 1 0\n")
            with open(scene, "w") as file:
                if not block.startswith("virga:"):
                    file.write(VERSION + ("" if block.startswith("camera:") else CAMERA))
                file.write(block)
            said = subprocess.run([virga, "check", scene], capture_output=True, text=True)
            report.expect(said.returncode == 0, f"{page}: {said.stderr.strip()}")

gallery = pages.read(root, "assets/README.md")
for name in sorted(os.listdir(f"{root}/assets/scenes")):
    if name.endswith(".yaml"):
        section = re.search(rf"^### {name[:-5]}\n(.*?)^##", gallery, re.M | re.S)
        report.expect(section and f"pictures/{name[:-5]}.png" in section.group(1) and name in section.group(1),
                      f"assets/README.md does not show {name} with a picture and a command")
report.end("scenes are good")
