#!/usr/bin/env python3
"""Commands on the pages are ones that the programs accept. Usage: check_commands.py SOURCE_ROOT BUILD_ROOT

Programs, scripts, commands and options exist. Scenes exist, and accept what --set gives them. Nothing is rendered.
"""
import os
import re
import shlex
import subprocess
import sys

import pages

root, build = sys.argv[1:3]
report = pages.Report()
virga, drive = f"{build}/tools/virga/virga", f"{build}/tools/drive/drive"
SCRIPTS = {"tools/demo", "tools/test", "tools/setup", "tools/check", "tools/swiftshader", "assets/make_pictures",
           "assets/make_comparison", "assets/measure_streaks.py",
           "assets/measure_drops.py"}
helps = {}


def help_of(*command):
    if command not in helps:
        helps[command] = subprocess.run(command, capture_output=True, text=True).stdout
    return helps[command]


def check_options(page, line, words, text):
    for word in words:
        if re.match(r"--?[a-z]", word):
            option = word.split("=")[0]
            report.expect(re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", text), f"{page}: no {option}: {line}")


def check_settings(page, line, words):
    """Scenes of ours exist, and accept the settings."""
    for scene in (word for word in words if word.startswith("assets/scenes/")):
        settings = [part for i, word in enumerate(words[:-1]) if word == "--set" for part in (word, words[i + 1])]
        said = subprocess.run([virga, "check", f"{root}/{scene}", *settings], capture_output=True, text=True)
        report.expect(said.returncode == 0, f"{page}: {line}: {said.stderr.strip()}")


def check_virga(page, line, words):
    command = words[1] if len(words) > 1 else "help"
    overview = help_of(virga, "help")
    is_command = re.search(rf"^  {re.escape(command)} ", overview, re.M) or command.startswith("-")
    report.expect(is_command, f"{page}: no command {command}: {line}")
    if is_command and not command.startswith("-"):
        text = help_of(virga, "help", command)
        if command == "bench" and len(words) > 2 and not words[2].startswith("-"):
            report.expect(re.search(rf"^{words[2]} ", text, re.M), f"{page}: no bench {words[2]}: {line}")
        check_options(page, line, words[2:], text)
        check_settings(page, line, words)


def check_line(page, line):
    """A line may have variables and xvfb-run before its program, and two commands in it."""
    for part in line.split(" && "):
        try:
            words = shlex.split(part)
        except ValueError:
            continue
        for i, word in enumerate(words):
            if word == "virga" and (i == 0 or words[0] in ("xvfb-run", "renderdoccmd") or "=" in words[0]):
                check_virga(page, part, words[i:])
            elif word.endswith("build/tools/drive/drive"):
                check_options(page, part, words[i + 1:], help_of(drive, "--help"))
            elif word in SCRIPTS:
                report.expect(os.access(f"{root}/{word}", os.X_OK), f"{page}: no program {word}")
            elif word.startswith("build/tests/"):
                report.expect(os.access(f"{build}/{word[6:]}", os.X_OK), f"{page}: no program {word}")


for page in pages.names(root):
    text = pages.read(root, page)
    for line in pages.command_lines(text):
        check_line(page, line)
report.end("commands are known")
