#!/usr/bin/env python3
"""Draws faults, puts all of them into one build, switched on one at a time, and tells which tests catch them.

    tests/faults/draw_faults.py --seed N --count 100 [--work FOLDER] [--rooms ROOM ...] [--programs TEST ...]
    tests/faults/draw_faults.py --seed N --count 100 --list

A fault changes a sign, an operator, a comparison, a constant or the order of arguments in a drawn
statement of arithmetic. In a copy of the sources every drawn statement stands twice, sound and faulty,
and FINGERTIP_FAULT=N chooses number N. Once all tests have run sound it is known which statement each
of them reaches; a fault is then tried by those that reach it, the quickest first, until one fails. What
the compiler refuses is left out and drawn anew. FOLDER keeps copy, build and table: a run that is
stopped goes on. equal.toml names survivors that change nothing that can be seen, and why.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ROOMS = ["lattice", "fem_reference", "calibration", "meshes/press", "meshes/rubber", "studies/measurements"]

# Every process notes which statements it comes by.
HEADER = """#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>
namespace fingertip_faults {
struct Reached {
  int chosen = std::getenv("FINGERTIP_FAULT") ? std::atoi(std::getenv("FINGERTIP_FAULT")) : -1;
  char at[%d] = {};
  ~Reached() {
    const char* folder = std::getenv("FINGERTIP_REACHED");
    if (!folder) return;
    std::string all;
    for (int i = 0; i < int(sizeof at); ++i)
      if (at[i]) all += std::to_string(i) + "\\n";
    if (all.empty()) return;
    if (std::FILE* file = std::fopen((std::string(folder) + "/" + std::to_string(getpid())).c_str(), "a")) {
      std::fputs(all.c_str(), file);
      std::fclose(file);
    }
  }
};
inline Reached reached;
inline bool is(int number) {
  reached.at[number] = 1;
  return reached.chosen == number;
}
}  // namespace fingertip_faults
"""

NUMBER = re.compile(r"(?<![\w.<\"'])(\d+\.\d*(?:e[-+]?\d+)?|\d+)(?![\w.\"'])")
PAIR = re.compile(r"(?<!min)(?<!max)(?<!hypot)\((\w+(?:\.\w+)*), (\w+(?:\.\w+)*)\)")
NEGATIVE = re.compile(r"(?<=[(=,] )-(?=[\w(])|(?<=\()-(?=[\w(])|(?<=return )-(?=[\w(])")
SWAPS = {
    " + ": [" - "], " - ": [" + "], " * ": [" / "], " / ": [" * "], " += ": [" -= "], " -= ": [" += "],
    " < ": [" <= ", " > "], " <= ": [" < ", " > "], " > ": [" >= ", " < "], " >= ": [" > ", " < "],
    " == ": [" != "], " != ": [" == "], " && ": [" || "], " || ": [" && "],
    "std::min(": ["std::max("], "std::max(": ["std::min("], "sin(": ["cos("], "cos(": ["sin("],
}  # fmt: skip


def changes(text):
    """(kind, changed text) of everything that can be changed in a piece of arithmetic."""
    found = []
    for old, news in SWAPS.items():
        for match in re.finditer(re.escape(old), text):
            kind = "comparison" if old.strip()[0] in "<>=!&|" else "operator"
            found += [(kind, text[: match.start()] + new + text[match.end() :]) for new in news]
    for match in NEGATIVE.finditer(text):
        found.append(("sign", text[: match.start()] + text[match.end() :]))
    for match in NUMBER.finditer(text):
        value = match[1]
        new = str(int(value) + 1) if value.isdigit() else f"({value} * 1.25 + 0.125)"
        found.append(("constant", text[: match.start()] + new + text[match.end() :]))
    for match in PAIR.finditer(text):
        if match[1] != match[2]:
            found.append(("arguments", f"{text[: match.start()]}({match[2]}, {match[1]}){text[match.end() :]}"))
    return found


RETURN = re.compile(r"return (?P<value>.+);")
VARIABLE = re.compile(r"(?P<head>(?:const )?(?P<type>(?:\w+::)*\w+(?:<[\w:, ]+>)?) \w+ = )(?P<value>.+);")
ASSIGNMENT = re.compile(r"(?P<head>[\w.\[\]()>+ :-]*?[\w\])] (?:=|\+=|-=|\*=|/=) )(?P<value>.+);")
BRACKETS = re.compile(r"\([^()]*\)|\[[^\[\]]*\]")
NO_TYPE = {"auto", "return", "using", "else", "case", "goto", "delete", "new", "throw"}


def both(line, number, draw):
    """(kind, faulty line, line that has it and the sound one) of a statement on one line, or None."""
    indent = line[: len(line) - len(line.lstrip())]
    code = line.strip().split("  //")[0].rstrip()
    choose = f"::fingertip_faults::is({number})"
    if re.search(r'"|constexpr|static|assert|\[&|\[=|\[this|using |template|operator|case |default:', code):
        return None
    if match := RETURN.fullmatch(code):
        options = [(kind, f"return {new.strip()};") for kind, new in changes(" " + match["value"])]
        form = "if ({choose}) {new} else {old}"
    elif (match := VARIABLE.fullmatch(code)) and match["type"] not in NO_TYPE:
        options = [(kind, match["head"] + new.strip() + ";") for kind, new in changes(" " + match["value"])]
        cast, head = match["type"], match["head"]
        if not options:
            return None
        kind, new = draw.choice(options)
        faulty = new[len(head) : -1]
        return kind, new, f"{indent}{head}{choose} ? {cast}({faulty}) : {cast}({match['value']});"
    elif (match := ASSIGNMENT.fullmatch(code)) and " " not in BRACKETS.sub("", match["head"].rsplit(" ", 2)[0]):
        options = [(kind, new) for kind, new in changes(code) if new.count("=") == code.count("=")]
        form = "if ({choose}) {new} else {old}"
    else:
        return None
    if not options:
        return None
    kind, new = draw.choice(options)
    return kind, new, indent + form.format(choose=choose, new=new, old=code)


def statements(rooms):
    """(file, number of the line) of all statements that stand on a line of their own."""
    listed = subprocess.run(["git", "ls-files", *rooms], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in sorted(listed.stdout.split()):
        if not name.endswith((".cc", ".h")):
            continue
        before = ";"
        for number, line in enumerate((ROOT / name).read_text().splitlines()):
            code = line.strip()
            if code.endswith(";") and before.endswith((";", "{", "}", ")", ":", "*/")) and line.startswith("  "):
                yield name, number
            if code and not code.startswith("//"):
                before = code.split("  //")[0].rstrip()


def drawn(options):
    """The faults: dictionaries with file, line, kind, old, new and the line for both."""
    draw = random.Random(options.seed)
    places = list(statements(options.rooms))
    draw.shuffle(places)
    for name, line in places:
        text = (ROOT / name).read_text().splitlines()[line]
        if found := both(text, "NUMBER", draw):
            yield {"file": name, "line": line, "kind": found[0], "old": text.strip(), "new": found[1], "both": found[2]}


def put_in(faults, sources):
    """The sources with all faults, each to be chosen by its number."""
    by_file = collections.defaultdict(list)
    for number, fault in faults.items():
        by_file[fault["file"]].append((number, fault))
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.split("\n"):
        if not (ROOT / name).is_file():
            continue
        text = (ROOT / name).read_bytes()
        if name in by_file:
            lines = text.decode().split("\n")
            for number, fault in by_file[name]:
                lines[fault["line"]] = fault["both"].replace("NUMBER", str(number))
            text = "\n".join(lines).encode()
        target = sources / name
        if not target.exists() or target.read_bytes() != text:  # else nothing is compiled again
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(text)
            shutil.copymode(ROOT / name, target)


def built(options, faults, sources, build):
    """Builds; leaves out what does not compile, until it does."""
    header = options.work / "faults.h"
    text = HEADER % (10 * options.count)
    if not header.exists() or header.read_text() != text:
        header.write_text(text)
    while True:
        put_in(faults, sources)
        if not (build / "build.ninja").exists():
            subprocess.run(["cmake", "-S", sources, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            f"-DCMAKE_CXX_FLAGS=-include {header} -w"],
                           check=True, stdout=subprocess.DEVNULL)  # fmt: skip
        run = subprocess.run(["ninja", "-C", build, "-k", "0", *options.programs], capture_output=True, text=True)
        if run.returncode == 0:
            return
        places = {(match[1], int(match[2]) - 1)
                  for match in re.finditer(rf"{re.escape(str(sources))}/([\w./]+):(\d+):\d+: ", run.stdout)}  # fmt: skip
        refused = [number for number, fault in faults.items() if (fault["file"], fault["line"]) in places]
        if not refused:  # what it declares is missed further on
            refused = [max((number for number, fault in faults.items() if (fault["file"], fault["line"]) < place
                            and fault["file"] == place[0]), key=lambda number: faults[number]["line"], default=None)
                       for place in places]  # fmt: skip
            refused = sorted({number for number in refused if number is not None})
        if not refused:
            sys.exit(f"the build fails without a fault at fault:\n{run.stdout[-3000:]}")
        for number in refused:
            del faults[number]
        print(f"{len(refused)} faults do not compile; {len(faults)} are left", flush=True)


def test_list(build, programs):
    run = subprocess.run(["ctest", "--test-dir", build, "-LE", "slow", "--show-only=json-v1"],
                         capture_output=True, text=True, check=True)  # fmt: skip
    tests = {}
    for test in json.loads(run.stdout)["tests"]:
        properties = {each["name"]: each["value"] for each in test.get("properties", [])}
        if "command" not in test or properties.get("DISABLED"):
            continue
        if programs and test["name"].split(".")[0] not in programs:
            continue
        tests[test["name"]] = (test["command"], properties.get("WORKING_DIRECTORY", str(build)),
                               dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", [])))  # fmt: skip
    return tests


def passes(test, limit, **further):
    command, folder, own = test
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", **own, **further}
    try:
        return subprocess.run(command, cwd=folder, env=environment, timeout=limit, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0  # fmt: skip
    except subprocess.TimeoutExpired:
        return False


def reaches(tests, folder):
    """Of every test that passes sound: seconds, and the numbers of the statements that it comes by."""

    def one(item):
        name, test = item
        seen = folder / re.sub(r"\W", "_", name)
        seen.mkdir(parents=True, exist_ok=True)
        start = time.monotonic()
        sound = passes(test, 1800.0, FINGERTIP_REACHED=str(seen))
        numbers = {int(line) for file in seen.iterdir() for line in file.read_text().split()}
        return name, (time.monotonic() - start, sorted(numbers)) if sound else None

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return {name: found for name, found in pool.map(one, tests.items()) if found}


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--seed", type=int, required=True)
    arguments.add_argument("--count", type=int, required=True)
    arguments.add_argument("--work", type=pathlib.Path, default=pathlib.Path("build/faults"))
    arguments.add_argument("--rooms", nargs="+", default=ROOMS)
    arguments.add_argument("--programs", nargs="+", default=[], help="test programs; default: all")
    arguments.add_argument("--list", action="store_true", help="only tell what is drawn")
    options = arguments.parse_args()

    wanted = drawn(options)
    # Some more than asked for: what does not compile is replaced.
    faults = dict(enumerate(fault for fault, _ in zip(wanted, range(options.count + options.count // 2))))
    if options.list:
        for number, fault in list(faults.items())[: options.count]:
            print(f"{number} {fault['file']}:{fault['line'] + 1} ({fault['kind']})\n  {fault['old']}\n  {fault['new']}")
        return
    options.work = options.work.resolve()
    sources, build = options.work / "sources", options.work / "build"
    options.work.mkdir(parents=True, exist_ok=True)
    built(options, faults, sources, build)
    faults = dict(list(faults.items())[: options.count])

    tests = test_list(build, options.programs)
    record = options.work / "reached.json"
    if not record.exists():
        record.write_text(json.dumps(reaches(tests, options.work / "reached")))
    found = json.loads(record.read_text())
    print(f"{len(found)} of {len(tests)} tests pass sound, in {sum(s for s, _ in found.values()):.0f} s", flush=True)

    equal = tomllib.loads((HERE / "equal.toml").read_text())["fault"]
    table = options.work / "drawn.json"
    results = json.loads(table.read_text()) if table.exists() else {}

    def tried(number, fault):
        own = sorted((seconds, name) for name, (seconds, numbers) in found.items() if number in numbers)
        for seconds, name in own:
            if not passes(tests[name], 5.0 * seconds + 60.0, FINGERTIP_FAULT=str(number)):
                return f"caught by {name}"
        for known in equal:
            if (known["file"], known["old"], known["new"]) == (fault["file"], fault["old"], fault["new"]):
                return f"equal: {known['why']}"
        return f"survived {len(own)} tests" if own else "never reached"

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        left = {pool.submit(tried, number, fault): number for number, fault in faults.items() if str(number) not in results}
        for future in concurrent.futures.as_completed(left):
            number = left[future]
            fault, results[str(number)] = faults[number], future.result()
            table.write_text(json.dumps(results, indent=1))
            print(f"{number} {fault['file']}:{fault['line'] + 1} ({fault['kind']}): {results[str(number)]}\n"
                  f"  {fault['old']}\n  {fault['new']}", flush=True)  # fmt: skip
    words = [results[str(number)].split()[0] for number in faults]
    caught, same = words.count("caught"), words.count("equal:")
    print(f"{caught} of {len(words) - same} caught; {same} equal in effect; {len(words) - caught - same} survived")


if __name__ == "__main__":
    main()
