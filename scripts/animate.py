#!/usr/bin/python3
"""Make a movie from a result file of shoal: bodies, wakes and paths. The ending of its name decides its kind.

    animate.py RUN.nc [MOVIE.mp4|MOVIE.gif]

One row of the file is one picture. Without --fps the movie runs as fast as the fish do.
"""

import argparse
import os
import shutil
import sys

from plot import EXIT_FILE, EXIT_USAGE, check_folder, matplotlib, stop
from shoal import FileError
from shoal._files import DAMAGE, Results, np
from shoal.plot import STYLE, Snapshot, add_legend, limits, pyplot, swim_handles

from matplotlib import animation

WIDTH, MOST_HEIGHT, LEAST_HEIGHT = 8.0, 8.0, 2.5  # inches


def choose_writer(movie, fps):
    """What writes the movie: ffmpeg, or Pillow for a .gif where there is no ffmpeg."""
    ending = os.path.splitext(movie)[1].lower()
    if ending not in (".mp4", ".gif"):
        stop(f"{movie}: the name of a movie ends in .mp4 or .gif", EXIT_USAGE)
    if shutil.which("ffmpeg"):
        return animation.FFMpegWriter(fps, bitrate=-1, extra_args=["-pix_fmt", "yuv420p"] if ending == ".mp4" else None)
    if ending == ".gif":
        return animation.PillowWriter(fps)
    return stop("a .mp4 needs ffmpeg: apt install ffmpeg, or name a .gif", EXIT_USAGE)


def real_time(results, rows):
    """Pictures per second of a movie that runs as fast as the fish do, within what movie players take."""
    step = np.median(np.diff(results.time[rows])) if len(rows) > 1 else 0.04
    return float(np.clip(1 / step, 1, 60))


def fixed_window(results, rows):
    """A function of the row that gives the window of the whole movie, and the size of that window."""
    sample = [*rows[:: max(1, len(rows) // 50)], rows[-1]]
    window = limits(results, sample)
    return lambda row: window, (window[1] - window[0], window[3] - window[2])


def following_window(results, rows):
    """The same for a window that moves with the fish and holds them and their wakes all the time; along walls."""
    centre = results["com"].mean(axis=1)
    half = np.zeros(2)
    if results.walls:
        x0, x1, y0, y1 = limits(results, rows, with_paths=False)
        centre[:, 1] = (y0 + y1) / 2
    for row in rows[:: max(1, len(rows) // 50)]:
        low, high = np.reshape(limits(results, [row], with_paths=False), (2, 2)).T
        half = np.maximum(half, np.maximum(high - centre[row], centre[row] - low))
    return lambda row: np.column_stack([centre[row] - half, centre[row] + half]).ravel(), 2 * half


def animate(results, rows, follow):
    """The animation: a snapshot that goes from row to row."""
    window, size = (following_window if follow else fixed_window)(results, rows)
    height = np.clip((WIDTH - 0.8) * size[1] / size[0] + 0.8, LEAST_HEIGHT, MOST_HEIGHT)
    figure, axes = pyplot.subplots(figsize=(WIDTH, height), layout="constrained")
    snapshot = Snapshot(axes, results)
    add_legend(axes, swim_handles()).set_in_layout(True)

    def show(row):
        snapshot.show(row)
        axes.axis(window(row))

    show(rows[0])
    figure.canvas.draw()
    figure.set_layout_engine("none")  # laid out once: it takes longer than drawing
    return animation.FuncAnimation(figure, show, frames=rows, init_func=lambda: None, blit=False)


def parse(arguments):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RUN.nc")
    parser.add_argument("movie", metavar="MOVIE", nargs="?", help="default: RUN.mp4 in this folder")
    parser.add_argument("--fps", type=float, help="pictures per second (as fast as the fish)")
    parser.add_argument("--dpi", type=float, default=120, help="dots per inch of a movie 8 inches wide (120)")
    parser.add_argument("--follow", action="store_true", help="let the window move with the fish")
    return parser.parse_intermixed_args(arguments)  # options and names in any order


def make_movie(options, movie):
    """Read, draw and write; raises FileError."""
    results = Results(options.results)
    rows = results.rows_with_wake()
    writer = choose_writer(movie, options.fps or real_time(results, rows))
    animate(results, rows, options.follow).save(movie, writer, dpi=options.dpi)


def main(arguments):
    options = parse(arguments)
    movie = options.movie or os.path.splitext(os.path.basename(options.results))[0] + ".mp4"
    check_folder(movie)
    with matplotlib.rc_context({**STYLE, "savefig.bbox": None}):  # every picture of a movie has the same size
        try:
            make_movie(options, movie)
        except FileError as error:
            stop(error, EXIT_FILE)
        except OSError as error:
            stop(f"{movie}: cannot be written: {error.strerror or error}", EXIT_FILE)
        except DAMAGE as error:
            stop(f"{options.results}: cannot be drawn, it may be damaged ({type(error).__name__}: {error})", EXIT_FILE)
    print(movie)


if __name__ == "__main__":
    main(sys.argv[1:])
