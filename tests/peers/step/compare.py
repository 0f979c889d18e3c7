"""STEP files of /v1/parts read by others: compare.py SERVER_BINARY READER [PARTS [SEED]]

Parts are drawn here by a seed of the day. Open CASCADE (READER, read_step.cpp) must see each in both views as one valid solid; view `straight` has the answered volume, and
points of the answered cut on it; our own reader measures 1000 points of each. Of the default view it measures the rows."""

import json
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "formats"))
import drawn_parts  # noqa: E402
import step_volume  # noqa: E402
import step_test  # noqa: E402

AT_ONCE = 50
POINTS, OF_THEM_BY_READER = 1000, 4
ROWS = 200
NEAR_CUT = 2e-3  # mm


def answers(server, bodies, folder):
    """[(request, result, STEP as answered, default STEP)] of those that are answered all ways."""
    ways = (("json", {}), ("step", {"format": "step", "options": {"view": "straight"}}), ("smooth", {"format": "step"}))
    lines = [{"id": f"{i} {what}", "endpoint": "parts", "body": body, **more} for i, body in enumerate(bodies) for what, more in ways]
    batch = folder / "batch.ndjson"
    batch.write_text("".join(json.dumps(line) + "\n" for line in lines))
    ran = subprocess.run([server, "run", str(batch)], capture_output=True, text=True)
    found = {line["id"]: line for line in map(json.loads, ran.stdout.splitlines()) if "id" in line}
    for i, body in enumerate(bodies):
        one, other, smooth = (found[f"{i} {what}"] for what, _ in ways)
        if one["status"] == 200 and step_test.meets_end(one["body"]):
            continue
        if one["status"] == 200 and other["status"] == 200:
            yield body, one["body"]["result"], other["document"], smooth["document"]
        elif one["status"] == 200 and b"step prints no such solid" not in json.dumps(other["body"]).encode():
            sys.exit(f"no STEP of {json.dumps(body)}: {other}")


def main(server, reader, wanted="1000", seed=None):
    wanted, seed = int(wanted), int(seed or random.randrange(10**9))
    print(f"seed {seed}", flush=True)
    r, read, holes, biggest, small, invalid, beyond, few = random.Random(seed), 0, 0, 0, 0, 0, 0, 0
    worst = {"volume": 0.0, "volume by Open CASCADE": 0.0, "cut": 0.0, "cut by Open CASCADE": 0.0, "rows of the default": 0.0}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        while read < wanted:
            cases, asked = list(answers(server, [drawn_parts.part(r) for _ in range(AT_ONCE)], folder))[:wanted - read], []
            for i, (body, result, text, smooth) in enumerate(cases):
                points = step_test.exact_points(r, body, result, POINTS // (2 + len(result["holes"])))
                solid = step_test.solid_of(text.encode())
                far = step_test.off_cut(solid, points)
                if far > NEAR_CUT:
                    print(f"the cut is {far:.2g} mm off: {json.dumps(body)}", flush=True)
                worst["cut"] = max(worst["cut"], far)
                told = result["lengths"]["volume_mm3"]
                own = abs(step_volume.volume(solid) - told)
                beyond += not own <= step_test.volume_off(body["target"], result)
                worst["volume"] = max(worst["volume"], own / told)
                rows = step_test.rows_of(body, result)
                worst["rows of the default"] = max(worst["rows of the default"],
                                                   step_test.off_cut(step_test.solid_of(smooth.encode()), rows[r.sample(range(len(rows)), min(ROWS, len(rows)))]))
                small = max(small, len(smooth))
                (folder / f"{i}-smooth.step").write_text(smooth)
                asked.append(f"{folder}/{i}-smooth.step 0\n")
                (folder / f"{i}.step").write_text(text)
                some = points[r.sample(range(len(points)), OF_THEM_BY_READER)]
                asked.append(f"{folder}/{i}.step {len(some)}\n" + "".join("%.9f %.9f %.9f\n" % tuple(p) for p in some))
            ran = subprocess.run([reader], input="".join(asked), capture_output=True, text=True, check=True)
            seen = [line.split() for line in ran.stdout.splitlines() if line.count(" ") == 5]
            for (body, *_), smooth in zip(cases, seen[::2], strict=True):
                if (smooth[0], smooth[1], smooth[3]) != ("1", "1", "1"):
                    invalid += 1
                    print(f"default view, solids, shells, faces, valid: {smooth}: {json.dumps(body)}", flush=True)
            for (body, result, text, _), (solids, shells, _, valid, volume, far) in zip(cases, seen[1::2], strict=True):
                told = result["lengths"]["volume_mm3"]
                off = abs(float(volume) / told - 1)
                few += off > step_test.VOLUME_OFF
                if off > step_test.VOLUME_OFF:
                    print(f"volume off by {off:.2g}, {float(volume) - told:.3g} mm3: {json.dumps(body)}", flush=True)
                if (solids, shells, valid) != ("1", "1", "1"):
                    invalid += 1
                    print(f"{solids} solids, {shells} shells, valid {valid}, {len(text)} bytes: {json.dumps(body)}", flush=True)
                beyond += not off <= step_test.volume_off(body["target"], result) / told
                worst["volume by Open CASCADE"] = max(worst["volume by Open CASCADE"], off)
                worst["cut by Open CASCADE"] = max(worst["cut by Open CASCADE"], float(far))
                holes, biggest = holes + len(result["holes"]), max(biggest, len(text))
            read += len(cases)
    print(f"{read} parts with {holes} holes, up to {biggest} bytes, {small} in the default view; to Open CASCADE {invalid} are not one valid solid, {beyond} off in volume, " +
          f"{few} by more than a millionth; at worst " +
          ", ".join(f"{name} {value:.2g}" for name, value in worst.items()))
    cut = max(worst["cut"], worst["cut by Open CASCADE"])
    sys.exit(0 if invalid == beyond == few == 0 and cut <= NEAR_CUT and worst["rows of the default"] <= step_test.NEAR_ROWS else 1)


main(*sys.argv[1:])
