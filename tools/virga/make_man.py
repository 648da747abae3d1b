#!/usr/bin/env python3
"""Makes the manual page from what the program says of itself: make_man.py PROGRAM > virga.1"""
import subprocess, sys

program = sys.argv[1]


def says(*arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def roff(text):
    lines = ("\\&" + line.replace("\\", "\\e").replace("-", "\\-") if line else "" for line in text.splitlines())
    return "\n".join(lines)


overview = says("help")
version = overview.split()[1]
commands = []
for line in overview.splitlines()[4:]:
    if not line.startswith("  "):
        break
    name, summary = line.strip().split(None, 1)
    if name != "help":
        commands.append((name, summary))

print(f'.TH VIRGA 1 "" "virga {version}" "User commands"')
print(".SH NAME\nvirga \\- rain, rendered")
print(".SH SYNOPSIS")
for name, _ in commands:
    print(f".B virga {name}\n.RI [ options ]\n.br")
print(".B virga \\-\\-version")
print(""".SH DESCRIPTION
Renders rain to layered EXR frames with Vulkan, on a GPU or in software: falling drops, splashes, ground that gets wet,
drops on panes under wipers. A scene is a YAML file; the same scene, seed and frame give the same file.""")
print(".SH COMMANDS")
for name, summary in commands:
    print(f".SS virga {name}\n{roff(summary)}\n.PP\n.nf\n{roff(says('help', name).rstrip())}\n.fi")
print(""".SH EXIT STATUS
0 done, 1 failed, 2 wrong command line or input, 130 interrupted: what was finished is kept.
.SH ENVIRONMENT
.TP
.B VIRGA_VALIDATE
1 loads the Vulkan validation layer with synchronization validation; a message fails the command.
.SH EXAMPLES
.nf
virga check assets/scenes/street.yaml
virga render assets/scenes/street.yaml \\-o out \\-\\-frames 1\\-48 \\-\\-samples 8 \\-\\-preview
virga render assets/scenes/storm.yaml \\-o out \\-\\-set rain.rate_mm_h=90 \\-\\-size 1920x1080
.fi""")
