#!/usr/bin/env python3
"""A finger that is a quarter, pressed by CalculiX on the first mesh of a reference run.

    solid_press.py RUN [--stiffness 1e7] [--limit 600]

RUN is the folder of a frictionless `fingertip reference` at large strain (law A) on the plane, of a
finger with two mirror planes, with its tip.msh. Elements are C3D20R with straight edges, the law
*HYPERFOAM as in README.md, contact node to surface with a penalty of `stiffness` E/m, SPOOLES, one
thread. Prints both programs' forces [mN] and CalculiX's time [s].
"""
import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

OUTER, BOND, ACROSS_X, ACROSS_Y = 2, 3, 5, 6  # physical groups of tip.msh
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
PAIR, LOGARITHM = 0.02, 1e-5  # exponents of the foam's terms: deck.cc


class Mesh:
    """Hexahedra with nodes on the middles of their edges; millimetres, numbers from 1."""

    def __init__(self, file):
        lines = iter(file.read_text().split("\n"))
        numbers, groups, self.places, self.middles = {}, {}, [], {}
        self.hexahedra, self.sides = [], {}
        for line in lines:
            if line == "$Entities":
                points, curves, surfaces, _ = map(int, next(lines).split())
                for _ in range(points + curves):
                    next(lines)
                for _ in range(surfaces):
                    words = next(lines).split()
                    groups[words[0]] = int(words[8]) if int(words[7]) else 0
            elif line == "$Nodes":
                for _ in range(int(next(lines).split()[0])):
                    count = int(next(lines).split()[3])
                    tags = [next(lines) for _ in range(count)]
                    for tag in tags:
                        self.places.append([1e3 * float(x) for x in next(lines).split()[:3]])
                        numbers[tag] = len(self.places)
            elif line == "$Elements":
                for _ in range(int(next(lines).split()[0])):
                    _, entity, kind, count = next(lines).split()
                    for _ in range(int(count)):
                        corners = [numbers[tag] for tag in next(lines).split()[1:]]
                        if kind == "5":
                            self.hexahedra.append(corners)
                        elif kind == "3":
                            self.sides.setdefault(groups[entity], []).append(corners)
        self.elements = [h + [self.middle(h[a], h[b]) for a, b in EDGES] for h in self.hexahedra]

    def middle(self, a, b):
        key = (min(a, b), max(a, b))
        if key not in self.middles:
            ends = zip(self.places[a - 1], self.places[b - 1])
            self.places.append([0.5 * (x + y) for x, y in ends])
            self.middles[key] = len(self.places)
        return self.middles[key]

    def nodes(self, group):
        found = set()
        for corners in self.sides.get(group, []):
            for a, b in zip(corners, corners[1:] + corners[:1]):
                found |= {a, self.middle(a, b)}
        return found

    def outer_faces(self, lowest):
        number = {tuple(sorted(h[c] for c in face)): (e + 1, f + 1)
                  for e, h in enumerate(self.hexahedra) for f, face in enumerate(FACES)}
        return [number[tuple(sorted(side))] for side in self.sides[OUTER]
                if max(self.places[c - 1][2] for c in side) > lowest]


