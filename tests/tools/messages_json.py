#!/usr/bin/env python3
"""Standard error of `--messages json`: objects of JSON alone, one a line, as docs/user/messages.schema.json has them.

messages_json.py ATRITO PROJECT FOLDER   (FOLDER to work in)
"""
import json
import os
import re
import subprocess
import sys

atrito, project, folder = map(os.path.abspath, sys.argv[1:4])
with open(os.path.join(project, "docs/user/messages.schema.json"), encoding="utf-8") as file:
    schema = json.load(file)
scene = os.path.join(project, "tests/errors/scene.inp")
deck = os.path.join(project, "input/ex1-plate-on-rigid-support.inp")
failures = 0
kinds = {"string": str, "integer": int, "array": list, "null": type(None)}


def fail(text):
    global failures
    failures += 1
    print(text)


def check_member(where, value, rule):
    if "enum" in rule:
        if value not in rule["enum"]:
            fail(f"{where}: {value!r} is none of {rule['enum']}")
        return
    types = rule["type"] if isinstance(rule["type"], list) else [rule["type"]]
    if isinstance(value, bool) or not any(isinstance(value, kinds[name]) for name in types):
        fail(f"{where}: {value!r} is no {types}")
    elif isinstance(value, str) and not re.search(rule.get("pattern", ""), value):
        fail(f"{where}: {value!r} is not {rule['pattern']}")
    elif isinstance(value, int) and value < rule.get("minimum", value):
        fail(f"{where}: {value!r} is too small")
    elif isinstance(value, list):
        if len(value) < rule["minItems"]:
            fail(f"{where}: too short")
        for item in value:
            check_member(where, item, rule["items"])


def check_object(where, message):
    if set(message) != set(schema["required"]) or set(message) != set(schema["properties"]):
        fail(f"{where}: its members are {sorted(message)}")
        return
    for name, rule in schema["properties"].items():
        check_member(f"{where}: {name}", message[name], rule)


def told(where, code, arguments, option=("--messages", "json")):
    """The messages of a call that ends with this exit code."""
    done = subprocess.run([atrito, *arguments, *option], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=300)
    if done.returncode != code:
        fail(f"{where}: exit {done.returncode}, not {code}")
    messages = []
    for line in done.stderr.decode("utf-8").splitlines():
        try:
            messages.append(json.loads(line))
        except ValueError:
            fail(f"{where}: no JSON: {line[:200]}")
            continue
        check_object(where, messages[-1])
    return messages


def ids(where, code, expected, arguments, option=("--messages", "json")):
    messages = told(where, code, arguments, option)
    found = [message["id"] for message in messages]
    if found != expected:
        fail(f"{where}: {found[:10]}, not {expected[:10]}")
    return messages


def changed(name, changes):
    """The scene with changed lines."""
    with open(scene, "rb") as source:
        lines = source.read().split(b"\n")
    for number, text in changes.items():
        lines[number - 1] = text
    with open(os.path.join(folder, name), "wb") as target:
        target.write(b"\n".join(lines))
    return name


os.makedirs(folder, exist_ok=True)
sound = changed("sound.inp", {})

ids("a sound deck", 0, ["N-RADIUS"], ["check", sound])
ids("a run", 0, [], [deck, "-o", "run"])
ids("a sweep", 0, [], ["sweep", deck, "--vary", "nu=0,0.1", "-o", "sweep"])
ids("a study", 0, [], ["study", deck, "--levels", "1", "-o", "study"])

# a name in UTF-8, a byte of Latin-1, a control character, a quote and a backslash
bad = changed("bad.inp", {7: b"1, \xe9, 0", 8: '2, "\u00e4\\\u20ac\u0007", 0'.encode(), 14: b"1, 1, 2, \x01, 4"})
messages = told("a broken deck", 2, ["check", bad])
places = [(message["line"], message["column"]) for message in messages if message["severity"] == "error"]
if (7, 4) not in places or places != sorted(places):
    fail(f"a broken deck: places {places}")
if not any(message["source"] == "1, \u00e9, 0" for message in messages):
    fail("a broken deck: the line with Latin-1 is not there")

one = ids("one error", 2, ["E-OPTION"], ["check", changed("one.inp", {6: b"*NODE, NSTE=ALL"})])
expected = {"severity": "error", "id": "E-OPTION", "file": "one.inp", "line": 6, "column": 8, "length": 4,
            "text": "unknown option NSTE of *NODE", "expected": None, "nearest": ["NSET"], "known": None, "keyword": "NODE",
            "source": "*NODE, NSTE=ALL", "skipped": 0, "more": 0}
if one != [expected]:
    fail(f"one error: {one}")

# more than the 50 errors of the screen, and more than are kept
many = changed("many.inp", {6: b"*NODE\n" + b"\n".join(b"%d, x, 0" % i for i in range(1000, 1070)) + b"\n*NODE"})
found = [message["line"] for message in told("many errors", 2, ["check", many]) if message["id"] == "E-NUMBER"]
if found != list(range(7, 77)):
    fail(f"many errors: {len(found)} of them")
more = changed("more.inp", {6: b"*NODE\n" + b"\n".join(b"%d, x, 0" % i for i in range(1000, 2500)) + b"\n*NODE"})
last = told("more errors", 2, ["check", more])[-1]
if last["id"] != "N-MORE" or not last["text"].startswith("500 more errors"):
    fail(f"more errors: {last}")
shown = subprocess.run([atrito, "check", more], cwd=folder, capture_output=True, text=True).stderr.splitlines()
if shown[-2:] != ["... the first 50 of 1500 errors", "1500 errors in the deck"]:
    fail(f"more errors, on the screen: {shown[-2:]}")

# a note, and --quiet
noted = changed("noted.inp", {35: b"1, 1, 3"})
ids("two notes", 0, ["N-RADIUS", "N-DOF"], ["check", noted])
ids("no note", 0, [], ["check", noted, "--quiet"])

ids("wrong option", 1, ["E-COMMAND"], ["check", sound, "--foo"], ("--messages=json",))
ids("wrong command", 1, ["E-COMMAND"], ["chekc", sound])
ids("no such parameter", 1, ["E-COMMAND"], ["check", sound, "--set", "zz=1"])
ids("no such keyword", 1, ["E-COMMAND"], ["help", "NODEE"])
ids("no such file", 5, ["E-FILE"], ["check", "missing.inp"])
ids("no such folder", 5, ["E-FILE"], ["compare", "missing", "absent"])
ids("cannot write", 5, ["E-FILE"], [deck, "-o", "/dev/null/x"])
ids("singular", 4, ["N-RADIUS", "W-LOADED-CONTACT", "E-SINGULAR"], [changed("loose.inp", {35: b"1, 2", 39: b"BLOCK, P1, <q>"})])
post = os.path.join(project, "tests/verify/not-converged/post.inp")
with open(os.path.join(folder, "controls.inp"), "w", encoding="ascii") as file:
    file.write("*CONTROLS, METHOD=PICARD\n")
with open(post, "rb") as source, open(os.path.join(folder, "post.inp"), "wb") as target:
    target.write(source.read())
last = told("not converged", 3, ["post.inp", "-o", "post", "--set", "px=0.5", "--set", "lean=0.3", "--set", "nu=1.5"])[-1:]
if [message["id"] for message in last] != ["E-NOT-CONVERGED"]:
    fail(f"not converged: {last}")

print("all as expected" if failures == 0 else f"{failures} failures")
sys.exit(1 if failures else 0)
