#!/usr/bin/env python3
"""Checks the water that goes from the ground to a solver and back. Usage: check_exchange.py FOLDER [spray]
With `spray` some of it must fly on as droplets."""
import json
import sys

wrong, most, sprayed, landed = [], 0, 0, 0
for line in map(json.loads, open(f"{sys.argv[1]}/stats.jsonl")):
    ground, solver = line["water_ul"], line["water"]["solver"]
    exchange = solver["exchange"]
    nl = {name: round(1000 * value) for name, value in ground.items()}
    came = sum(nl[name] for name in "start rained_total spray spray_off_ground touched given".split())
    went = sum(nl[name] for name in "absorbed film puddle run_off evaporated in_air off_ground cached evicted "
               "taken thrown".split())
    if came != went:
        wrong.append(f"frame {line['frame']}: {came} nl came to the ground, {went} nl are there or gone: {ground}")
    # Particles are whole: what the solver has is a multiple of one.
    left = exchange["given_ul"] + exchange["sprayed_ul"] + exchange["rest_ul"]
    has = round(1000 * (exchange["taken_ul"] - left)) - solver["particles"] * round(1000 * exchange["particle_ul"])
    if has != 0:
        wrong.append(f"frame {line['frame']}: the particles have {has} nl too little: {solver}")
    if abs(line["water"]["volume_l"] / (solver["particles"] * exchange["particle_ul"] * 1e-6) - 1) > 1e-6:
        wrong.append(f"frame {line['frame']}: {line['water']['volume_l']} l")
    most = max(most, solver["particles"])
    if "spray" in sys.argv[2:]:
        # All that left the solver is in the air, on the ground, or gone from it.
        spray = {name: round(1000 * value) for name, value in line["splash"]["spray_ul"].items()}
        if spray["handed_over"] != sum(spray[name] for name in "taken_back returned panes in_air".split()):
            wrong.append(f"frame {line['frame']}: not all of the spray is there: {spray}")
        sprayed, landed = exchange["sprayed_ul"], nl["spray"]
if most < 200:
    wrong.append(f"only {most} particles came from the ground")
if "spray" in sys.argv[2:] and not (sprayed > 0 and landed > 0):
    wrong.append(f"{sprayed} ul were thrown out of the water, and {landed} nl of it came to the ground")
if wrong:
    sys.exit("\n".join(wrong[:5]))
