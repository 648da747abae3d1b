"""Compares the statistics of two runs over the same frames: one line a frame in each, in any order, and the same
numbers but for what depends on the clock and the memory of the moment. Usage: check_lines.py STATS STATS
"""
import json
import sys


def read(path):
    frames = {}
    for number, line in enumerate(open(path), 1):
        if not line.endswith("\n"):
            sys.exit(f"{path}: line {number} has no end")
        values = json.loads(line)
        if values["frame"] in frames:
            sys.exit(f"{path}: frame {values['frame']} is there twice")
        frames[values["frame"]] = {key: values[key] for key in values if key not in ("milliseconds", "device_bytes")}
    return frames


one, other = read(sys.argv[1]), read(sys.argv[2])
if one.keys() != other.keys():
    sys.exit(f"{sys.argv[2]}: frames {sorted(other)}, expected {sorted(one)}")
for frame in sorted(one):
    if one[frame] != other[frame]:
        sys.exit(f"{sys.argv[2]}: frame {frame}: {other[frame]}, expected {one[frame]}")
