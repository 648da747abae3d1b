#!/usr/bin/env python3
"""Holds README.md's "Embed it" to the programs that it shows. Usage: check_readme.py SOURCE_ROOT

Each C block there begins with a comment that names a file; what follows must stand in that file line by line, whatever
its indentation. Those files are built and run by the tests, so what README says compiles. The other way round, every call of
Virga in rain_triangle.c stands in README: following it alone is enough.
"""
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
shown = {line for block in blocks for line in lines_of(block)}
for line in lines_of(open(f"{root}/tests/readme/rain_triangle.c").read()):
    if "virga_" in line and line not in shown:
        sys.exit(f"README.md does not show '{line}' of tests/readme/rain_triangle.c")
print(f"{len(blocks)} blocks stand in their files")
