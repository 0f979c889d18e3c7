"""check_openapi's comparison sees what is missing, or different, on either side."""

import copy
import unittest

from tool import load

check_openapi = load("check_openapi")

LIMITS = {"uniform_points_min": 8, "uniform_points_max": 20000, "tolerance_min_mm": 1e-4, "tolerance_max_mm": 10, "cutters_max": 64,
          "members_max": 10000, "diameter_min_mm": 5, "diameter_max_mm": 5000, "wall_min_mm": 0.5, "wall_max_mm": 2499.9,
          "offset_max_mm": 1e6, "angle_max_deg": 3600, "problems_named_max": 32, "reference_characters_max": 64, "nesting_max": 32}
PROPERTIES = {
    "uniform_points": {"minimum": 8, "maximum": 20000}, "tolerance_mm": {"minimum": 0.0001, "maximum": 10},
    "outer_diameter_mm": {"minimum": 5, "maximum": 5000}, "wall_mm": {"minimum": 0.5, "maximum": 2499.9},
    "offset_mm": {"minimum": -1000000, "maximum": 1000000}, "height_mm": {"minimum": -1000000, "maximum": 1000000},
    "clocking_deg": {"minimum": -3600, "maximum": 3600}, "cutters": {"$ref": "#/components/schemas/Cutters"},
    "errors": {"maxItems": 32}, "part": {"maxLength": 64}, "members": {"maxItems": 10000},
}
CONTRACT = {
    "paths": {"/v1/errors": {"get": {}}, "/v1/bevel-tables": {"post": {}}, "/v1/batches": {"post": {}}},
    "components": {"schemas": {
        "ErrorCode": {"enum": ["open_profile", "torch_range"]}, "WarningCode": {"enum": ["free_end"]},
        "Cutters": {"maxItems": 64}, "Request": {"properties": PROPERTIES}}},
}
FACTS = {
    "version": {"endpoints": [{"path": "/v1/bevel-tables"}], "batches": {"path": "/v1/batches"}},
    "errors": {"errors": [{"code": "open_profile"}, {"code": "torch_range"}], "warnings": [{"code": "free_end"}]},
    "limits": {"limits": LIMITS},
}


def said(contract, facts, catalogue=frozenset({"/v1/errors"})):
    return check_openapi.problems(contract, facts, catalogue)


def request(contract):
    return contract["components"]["schemas"]["Request"]["properties"]


# name: (change, words of the complaint)
CHANGES = {
    "path not written": (lambda c, f: f["version"]["endpoints"].append({"path": "/v1/holes"}), "/v1/holes is in the code"),
    "path not coded": (lambda c, f: f["version"]["endpoints"].pop(), "/v1/bevel-tables is in the contract"),
    "batches not written": (lambda c, f: c["paths"].pop("/v1/batches"), "/v1/batches is in the code"),
    "catalogue not written": (lambda c, f: c["paths"].pop("/v1/errors"), "GET /v1/errors is in the code"),
    "error not written": (lambda c, f: f["errors"]["errors"].append({"code": "wall"}), "wall is in the code"),
    "error not coded": (lambda c, f: f["errors"]["errors"].pop(), "torch_range is in the contract"),
    "warning not written": (lambda c, f: f["errors"]["warnings"].append({"code": "x"}), "x is in the code"),
    "warning not coded": (lambda c, f: f["errors"]["warnings"].pop(), "free_end is in the contract"),
    "limit not coded": (lambda c, f: f["limits"]["limits"].pop("wall_max_mm"), "wall_max_mm is shown by wall_mm"),
    "limit not known": (lambda c, f: f["limits"]["limits"].update(new_max=1), "new_max is in the code"),
    "field gone": (lambda c, f: request(c).pop("wall_mm"), "has no field wall_mm"),
    "field unbounded": (lambda c, f: request(c)["wall_mm"].pop("maximum"), "maximum None"),
    "one of two fields": (lambda c, f: c["components"]["schemas"].update(Two={"properties": {"wall_mm": {"minimum": 0.5, "maximum": 20}}}),
                          "maximum 20 at /components/schemas/Two"),
    "behind a reference": (lambda c, f: c["components"]["schemas"]["Cutters"].update(maxItems=65), "maxItems 65"),
}
# Every limit, changed only in the code.
CHANGES |= {f"{name} differs": ((lambda name: lambda c, f: f["limits"]["limits"].update({name: LIMITS[name] / 2}))(name), f"limit {name}: ")
            for name in LIMITS if name != "nesting_max"}


class CheckOpenapi(unittest.TestCase):
    def test_what_agrees_passes(self):
        self.assertEqual(said(CONTRACT, FACTS), [])

    def test_each_difference_is_named(self):
        for name, (change, words) in CHANGES.items():
            with self.subTest(name):
                contract, facts = copy.deepcopy(CONTRACT), copy.deepcopy(FACTS)
                change(contract, facts)
                self.assertIn(words, " | ".join(said(contract, facts)))


if __name__ == "__main__":
    unittest.main()
