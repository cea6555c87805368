"""check_refusals.py finds what is planted: a reason that is not shown, in every way of saying one."""
import contextlib
import io
import json
import pathlib
import tempfile
import unittest

import check_refusals

SOURCE = '''
// return make_problem(422, "in a comment");
return make_problem(422, "shown " + std::to_string(n) + " times");
return make_problem(422, "not shown");
value.fail(is_point ? "first branch" : "second branch");
return Refusal{503, std::string("of, a kind ") + name(other("never told")), {}};
'''


class PlantedTest(unittest.TestCase):
    def test_what_is_not_shown_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "server").mkdir()
            (root / "protocol").mkdir()
            (root / "server/planted.cpp").write_text(SOURCE)
            shown = {"examples": [{"detail": "shown 3 times"}, {"bye": "second branch"}]}
            (root / "protocol/openapi.json").write_text(json.dumps(shown))
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                self.assertEqual(check_refusals.main(root), 1)
        found = [line for line in said.getvalue().splitlines() if line.startswith("server/")]
        self.assertEqual(found, [
            "server/planted.cpp:4: the OpenAPI document does not show 'not shown'",
            "server/planted.cpp:5: the OpenAPI document does not show 'first branch'",
            "server/planted.cpp:6: the OpenAPI document does not show 'of, a kind *'",
        ])


if __name__ == "__main__":
    unittest.main()
