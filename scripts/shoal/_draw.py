"""A run in memory as a picture: html for notebooks, an array for environments."""

from __future__ import annotations

import html

import numpy as np

RED, BLUE, BODY, EDGE = "#b2182b", "#4393c3", "#d9d9d9", "#222222"


def _bodies(run):
    """The outline of each body as a polygon (2 n, 2), m, from the nodes and the thickness of the edges."""
    x, thickness, counts = run.view("x"), run.view("edge_thickness"), run.view("n_nodes")
    for nodes, of_edge, n in zip(x, thickness, counts):
        nodes, of_edge = np.array(nodes[:n]), np.array(of_edge[: n - 1])
        half = np.concatenate([[0], (of_edge[1:] + of_edge[:-1]) / 4, [0]])[:, None]
        along = np.gradient(nodes, axis=0)
        along /= np.hypot(*along.T)[:, None]
        normal = np.column_stack([-along[:, 1], along[:, 0]])
        yield np.concatenate([nodes + half * normal, (nodes - half * normal)[::-1]])


def _wake(run):
    """Positions (n, 2) and circulations (n) of all free vortices."""
    circulation = np.array(run.view("wake_circulation"))
    used = np.isfinite(circulation)
    return np.array(run.view("wake_x"))[used], circulation[used]


def _window(run, aspect):
    """The window around all bodies with three lengths of wake: x0, x1, y0, y1, of this height over width."""
    nodes = np.array(run.view("x")).reshape(-1, 2)
    low, high = np.nanmin(nodes, axis=0), np.nanmax(nodes, axis=0)
    length = float(np.nanmax(run.view("body_length")))
    width = max(high[0] - low[0] + 4 * length, (high[1] - low[1] + length) / aspect)
    x0, middle = low[0] - 0.5 * length, (low[1] + high[1]) / 2
    if x0 + width < high[0] + 0.5 * length:
        width = high[0] - x0 + 0.5 * length
    return x0, x0 + width, middle - aspect * width / 2, middle + aspect * width / 2


def _numbers(values):
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in values)


def snapshot_of(run, width=720, aspect=0.45) -> str:
    """Bodies and vortices now, as html."""
    x0, x1, y0, y1 = _window(run, aspect)
    height = aspect * width

    def place(points):
        return np.column_stack([(points[:, 0] - x0) / (x1 - x0) * width, (y1 - points[:, 1]) / (y1 - y0) * height])

    position, circulation = _wake(run)
    place_of_vortex = place(position) if position.size else np.empty((0, 2))
    inside = np.all((place_of_vortex > 0) & (place_of_vortex < [width, height]), axis=1)
    strongest = np.abs(circulation).max(initial=1e-300)
    dots = "".join(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{0.6 + 1.8 * abs(g) / strongest:.1f}" '
                   f'fill="{RED if g > 0 else BLUE}"/>'
                   for (x, y), g in zip(place_of_vortex[inside], circulation[inside]))
    bodies = "".join(f'<polygon points="{_numbers(place(body))}" fill="{BODY}" stroke="{EDGE}"/>' for body in _bodies(run))
    return (f'<div>{html.escape(repr(run))}<br><svg width="{width}" height="{height:.0f}" '
            f'viewBox="0 0 {width} {height:.0f}" style="background: white">{dots}{bodies}</svg></div>')


def picture_of(run, width=720, aspect=0.45) -> np.ndarray:
    """Bodies and vortices now, as bytes (height, width, 3)."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError("render_mode rgb_array needs matplotlib: apt install python3-matplotlib") from error
    window = _window(run, aspect)
    figure = Figure(figsize=(width / 100, aspect * width / 100), dpi=100)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    position, circulation = _wake(run)
    if circulation.size:
        share = np.abs(circulation) / np.abs(circulation).max(initial=1e-300)
        axes.scatter(*position.T, s=1 + 12 * share, c=np.where(circulation > 0, RED, BLUE), lw=0)
    for body in _bodies(run):
        axes.fill(*body.T, fc=BODY, ec=EDGE, lw=0.7)
    axes.text(0.99, 0.97, f"t = {run.time:.2f} s", ha="right", va="top", transform=axes.transAxes)
    axes.axis(window)
    axes.set_axis_off()
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
