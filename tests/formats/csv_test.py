"""Every column of the JSON answer stands in the CSV, with equal numbers, of every endpoint that has one."""

import csv
import io
import json
import math
import re

from service import FormatTest, cutout_name, examples, main

# Arrays of the answers that are no columns of a table: coefficients, names, vectors, the points of a program's ways.
NO_COLUMNS = re.compile(r"^side_lengths\.|^(fit|comparison\[\d+\])\.(chebyshev|scaled|seconds|seconds_rounded)$|cutter_ids$|^(axes|idle)$|^frame\."
                        r"|^check_dimensions\[\d+\]\.changes_with$|\.box$|^segments\[\d+\]\.way\.")
SCALARS = (int, float, str, bool, type(None))


def columns(value, path=""):
    """(path, values) of every array of scalars."""
    if isinstance(value, dict):
        for name, member in value.items():
            yield from columns(member, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and value and all(isinstance(v, SCALARS) for v in value):
        yield path, value
    elif isinstance(value, list):
        for i, member in enumerate(value):
            yield from columns(member, f"{path}[{i}]")


def label_of(endpoint, result, path):
    """The rows of a stacked CSV that a JSON path belongs to, and their label's column; None: all rows."""
    at = re.match(r"(\w+)\[(\d+)\]", path)
    if endpoint == "intersections":
        return "surface", result["profiles"][int(at[2])]["surface"]
    if endpoint == "holes":
        return "side", result["holes"][int(at[2])]["side"] if at else "branch"
    if endpoint == "parts":
        if at and at[1] == "cutouts":
            group = result["cutouts"][int(at[2])]
            return "cut", cutout_name(group, group["instances"][0])
        if at and at[1] == "marks":
            text, stroke = result["marks"][int(at[2])]["lettering"]["id"], int(re.search(r"strokes\[(\d+)\]", path)[1])
            return "cut", f"mark of text {text}, stroke {stroke + 1}"
        return "cut", f"hole {at[2]}" if at else path.split(".")[1]
    return None


def names_of(path, result):
    """What the column may be called: its own name, or with that of the object it stands in."""
    if axis := re.match(r"comparison\.naive\.axes\[(\d+)\]\.pulses$", path):
        return (f"naive_{result['comparison']['naive']['axes'][int(axis[1])]['name']}_pulses",)
    *_, group, name = ["", *re.sub(r"\[\d+\]", "", path).split(".")]
    return (name + "_pulses",) if group == "counts" else (f"{group}_{name}", name)


def cell(value):
    if value is None:
        return ""  # an empty cell
    return str(value).lower() if isinstance(value, bool) else value if isinstance(value, str) else float(value)


def rows_of(text):
    """Rows behind the head of remarks."""
    lines = text.split("\r\n")
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    return list(csv.DictReader(io.StringIO("\r\n".join(lines[head:]), newline="")))


class Csv(FormatTest):
    def endpoints(self):
        version = json.loads(self.service.get("/v1/version"))
        # A frame's is its cut list, a row a member, which the bundle's test reads.
        found = [e["id"] for e in version["endpoints"] if "text/csv" in e["formats"] and e["id"] != "frames"]
        self.assertGreaterEqual(len(found), 8)
        return found

    def bodies(self, endpoint):
        yield from examples(endpoint, drawn=False).items()
        if endpoint == "bevel-tables":  # 360 i / n is exact, not through radians and back
            yield "uniform", examples(endpoint)["zones"] | {"sampling": {"uniform_points": 12}}
        if endpoint == "holes":
            for name, body in examples(endpoint).items():
                yield name + ", uniform", {**body, "sampling": {"uniform_points": 12}}

    def test_every_column_of_the_json(self):
        for endpoint in self.endpoints():
            count = 0
            for name, body in self.bodies(endpoint):
                result = self.service.answer(endpoint, body)["result"]
                text = self.service.text(endpoint, body, "format=csv").decode("ascii")
                rows = rows_of(text)
                for path, values in columns(result):
                    if NO_COLUMNS.search(path):
                        continue
                    with self.subTest(f"{endpoint} {name} {path}"):
                        column = next((n for n in names_of(path, result) if n in rows[0]), None)
                        self.assertIsNotNone(column, "no such column in the CSV")
                        where = label_of(endpoint, result, path)
                        mine = [row[column] for row in rows if not where or row[where[0]] == where[1]]
                        mine = mine[:len(values)] + [left for left in mine[len(values):] if left]
                        self.assertEqual([type(v)(m) if not isinstance(v, bool) else m for v, m in zip(map(cell, values), mine, strict=True)],
                                         list(map(cell, values)))
                        count += 1
            print(f"{endpoint}: {count} columns")
            self.assertGreater(count, 2, endpoint)

    def test_check_dimensions_are_a_table_of_their_own(self):
        for name, body in examples("parts").items():
            with self.subTest(name):
                asked = self.service.answer("parts", body)["result"]["check_dimensions"]
                rows = rows_of(self.service.text("parts", body, "format=csv&view=check_dimensions").decode())
                plain = [re.sub(r"(^|[,;|])([ \"]*)'(?=[=+\-@'])", r"\1\2", r["measured_from"]) for r in rows]
                self.assertEqual([(r["name"], float(r["value_mm"]), r["tool"], text, r["changes_with"].split()) for r, text in zip(rows, plain)],
                                 [(d["name"], d["value_mm"], d["tool"], d["measured_from"], d["changes_with"]) for d in asked])
                cuts = rows_of(self.service.text("parts", body, "format=csv").decode())
                self.assertFalse({"name", "measured_from"} & set(cuts[0]))
                self.assertTrue(all(row["cut"] for row in cuts))

    def test_uniform_angles_are_exact(self):
        body = examples("bevel-tables")["zones"] | {"sampling": {"uniform_points": 12}}
        rows = rows_of(self.service.text("bevel-tables", body, "format=csv").decode())
        self.assertEqual([row["phi_deg"] for row in rows], [str(30 * i) for i in range(12)])

    def test_an_empty_cell_is_where_a_cut_has_no_such_column(self):
        text = self.service.text("parts", examples("parts")["chord-with-holes"], "format=csv").decode()
        rows = rows_of(text)
        self.assertEqual({bool(row["z_outer_mm"]) for row in rows if row["cut"] in ("start", "finish")}, {True})
        self.assertEqual({bool(row["z_outer_mm"]) for row in rows if row["cut"].startswith("hole")}, {False})
        self.assertTrue(all(math.isfinite(float(row["torch_z_mm"])) for row in rows if row["cut"].startswith("hole")))


if __name__ == "__main__":
    main()
