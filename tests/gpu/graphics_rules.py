#!/usr/bin/env python3
"""What Vulkan asks of vertex and fragment shaders, and neither software Vulkan nor the eye notices.

The SPIR-V of every vertex and fragment shader of the library is read, in all forms that the build compiles:
  - no derivative (nor a sample that takes one) comes after a discard: the pixels beside may be gone, and what is
    derived is undefined (GLSL 4.60, section 8.14.1);
  - every storage buffer and image is readonly: stores in these stages are features (vertexPipelineStoresAndAtomics,
    fragmentStoresAndAtomics) that Virga does not ask for (VUID-RuntimeSpirv-NonWritable-06340 and -06341);
  - what a vertex shader hands on has room in 64 components, gl_Position among them: Vulkan promises no more
    (maxVertexOutputComponents, maxFragmentInputComponents), and software Vulkan has more;
  - no chance is made of a sine's last digits: they are the device's, and of each form of a shader (shared/random.h has
    numbers that are not).

usage: graphics_rules.py SOURCE_ROOT BUILD_ROOT
"""
import os
import re
import shutil
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools"))
from built_shaders import disassemble, list_passes, name_of  # noqa: E402

DISCARDS = ("OpKill", "OpTerminateInvocation", "OpDemoteToHelperInvocation")
LOCATIONS = 64 // 4 - 1
DERIVES = re.compile(r"^Op(DPdx|DPdy|Fwidth|Image\w*ImplicitLod|ImageQueryLod)")


def instructions(text):
    """[(result, op, operands)]"""
    found = []
    for line in text.splitlines():
        match = re.match(r"\s*(?:(%\w+) = )?(Op\w+)\s*(.*)", line)
        if match:
            found.append((match.group(1), match.group(2), match.group(3).split()))
    return found


def bodies(code):
    """{function: its instructions}, in the order of the module: glslang puts main first."""
    functions, name = {}, None
    for result, op, words in code:
        name = result if op == "OpFunction" else None if op == "OpFunctionEnd" else name
        if name:
            functions.setdefault(name, []).append((op, words))
    return functions


def with_calls(functions, test):
    """The functions in which an instruction passes the test, or which call one of those."""
    found = set()
    while True:
        more = {name for name, body in functions.items() if name not in found
                and any(test(op) or op == "OpFunctionCall" and words[1] in found for op, words in body)}
        if not more:
            return found
        found |= more


def derives_late(code):
    functions = bodies(code)
    derive = with_calls(functions, lambda op: DERIVES.match(op))
    discard = with_calls(functions, lambda op: op in DISCARDS)
    for body in functions.values():
        discarded = False
        for op, words in body:
            called = words[1] if op == "OpFunctionCall" else None
            if discarded and (DERIVES.match(op) or called in derive):
                return ["takes a derivative after a discard"]
            discarded = discarded or op in DISCARDS or called in discard
    return []


def hashes_by_sine(code):
    numbers = {result: float(words[1]) for result, op, words in code
               if op == "OpConstant" and re.match(r"-?[0-9.]+(e[-+]?[0-9]+)?$", words[1])}
    sines = {result for result, op, words in code if op == "OpExtInst" and words[2] in ("Sin", "Cos")}
    return ["multiplies a sine by %g" % numbers[number] for _, op, words in code if op == "OpFMul"
            for sine, number in (words[1:], words[:0:-1]) if sine in sines and abs(numbers.get(number, 0)) > 1000]


def member_decorations(code, name):
    """{struct: members with the decoration}"""
    found = {}
    for _, op, words in code:
        if op == "OpMemberDecorate" and words[2] == name:
            found.setdefault(words[0], set()).add(words[1])
    return found


def writes(code):
    types = {result: (op, words) for result, op, words in code if result and op.startswith("OpType")}
    decorated = {name: {words[0] for _, op, words in code if op == "OpDecorate" and words[1] == name}
                 for name in ("NonWritable", "BufferBlock")}
    readonly_members = member_decorations(code, "NonWritable")
    names = {words[0]: words[1].strip('"') for _, op, words in code if op == "OpName"}
    found = []
    for result, op, words in code:
        if op != "OpVariable" or result in decorated["NonWritable"]:
            continue
        kind, of = types[types[words[0]][1][1]]
        while kind in ("OpTypeArray", "OpTypeRuntimeArray"):
            kind, of = types[of[0]]
        pointee = types[words[0]][1][1]
        stored_image = kind == "OpTypeImage" and of[5] == "2"
        block = words[1] == "StorageBuffer" or pointee in decorated["BufferBlock"]
        if stored_image or block and len(readonly_members.get(pointee, ())) < len(of):
            found.append("may write to %s" % (names[result] or names[pointee]))
    return found


def locations(code, vertex):
    """What the shader's varyings need of them: up to the last that has any."""
    types = {result: (op, words) for result, op, words in code if result and op.startswith("OpType")}
    numbers = {result: int(words[1]) for result, op, words in code if op == "OpConstant" and words[1].isdigit()}
    at = {words[0]: int(words[2]) for _, op, words in code if op == "OpDecorate" and words[1] == "Location"}
    end = 0
    for result, op, words in code:
        if op == "OpVariable" and words[1] == ("Output" if vertex else "Input") and result in at:
            kind, of = types[types[words[0]][1][1]]
            end = max(end, at[result] + (numbers[of[1]] if kind == "OpTypeArray" else 1))
    return end


def too_many_locations(code, vertex):
    end = locations(code, vertex)
    return ["has varyings in %d locations, of %d" % (end, LOCATIONS)] if end > LOCATIONS else []


def main():
    source, build = sys.argv[1:]
    if not shutil.which("spirv-dis"):
        print("graphics_rules.py: skipped, there is no spirv-dis (package spirv-tools)")
        sys.exit(77)
    modules, wrong = 0, []
    for shader, header in list_passes(source, build, (".vert", ".frag")):
        code = instructions(disassemble(header))
        wrong += ["%s: %s: %s" % (shader, name_of(header), text)
                  for text in derives_late(code) + writes(code) + hashes_by_sine(code)
                  + too_many_locations(code, shader.endswith(".vert"))]
        modules += 1
    for text in wrong:
        print("graphics_rules.py: " + text, file=sys.stderr)
    print("graphics_rules.py: %d modules, %d wrong" % (modules, len(wrong)))
    sys.exit(1 if wrong or not modules else 0)


if __name__ == "__main__":
    main()
