"""The pages of the repository, and what the tests look for in them."""
import os
import re
import subprocess
import sys


def names(root):
    """Paths of all pages, README.md first."""
    found = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
                           capture_output=True, text=True)
    pages = found.stdout.split() if found.returncode == 0 else []
    if not pages: # not a git checkout
        pages = [os.path.relpath(os.path.join(folder, name), root) for folder, _, files in os.walk(root)
                 for name in files if name.endswith(".md") and "build" not in os.path.relpath(folder, root)]
    return sorted((page for page in pages if os.path.exists(f"{root}/{page}")), key=lambda p: (p != "README.md", p))


def read(root, page):
    return open(f"{root}/{page}", encoding="utf-8").read()


def blocks(text, language):
    """Contents of the code blocks that are marked with a language; a block in a list is indented."""
    return re.findall(rf"^ *```{language}\n(.*?)^ *```$", text, re.M | re.S)


def prose(text):
    """The text without its marked code blocks."""
    return re.sub(r"^ *```.*?^ *```$", "", text, flags=re.M | re.S)


def spans(text):
    """What stands in code font in the prose and in tables."""
    return re.findall(r"`([^`\n]+)`", prose(text))


def command_lines(text):
    """Lines of indented and of sh code blocks, and code spans, without comments."""
    lines = [line for block in blocks(text, "sh") for line in block.splitlines()]
    lines += re.findall(r"^    (.*)$", prose(text), re.M)
    return [line.split(" #")[0].strip() for line in lines + spans(text)]


class Report:
    """Collects what is wrong, and ends the test."""

    def __init__(self):
        self.wrong, self.checked = [], 0

    def expect(self, is_right, message):
        self.checked += 1
        if not is_right:
            self.wrong.append(message)

    def end(self, what):
        print("\n".join(self.wrong) or f"{self.checked} {what}")
        sys.exit(bool(self.wrong) or not self.checked)
