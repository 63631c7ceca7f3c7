"""``gestureapp``: the application, and every command. Qt is imported only when a window opens."""

import sys

from gestureapp import cli
from gestureapp.running import RunningCell
from gestureapp.window_port import Driver


def open_window(
    running: RunningCell, exit_after_s: float | None, driver: Driver | None = None
) -> int:
    """Show the window of a running cell until it is closed; the exit code."""
    from ui.app import run_window

    return run_window(
        running.cell,
        running.operator,
        exit_after_s,
        driver,
        running.last_time,
        running.guided,
        running.trainer,
        running.setup,
    )


def show_refusal(text: str) -> None:
    """Show why the application did not start, in a message of its own."""
    from ui.app import show_message

    show_message(text)


def main() -> int:
    """The console script."""
    return cli.main(open_window=open_window, show_refusal=show_refusal)


if __name__ == "__main__":
    sys.exit(main())
