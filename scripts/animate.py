#!/usr/bin/python3
"""Make a movie from a result file of shoal: bodies, wakes and paths. The ending of its name decides its kind.

    animate.py RUN.nc [MOVIE.mp4|MOVIE.gif]

The movie has 25 pictures a second and runs as fast as the fish do. Pictures are rows of the file where rows are as fine as
the pictures, else interpolated between rows: the last line of output says which.
"""

import argparse
import functools
import os
import shutil
import sys

from plot import EXIT_FILE, EXIT_USAGE, check_folder, matplotlib, stop
from shoal import FileError
from shoal._files import DAMAGE, Results, np
from shoal.plot import GRID, STYLE, Snapshot, add_legend, limits, pyplot, swim_handles

from matplotlib import animation

WIDTH, MOST_HEIGHT, LEAST_HEIGHT = 8.0, 8.0, 2.5  # inches
# of ffmpeg: the few colours of the whole movie, without dots between them, which no frame has in common with the next one
GIF_COLOURS = ["-filter_complex", "split[a][b];[a]palettegen=max_colors=32[p];[b][p]paletteuse=dither=none"]
FEW_ROWS = 8  # of a beat, that shapes between rows are uncertain


def cubic(t, start, end):
    """The cubic in time through two states (time, value, velocity)."""
    (t0, x0, v0), (t1, x1, v1) = start, end
    h = t1 - t0
    q = (t - t0) / h
    return (1 + 2 * q) * (1 - q) ** 2 * x0 + q * (1 - q) ** 2 * h * v0 + q**2 * (3 - 2 * q) * x1 - q**2 * (1 - q) * h * v1


def ordinal(n):
    """2nd, 3rd, 4th, ..."""
    ending = "th" if 10 < n % 100 < 14 else {1: "st", 2: "nd", 3: "rd"}.get(n % 10, "th")
    return f"{n}{ending}"


class Frames(Results):
    """A result at the moments of the pictures of a movie: `time`; rows are the rows of the file.

    Bodies between rows lie on cubics in time with the velocities of the rows. A vortex moves on a straight line between rows
    with a wake; a new one comes from the tail.
    """

    def __init__(self, path, fps, rate):
        super().__init__(path)
        self.rows = self.time
        self.wake_rows = self.rows_with_wake()
        self.row = functools.lru_cache(4)(self._row)
        self.wake_row = functools.lru_cache(4)(self._wake_row)
        self.shedding = float(self["shedding_interval"])
        step = rate / fps
        n = int((self.rows[-1] - self.rows[0]) / step + 1e-6) + 1
        self.time = self.rows[0] + step * np.arange(n)
        at = np.clip(np.searchsorted(self.rows, self.time - 0.5 * step), 0, self.rows.size - 1)
        nearest = np.array([k + np.argmin(np.abs(self.rows[k : k + 50] - t)) for k, t in zip(at, self.time)])
        self.is_exact = bool(np.all(np.abs(self.rows[nearest] - self.time) < 1e-6 * step))
        interval = float(np.median(np.diff(self.rows))) if self.rows.size > 1 else step
        self.interval = interval
        if not self.is_exact:
            self.how = f"interpolated between rows {interval:.3g} s apart"
        else:
            stride = round(step / interval)
            self.how = "every row of the file" if stride == 1 else f"every {ordinal(stride)} row of the file"
            apart = float(np.median(np.diff(self.rows[self.wake_rows]))) if self.wake_rows.size > 1 else 0.0
            if not np.isin(nearest, self.wake_rows).all():
                self.how += f", wakes interpolated between rows {apart:.3g} s apart"

    def __getitem__(self, name):
        return self.centres if name == "com" else super().__getitem__(name)

    @functools.cached_property
    def centres(self):
        """Centres of mass at all moments (moment, fish, 2)."""
        com, velocity = self.read("com"), self.read("com_velocity")
        return np.array([self.between(t, lambda k: (self.rows[k], com[k], velocity[k])) for t in self.time])

    def between(self, t, state):
        """The cubic between the rows around t; state: of a row, its time, value and velocity."""
        k = int(np.clip(np.searchsorted(self.rows, t + 1e-9, side="right") - 1, 0, max(self.rows.size - 2, 0)))
        if self.rows.size == 1:
            return state(0)[1]
        return cubic(t, state(k), state(k + 1))

    def _row(self, k):
        return self.read("x", k), self.read("v", k)

    def _wake_row(self, k):
        return self.read("wake_x", k), self.read("wake_circulation", k), self.read("wake_birth", k)

    def nodes_at(self, t, fish):
        """Nodes of a fish at a time (n_nodes, 2)."""
        n = self.n_nodes[fish]
        return self.between(t, lambda k: (self.rows[k], self.row(k)[0][fish, :n], self.row(k)[1][fish, :n]))

    def nodes(self, row, fish):
        return self.nodes_at(self.time[row], fish)

    def wake(self, row):
        t, rows = self.time[row], self.wake_rows
        if rows.size == 0:
            return np.empty((0, 2)), np.empty(0)
        at = int(np.clip(np.searchsorted(self.rows[rows], t + 1e-9, side="right") - 1, 0, rows.size - 1))
        a, b = rows[at], rows[min(at + 1, rows.size - 1)]
        ta, tb = self.rows[a], self.rows[b]
        q = np.clip((t - ta) / (tb - ta), 0, 1) if b > a else 0.0
        parts = [self.wake_of(fish, t, q, a, b) for fish in range(self.n_fish)]
        position, circulation, birth = (np.concatenate(part) for part in zip(*parts))
        aged = np.repeat(self.aged(), [part[2].size for part in parts])
        return position, circulation * self.remaining(t - birth + aged)

    def wake_of(self, fish, t, q, a, b):
        """The vortices of a fish between two rows with a wake, by their time of birth: positions, circulations, births."""
        (xa, ca, ba), (xb, cb, bb) = ([part[fish][np.isfinite(self.wake_row(k)[1][fish])] for part in self.wake_row(k)] for k in (a, b))
        order = np.searchsorted(bb, ba - 1e-9)
        known = np.minimum(order, max(bb.size - 1, 0))
        stays = (order < bb.size) & (np.abs((bb[known] if bb.size else np.full(ba.size, np.inf)) - ba) < 1e-6)
        j = known[stays]
        # a circulation is constant from an interval after the release on, but for dropped neighbours and, with pressure.span:
        # finite, for the flow along the span
        part = np.where(t - ba[stays] > self.shedding - 1e-9, np.where(self.rows[a] - ba[stays] < self.shedding - 1e-9, 1, q), q)
        moved = (1 - q) * xa[stays] + q * xb[j], (1 - part) * ca[stays] + part * cb[j], ba[stays]
        gone = xa[~stays], (1 - q) * ca[~stays], ba[~stays]  # removed or dropped until the next row
        is_new = np.ones(bb.size, dtype=bool)
        is_new[j] = False
        born = np.flatnonzero(is_new & (bb <= t + 1e-9))
        new = xb[born].copy(), cb[born], bb[born]
        for i, k in enumerate(born):
            if bb[k] > self.rows[a] - 1e-9:
                part = np.clip((t - bb[k]) / max(self.rows[b] - bb[k], 1e-12), 0, 1)
                new[0][i] = (1 - part) * self.nodes_at(bb[k], fish)[-1] + part * xb[k]
        found = [np.concatenate(parts) for parts in zip(moved, gone, new)]
        order = np.argsort(found[2], kind="stable")
        return tuple(values[order] for values in found)


