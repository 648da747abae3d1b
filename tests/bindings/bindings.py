#!/usr/bin/env python3
"""A generator of bindings swallows the installed headers: cffi reads them, loads the library, and calls it.
Usage: bindings.py BUILD_ROOT CC

Exits with 77 if cffi is missing. Checked: no union and no bit-field; every value of an enum is written out, and none
differs from the list in enums.txt (a binding compiles numbers in, so a published one must stay); every function is
found in the library; every struct has the size that the library gives it; a context that can not be made says why
through a callback.
"""
import os
import re
import subprocess
import sys
import tempfile

try:
    import cffi
except ImportError:
    print("bindings.py: skipped, no python3-cffi")
    sys.exit(77)

build, cc = sys.argv[1:3]
here = os.path.dirname(os.path.abspath(__file__))
wrong = []


def expect(good, text):
    if not good:
        wrong.append(text)


def preprocess(prefix):
    """The declarations of our headers and Vulkan's, without those of the system."""
    code = subprocess.run(
        [cc, "-E", "-DVIRGA_STATIC", "-D__attribute__(x)=", f"-I{prefix}/include", "-"],
        input="#include <virga/virga.h>\n", capture_output=True, text=True, check=True).stdout
    kept, from_us = {"virga": [], "vulkan": []}, None
    for line in code.splitlines():
        marker = re.match(r'# \d+ "([^"]*)"', line)
        if marker:
            name = marker.group(1)
            from_us = "virga" if "/virga/" in name else "vulkan" if re.search("/vulkan/|/vk_video/", name) else None
        elif from_us:
            kept[from_us].append(line)
    return {name: "\n".join(lines) for name, lines in kept.items()}


def without_constants(code):
    """Without what cffi does not know and bindings do not need: 64-bit constants, and assertions of the compiler."""
    code = re.sub(r"static const \w+ \w+ = [^;]*;", "", code)
    return re.sub(r"_Static_assert\([^;]*\);", "", code).replace("_Bool", "bool")


def check_text(code):
    expect(not re.search(r"\bunion\b", code), "a header has a union")
    expect(not re.search(r"\b(u?int\w*|bool|_Bool|unsigned)\s+\w+\s*:\s*\d+\s*;", code), "a header has a bit-field")


def check_enums(code):
    found = {}
    for body in re.findall(r"\benum\s+\w+\s*\{([^}]*)\}", code):
        for entry in body.split(","):
            name, _, value = (part.strip() for part in entry.partition("="))
            if name.startswith("VIRGA_"):
                counts = name.endswith("S") and not value  # the number of values, which may grow
                expect(value or counts, f"{name} has no number of its own")
                if not counts:
                    found[name] = int(getattr(library, name))
    path = os.path.join(here, "enums.txt")
    with open(path, encoding="utf-8") as file:
        listed = {name: int(value) for name, value in (line.split() for line in file)}
    for name, value in listed.items():
        expect(found.get(name) == value, f"{name} was {value} and is {found.get(name)}: numbers must not change")
    for name in sorted(set(found) - set(listed)):
        expect(False, f"enums.txt lacks '{name} {found[name]}'")


def check_structs(ffi):
    """The library's own sizes, as its default functions give them."""
    count = 0
    for name in functions:
        made = re.fullmatch(r"virga_default_(\w+)", name)
        kind = made and f"virga_{made.group(1)}"
        if not kind or "size" not in dict(ffi.typeof(kind).fields):
            continue
        value = getattr(library, name)()
        expect(value.size == ffi.sizeof(kind), f"{kind} has {value.size} bytes, in the binding {ffi.sizeof(kind)}")
        count += 1
    expect(count > 15, f"only {count} structs were compared")


def check_calls(ffi):
    lines = []

    @ffi.callback("void(void *, virga_log_level, virga_log_id, const char *)")
    def log(_user, _level, number, text):
        lines.append((number, ffi.string(text).decode()))

    settings = library.virga_default_rain_settings()
    expect(settings.rate_mm_h > 0 and settings.sizes.kind == 0, "default settings are not what the header says")
    expect(abs(library.virga_drop_terminal_speed(0.002, 0) - 6.49) < 0.05, "a drop of 2 mm falls at 6.49 m/s")
    definition = ffi.new("virga_context_def *", library.virga_default_context_def())
    definition.log = log
    context = ffi.new("virga_context **")
    result = library.virga_context_create(definition, context)
    expect(result == library.VIRGA_ERROR_INVALID and context[0] == ffi.NULL, "a context of no device was made")
    expect(lines and lines[0][0] == library.VIRGA_LOG_ARGUMENT and "device" in lines[0][1], f"the log said {lines}")
    expect(ffi.string(library.virga_result_name(result)) == b"VIRGA_ERROR_INVALID", "the result has another name")


with tempfile.TemporaryDirectory() as folder:
    subprocess.run(["meson", "install", "-C", build, "--no-rebuild", "--quiet", "--destdir", folder,
                    "--tags", "devel,runtime"], check=True)
    header = subprocess.run(["find", folder, "-path", "*/virga/virga.h"], capture_output=True, text=True,
                            check=True).stdout.split()[0]
    prefix = os.path.dirname(os.path.dirname(os.path.dirname(header)))
    shared = subprocess.run(["find", folder, "-name", "libvirga.so"], capture_output=True, text=True,
                            check=True).stdout.split()[0]
    codes = preprocess(prefix)
    ffi = cffi.FFI()
    ffi.cdef(without_constants(codes["vulkan"]) + without_constants(codes["virga"]))
    library = ffi.dlopen(shared)
    functions = re.findall(r"\b(virga_\w+)\(", codes["virga"])
    for function in functions:
        expect(hasattr(library, function), f"the library has no {function}")
    check_text(codes["virga"])
    check_enums(codes["virga"])
    check_structs(ffi)
    check_calls(ffi)

for text in wrong:
    print(text)
print(f"bindings.py: {len(functions)} functions, {len(wrong)} mistakes")
sys.exit(1 if wrong else 0)
