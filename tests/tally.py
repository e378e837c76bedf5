"""Sums what CTest's JUnit reports say: prints 'passed failed skipped'. A suite counts its cmocka cases, any other test
counts one; a suite that failed without saying which case (a crash, a time-out) counts as one failure more."""

import re
import sys
import xml.etree.ElementTree

CASES = re.compile(r"^\[  (PASSED|FAILED|SKIPPED) *\] (\d+) test\(s\)", re.MULTILINE)


def tally_test(case):
    """(passed, failed, skipped) of one CTest entry."""
    output = "".join(element.text or "" for element in case.iter("system-out"))
    counts = {"PASSED": 0, "FAILED": 0, "SKIPPED": 0}
    for word, number in CASES.findall(output):
        counts[word] += int(number)
    status = case.get("status")
    if status == "fail" or case.find("failure") is not None:
        return counts["PASSED"], max(counts["FAILED"], 1), counts["SKIPPED"]
    if status == "run" and sum(counts.values()):
        return counts["PASSED"], counts["FAILED"], counts["SKIPPED"]
    return (1, 0, 0) if status == "run" else (0, 0, 1)


def own_test():
    """Shows tally_test one report of each kind."""
    reports = {
        '<testcase status="run"><system-out>[  PASSED  ] 7 test(s).\n</system-out></testcase>': (7, 0, 0),
        '<testcase status="run"><system-out>[  PASSED  ] 5 test(s).\n[  SKIPPED ] 2 test(s), listed below:\n'
        '</system-out></testcase>': (5, 0, 2),
        '<testcase status="fail"><failure/><system-out>[  PASSED  ] 5 test(s).\n[  FAILED  ] 2 test(s), listed below:\n'
        '</system-out></testcase>': (5, 2, 0),
        '<testcase status="fail"><failure/><system-out>Segmentation fault\n</system-out></testcase>': (0, 1, 0),
        '<testcase status="run"><system-out>layers: 0 problem(s)\n</system-out></testcase>': (1, 0, 0),
        '<testcase status="notrun"><skipped/></testcase>': (0, 0, 1),
    }
    for text, expected in reports.items():
        got = tally_test(xml.etree.ElementTree.fromstring(text))
        if got != expected:
            sys.exit(f"wanted {expected}, got {got} from {text}")
    print(f"{len(reports)} reports tallied")


def main():
    if sys.argv[1:] == ["--self-test"]:
        own_test()
        return
    totals = [0, 0, 0]
    for path in sys.argv[1:]:
        for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
            totals = [total + more for total, more in zip(totals, tally_test(case))]
    print(*totals)


main()
