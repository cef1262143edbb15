#!/usr/bin/python3
"""test_results.py BUILD: reads the results of the tests that ctest knows there.

Prints each case that failed and each result that is missing; the last line is `PASSED FAILED`, numbers of cases.
"""
import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def expected_results(build):
    """Return {result file: test name} of every test; catkin gives the file after its run_tests.py."""
    answer = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, capture_output=True, text=True, check=True)
    results = {}
    for test in json.loads(answer.stdout)["tests"]:
        command = test["command"]
        runner = next(i for i, word in enumerate(command) if word.endswith("run_tests.py"))
        results[Path(command[runner + 1])] = test["name"].replace("_ctest_screwline_", "", 1)
    return results


def cases(path):
    """Yield (name, why it failed or None) of each test case of a result file."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        yield path.name, f"not readable: {error}"
        return
    for case in root.iter("testcase"):
        bad = next((child for child in case if child.tag in ("failure", "error")), None)
        name = f"{path.stem}: {case.get('classname', '')}.{case.get('name', '')}"
        yield name, None if bad is None else (bad.get("message") or bad.text or "failed").strip()


def is_wrapper(path):
    """Of a rostest, rostest-NAME.xml only says that its tests ran; their cases are in the rosunit-*.xml beside it."""
    return path.name.startswith("rostest-")


def main():
    build = Path(sys.argv[1])
    expected = expected_results(build)
    found = set((build / "test_results").rglob("*.xml"))
    passed, failed = 0, []
    for path in sorted(found):
        for name, why in cases(path):
            if why is not None:
                failed.append(f"{name}: {why[:500]}")
            elif not is_wrapper(path):
                passed += 1
    failed += [f"{name}: no result" for path, name in expected.items()
               if path not in found and path.with_name(f"MISSING-{path.name}") not in found]
    print("\n".join(failed + [f"{passed} {len(failed)}"]))


if __name__ == "__main__":
    main()
