#!/usr/bin/env python3
"""The structs of shaders/shared have the same layout in C and in SPIR-V.

Every struct is asked for its offsets and size three ways: of the C compiler, of a probe shader that holds one buffer of
each, and of every pass that ships, wherever it reads or writes one. In a block of several members each must begin
where the one before it ends, as the C that fills the buffer has it.

usage: layouts.py SOURCE_ROOT BUILD_ROOT CC GLSLANG_VALIDATOR
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools"))
import built_shaders  # noqa: E402

STRUCT = re.compile(r"^struct\s+(virga_\w+)\s*\{(.*?)^\};", re.S | re.M)
MEMBER = re.compile(r"^(?:float|uint|int|virga_\w+)\s+(\w+)((?:\[[^\]]*\])*)$")
GLSLANG = ["-V", "--quiet", "--target-env", "vulkan1.2"]


def fail(text):
    print("layouts.py: " + text, file=sys.stderr)
    sys.exit(1)


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if done.returncode:
        fail("%s gave %d:\n%s" % (" ".join(command), done.returncode, done.stdout))
    return done.stdout


# ---- what the headers hold


def strip_comments(text):
    return re.sub(r"//[^\n]*", "", re.sub(r"/\*.*?\*/", "", text, flags=re.S))


def read_headers(folder):
    """{struct: (header, [member...])}, in the order of the headers."""
    structs = {}
    for header in sorted(os.listdir(folder)):
        if not header.endswith(".h"):
            continue
        with open(os.path.join(folder, header), encoding="utf-8") as file:
            text = strip_comments(file.read())
        found = STRUCT.findall(text)
        if len(found) != len(re.findall(r"^\s*struct\s+virga_\w+\s*\{", text, re.M)):
            fail("%s: a struct is written so that this script does not find it" % header)
        for name, body in found:
            members = []
            for line in filter(None, (part.strip() for part in body.split(";"))):
                match = MEMBER.match(" ".join(line.split()))
                if not match:
                    fail("%s: %s has a member that this script does not read: %s" % (header, name, line))
                members.append(match.group(1))
            structs[name] = (header, members)
    return structs


# ---- as C has them


def c_layouts(structs, source, cc, folder):
    """{struct: ({member: offset}, size)}"""
    path = os.path.join(folder, "layouts.c")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#include <stddef.h>\n#include <stdio.h>\n")
        for header in sorted({header for header, _ in structs.values()}):
            file.write('#include "%s"\n' % header)
        file.write("int main(void)\n{\n")
        for name, (_, members) in structs.items():
            for member in members:
                file.write('    printf("%s %s %%zu\\n", offsetof(%s, %s));\n' % (name, member, name, member))
            file.write('    printf("%s . %%zu\\n", sizeof(%s));\n' % (name, name))
        file.write("    return 0;\n}\n")
    program = os.path.join(folder, "layouts")
    run(cc + ["-std=c11", "-I" + os.path.join(source, "shaders", "shared"), path, "-o", program])
    layouts = {name: ({}, 0) for name in structs}
    for line in run([program]).splitlines():
        name, member, value = line.split()
        if member == ".":
            layouts[name] = (layouts[name][0], int(value))
        else:
            layouts[name][0][member] = int(value)
    return layouts


# ---- as SPIR-V has them


class Module:
    """What spirv-dis says of types, names and decorations."""

    def __init__(self, text):
        self.names, self.member_names, self.offsets, self.strides, self.blocks = {}, {}, {}, {}, set()
        self.structs, self.arrays, self.scalars, self.vectors, self.constants = {}, {}, {}, {}, {}
        for line in text.splitlines():
            self.parse(line.strip())

    def parse(self, line):
        match = re.match(r'OpName (%\w+) "([^"]*)"', line)
        if match:
            self.names[match.group(1)] = match.group(2)
            return
        match = re.match(r'OpMemberName (%\w+) (\d+) "([^"]*)"', line)
        if match:
            self.member_names[match.group(1), int(match.group(2))] = match.group(3)
            return
        match = re.match(r"OpMemberDecorate (%\w+) (\d+) Offset (\d+)", line)
        if match:
            self.offsets[match.group(1), int(match.group(2))] = int(match.group(3))
            return
        match = re.match(r"OpDecorate (%\w+) ArrayStride (\d+)", line)
        if match:
            self.strides[match.group(1)] = int(match.group(2))
            return
        match = re.match(r"OpDecorate (%\w+) (Block|BufferBlock)\b", line)
        if match:
            self.blocks.add(match.group(1))
            return
        match = re.match(r"(%\w+) = (Op\w+)\s*(.*)", line)
        if match:
            self.define(match.group(1), match.group(2), match.group(3).split())

    def define(self, result, op, words):
        if op == "OpTypeStruct":
            self.structs[result] = words
        elif op in ("OpTypeArray", "OpTypeRuntimeArray"):
            self.arrays[result] = words
        elif op in ("OpTypeInt", "OpTypeFloat"):
            self.scalars[result] = int(words[0]) // 8
        elif op == "OpTypeVector":
            self.vectors[result] = words
        elif op == "OpConstant":
            self.constants[result] = words[1]

    def has_offsets(self, struct):
        return (struct, 0) in self.offsets

    def size(self, kind):
        """In bytes; None for an array without an end."""
        if kind in self.scalars:
            return self.scalars[kind]
        if kind in self.vectors:
            return self.size(self.vectors[kind][0]) * int(self.vectors[kind][1])
        if kind in self.arrays:
            words = self.arrays[kind]
            return self.strides[kind] * int(self.constants[words[1]]) if len(words) > 1 else None
        last = len(self.structs[kind]) - 1
        return self.offsets[kind, last] + self.size(self.structs[kind][last])

    def element(self, kind):
        while kind in self.arrays:
            kind = self.arrays[kind][0]
        return kind


# ---- both beside each other


class Checker:
    def __init__(self, layouts):
        self.layouts, self.failures, self.seen, self.members, self.blocks = layouts, [], {}, 0, 0

    def wrong(self, where, text):
        self.failures.append("%s: %s" % (where, text))

    def check_struct(self, where, module, struct):
        name = module.names.get(struct)
        offsets, size = self.layouts[name]
        found = {module.member_names[struct, i]: module.offsets[struct, i] for i in range(len(module.structs[struct]))}
        if list(found) != list(offsets):
            self.wrong(where, "%s has the members %s, in C %s" % (name, list(found), list(offsets)))
        for member in offsets:
            self.members += 1
            if found.get(member) != offsets[member]:
                self.wrong(where, "%s.%s is at %s, in C at %d" % (name, member, found.get(member), offsets[member]))
        if module.size(struct) != size:
            self.wrong(where, "%s ends at %s bytes, in C at %d" % (name, module.size(struct), size))
        self.seen.setdefault(name, set()).add(where)

    def check_strides(self, where, module):
        for array, stride in module.strides.items():
            name = module.names.get(module.arrays[array][0])
            if name in self.layouts and stride != self.layouts[name][1]:
                self.wrong(where, "%s follow each other every %d bytes, in C every %d"
                           % (name, stride, self.layouts[name][1]))

    def check_block(self, where, module, block):
        """C fills a block as one struct after the other; only the last may be without an end."""
        expected = 0
        for i, kind in enumerate(module.structs[block]):
            if expected is None or module.offsets[block, i] != expected:
                self.wrong(where, "member %s of block %s begins at %d, expected %s" % (
                    module.member_names[block, i], module.names.get(block), module.offsets[block, i], expected))
                return
            size = module.size(kind)
            expected = None if size is None else expected + size
        self.blocks += 1

    def check(self, where, module):
        for struct in module.structs:
            if module.names.get(struct) in self.layouts and module.has_offsets(struct):
                self.check_struct(where, module, struct)
        for block in module.blocks:
            if any(module.names.get(module.element(kind)) in self.layouts for kind in module.structs[block]):
                self.check_block(where, module, block)
        self.check_strides(where, module)


def probe(structs, source, glslang, folder):
    """A shader that reads a buffer of each struct."""
    path = os.path.join(folder, "probe.comp")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#version 460\n#extension GL_EXT_scalar_block_layout : require\n")
        file.write("#extension GL_GOOGLE_include_directive : require\n#define VIRGA_GLSL\n")
        for header in sorted({header for header, _ in structs.values()}):
            file.write('#include "shared/%s"\n' % header)
        file.write("layout(local_size_x = 1) in;\n")
        for i, name in enumerate(structs):
            file.write("layout(scalar, binding = %d) buffer Block%d { %s all%d[]; };\n" % (i, i, name, i))
        file.write("void main()\n{\n")
        for i in range(len(structs)):
            file.write("    all%d[0] = all%d[1];\n" % (i, i))
        file.write("}\n")
    output = os.path.join(folder, "probe.spv")
    run([glslang] + GLSLANG + ["-I" + os.path.join(source, "shaders"), "-o", output, path])
    return Module(run(["spirv-dis", "--raw-id", output]))


def main():
    source, build, cc, glslang = sys.argv[1], sys.argv[2], sys.argv[3].split(), sys.argv[4]
    if not shutil.which("spirv-dis"):
        print("layouts.py: skipped, there is no spirv-dis (package spirv-tools)")
        sys.exit(77)
    structs = read_headers(os.path.join(source, "shaders", "shared"))
    shaders = built_shaders.list_passes(source, build, (".vert", ".frag", ".comp"))
    if not structs or not shaders:
        fail("there are %d structs and %d shaders to look at" % (len(structs), len(shaders)))
    with tempfile.TemporaryDirectory() as folder:
        checker = Checker(c_layouts(structs, source, cc, folder))
        checker.check("probe", probe(structs, source, glslang, folder))
        missing = [name for name in structs if name not in checker.seen]
        if missing:
            fail("not seen in the probe: " + ", ".join(missing))
        for _, header in shaders:
            checker.check(built_shaders.name_of(header), Module(built_shaders.disassemble(header)))
    for text in checker.failures:
        print("layouts.py: " + text, file=sys.stderr)
    used = sum(len(users) > 1 for users in checker.seen.values())
    print("layouts.py: %d structs, %d of them in %d passes: %d members and %d blocks compared, %d wrong"
          % (len(structs), used, len(shaders), checker.members, checker.blocks, len(checker.failures)))
    if used < len(structs) // 2:
        fail("few structs were seen in the passes; are their names stripped?")
    sys.exit(1 if checker.failures else 0)


if __name__ == "__main__":
    main()
