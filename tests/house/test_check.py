#!/usr/bin/env python3
"""tools/check finds what it is for: a small tree with one mistake of each kind, and the same tree without them.

usage: test_check.py CHECK     (the script; parts whose program is not installed are left out, and then the test skips)
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

GOOD = "int add(int a, int b)\n{\n    return a + b;\n}\n"
# A compute shader that does nothing, and a module that ends within an instruction.
SPIRV = [0x07230203, 0x00010500, 0, 5, 0,
         0x00020011, 1,                              # OpCapability Shader
         0x0003000E, 0, 1,                           # OpMemoryModel Logical GLSL450
         0x0005000F, 5, 1, 0x6E69616D, 0,            # OpEntryPoint GLCompute %1 "main"
         0x00060010, 1, 17, 1, 1, 1,                 # OpExecutionMode %1 LocalSize 1 1 1
         0x00020013, 2, 0x00030021, 3, 2,            # %2 = OpTypeVoid, %3 = OpTypeFunction %2
         0x00050036, 2, 1, 0, 3, 0x000200F8, 4,      # %1 = OpFunction %2 None %3, %4 = OpLabel
         0x000100FD, 0x00010038]                     # OpReturn, OpFunctionEnd
BAD_SPIRV = SPIRV[:-3]

# What is wrong in each file, and the line that says so.
BAD = {
    "engine/core/format.c": ("int  add(int a, int b)\n{\n    return a + b;\n}\n", "1: format: "),
    "engine/core/tidy.c": ("int divide(void)\n{\n    int *none = 0;\n    return *none;\n}\n", "4: tidy: "),
    "engine/core/up.c": ('#include "gpu/context.h"\n', "1: includes: engine/core may not include engine/gpu"),
    "engine/rain/beside.c": ('#include "glass/glass.h"\n', "1: includes: engine/rain may not include"),
    "tools/io/up.c": ('#include "../host/host.h"\n', "1: includes: tools/io may not include tools/host/host.h"),
    "tools/host/inside.c": ('#include "../../engine/gpu/context.h"\n', "1: includes: tools/host may not include"),
    "shaders/rain/step/beside.comp": ('#include "glass/wipe.glsl"\n', "1: includes: shaders/rain/step may not"),
    "engine/core/wide.c": ("/* %s */\n" % ("x" * 115), "1: lengths: 121 columns"),
    "engine/core/long.c": ("int one(void)\n{\n%s    return 1;\n}\n" % ("    /* x */\n" * 58), "1: lengths: a function"),
    "tools/long.py": ("def one():\n%s" % ("    pass\n" * 60), "1: lengths: a function of 61 lines"),
    "tools/long.sh": ("one() {\n%s}\n" % ("    true\n" * 59), "1: lengths: a function of 61 lines"),
    "engine/core/file.c": ("/* x */\n" * 801, "801: lengths: a file of 801 lines"),
    "README.md": ("The program " + "reci" + "eves drops.\n", "1: spelling: "),
    "shaders/rain/draw/bad.comp": ("void main()\n{\n}\n", "1: spirv: bad: "),
}
# What stands beside them, in which nothing is wrong.
FINE = {
    "engine/core/memory.h": "",
    "engine/gpu/context.h": '#include "core/memory.h"\n',
    "engine/glass/glass.h": '#include "gpu/context.h"\n#include "shared/drop.h"\n',
    "engine/scene/scene.c": '#include "core/memory.h"\n#include "glass/glass.h"\n',
    "shaders/shared/drop.h": "",
    "shaders/glass/wipe.glsl": '#include "shared/drop.h"\n',
    "shaders/glass/draw/fine.comp": '#include "../wipe.glsl"\n',
    "tools/host/host.h": '#include <virga/shared/drop.h>\n',
    "tests/rain/any.c": '#include "glass/glass.h"\n',
    "engine/core/exact.c": "/* %s */\nint one(void)\n{\n%s    return 1;\n}\n" % ("x" * 114, "    /* x */\n" * 56),
    "engine/core/add.c": GOOD,
    ".clang-tidy": "Checks: '-*,clang-analyzer-core.*'\n",
    ".gitignore": "/build/\n",
}
PROGRAMS = {"format": "clang-format", "tidy": "clang-tidy", "spirv": "spirv-val", "spelling": "codespell"}
failures = 0


def fail(text, said):
    global failures
    failures += 1
    print("FAILED: %s; it said:\n%s" % (text, said))


def write(root, name, text):
    path = os.path.join(root, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def build(root, name, words):
    """A build folder as Meson leaves it: what is compiled, and a shader as a C array."""
    source = [path for path in (os.path.join(root, each) for each in BAD) if path.endswith("bad.comp")][0]
    array = "const uint32_t bad[] = {%s};\n" % ",".join("0x%08x" % word for word in words)
    header = write(root, "build/shaders/%s.spv.h" % name, array)
    targets = [{"filename": [header], "target_sources": [{"sources": [source]}]}]
    commands = [{"directory": root, "file": each, "command": "cc -c " + each}
                for each in ("engine/core/tidy.c", "engine/core/add.c")]
    write(root, "build/meson-info/intro-targets.json", json.dumps(targets))
    write(root, "build/compile_commands.json", json.dumps(commands))


def tree(root, files):
    for name, text in files.items():
        write(root, name, text)
    shutil.copy(os.path.join(os.path.dirname(sys.argv[1]), "..", ".clang-format"), root)
    for command in (["init", "-q", "-b", "main"], ["add", "-A"],
                    ["-c", "user.name=t", "-c", "user.email=t@example.org", "commit", "-q", "-m", "t"]):
        subprocess.run(["git", "-C", root] + command, check=True)


def check(root, *arguments):
    done = subprocess.run([sys.argv[1], "--root", root] + list(arguments), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)
    return done.returncode, done.stdout


def installed(part):
    return part not in PROGRAMS or shutil.which(PROGRAMS[part]) is not None


def bad_tree(root):
    tree(root, dict(FINE, **{name: text for name, (text, _) in BAD.items()}))
    build(root, "bad", BAD_SPIRV)


def every_mistake_is_found_once(root, parts):
    bad_tree(root)
    code, said = check(root, "--all", *parts)
    expected = [name + ":" + finding for name, (_, finding) in BAD.items()
                if finding.split(": ")[1] in parts]
    found = [line for line in said.splitlines() if not line.startswith("tools/check: ")]
    for start in expected:
        if len([line for line in found if line.startswith(start)]) != 1:
            fail("not found once: " + start, said)
    others = [line for line in found if not any(line.startswith(start) for start in expected)]
    if others or code != 1:
        fail("exit code %d, findings where nothing is wrong: %s" % (code, others), said)


def parts_run_alone(root, parts):
    bad_tree(root)
    for part in parts:
        code, said = check(root, "--all", part)
        kinds = {line.split(": ")[1] for line in said.splitlines() if not line.startswith("tools/check: ")}
        if code != 1 or kinds != {part}:
            fail("%s alone: exit code %d" % (part, code), said)


def a_good_tree_is_good(root, parts):
    tree(root, FINE)
    build(root, "good", SPIRV)
    code, said = check(root, "--all", *parts)
    if code != 0 or said != "tools/check: good\n":
        fail("a good tree: exit code %d" % code, said)


def what_cannot_run_says_so(root):
    code, said = check(root, "--build", "nowhere", "spirv")
    if code != 2 or "no compiled shaders in" not in said and "not installed" not in said:
        fail("a part without a build: exit code %d" % code, said)
    code, said = check(root, "speling")
    if code != 2 or "no part 'speling'" not in said:
        fail("a part that is not there: exit code %d" % code, said)


def the_hook_stops_a_bad_commit(root):
    """The hook calls the tree's own tools/check: here one that finds something, and one that does not."""
    code, said = check(root, "--install-hook")
    again, _ = check(root, "--install-hook")
    if code != 0 or again != 0:
        fail("--install-hook: exit code %d, then %d" % (code, again), said)
    for status, expected in ((1, 1), (0, 0)):
        os.chmod(write(root, "tools/check", "#!/bin/sh\nexit %d\n" % status), 0o755)
        done = subprocess.run(["git", "-C", root, "-c", "user.name=t", "-c", "user.email=t@example.org", "commit", "-q",
                               "--allow-empty", "-m", "t"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != expected:
            fail("a commit where tools/check gives %d: exit code %d" % (status, done.returncode), done.stdout)
    write(root, ".git/hooks/pre-commit", "#!/bin/sh\n")
    code, said = check(root, "--install-hook")
    if code != 2 or "is there already" not in said:
        fail("a hook of somebody else: exit code %d" % code, said)


def main():
    parts = [part for part in ("format", "tidy", "spirv", "includes", "lengths", "spelling") if installed(part)]
    for test in (every_mistake_is_found_once, parts_run_alone, a_good_tree_is_good):
        with tempfile.TemporaryDirectory() as root:
            test(root, parts)
    for test in (what_cannot_run_says_so, the_hook_stops_a_bad_commit):
        with tempfile.TemporaryDirectory() as root:
            tree(root, FINE)
            test(root)
    lacking = [PROGRAMS[part] for part in PROGRAMS if not installed(part)]
    if failures:
        return 1
    if lacking:
        print("skipped in part: not installed: %s" % ", ".join(lacking))
        return 77
    print("each mistake is found")
    return 0


if __name__ == "__main__":
    sys.exit(main())
