"""Cases that are drawn, answered by the service, and given to a program of Open CASCADE as numbers."""

import json
import subprocess
import sys


def answered(server, endpoint, body):
    """The result, or nothing if the service refuses."""
    ran = subprocess.run([server, "run", "--endpoint", endpoint, "-"], input=json.dumps(body), capture_output=True, text=True)
    return json.loads(ran.stdout).get("result")


def compared(what, wanted, draw, program, bounds):
    """Gives `wanted` cases to the program. `draw` returns one case's text, or nothing if the service refuses it. Returns the most and the count
    of each bound's deviations."""
    cases, refused = [], 0
    while len(cases) < wanted:
        case = draw()
        if case is not None:
            cases.append(case)
            continue
        refused += 1
        if refused > 3 * wanted:
            sys.exit(f"{what}: the service refuses most of them")
    ran = subprocess.run([program], input="".join(cases), capture_output=True, text=True, check=True)
    seen = [words for words in map(str.split, ran.stdout.splitlines()) if words[0] in bounds]
    if len(seen) != len(bounds) * len(cases):
        sys.exit(f"{what}: {len(seen)} lines for {len(cases)} cases")
    most, counts = dict.fromkeys(bounds, 0.0), dict.fromkeys(bounds, 0)
    for name, count, deviation in seen:
        counts[name] += int(count)
        most[name] = max(most[name], float(deviation))
    print(f"{what}: {len(cases)} cases, {refused} more refused; largest deviation in mm (points compared): " +
          ", ".join(f"{name} {most[name]:.2g} ({counts[name]})" for name in bounds), flush=True)
    return most, counts


def held(worst, bounds):
    """Prints each bound; true if all hold."""
    for name, bound in bounds.items():
        print(f"{name}: {worst[name]:.3g} mm, bound {bound:g} mm: {'held' if worst[name] <= bound else 'BROKEN'}")
    return all(worst[name] <= bound for name, bound in bounds.items())
