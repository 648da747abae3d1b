"""The shaders that a build folder has compiled: what tools/check and the tests of SPIR-V read.

The build makes a C array of each module. Here they are words again, as spirv-val and spirv-dis read them.
"""
import array
import json
import os
import re
import subprocess


def list_shaders(root, build):
    """[(source, header)]: the sources below root, each once for each form, and the C arrays that were made of them."""
    targets = os.path.join(build, "meson-info", "intro-targets.json")
    if not os.path.isfile(targets):
        return []
    with open(targets, encoding="utf-8") as file:
        found = [(os.path.relpath(target["target_sources"][0]["sources"][0], root), target["filename"][0])
                 for target in json.load(file) if target["filename"][0].endswith(".spv.h")]
    return sorted(each for each in found if os.path.isfile(each[1]))


def list_passes(root, build, endings):
    """Those of the library, with such endings."""
    return [(source, header) for source, header in list_shaders(root, build)
            if source.startswith("shaders/") and source.endswith(endings)]


def name_of(header):
    return os.path.basename(header)[:-len(".spv.h")]


def pass_through(command, header):
    """Gives the module to a program's standard input. Returns its exit code and all that it prints."""
    with open(header, encoding="utf-8") as file:
        words = array.array("I", (int(word, 16) for word in re.findall(r"\b0x([0-9a-f]{8})\b", file.read())))
    done = subprocess.run(command + ["-"], input=words.tobytes(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout.decode("utf-8", "replace")


def disassemble(header):
    """What spirv-dis says of the module, with ids as numbers."""
    code, text = pass_through(["spirv-dis", "--raw-id"], header)
    if code:
        raise SystemExit("spirv-dis gave %d for %s:\n%s" % (code, header, text))
    return text
