#!/usr/bin/python3
"""Draw the notation of doc/model.md: the rod, its curvature, its outline, the vortex sheets, and a ring of finite span.

    scripts/drawings.py NAME PICTURE      NAME: rod, curvature, outline, sheet or ring

All points are where the formulas of doc/model.md put them, for a body of few nodes.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot
from matplotlib.patches import Arc, Circle, Ellipse, FancyArrowPatch, Polygon
from shoal._files import centreline
from shoal._plot_style import BLUE, BODY, BODY_EDGE, RED, STYLE, WIDTH

TEXT, ACCENT, FAINT = "#222222", "#0072b2", "#888888"
FONT = {"font.size": 10, "mathtext.fontset": "cm"}


# ---- parts of a drawing


def canvas(window, width=WIDTH):
    """Axes without a frame; window: x0, x1, y0, y1 in units of the drawing, which are as large along x as along y."""
    x0, x1, y0, y1 = window
    figure = pyplot.figure(figsize=(width, width * (y1 - y0) / (x1 - x0)))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
    axes.set_axis_off()
    return axes


def arrow(axes, start, end, colour=TEXT, heads="-|>", width=1.0, **more):
    """An arrow from start to end."""
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle=heads, mutation_scale=9, lw=width, color=colour, shrinkA=0, shrinkB=0, **more))


def word(axes, at, text, offset=(0, 0), colour=TEXT, across="center", along="center", **more):
    """A text beside a point; offset: in points of print."""
    axes.annotate(text, at, offset, textcoords="offset points", ha=across, va=along, color=colour, **more)


def leader(axes, at, text_at, text, colour=TEXT, **more):
    """A text with a thin line to what it names."""
    axes.annotate(text, at, text_at, color=colour, arrowprops={"arrowstyle": "-", "lw": 0.6, "color": FAINT, "shrinkA": 2, "shrinkB": 1}, **more)


def measure(axes, start, end, text, offset, **more):
    """A dimension: a double arrow between two points with its text."""
    arrow(axes, start, end, heads="<|-|>", width=0.7)
    word(axes, (np.asarray(start) + end) / 2, text, offset, **more)


def turned(vector):
    """A vector turned to the left by 90 degrees."""
    return np.array([-vector[1], vector[0]])


def unit(vector):
    return np.asarray(vector) / np.hypot(*vector)


def chain(angles, length):
    """The nodes of a rod with the nose at 0; angles: of its edges."""
    edges = length * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([[[0, 0]], np.cumsum(edges, axis=0)])


def draw_rod(axes, nodes, colour=BODY_EDGE, **more):
    axes.plot(*nodes.T, color=colour, lw=1.6, marker="o", ms=6.5, mfc="white", mec=colour, mew=1.3, zorder=3, **more)


# ---- the drawings


def rod():
    """Nodes, edges and the turning angle of a joint."""
    nodes = chain(np.radians([12, 2, -28, 8, 34, 26]), 1.0)
    axes = canvas((-1.25, 6.25, -1.35, 1.5))
    draw_rod(axes, nodes)
    edges = np.diff(nodes, axis=0)
    tangents = np.array([unit(edge) for edge in edges])
    normals = np.array([turned(t) for t in tangents])
    k = 3

    # the heading and the ends
    arrow(axes, (-0.2, -0.04), (-1.0, -0.21), ACCENT)
    word(axes, (-0.6, -0.13), "heading", (-3, 12), ACCENT)
    word(axes, nodes[0], "node 0, the nose\n$s = 0$", (6, -24))
    word(axes, nodes[-1], "node $N-1$, the tail\n$s = L$", (-18, 20))
    for i, text, at in ((k - 1, "node $k-1$", (-16, -14)), (k, "node $k$", (-24, -12)), (k + 1, "node $k+1$", (30, -12))):
        word(axes, nodes[i], text, at)

    # the edges on both sides of node k, and its turning angle
    middle = (nodes[:-1] + nodes[1:]) / 2
    leader(axes, middle[k - 1], middle[k - 1] + (-0.3, 0.42), "edge $k-1$")
    leader(axes, middle[k], middle[k] + (-1.5, 1.05), r"edge $k$: vector $\mathbf{e}^k$, length $l^k$")
    axes.plot(*np.array([nodes[k], nodes[k] + 1.25 * tangents[k - 1]]).T, color=FAINT, lw=0.8, ls="--", zorder=1)
    angles = np.degrees(np.arctan2(tangents[:, 1], tangents[:, 0]))
    axes.add_patch(Arc(nodes[k], 1.4, 1.4, theta1=angles[k - 1], theta2=angles[k], color=RED, lw=1.3))
    word(axes, nodes[k] + 0.7 * unit(tangents[k - 1] + tangents[k]), r"$\phi_k > 0$", (6, -11), RED, across="left")

    # tangent and normal of edge k + 1
    at = middle[k + 1]
    arrow(axes, at, at + 0.4 * tangents[k + 1], ACCENT, width=1.8, zorder=4)
    arrow(axes, at, at + 0.7 * normals[k + 1], ACCENT, width=1.8, zorder=4)
    word(axes, at + 0.35 * tangents[k + 1], r"$\mathbf{t}^{k+1}$", (13, -9), ACCENT)
    word(axes, at + 0.7 * normals[k + 1], r"$\mathbf{n}^{k+1} = \mathbf{E}_3 \times \mathbf{t}^{k+1}$", (6, 2), ACCENT, across="left")

    # the spacing at rest
    start, end = nodes[0] + 0.42 * normals[0], nodes[1] + 0.42 * normals[0]
    for node in nodes[:2]:
        axes.plot(*np.array([node + 0.12 * normals[0], node + 0.5 * normals[0]]).T, color=FAINT, lw=0.6)
    measure(axes, start, end, r"$\bar l = L/(N-1)$ at rest", (-14, 13))
    return axes


def curvature():
    """The curvature of a joint and the osculating circle."""
    phi, natural = np.radians(52), np.radians(24)
    axes = canvas((-3.5, 3.9, -0.6, 2.5))
    length = 2.0

    def joint(angle):
        """The ends of the two edges at a joint in the origin, symmetric about the vertical."""
        half = angle / 2
        return np.array([[-length * np.cos(half), length * np.sin(half)], [0, 0], [length * np.cos(half), length * np.sin(half)]])

    def circle(angle, colour, **more):
        """The circle that touches both edges in their middles."""
        radius = length / (2 * np.tan(angle / 2))
        centre = np.array([0, radius / np.cos(angle / 2)])
        return radius, centre, Circle(centre, radius, fill=False, ec=colour, **more)

    radius, centre, drawn = circle(phi, RED, lw=1.3)
    axes.add_patch(drawn)
    drawn.set_clip_on(True)
    nodes = joint(phi)
    draw_rod(axes, nodes)
    middle = (nodes[:-1] + nodes[1:]) / 2
    axes.plot(*middle.T, ls="", marker="o", ms=4, color=RED, zorder=4)
    axes.plot(*centre, marker="o", ms=3.5, color=RED)
    axes.plot(*np.array([centre, middle[1]]).T, color=RED, lw=0.9)
    word(axes, (centre + middle[1]) / 2, r"$R_k = \bar l/\kappa_k$", (-7, -12), RED, across="right")
    leader(axes, middle[0], (-3.45, -0.45), "the osculating circle\ntouches both edges\nin their middles")

    # the turning angle
    direction = unit(nodes[1] - nodes[0])
    axes.plot(*np.array([nodes[1], nodes[1] + 1.25 * direction]).T, color=FAINT, lw=0.8, ls="--")
    axes.add_patch(Arc((0, 0), 1.7, 1.7, theta1=-np.degrees(phi / 2), theta2=np.degrees(phi / 2), color=TEXT, lw=1))
    word(axes, (0.85, 0.0), r"$\phi_k$", (12, 0))
    word(axes, nodes[1], "node $k$", (0, -14))
    word(axes, nodes[0], "node $k-1$", (-9, 4), across="right")
    word(axes, nodes[2], "node $k+1$", (9, 4), across="left")

    # the same joint as the muscle asks for it
    rest = joint(natural)
    axes.plot(*rest.T, color=ACCENT, lw=1.2, ls=(0, (5, 3)), marker="o", ms=4.5, mfc="white", zorder=2)
    word(axes, rest[2], "natural shape:\n" + r"$\bar\kappa_k = 2\,\tan(\bar\phi_k/2)$", (10, 0), ACCENT, across="left")
    axes.text(2.2, 1.75, r"$\kappa_k = 2\,\tan(\phi_k/2)$", ha="left", va="center", size=12)
    return axes


PROFILE = 0.12, 0.04  # parameter d of the foil, and the thickness of the tail, in lengths


def thickness_of(sigma):
    """The thickness over the length, of the Joukowski foil with a tail: section 1."""
    d, tail = PROFILE
    r0 = (1 - d) / 4
    c = r0 * (1 + d)
    theta = np.linspace(0, np.pi, 4001)
    zeta = r0 * (np.exp(1j * theta) + d)
    z = zeta + c**2 / zeta
    along = z.real - z.real[-1]
    r = np.abs(np.interp(sigma, along[::-1], np.abs(z.imag)[::-1]))
    return np.sqrt(4 * r**2 + (tail * sigma) ** 2)


def outline():
    """The outline of the body, the mean thickness of its edges, and a section."""
    n, scale = 9, 6.0
    sigma = (1 - np.cos(np.linspace(0, np.pi, 400))) / 2
    half = scale * thickness_of(sigma) / 2
    axes = canvas((-0.85, 8.6, -1.75, 1.45))
    axes.add_patch(Polygon(np.column_stack([np.r_[scale * sigma, scale * sigma[::-1]], np.r_[half, -half[::-1]]]), fc=BODY, ec=BODY_EDGE, lw=1.3))
    nodes = np.column_stack([np.linspace(0, scale, n), np.zeros(n)])
    spacing = scale / (n - 1)
    k = 3
    for i in range(n - 1):
        some = np.linspace(i, i + 1, 200) / (n - 1)
        mean = scale * thickness_of(some).mean()
        shown = {"fc": "#a6cbe3", "alpha": 0.8} if i == k else {"fc": "none"}
        axes.add_patch(pyplot.Rectangle((i * spacing, -mean / 2), spacing, mean, ec=ACCENT, lw=1.0 if i == k else 0.8, ls="-" if i == k else ":", **shown))
        if i == k:
            thick = mean
    draw_rod(axes, nodes)
    middle = (k + 0.5) * spacing

    # lengths
    for x in (0, scale):
        axes.plot([x, x], [-0.75, -1.5], color=FAINT, lw=0.6)
    measure(axes, (0, -1.4), (scale, -1.4), "$L$", (0, -9))
    for x in (k * spacing, (k + 1) * spacing):
        axes.plot([x, x], [-thick / 2, -0.95], color=FAINT, lw=0.6)
    measure(axes, (k * spacing, -0.88), ((k + 1) * spacing, -0.88), r"$\bar l$", (0, -8))
    leader(axes, (middle, thick / 2), (middle - 0.75, 0.95), r"mean thickness $\langle h\rangle$ of edge $k$", ACCENT)
    s = 1.05
    measure(axes, (s, -scale * thickness_of(np.array([s / scale]))[0] / 2), (s, scale * thickness_of(np.array([s / scale]))[0] / 2), "", (0, 0), zorder=5)
    leader(axes, (s, 0.3), (s - 1.15, 0.95), "thickness $h(s)$")
    tail = scale * thickness_of(np.array([1.0]))[0] / 2
    leader(axes, (scale, tail), (scale - 0.9, 0.75), "tail: $h(L) = b L$")
    word(axes, (0, 0), "$s = 0$", (-10, 0), across="right")
    leader(axes, nodes[6], (nodes[6][0] - 0.9, -0.98), "node: half the mass\nof either edge", va="center")

    # the section of edge k
    x, width, depth = 7.65, thick * 1.35, 1.7
    axes.add_patch(Ellipse((x, 0), width, depth, fc="#a6cbe3", ec=ACCENT, lw=1.2))
    arrow(axes, (x - width / 2, 0), (x + width / 2, 0), heads="<|-|>", width=0.7)
    leader(axes, (x + 0.2, 0), (x + 0.55, 0.12), "$h$")
    measure(axes, (x - width / 2 - 0.22, -depth / 2), (x - width / 2 - 0.22, depth / 2), "$w$", (-9, 0))
    for y in (-depth / 2, depth / 2):
        axes.plot([x - width / 2 - 0.3, x], [y, y], color=FAINT, lw=0.6)
    word(axes, (x, depth / 2), "section of an edge:\nan ellipse", (0, 19))
    word(axes, (x, -depth / 2), "area $A = \\pi\\,\\langle h\\rangle\\,w/4$\nthickness $h$ in the plane\ndepth $w$ across it", (0, -27), size=9.5)
    return axes


def sheet():
    """The bound sheet with its control points, and the free sheet with markers and labels."""
    axes = canvas((-0.75, 11.4, -2.25, 1.9))
    n, m = 7, 9
    along = np.arange(n)
    nodes = np.column_stack([along, 0.34 * np.sin(1.05 * along - 0.5) * (0.4 + 0.12 * along)])
    fractions = {"vortex": (1 - np.cos(np.pi * np.arange(m) / (m - 1))) / 2, "control": (1 - np.cos(np.pi * (np.arange(m - 1) + 0.5) / (m - 1))) / 2}
    line = centreline(nodes, np.linspace(0, 1, 300))[0]
    vortices, (control, normals) = centreline(nodes, fractions["vortex"])[0], centreline(nodes, fractions["control"])
    tail, before = line[-1], line[-2]

    # the wake: a wave behind the tail, with a marker per event
    x = np.linspace(tail[0], 10.9, 300)
    start = np.arctan2(*(tail - before)[::-1])
    wave = tail[1] + np.sin(1.45 * (x - tail[0])) * np.tan(start) / 1.45 * np.exp(-0.1 * (x - tail[0])) + 0.05 * (x - tail[0])
    at = tail[0] + np.array([1.0, 2.3, 3.3, 4.7])
    markers = np.column_stack([at, np.interp(at, x, wave)])
    shown = x < at[2] + 0.45
    axes.plot(x[shown], wave[shown], color=BLUE, lw=1.6, zorder=2)
    axes.plot(x[~shown & (x < at[3])], wave[~shown & (x < at[3])], color=BLUE, lw=1.6, ls=":", zorder=2)
    newest = x < at[0]
    axes.plot(x[newest], wave[newest], color=RED, lw=2.4, zorder=3)
    axes.plot(*markers.T, ls="", marker="o", ms=7, color=BLUE, zorder=4)

    # the body
    axes.plot(*line.T, color=BODY_EDGE, lw=1.6, zorder=2)
    axes.plot(*nodes.T, ls="", marker="o", ms=9, mfc="none", mec=FAINT, mew=0.9, zorder=3)
    axes.plot(*vortices.T, ls="", marker="o", ms=5, color=RED, zorder=4)
    axes.plot(*control.T, ls="", marker="x", ms=6, mew=1.6, color=ACCENT, zorder=4)
    word(axes, vortices[0], "nose\n$u = 0$", (-16, 0))
    leader(axes, nodes[2], nodes[2] + (-1.0, 1.2), "node $k$: $u = k$", FAINT)
    j = 2
    leader(axes, vortices[j], (vortices[j][0] - 0.75, -1.45), "bound vortex $j$ at $\\mathbf{x}_j$\ncirculation $q_j$", RED)
    c = 4
    tangent = -turned(normals[c])
    arrow(axes, control[c], control[c] + 0.85 * normals[c], ACCENT, width=1.6)
    arrow(axes, control[c], control[c] + 0.85 * tangent, ACCENT, width=1.6)
    word(axes, control[c] + 0.85 * normals[c], r"$\mathbf{n}_c$", (8, 4), ACCENT)
    word(axes, control[c] + 0.85 * tangent, r"$\mathbf{t}_c$", (-6, -11), ACCENT)
    leader(axes, control[c], (control[c][0] - 0.45, -1.45), "control point $c$ at $\\mathbf{x}_c$,\nvelocity $\\mathbf{v}_c$", ACCENT)
    leader(axes, line[205], (line[205][0] - 0.75, 1.35), r"the line $\mathbf{X}(u)$: " + "$\\sum_j q_j = -\\Gamma(t)$")
    leader(axes, tail, (tail[0] - 0.85, -1.9), "tail\n$u = N-1$")

    # words of the wake
    for k, text in ((0, r"marker $n$" + "\n" + r"label $\Gamma_n$"), (1, r"marker $n-1$" + "\n" + r"label $\Gamma_{n-1}$"), (3, "marker 0\n" + r"label 0")):
        leader(axes, markers[k], markers[k] + {0: (-0.35, 0.75), 1: (-0.2, 0.75), 3: (-0.7, 0.75)}[k], text, "#2b6a99")
    middle = 0.5 * (tail[0] + at[0]), np.interp(0.5 * (tail[0] + at[0]), x, wave)
    leader(axes, middle, (tail[0] + 0.3, -1.45), "nascent stretch:\n" + r"$\Gamma(t) - \Gamma_n$", RED)
    middle = at[:2].mean(), np.interp(at[:2].mean(), x, wave)
    leader(axes, middle, (at[1] + 0.25, -1.45), "stretch 1:\n" + r"$\Gamma_n - \Gamma_{n-1}$", "#2b6a99")
    return axes


def ring():
    """A vortex ring of the strip of finite depth, and the distances from it to a target."""
    axes = canvas((-1.0, 9.8, -2.55, 2.2))

    def seen(points):
        """Where points (n, 3) appear: x to the right, z up, y into the page."""
        points = np.atleast_2d(points)
        return np.column_stack([points[:, 0] + 0.55 * points[:, 1], points[:, 2] + 0.38 * points[:, 1]])

    def place(s, z=0.0):
        """A point of the strip: s along it, z from the middle plane."""
        s = np.asarray(s, dtype=float)
        return np.column_stack(np.broadcast_arrays(s, 0.5 * np.sin(0.8 * s - 0.6), z))

    half, b, tail, end = 1.3, 0.65, 4.6, 8.6
    for start, stop, colour in ((0, tail, BODY), (tail, end, "#dceaf4")):
        s = np.linspace(start, stop, 100)
        axes.add_patch(Polygon(np.concatenate([seen(place(s, half)), seen(place(s[::-1], -half))]), fc=colour, ec="none", alpha=0.75))
    s = np.linspace(0, end, 200)
    axes.plot(*seen(place(s)).T, color=FAINT, lw=0.8, ls="--")
    for z in (half, -half):
        axes.plot(*seen(place(s, z)).T, color=FAINT, lw=0.8)
    for z in (b, -b):
        axes.plot(*seen(place(s, z)).T, color=RED, lw=0.7, alpha=0.5)
    for one in (0.25, 0.9, 1.75, 3.6, 4.3, 5.3, 6.1, 6.9, 7.7):
        axes.plot(*seen(place([one, one], [-b, b])).T, color=RED, lw=0.9, alpha=0.5)
    word(axes, seen(place(0.05, half))[0], "body", (16, -12), FAINT)
    word(axes, seen(place(tail, half))[0], "wake", (20, -18), "#2b6a99")

    # the middle plane, in front of the strip
    front = [(0.7, -2.6, 0), (end + 0.6, -2.6, 0)]
    axes.add_patch(Polygon(np.concatenate([seen(place(s)), seen(front[::-1])]), fc=ACCENT, ec="none", alpha=0.09))
    word(axes, seen(front[0])[0], "middle plane", (36, 9), "#2b6a99", across="left")

    # the source
    at, step = 2.6, 0.95
    arrow(axes, seen(place(at, -b))[0], seen(place(at, b))[0], RED, width=2.2, zorder=4)
    leader(axes, seen(place(at, -0.3))[0], (0.2, -2.3), r"spanwise vortex at $\mathbf{x}_n$: circulation $q$, length $2b$", RED)
    for z, first, last in ((b, at, at + step), (-b, at + step, at)):
        arrow(axes, seen(place(first, z))[0], seen(place(last, z))[0], RED, width=2.2, zorder=4)
    leader(axes, seen(place(at + step / 2, b))[0], (1.6, 1.85), r"legs $\mathbf{d} = C\,\mathrm{d}\mathbf{x}$" + ", $C$ the sum of $q$ from the nose on", RED)

    # the target
    source = place(at)[0]
    target = source + np.array([4.6, -1.5, 0])
    axes.plot(*seen(target).T, marker="o", ms=6, color=ACCENT, zorder=5)
    axes.plot(*seen(source).T, marker="o", ms=4, color=TEXT, zorder=5)
    arrow(axes, seen(source)[0], seen(target)[0], ACCENT, width=1.3, zorder=4)
    word(axes, seen(target)[0], r"target $\mathbf{x}_t$", (8, -6), ACCENT, across="left")
    word(axes, seen(source + 0.62 * (target - source))[0], r"$\mathbf{r}$", (-4, -9), ACCENT)
    top = source + (0, 0, b)
    axes.plot(*seen([top, target]).T, color=ACCENT, lw=0.9, ls=":")
    word(axes, seen(top + 0.6 * (target - top))[0], r"$\sqrt{r^2 + b^2}$", (24, 7), ACCENT)

    # depth and span
    foot, head = seen(place(end, -half))[0], seen(place(end, half))[0]
    for y in (foot, head):
        axes.plot([y[0], y[0] + 0.55], [y[1], y[1]], color=FAINT, lw=0.6)
    measure(axes, foot + (0.42, 0), head + (0.42, 0), "depth\n$w$", (21, 0))
    foot, head = seen(place(0, -b))[0], seen(place(0, b))[0]
    for y in (foot, head):
        axes.plot([y[0] - 0.4, y[0]], [y[1], y[1]], color=FAINT, lw=0.6)
    measure(axes, foot - (0.28, 0), head - (0.28, 0), "$2b$", (-11, 0))
    axes.text(6.2, -2.1, "on the same strip $b = w/4$,\non other strips $b = w/2$", color=TEXT, va="center")
    return axes


DRAWINGS = {"rod": rod, "curvature": curvature, "outline": outline, "sheet": sheet, "ring": ring}


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in DRAWINGS:
        sys.exit(__doc__)
    with matplotlib.rc_context({**STYLE, **FONT}):
        DRAWINGS[arguments[0]]().figure.savefig(arguments[1], facecolor="white")


if __name__ == "__main__":
    main(sys.argv[1:])
