"""Progress of long calls: a function of the caller, or a bar."""

import html
import os
import shutil
import sys
import time

EVERY = 0.1  # s between two reports


def in_notebook() -> bool:
    """Whether this is the kernel of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


class Report:
    """Calls a function, or nothing for None, several times a second."""

    def __init__(self, function=None):
        self.function = function
        self._last = -EVERY

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def __call__(self, part, whole, now, end, is_due=False):
        if not is_due and time.monotonic() - self._last < EVERY:
            return
        self.show(part / whole if whole > 0 else 1.0, now, end)
        self._last = time.monotonic()

    def show(self, share, now, end):
        if self.function:
            self.function(now, end)


class Bar(Report):
    """One line that is drawn again: on standard error, or as an element of a notebook."""

    def __init__(self):
        super().__init__()
        self._started, self._display = time.monotonic(), None
        self._notebook = in_notebook()

    def text(self, share, now, end):
        elapsed = time.monotonic() - self._started
        left = f", {elapsed * (1 - share) / share:.0f} s left" if 0 < share < 1 and elapsed > 1 else ""
        return f"{100 * share:3.0f} % t = {now:.4g} of {end:.4g} s{left}"

    def show(self, share, now, end):
        text = self.text(share, now, end)
        if self._notebook:
            self._show_in_notebook(share, text)
            return
        columns = shutil.get_terminal_size((80, 24)).columns
        room = max(columns - len(text) - 4, 0)
        filled = round(room * share)
        line = f"[{'#' * filled}{'.' * (room - filled)}] {text}" if room >= 8 else text
        sys.stderr.write("\r" + line[: columns - 1].ljust(columns - 1))
        sys.stderr.flush()

    def _show_in_notebook(self, share, text):
        from IPython.display import HTML, display

        content = HTML(f"<progress value='{share:.4f}' max='1'></progress> {html.escape(text)}")
        if self._display is None:
            self._display = display(content, display_id=True)
        else:
            self._display.update(content)

    def __exit__(self, *_):
        if not self._notebook:
            sys.stderr.write("\n")


def somebody_looks() -> bool:
    """Whether standard error is a terminal, or this a notebook."""
    try:
        return in_notebook() or (os.isatty(sys.stderr.fileno()))
    except (AttributeError, OSError, ValueError):
        return False


def report(progress):
    """The receiver of progress reports."""
    if progress is None:
        progress = somebody_looks()
    if callable(progress):
        return Report(progress)
    if isinstance(progress, bool):
        return Bar() if progress else Report()
    raise TypeError(f"progress is a function of (time, end), True, False or None, not {progress!r}")