def write_deck(out, mesh, young, shear, depths, stiffness):
    poisson = young / (2 * shear) - 1
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    top = max(place[2] for place in mesh.places)

    def card(head, rows):
        out.write(head + "\n" + "".join(", ".join(f"{x:.15g}" for x in row) + "\n" for row in rows))

    def foam(beta):  # CalculiX asks for nu instead of beta
        return beta / (1 + 2 * beta)

    card("*NODE", [(n + 1, *place) for n, place in enumerate(mesh.places)])
    out.write("*ELEMENT, TYPE=C3D20R, ELSET=TIP\n")
    for e, nodes in enumerate(mesh.elements):
        out.write(f"{e + 1}, {', '.join(map(str, nodes[:12]))},\n{', '.join(map(str, nodes[12:]))}\n")
    term = lame / (4 * PAIR)
    out.write("*SOLID SECTION, ELSET=TIP, MATERIAL=TIP\n*MATERIAL, NAME=TIP\n")
    card("*HYPERFOAM, N=3", [(term, 2, -term, 2, shear, 2, foam(PAIR), foam(-PAIR)), (foam(LOGARITHM),)])
    first, plate = len(mesh.places) + 1, len(mesh.elements) + 1
    half = 0.6 * max(abs(x) for place in mesh.places for x in place[:2])
    card("*NODE, NSET=PLANE", [(first + 4 * level + k, half * x, half * y, top + 3 * level)
                               for level in (0, 1)
                               for k, (x, y) in enumerate([(-1, -1), (2, -1), (2, 2), (-1, 2)])])
    card("*ELEMENT, TYPE=C3D8, ELSET=PLATE", [(plate, *range(first, first + 8))])
    out.write("*MATERIAL, NAME=PLATE\n*ELASTIC\n1., 0.3\n*SOLID SECTION, ELSET=PLATE, MATERIAL=PLATE\n"
              f"*SURFACE, NAME=PLANEFACE\n{plate}, S1\n*SURFACE, NAME=TIPFACE\n")
    for element, face in mesh.outer_faces(top - 2 * depths[-1]):
        out.write(f"{element}, S{face}\n")
    card("*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
         [(1e-3 * stiffness * young, 1e-6)])
    out.write("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE\nTIPFACE, PLANEFACE\n")
    bond = mesh.nodes(BOND)
    for name, nodes in (("BOND", bond), ("SX", mesh.nodes(ACROSS_X) - bond),
                        ("SY", mesh.nodes(ACROSS_Y) - bond)):
        out.write(f"*NSET, NSET={name}\n" + "".join(f"{n},\n" for n in sorted(nodes)))
    out.write("*BOUNDARY\nBOND, 1, 3\nSX, 1\nSY, 2\nPLANE, 1, 2\n")
    for depth in depths:
        out.write(f"*STEP, INC=1000, NLGEOM\n*STATIC, SOLVER=SPOOLES\n1., 1.\n*BOUNDARY\nPLANE, 3, 3, {-depth:.15g}\n"
                  "*NODE PRINT, NSET=BOND, TOTALS=ONLY, FREQUENCY=1000\nRF\n*END STEP\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("--stiffness", type=float, default=1e7)
    parser.add_argument("--limit", type=float, default=600.0)
    options = parser.parse_args()
    job = json.loads((options.run / "job.json").read_text())
    young, shear = (1e-3 * job["rubber"][key] for key in ("youngs_modulus", "shear_modulus"))
    depths = [1e3 * depth for depth in job["protocol"]["samples"]]
    mesh = Mesh(options.run / "tip.msh")
    with tempfile.TemporaryDirectory() as folder, open(os.path.join(folder, "log.txt"), "w") as log:
        with open(os.path.join(folder, "press.inp"), "w") as out:
            write_deck(out, mesh, young, shear, depths, options.stiffness)
        begin = time.monotonic()
        subprocess.run(["ccx", "press"], cwd=folder, stdout=log, timeout=options.limit, check=True,
                       env=dict(os.environ, OMP_NUM_THREADS="1", CCX_NPROC_EQUATION_SOLVER="1"))
        taken = time.monotonic() - begin
        text = pathlib.Path(folder, "press.dat").read_text()
    forces = [4.0 * float(row.split()[2]) for row in re.findall(r"total force.*?\n\n(.*)\n", text)]
    with open(options.run / "response.csv") as table:
        ours = [1e3 * float(row["normal_force [N]"]) for row in csv.DictReader(table)]
    print(f"{len(mesh.elements)} elements, {3 * len(mesh.places)} unknowns: ccx {taken:.1f} s")
    for depth, own, other in zip(depths, ours, forces, strict=True):
        print(f"{depth:g} mm: fingertip {own:.5g} mN, ccx {other:.5g} mN, {100 * (other / own - 1):+.2f} %")


if __name__ == "__main__":
    main()