def choose_writer(movie, fps):
    """What writes the movie: ffmpeg, or Pillow for a .gif where there is no ffmpeg."""
    ending = os.path.splitext(movie)[1].lower()
    if ending not in (".mp4", ".gif"):
        stop(f"{movie}: the name of a movie ends in .mp4 or .gif", EXIT_USAGE)
    if shutil.which("ffmpeg"):
        return animation.FFMpegWriter(fps, bitrate=-1, extra_args=["-pix_fmt", "yuv420p"] if ending == ".mp4" else GIF_COLOURS)
    if ending == ".gif":
        return animation.PillowWriter(fps)
    return stop("a .mp4 needs ffmpeg: apt install ffmpeg, or name a .gif", EXIT_USAGE)


def sample(frames):
    """At most 50 pictures, the last one among them."""
    n = frames.time.size
    return [*range(0, n, max(1, n // 50)), n - 1]


def fixed_window(frames):
    """A function of the picture that gives the window of the whole movie, and the size of that window."""
    window = limits(frames, sample(frames))
    return lambda row: window, (window[1] - window[0], window[3] - window[2])


def smooth_path(path, n):
    """A path (moment, 2) averaged over n moments around each; beyond its ends it goes on as a straight line would."""
    n = min(n, path.shape[0] - 1) // 2
    if n < 1:
        return path
    before, after = 2 * path[0] - path[n:0:-1], 2 * path[-1] - path[-2 : -n - 2 : -1]
    sums = np.cumsum(np.concatenate([np.zeros((1, 2)), before, path, after]), axis=0)
    return (sums[2 * n + 1 :] - sums[: -2 * n - 1]) / (2 * n + 1)


def following_window(frames):
    """The same for a camera that moves with the school, without its beat: the window holds all bodies, a length
    of water ahead of them, and two lengths of their wakes; along walls it holds the walls."""
    frequency = frames.read("frequency")
    step = frames.time[1] - frames.time[0] if frames.time.size > 1 else 1.0
    beat = round(1 / (frequency[frequency > 0].min() * step)) if np.any(frequency > 0) else 1
    centre = smooth_path(frames["com"].mean(axis=1), beat)
    half = np.zeros(2)
    for row in sample(frames):
        bodies = np.concatenate([frames.outline(row, f) for f in range(frames.n_fish)])
        half = np.maximum(half, np.abs(bodies - centre[row]).max(axis=0))
    travel = np.abs(centre[-1] - centre[0])
    margin = np.array([1.5, 0.8] if travel[0] >= travel[1] else [0.8, 1.5])
    length = float(np.nanmax(frames["body_length"]))
    half += margin * length
    along = int(travel[1] > travel[0])
    centre[:, along] -= 0.5 * length * np.sign(centre[-1, along] - centre[0, along])
    if frames.walls:
        _, _, y0, y1 = limits(frames, sample(frames), with_paths=False)
        centre[:, 1], half[1] = (y0 + y1) / 2, (y1 - y0) / 2
    return lambda row: np.column_stack([centre[row] - half, centre[row] + half]).ravel(), 2 * half


def choose_window(frames, follow):
    """The camera: told to follow or not, or following where the fish would be tiny otherwise."""
    close = following_window(frames) if follow is not False else None
    whole = fixed_window(frames) if follow is not True else None
    if follow is None:
        follow = any(a > 2.5 * b for a, b in zip(whole[1], close[1]))
    return *(close if follow else whole), follow


def animate(frames, follow, with_axes):
    """The animation: a snapshot that goes from picture to picture."""
    window, size, follow = choose_window(frames, follow)
    border = 0.8 if with_axes else 0
    height = np.clip((WIDTH - border) * size[1] / size[0] + border, LEAST_HEIGHT, MOST_HEIGHT)
    figure, axes = pyplot.subplots(figsize=(WIDTH, height), layout="constrained")
    snapshot = Snapshot(axes, frames, dot=9 if with_axes else 30)  # the wakes are all that a movie without axes explains
    if with_axes:
        add_legend(axes, swim_handles())
    else:
        axes.tick_params(left=False, bottom=False, labelleft=False, labelbottom=False)
        axes.set(xlabel="", ylabel="", position=(0, 0, 1, 1))
        for words_or_path in (*snapshot.labels, *snapshot.paths):
            words_or_path.set_visible(False)
        for spine in axes.spines.values():
            spine.set_visible(False)
    if follow:  # lines that stay in the water show the motion
        axes.grid(lw=0.4, color=GRID)
        axes.set_axisbelow(True)

    def show(row):
        snapshot.show(row)
        axes.axis(window(row))

    last = frames.time.size - 1
    show(last)  # with the longest numbers, as a rule
    if with_axes:
        figure.canvas.draw()
    figure.set_layout_engine("none")  # laid out once: it takes longer than drawing
    return animation.FuncAnimation(figure, show, frames=range(last + 1), init_func=lambda: None, blit=False), follow


def parse(arguments):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RUN.nc")
    parser.add_argument("movie", metavar="MOVIE", nargs="?", help="default: RUN.mp4 in this folder")
    parser.add_argument("--fps", type=float, default=25, help="pictures per second (25)")
    parser.add_argument("--rate", type=float, default=1, help="seconds of the run per second of the movie (1)")
    parser.add_argument("--dpi", type=float, default=120, help="dots per inch of a movie 8 inches wide (120)")
    parser.add_argument(
        "--follow",
        action=argparse.BooleanOptionalAction,
        help="let the camera move with the school (default: where the fish would be tiny otherwise)",
    )
    parser.add_argument("--no-axes", action="store_true", help="draw bodies and wakes only, up to the edges of the movie")
    options = parser.parse_intermixed_args(arguments)  # options and names in any order
    for name in ("fps", "rate", "dpi"):
        if not 0 < getattr(options, name) < 1e4:
            stop(f"--{name}: has to be positive", EXIT_USAGE)
    return options


def make_movie(options, movie):
    """Read, draw and write; raises FileError. Returns what the pictures are."""
    frames = Frames(options.results, options.fps, options.rate)
    beats = frames.read("frequency").max() * frames.interval
    if not frames.is_exact and beats * FEW_ROWS > 1:
        print(f"animate.py: warning: {1 / beats:.1f} rows per beat: shapes between rows are uncertain, reduce "
              "time.output_interval", file=sys.stderr)
    writer = choose_writer(movie, options.fps)
    film, follow = animate(frames, options.follow, not options.no_axes)
    film.save(movie, writer, dpi=options.dpi)
    n = frames.time.size
    return f"{n} picture{'s' * (n > 1)}, {options.fps:g} a second: {frames.how}" + ("; the camera follows the school" if follow else "")


def main(arguments):
    options = parse(arguments)
    movie = options.movie or os.path.splitext(os.path.basename(options.results))[0] + ".mp4"
    check_folder(movie)
    with matplotlib.rc_context({**STYLE, "savefig.bbox": None}):  # every picture of a movie has the same size
        try:
            said = make_movie(options, movie)
        except FileError as error:
            stop(error, EXIT_FILE)
        except OSError as error:
            stop(f"{movie}: cannot be written: {error.strerror or error}", EXIT_FILE)
        except DAMAGE as error:
            stop(f"{options.results}: cannot be drawn, it may be damaged ({type(error).__name__}: {error})", EXIT_FILE)
    print(movie)
    print(said)


if __name__ == "__main__":
    main(sys.argv[1:])
