#!/usr/bin/env python3
"""The paper's task over the local socket: approach, touch, press, at constant speed and orientation.
Usage: client.py unix:PATH | tcp:127.0.0.1:PORT   (start the program first, it waits)"""
import json, math, socket, sys

kind, _, place = sys.argv[1].partition(":")
link = socket.socket(socket.AF_UNIX if kind == "unix" else socket.AF_INET)
link.connect(place if kind == "unix" else ("127.0.0.1", int(place.rpartition(":")[2])))
if kind == "tcp":
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
stream = link.makefile("rw", encoding="ascii", newline="\n")

def send(message):
    print(json.dumps(message, allow_nan=False), file=stream, flush=True)

def turn(a, b):  # the rotation vector from orientation b to a, both (w, x, y, z), nearly equal
    (w, x, y, z), (p, q, r, s) = a, b
    return [2 * (x * p - w * q - y * s + z * r), 2 * (y * p - w * r + x * s - z * q),
            2 * (z * p - w * s - x * r + y * q)]

omega = 2 * math.pi * 60  # poles of the bare rod
for line in stream:
    m = json.loads(line)
    if m["message"] == "hello":
        task, integral = m["task"], [0.0] * 6
        send({"protocol": "fingertip-control", "version": 1})
    elif m["message"] == "reset":
        integral = [0.0] * 6
    elif m["message"] == "measurement":
        goal = m["set_point"]  # the way at constant speed
        error = [a - b for a, b in zip(goal["position"], m["position"])] + turn(goal["orientation"], m["orientation"])
        rate = [a - b for key in ("velocity", "angular_velocity") for a, b in zip(goal[key], m[key])]
        ahead = goal["acceleration"] + goal["angular_acceleration"]
        wanted = [a + 3 * omega**2 * e + i + 3 * omega * r for a, e, i, r in zip(ahead, error, integral, rate)]
        integral = [i + task["period"] * omega**3 * e for i, e in zip(integral, error)]
        push = [sum(a * b for a, b in zip(row, wanted)) for row in task["inertia"]]
        send({"wrench": [p - f for p, f in zip(push, m["force"] + m["torque"])]})
