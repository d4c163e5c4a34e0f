"""What failed or was skipped, and the end of what it printed: python3 .ci/failures.py BUILD_NAME CTESTS_REPORT."""
import sys
import xml.etree.ElementTree

LINES_MAX = 60
WORDS = {"fail": "FAILED", "notrun": "SKIPPED", "disabled": "SKIPPED"}

build, report = sys.argv[1:]
for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
    word = WORDS.get(case.get("status"))
    if word is None:
        continue
    print(f"{word} {build}: {case.get('name')}, after {float(case.get('time') or 0):.1f} s")
    lines = (case.findtext("system-out") or "").splitlines()
    telling = [line for line in lines if "[       OK ]" not in line and "[ RUN      ]" not in line]
    print("".join(f"    {line}\n" for line in telling[-LINES_MAX:]), end="")
