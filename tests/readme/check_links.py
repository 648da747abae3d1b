#!/usr/bin/env python3
"""Links, pictures and paths of the pages exist, and README.md is short. Usage: check_links.py SOURCE_ROOT"""
import os
import re
import sys

import pages

root = sys.argv[1]
report = pages.Report()
README_LINES = 200
FOLDERS = ("engine/", "shaders/", "tools/", "tests/", "assets/", ".ci/")


def anchors(text):
    """The anchors that GitHub makes of headings."""
    headings = re.findall(r"^#+ (.*)$", pages.prose(text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def check_link(page, target):
    path, _, anchor = target.partition("#")
    path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
    report.expect(os.path.exists(f"{root}/{path}"), f"{page}: there is no {target}")
    if anchor and os.path.exists(f"{root}/{path}"):
        report.expect(anchor in anchors(pages.read(root, path)), f"{page}: there is no heading {target}")
    return path


linked = {"README.md"}
for page in pages.names(root):
    text = pages.prose(pages.read(root, page))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if not target.startswith(("https://", "http://")):
            linked.add(check_link(page, target))
    for path in pages.spans(text):
        if path.startswith(FOLDERS) and re.fullmatch(r"[\w./-]+", path) and "NAME" not in path:
            report.expect(os.path.exists(f"{root}/{path}"), f"{page}: there is no {path}")

for page in pages.names(root):
    report.expect(page in linked, f"no page links to {page}")
readme = pages.read(root, "README.md").splitlines()
report.expect(len(readme) <= README_LINES, f"README.md has {len(readme)} lines, and {README_LINES} are allowed")
report.expect(readme[2].startswith("!["), "README.md does not begin with a picture")
report.end("links and paths exist")
