#!/usr/bin/env python3
"""What compute shaders need of a device, and what software Vulkan, which runs a workgroup in order, never notices.

The SPIR-V of every compute shader of the library is read, as the build compiles it:
  - shared memory is within the 16 KiB that Vulkan promises (maxComputeSharedMemorySize), but for passes that the
    library has another way for, and chooses it where a device has less;
  - a workgroup has no more invocations than the 256 that virga_check_device asks for;
  - where invocations wait for what others of their workgroup write to a buffer (memoryBarrierBuffer) there is a buffer
    that is coherent: without it each may go on to see what its own cache has (GLSL 4.60, section 4.10);
  - subgroups are known to the forms of passes that are chosen by the device's size of them, and to no other.

usage: compute_rules.py SOURCE_ROOT BUILD_ROOT
"""
import shutil
import sys

from graphics_rules import disassemble, instructions, list_passes

SHARED_BYTES = 16384
# Passes that are not used where a device has less, and what the library asks for: lens_way_of, engine/lens/lens.c.
ASKED_BYTES = {f"lens/{name}.comp": 27648 for name in ("narrow", "wide", "narrow_plane", "narrow_depths")}
INVOCATIONS = 256
BUFFERS = 0x40  # UniformMemory, among a barrier's semantics
OF_SUBGROUPS = ("_shuffle.comp", "_narrow.comp")
# Constants that pipelines set: of the workgroups that scan a long list, see scan_lanes in engine/gpu/pipeline_build.c.
SPECIAL = {"5": 512}
OPERATORS = {"IAdd": lambda a, b: a + b, "IMul": lambda a, b: a * b, "UDiv": lambda a, b: a // b,
             "BitwiseAnd": lambda a, b: a & b, "INotEqual": lambda a, b: int(a != b),
             "ULessThan": lambda a, b: int(a < b), "Select": lambda a, b, c: b if a else c}


def numbers_of(code):
    """Whole numbers by name: constants, and what is computed of those that pipelines set."""
    special = {words[0]: words[2] for _, op, words in code if op == "OpDecorate" and words[1] == "SpecId"}
    numbers, parts = {}, {}
    for result, op, words in code:
        if op in ("OpConstant", "OpSpecConstant") and words[1].isdigit():
            numbers[result] = SPECIAL.get(special.get(result), int(words[1]))
        elif op == "OpSpecConstantComposite":
            parts[result] = words[1:]
        elif op == "OpSpecConstantOp" and words[1] == "CompositeExtract" and words[2] in parts:
            numbers[result] = numbers[parts[words[2]][int(words[3])]]
        elif op == "OpSpecConstantOp" and words[1] in OPERATORS and all(word in numbers for word in words[2:]):
            numbers[result] = OPERATORS[words[1]](*(numbers[word] for word in words[2:]))
    return numbers


def bytes_of(name, types, numbers):
    op, words = types[name]
    if op in ("OpTypeInt", "OpTypeFloat"):
        return int(words[0]) // 8
    if op == "OpTypeVector":
        return int(words[1]) * bytes_of(words[0], types, numbers)
    if op == "OpTypeArray":
        return numbers[words[1]] * bytes_of(words[0], types, numbers)
    if op == "OpTypeStruct":
        return sum(bytes_of(word, types, numbers) for word in words)
    return 4  # a boolean, which has no size of its own


def shared_bytes(code):
    types = {result: (op, words) for result, op, words in code if result and op.startswith("OpType")}
    numbers = numbers_of(code)
    return sum(bytes_of(types[words[0]][1][1], types, numbers) for _, op, words in code
               if op == "OpVariable" and words[1] == "Workgroup")


def invocations(code):
    for _, op, words in code:
        if op == "OpExecutionMode" and words[1] == "LocalSize":
            return int(words[2]) * int(words[3]) * int(words[4])
    return 0


def waits_for_buffers(code):
    numbers = {result: int(words[1]) for result, op, words in code if op == "OpConstant" and words[1].isdigit()}
    return any(op == "OpMemoryBarrier" and numbers[words[1]] & BUFFERS for _, op, words in code)


def wrong_in(code, shader):
    found, shared, lanes = [], shared_bytes(code), invocations(code)
    coherent = any("Coherent" in words for _, op, words in code if op in ("OpDecorate", "OpMemberDecorate"))
    subgroups = any(op == "OpCapability" and words[0].startswith("GroupNonUniform") for _, op, words in code)
    most = next((n for name, n in ASKED_BYTES.items() if shader.endswith(name)), SHARED_BYTES)
    if shared > most:
        found.append("has %d bytes of shared memory, of %d" % (shared, most))
    if not 0 < lanes <= INVOCATIONS:
        found.append("has %d invocations in a workgroup, of %d" % (lanes, INVOCATIONS))
    if waits_for_buffers(code) and not coherent:
        found.append("waits for what is written to buffers, none of which is coherent")
    if subgroups and not shader.endswith(OF_SUBGROUPS):
        found.append("looks at its subgroup")
    return found


def main():
    source, build = sys.argv[1:]
    if not shutil.which("spirv-dis"):
        print("compute_rules.py: skipped, there is no spirv-dis (package spirv-tools)")
        sys.exit(77)
    modules, wrong = 0, []
    for shader, header in list_passes(source, build, ".comp"):
        wrong += [shader + ": " + text for text in wrong_in(instructions(disassemble(header)), shader)]
        modules += 1
    for text in wrong:
        print("compute_rules.py: " + text, file=sys.stderr)
    print("compute_rules.py: %d modules, %d wrong" % (modules, len(wrong)))
    sys.exit(1 if wrong or not modules else 0)


if __name__ == "__main__":
    main()
