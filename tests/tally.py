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


def main():
    totals = [0, 0, 0]
    for path in sys.argv[1:]:
        for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
            totals = [total + more for total, more in zip(totals, tally_test(case))]
    print(*totals)


main()
