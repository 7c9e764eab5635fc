"""A run folder of `press --movie` as an animation: the finger, and its force over depth with its error.

    ./fingertip press --set rubber.youngs_modulus="20 kPa" --set run.integrator=mass-scaled --movie 32 --out runs/press
    ./fingertip python studies/examples/animate.py runs/press press.gif
    ./fingertip python studies/examples/animate.py runs/press press.png      # the pressed finger alone

Needs Matplotlib and Pillow (Debian: python3-matplotlib).
"""

import base64
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import fingertip
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import LineCollection, PolyCollection

TEAL, MAGENTA, INK = "#2a7f6f", "#c2408f", "#333333"
TYPES = {"Float32": np.float32, "Int32": np.int32, "UInt8": np.uint8}


class Piece:
    """Points and cells of a part of a frame: 0 tip, 1 rod, 2 obstacle (studies/presses/pictures/movie.h)."""

    def __init__(self, piece):
        arrays = {a.get("Name"): self._values(a) for a in piece.iter("DataArray") if a.get("format") == "binary"}
        points = next(self._values(a) for a in piece.find("Points"))
        self.points = points.reshape(-1, 3)
        self.held = arrays["held"]
        self.cells = np.split(arrays["connectivity"], arrays["offsets"][:-1])

    @staticmethod
    def _values(array):
        return np.frombuffer(base64.b64decode(array.text)[8:], TYPES[array.get("type")])

    def with_corners(self, count):
        return np.array([cell for cell in self.cells if len(cell) == count], dtype=int).reshape(-1, count)


class Frame:
    def __init__(self, file):
        root = xml.parse(file).getroot()
        told = {a.get("Name"): np.array(a.text.split(), float) for a in root.find(".//FieldData")}
        self.indentation, self.force = told["indentation"][0], told["force"]
        self.tip, self.rod, self.obstacle = (Piece(piece) for piece in root.iter("Piece"))


def seen(points, turn=0.5, height=0.28):
    """Orthographic: right, up, toward the eye [mm]; the rod's +z points down."""
    x, y, z = 1e3 * points.T
    right, ahead = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
    return np.column_stack([right, -z * np.cos(height) + ahead * np.sin(height), -z * np.sin(height) - ahead * np.cos(height)])


def draw_finger(axes, frame):
    axes.clear()
    axes.set_axis_off()
    axes.set_aspect("equal")
    flat = seen(frame.obstacle.points)[:, :2]
    axes.add_collection(PolyCollection(flat[frame.obstacle.with_corners(4)], facecolor="#e4e4e4", edgecolor="#cfcfcf", lw=0.4))
    rod = seen(frame.rod.points)[:, :2]
    axes.add_collection(PolyCollection(rod[frame.rod.with_corners(4)], facecolor="#8d99a6", edgecolor="none", alpha=0.25))
    tip = seen(frame.tip.points)
    springs = frame.tip.with_corners(2)
    nearness = tip[springs, 2].mean(axis=1)
    nearness = (nearness - nearness.min()) / np.ptp(nearness)
    colours = np.array([matplotlib.colors.to_rgba(TEAL, 0.12 + 0.75 * near**1.5) for near in nearness])
    order = np.argsort(nearness)
    axes.add_collection(LineCollection(tip[springs][order][:, :, :2], colors=colours[order], lw=0.8))
    touching = tip[frame.tip.held > 0]
    axes.plot(touching[:, 0], touching[:, 1], ".", color=MAGENTA, ms=4)


def read_frames(run):
    return [Frame(name) for name in sorted((run.folder / "movie").glob("frame_*.vtu"))]


def frame_view(axes, frames):
    corners = np.vstack([seen(part.points)[:, :2] for f in (frames[0], frames[-1]) for part in (f.tip, f.rod, f.obstacle)])
    axes.set_xlim(corners[:, 0].min(), corners[:, 0].max())
    axes.set_ylim(corners[:, 1].min(), corners[:, 1].max())


def still(run, file):
    frames = read_frames(run)
    figure, axes = plt.subplots(figsize=(1.6, 1.8), dpi=100, layout="constrained")
    draw_finger(axes, frames[-1])
    frame_view(axes, frames[-1:])
    figure.savefig(file)


def animate(run, file):
    frames = read_frames(run)
    depth, force, error = 1e3 * run.indentation, 1e3 * run.normal_force, 1e3 * run.force_error
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.2), dpi=90, width_ratios=[1, 1.25], layout="constrained")

    def show(number):
        frame = frames[number]
        draw_finger(left, frame)
        frame_view(left, frames)
        right.clear()
        right.spines[["top", "right"]].set_visible(False)
        right.set(xlabel="indentation [mm]", ylabel="force [mN]", xlim=(0, 1.02 * depth[-1]), ylim=(0, 1.05 * force[-1]))
        path = np.array([(1e3 * f.indentation, 1e3 * np.linalg.norm(f.force)) for f in frames[: number + 1] if f.indentation > 0])
        if len(path):
            x, y = path[-1]
            right.plot(*path.T, color=TEAL, lw=1.6)
            right.plot(x, y, "o", color=MAGENTA, ms=6)
            off = np.interp(x, depth, error)
            right.text(0.06, 0.9, f"{y:.0f} ± {off:.{0 if off > 2 else 1}f} mN", transform=right.transAxes, size=15, color=MAGENTA)
            right.text(0.06, 0.82, "± against the continuum", transform=right.transAxes, size=9, color=INK)

    # Down, a moment's rest, and from the start again.
    order = [*range(len(frames)), *[len(frames) - 1] * 10]
    FuncAnimation(figure, show, frames=order).save(file, writer=PillowWriter(fps=12))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    draw = still if sys.argv[2].endswith(".png") else animate
    draw(fingertip.Response(Path(sys.argv[1])), sys.argv[2])
    print(f"written: {sys.argv[2]}")
