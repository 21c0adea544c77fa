# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""The program's side of `--simulator-command`: docs/simulators.md#program. Standard library alone.

    simulator_protocol.serve("my simulator 1", prepare)

`prepare(machine, soil)` gets two objects of the protocol and gives a function dig(ground, poses)
that returns (payload [kg], loads): a load (force x, force z, moment, carried) for each step. It
changes the ground in place.
"""
import array
import base64
import json
import sys

PROTOCOL = 1


def numbers(text):
    """The numbers of a base64 text."""
    values = array.array("d", base64.b64decode(text, validate=True))
    if sys.byteorder == "big":
        values.byteswap()
    return values


def text(values):
    """The inverse."""
    if sys.byteorder == "big":
        values = array.array("d", values)
        values.byteswap()
    return base64.b64encode(values.tobytes()).decode("ascii")


class Ground:
    """The window of the ground: bank and loose layer of cell (row, col) at [col * rows + row]."""

    def __init__(self, data):
        self.rows, self.cols, self.cell = data["rows"], data["cols"], data["cell_m"]
        self.origin = data["origin_m"]
        self.bank, self.loose = numbers(data["bank_m"]), numbers(data["loose_m"])

    def at(self, row, col):
        return col * self.rows + row

    def x(self, col):
        return self.origin[0] + self.cell * (col + 0.5)

    def y(self, row):
        return self.origin[1] + self.cell * (row + 0.5)

    def col(self, x):
        return min(max(int((x - self.origin[0]) / self.cell), 0), self.cols - 1)


def answer(request, name, mass_tolerance, prepare, state):
    if request["type"] == "hello":
        if request["protocol"] != PROTOCOL:
            raise ValueError(f"protocol {request['protocol']} is not known, only {PROTOCOL}")
        return {"type": "hello", "protocol": PROTOCOL, "name": name,
                "mass_tolerance": mass_tolerance}
    if request["type"] == "prepare":
        state["dig"] = prepare(request["machine"], request["soil"])
        return {"type": "ready"}
    ground = Ground(request["ground"])
    payload, loads = state["dig"](ground, request["poses"])
    return {"type": "dug", "id": request["id"], "payload_kg": payload,
            "loads": [number for load in loads for number in load],
            "ground": {"bank_m": text(ground.bank), "loose_m": text(ground.loose)}}


def serve(name, prepare, mass_tolerance=1e-9):
    """Answers until standard input ends, which is the sign to end."""
    state = {}
    answers, sys.stdout = sys.stdout, sys.stderr  # print() of a simulator is a note
    for line in sys.stdin:
        try:
            request = json.loads(line)
            reply = answer(request, name, mass_tolerance, prepare, state)
            text_of_reply = json.dumps(reply, allow_nan=False)
        except Exception as error:  # a dig that fails is an answer too
            message = " ".join(f"{type(error).__name__}: {error}".split())
            text_of_reply = json.dumps({"type": "error", "message": message})
        print(text_of_reply, file=answers, flush=True)
