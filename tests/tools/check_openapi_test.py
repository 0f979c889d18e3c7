"""check_openapi's comparison sees what is missing on either side."""

import copy
import unittest

from tool import load

check_openapi = load("check_openapi")

CONTRACT = {
    "paths": {"/v1/errors": {"get": {}}, "/v1/bevel-tables": {"post": {}},
              "/readyz": {"servers": [{"url": "http://localhost:9090"}], "get": {}}},
    "x-limits-elsewhere": ["body_bytes"],
    "components": {"schemas": {
        "ErrorCode": {"enum": ["open_profile", "torch_range"]},
        "WarningCode": {"enum": ["free_end"]},
        "Points": {"type": "integer", "minimum": 8, "maximum": 20000, "x-limit": "uniform_points"},
        "Cutters": {"type": "array", "minItems": 1, "maxItems": 64, "x-limit": "cutters"}}},
}
FACTS = {
    "version": {"endpoints": ["GET /v1/errors", "POST /v1/bevel-tables"]},
    "errors": {"errors": [{"code": "open_profile"}, {"code": "torch_range"}], "warnings": [{"code": "free_end"}]},
    "limits": {"uniform_points": {"min": 8, "max": 20000}, "cutters": {"min": 1, "max": 64}, "body_bytes": 1048576},
}

# name: (change, words of the only complaint)
CHANGES = {
    "path not written": (lambda c, f: f["version"]["endpoints"].append("GET /v1/limits"), "GET /v1/limits is in the code"),
    "path not coded": (lambda c, f: f["version"]["endpoints"].pop(), "/v1/bevel-tables is in the contract"),
    "other method": (lambda c, f: f["version"]["endpoints"].__setitem__(0, "POST /v1/errors"), "/v1/errors"),
    "error not written": (lambda c, f: f["errors"]["errors"].append({"code": "wall"}), "wall is in the code"),
    "error not coded": (lambda c, f: f["errors"]["errors"].pop(), "torch_range is in the contract"),
    "warning not written": (lambda c, f: f["errors"]["warnings"].append({"code": "x"}), "x is in the code"),
    "warning not coded": (lambda c, f: f["errors"]["warnings"].pop(), "free_end is in the contract"),
    "limit differs": (lambda c, f: f["limits"]["uniform_points"].update(max=10000), "max is 10000 in the code, 20000"),
    "limit below differs": (lambda c, f: f["limits"]["cutters"].update(min=0), "min is 0 in the code, 1"),
    "limit not written": (lambda c, f: f["limits"].update(nesting=32), "nesting is in the code"),
    "limit not coded": (lambda c, f: f["limits"].pop("cutters"), "cutters is in the contract"),
    "limit not named": (lambda c, f: c["components"]["schemas"]["Cutters"].pop("x-limit"), "cutters is in the code"),
}


class CheckOpenapi(unittest.TestCase):
    def test_what_agrees_passes(self):
        self.assertEqual(check_openapi.problems(CONTRACT, FACTS), [])

    def test_each_difference_is_named(self):
        for name, (change, words) in CHANGES.items():
            with self.subTest(name):
                contract, facts = copy.deepcopy(CONTRACT), copy.deepcopy(FACTS)
                change(contract, facts)
                found = check_openapi.problems(contract, facts)
                self.assertTrue(found)
                self.assertIn(words, " | ".join(found))


if __name__ == "__main__":
    unittest.main()
