#!/usr/bin/env python3
"""Every C and GLSL block of a page is a part of a file that the tests build. Usage: check_code.py SOURCE_ROOT

A block begins with a comment that names a file. What follows must be in that file, line by line; indentation may
differ. And engine/README.md must show every line in which rain_triangle.c differs from triangle.c, so that a reader who
follows it alone gets from the one program to the other.
"""
import difflib
import os
import re
import sys

import pages

root = sys.argv[1]
report = pages.Report()


def lines_of(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def check_block(page, block):
    first, _, rest = block.partition("\n")
    named = re.fullmatch(r"/\* ([\w./-]+\.\w+)(:.*)? \*/", first.strip())
    is_file = named and os.path.exists(f"{root}/{named.group(1)}")
    report.expect(is_file, f"{page}: the block that begins with '{first}' does not name a file")
    if not is_file:
        return
    wanted, there = lines_of(rest), lines_of(pages.read(root, named.group(1)))
    is_there = any(there[i:i + len(wanted)] == wanted for i in range(len(there)))
    missing = next((line for line in wanted if line not in there), wanted[0])
    report.expect(is_there, f"{page}: {named.group(1)} does not have this block; look at '{missing}'")


for page in pages.names(root):
    text = pages.read(root, page)
    for block in pages.blocks(text, "c") + pages.blocks(text, "glsl") + pages.blocks(text, "cpp"):
        check_block(page, block)

# The functions that hold the page's blocks, and their calls.
FRAME = {
    "{", "}", "static void create_rain(void)", "create_rain();",
    "static void step_rain(VkCommandBuffer cmd, uint64_t frame)",
    "step_rain(cmd, frame + 1); /* Virga counts frames from 1 */",
}
# What the page says to replace. Nothing else of the triangle may go.
REPLACED = {
    ".apiVersion = VK_API_VERSION_1_0,", "VkPhysicalDeviceFeatures features = {0};", ".pEnabledFeatures = &features,",
}


def code_of(name):
    """The lines of a program without its first comment."""
    return lines_of(pages.read(root, f"tests/readme/{name}").split("*/\n", 1)[1])


walk = pages.read(root, "engine/README.md")
for change in difflib.ndiff(code_of("triangle.c"), code_of("rain_triangle.c"), charjunk=None):
    kind, line = change[0], change[2:]
    if kind == "+" and line not in FRAME:
        report.expect(line.rstrip(",") in walk, f"engine/README.md does not show '{line}' of rain_triangle.c")
    if kind == "-" and line not in FRAME:
        report.expect(line in REPLACED, f"rain_triangle.c lacks '{line}' of triangle.c")
report.end("blocks and lines are in their files")
