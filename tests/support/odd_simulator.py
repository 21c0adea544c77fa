# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The program of a simulator that misbehaves in one way: odd_simulator.py HOW [FILE]."""
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples/simulator_command"))
import fee_wedge  # noqa: E402
import simulator_protocol  # noqa: E402

HOW = sys.argv[1]
STATE = {}


def edit(reply):
    ground = reply["ground"]
    layer = simulator_protocol.numbers(ground["bank_m"])
    edits = {
        "wrong-number": lambda: reply.update(payload_kg=-1.0),
        "text-number": lambda: reply.update(payload_kg="many"),
        "heavy": lambda: reply.update(payload_kg=1.1 * reply["payload_kg"]),
        "overfull": lambda: reply.update(payload_kg=2000.0),
        "no-load": lambda: reply.pop("loads"),
        "few-loads": lambda: reply.update(loads=reply["loads"][:8]),
        "odd-loads": lambda: reply.update(loads=reply["loads"][:7]),
        "other-id": lambda: reply.update(id=77),
        "other-type": lambda: reply.update(type="digged"),
        "unknown-key": lambda: reply.update(payload_t=0.3),
        "short-ground": lambda: ground.update(bank_m=ground["bank_m"][:-4]),
        "no-base64": lambda: ground.update(bank_m="!" * len(ground["bank_m"])),
        "cheap": lambda: (reply.pop("loads"), reply.update(energy={"total_j": 1.0})),
        "energy": lambda: (reply.pop("loads"), reply.update(energy={
            "total_j": 60e3, "by_phase_j": [10e3, 40e3, 10e3], "lift_j": 5e3})),
    }
    if HOW in ("nan-ground", "risen"):
        layer[len(layer) // 2] = float("nan") if HOW == "nan-ground" else 1.0
        ground["bank_m"] = simulator_protocol.text(layer)
    if HOW in edits:
        edits[HOW]()
    return reply


def misbehave():
    """What is done in place of an answer to a dig."""
    first = len(sys.argv) < 3 or not os.path.exists(sys.argv[2])
    if len(sys.argv) > 2 and first:
        Path(sys.argv[2]).touch()
    if HOW == "crash-once" and first or HOW == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    misbehave.digs += 1
    if HOW == "crash-third" and misbehave.digs % 3 == 0:
        os.kill(os.getpid(), signal.SIGSEGV)
    if HOW == "exit":
        print("out of\x1b[31m licences", file=sys.stderr, flush=True)
        sys.exit(3)
    if HOW == "silent":
        time.sleep(600)
    if HOW == "closes":
        os.close(1)
        time.sleep(600)
    if HOW == "family":
        child = subprocess.Popen(["sleep", "600"])
        Path(sys.argv[2]).write_text(f"{os.getpid()} {child.pid}")
        time.sleep(600)
    if HOW == "no-json":
        print("Loading model ...", flush=True)
    if HOW == "half-json":
        print('{"type": "dug", "id": 1,', flush=True)
    if HOW == "nan":
        print('{"type": "dug", "id": 1, "payload_kg": NaN}', flush=True)
    if HOW == "long":
        for _ in range(70):
            sys.stdout.write("x" * (1 << 20))
        print(flush=True)
    if HOW == "refuses":
        print(json.dumps({"type": "error", "message": "no licence left"}), flush=True)
    return HOW in ("no-json", "half-json", "nan", "long", "refuses")


misbehave.digs = 0


for line in sys.stdin:
    request = json.loads(line)
    if request["type"] == "hello" and HOW == "protocol":
        print('{"type": "hello", "protocol": 2, "name": "odd 1"}', flush=True)
        continue
    if request["type"] == "hello" and HOW == "nameless":
        print('{"type": "hello", "protocol": 1, "name": "a,b"}', flush=True)
        continue
    if request["type"] == "dig" and misbehave():
        continue
    reply = simulator_protocol.answer(request, "odd 1", 1e-9, fee_wedge.prepare, STATE)
    if request["type"] == "dig":
        reply = edit(reply)
        print("step\x1b[2J one", file=sys.stderr, flush=True)
    print(json.dumps(reply), flush=True)
    if request["type"] == "dig" and HOW == "unasked":
        print("done", flush=True)
        time.sleep(0.2)
