"""check_layers passes a sound tree and names what is wrong in a bad one."""

import unittest

from tool import run_on_tree

SOUND = {
    "core/base/angle.hpp": "#pragma once\n#include <Eigen/Core>\n#include <cmath>\n#include <tl/expected.hpp>\n",
    "core/base/elementary.cpp": '#include <sleef.h>\n#include "core/base/angle.hpp"\n',
    "core/base/error_codes.hpp": "#pragma once\n#include <cstdint>\n",
    "api/api.hpp": '#pragma once\n#include "core/base/error_codes.hpp"\n',
    "api/wire/json.cpp": '#include <nlohmann/json.hpp>\n#include "api/api.hpp"\n',
    "server/app.hpp": "#pragma once\n#include <thread>\n",
    "server/admin_port.cpp": '#include <httplib.h>\n#include "api/api.hpp"\n#include "server/app.hpp"\n',
    "server/http/loop.hpp": "#pragma once\n#include <boost/asio/io_context.hpp>\n",
    "server/observe/json_line.cpp": "#include <nlohmann/json.hpp>\n",
    "server/observe/metrics.cpp": "#include <prometheus/counter.h>\n",
    "tests/x_test.cpp": '#include "core/base/angle.hpp"\n#include "server/app.hpp"\n',
}

# Additions to the sound tree, and the tool's expected messages.
BAD = {
    "two types of one name": (
        {"api/x.hpp": "#pragma once\nnamespace tubecut::api {\nstruct Column {\n};\n}  // namespace tubecut::api\n",
         "api/wire/y.hpp": "#pragma once\nnamespace tubecut::api {\nclass Column final {\n};\n}  // namespace tubecut::api\n"},
        "tubecut::api::Column is another type in"),
    "core looks at api": ({"core/x.cpp": '#include "api/api.hpp"\n'}, "core may not look there"),
    "core looks at server": ({"core/x.cpp": '#include "server/app.hpp"\n'}, "core may not look there"),
    "core in brackets": ({"core/x.cpp": "#include <api/api.hpp>\n"}, "core may not look there"),
    "core reads JSON": ({"core/x.cpp": "#include <nlohmann/json.hpp>\n"}, "belongs in"),
    "core calls sleef": ({"core/x.cpp": "#  include <sleef.h>\n"}, "belongs in core/base/elementary.cpp"),
    "core formats": ({"core/x.cpp": "#include <fmt/core.h>\n"}, "not among what core may include"),
    "core reads files": ({"core/x.cpp": "#include <fstream>\n"}, "does no I/O"),
    "core reads a clock": ({"core/x.cpp": "#include <chrono>\n"}, "does no I/O"),
    "api looks at server": ({"api/x.cpp": '#include "server/app.hpp"\n'}, "api may not look there"),
    "api speaks HTTP": ({"api/x.cpp": "#include <httplib.h>\n"}, "belongs in server/admin_port.cpp"),
    "nlohmann in a header": ({"api/x.hpp": "#pragma once\n#include <nlohmann/json_fwd.hpp>\n"}, "belongs in"),
    "nlohmann twice": ({"server/x.cpp": "#include <nlohmann/json.hpp>\n"}, "belongs in api/wire/json.cpp and server/observe/json_line.cpp"),
    "nlohmann in a test": ({"tests/x.cpp": "#include <nlohmann/json.hpp>\n"}, "more than one file"),
    "server reaches into api": (
        {"server/x.cpp": '#include "api/wire/json.hpp"\n', "api/wire/json.hpp": "#pragma once\n"}, "server may not look there"),
    "server reaches into core": ({"server/x.cpp": '#include "core/base/angle.hpp"\n'}, "server may not look there"),
    "httplib elsewhere": ({"server/x.cpp": "#include <httplib.h>\n"}, "belongs in server/admin_port.cpp"),
    "boost beside its room": ({"server/x.hpp": "#pragma once\n#include <boost/asio.hpp>\n"}, "belongs in server/http/"),
    "prometheus twice": ({"server/x.cpp": "#include <prometheus/gauge.h>\n"}, "more than one file"),
    "a circle": (
        {"core/a.hpp": '#pragma once\n#include "core/b.hpp"\n', "core/b.hpp": '#pragma once\n#include "core/a.hpp"\n'},
        "include each other"),
    "a circle of the console's": (
        {"web/src/a.ts": "import {b} from './pictures/b';\n", "web/src/pictures/b.ts": "import type {A} from '../a';\n"},
        "include each other"),
    "a circle of its views": (
        {"web/src/view/a.tsx": "import {B} from './b';\n", "web/src/view/b.tsx": "import type {A} from './a';\n"},
        "include each other"),
    "no such file": ({"core/x.cpp": '#include "angle.hpp"\n'}, "is no file"),
    "no guard": ({"core/x.hpp": "int x;\n"}, "#pragma once"),
}


class CheckLayers(unittest.TestCase):
    def test_a_sound_tree_passes(self):
        status, said = run_on_tree(SOUND, "check_layers", "ROOT")
        self.assertEqual(status, 0, said)
        self.assertIn("10 files", said)

    def test_each_bad_tree_fails_and_says_why(self):
        for name, (files, words) in BAD.items():
            with self.subTest(name):
                status, said = run_on_tree({**SOUND, **files}, "check_layers", "ROOT")
                self.assertEqual(status, 1, said)
                self.assertIn(words, said)

    def test_an_empty_tree_fails(self):
        self.assertEqual(run_on_tree({}, "check_layers", "ROOT")[0], 1)


if __name__ == "__main__":
    unittest.main()
