#!/usr/bin/env python3
"""Checks the water that goes from the ground to the solver of solver.sh and back. Usage: check_exchange.py FOLDER"""
import json
import sys

wrong, most = [], 0
for line in map(json.loads, open(f"{sys.argv[1]}/stats.jsonl")):
    ground, solver = line["water_ul"], line["water"]["solver"]
    exchange = solver["exchange"]
    nl = {name: round(1000 * value) for name, value in ground.items()}
    came = sum(nl[name] for name in "start rained_total spray spray_off_ground touched given".split())
    went = sum(nl[name] for name in "absorbed film puddle run_off evaporated in_air off_ground cached evicted "
               "taken".split())
    if came != went:
        wrong.append(f"frame {line['frame']}: {came} nl came to the ground, {went} nl are there or gone: {ground}")
    # Particles are whole: what the solver has is a multiple of one.
    has = round(1000 * (exchange["taken_ul"] - exchange["given_ul"])) - solver["particles"] * round(
        1000 * exchange["particle_ul"])
    if has != 0:
        wrong.append(f"frame {line['frame']}: the particles have {has} nl too little: {solver}")
    if abs(line["water"]["volume_l"] - solver["particles"] * exchange["particle_ul"] * 1e-6) > 1e-6:
        wrong.append(f"frame {line['frame']}: {line['water']['volume_l']} l")
    most = max(most, solver["particles"])
if most < 200:
    wrong.append(f"only {most} particles came from the ground")
if wrong:
    sys.exit("\n".join(wrong[:5]))
