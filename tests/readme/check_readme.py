#!/usr/bin/env python3
"""Holds README.md's "Embed it" to the programs that it shows. Usage: check_readme.py SOURCE_ROOT

Each C block there begins with a comment that names a file; what follows must stand in that file line by line, whatever
its indentation. Those files are built and run by the tests, so what README says compiles. The other way round, what
rain_triangle.c has more than triangle.c stands in README: following it alone leads from the one to the other.
"""
import difflib
import re
import sys

root = sys.argv[1]
readme = open(f"{root}/README.md").read()
section = re.search(r"^## Embed it\n(.*?)^## ", readme, re.M | re.S)
if not section:
    sys.exit("README.md has no section 'Embed it'")


def lines_of(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


blocks = re.findall(r"^```c\n(.*?)^```$", section.group(1), re.M | re.S)
if len(blocks) < 8:
    sys.exit(f"README.md, 'Embed it': {len(blocks)} C blocks, expected 8 and more")
for block in blocks:
    first, _, rest = block.partition("\n")
    named = re.fullmatch(r"/\* (\S+\.c): .* \*/|/\* (\S+\.c) \*/", first.strip())
    if not named:
        sys.exit(f"README.md: the block that begins '{first}' does not name its file")
    path = named.group(1) or named.group(2)
    wanted, there = lines_of(rest), lines_of(open(f"{root}/{path}").read())
    if not any(there[i:i + len(wanted)] == wanted for i in range(len(there))):
        missing = next((line for line in wanted if line not in there), wanted[0])
        sys.exit(f"README.md: a block is no part of {path}; look at '{missing}'")


def code_of(name):
    """The lines of a program without the comment that it begins with."""
    return lines_of(open(f"{root}/tests/readme/{name}").read().split("*/\n", 1)[1])


# The functions that README's parts stand in, and their calls.
frame_of_parts = {
    "{", "}", "static void create_rain(void)", "create_rain();",
    "static void step_rain(VkCommandBuffer cmd, uint64_t frame)",
    "step_rain(cmd, frame + 1); /* Virga counts frames from 1 */",
}
# What README says to replace: nothing else of the triangle goes.
replaced = {
    ".apiVersion = VK_API_VERSION_1_0,", "VkPhysicalDeviceFeatures features = {0};", ".pEnabledFeatures = &features,",
}
for change in difflib.ndiff(code_of("triangle.c"), code_of("rain_triangle.c"), charjunk=None):
    kind, line = change[0], change[2:]
    if kind == "+" and line not in frame_of_parts and line.rstrip(",") not in section.group(1):
        sys.exit(f"README.md does not show '{line}' of tests/readme/rain_triangle.c")
    if kind == "-" and line not in replaced and line not in frame_of_parts:
        sys.exit(f"tests/readme/rain_triangle.c lacks '{line}' of tests/readme/triangle.c")
print(f"{len(blocks)} blocks stand in their files")
