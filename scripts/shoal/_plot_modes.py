"""Draw the multipliers of a steady state, and the fish that move in the mode of the largest one. Used by shoal.plot."""

from ._plot_style import BLUE, GRID, LINES, RED, add_legend
from ._files import FileError, np

# the slow quantities of a fish, in the order of the file
SLOW = ("speed", "slip", "turn", "heading", "ahead", "aside", "amplitude", "course")


def draw_multipliers(axes, multipliers, errors):
    """The complex plane with the unit circle; a bar along the radius is the error of the modulus."""
    angle = np.linspace(0, 2 * np.pi, 361)
    axes.plot(np.cos(angle), np.sin(angle), color="black", lw=0.8)
    for one, error in zip(multipliers, errors):
        size = abs(one)
        ends = one / size * np.array([max(size - error, 0), size + error])
        colour = RED if size - error > 1 else BLUE if size + error < 1 else "black"
        axes.plot(ends.real, ends.imag, color=colour, lw=1)
        axes.plot(one.real, one.imag, "o", color=colour, ms=3.5)
    for label, colour in (("stable", BLUE), ("undecided", "black"), ("unstable", RED)):
        axes.plot([], [], "o", color=colour, ms=3.5, label=label)
    axes.set(aspect="equal", xlabel="real part of the multiplier", ylabel="imaginary part")
    add_legend(axes, axes.get_legend_handles_labels()[0])


def draw(results, figure):
    """Fill an empty figure: the multipliers, and the amplitudes of the first mode."""
    if "steady_multiplier" not in results.data.variables or not np.isfinite(results["steady_multiplier"]).any():
        raise FileError(f"{results.path}: no steady state with multipliers: find one with shoal steady")
    pairs = results["steady_multiplier"]
    used = np.hypot(*pairs.T) > 0
    multipliers, errors = (pairs @ [1, 1j])[used], results["steady_multiplier_error"][used]
    mode = np.hypot(*np.moveaxis(results["steady_mode"][used][0], -1, 0))
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.3))
    draw_multipliers(left, multipliers, errors)

    # one group of bars per fish, one bar per slow quantity
    slow = [q for q in range(len(SLOW)) if np.isfinite(mode[:, q]).any()]
    width = 0.8 / len(slow)
    for i, q in enumerate(slow):
        right.bar(np.arange(results.n_fish) + (i - (len(slow) - 1) / 2) * width, mode[:, q], width, color=LINES[i % len(LINES)], label=SLOW[q])
    right.set_xticks(range(results.n_fish), results.names)
    turn = abs(np.angle(multipliers[0]))
    period = f", period {2 * np.pi / turn:.1f} beats" if turn > 0 else ""
    right.set(ylabel="part of the mode", xlabel=f"mode of {abs(multipliers[0]):.3f} ± {errors[0]:.3f} per beat{period}")
    add_legend(right, right.get_legend_handles_labels()[0])
    for axes in (left, right):
        axes.grid(lw=0.3, color=GRID)
        axes.set_axisbelow(True)
