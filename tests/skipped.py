#!/usr/bin/env python3
"""skipped.py RESULTS: one line of what a run of ctest left out and why, from its --output-junit."""

import collections
import re
import sys
from xml.etree import ElementTree


def reason(case):
    """GoogleTest's own words stand in a line after the place of the skip."""
    words = re.search(r": Skipped\n+(.+)", case.findtext("system-out") or "")
    return words[1].strip() if words else "no reason told"


def main():
    cases = ElementTree.parse(sys.argv[1]).getroot().iter("testcase")
    left_out = collections.defaultdict(list)
    for case in cases:
        if case.get("status") == "disabled":
            left_out["disabled in its source"].append(case.get("name"))
        elif case.find("skipped") is not None:
            left_out[reason(case)].append(case.get("name"))
    told = [f"{', '.join(names)} ({why})" for why, names in left_out.items()]
    print("fingertip: skipped: " + ("; ".join(told) if told else "nothing"))


if __name__ == "__main__":
    main()
