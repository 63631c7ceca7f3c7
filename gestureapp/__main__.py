"""``python -m gestureapp``: every command that needs no window."""

import sys

from gestureapp.cli import main

if __name__ == "__main__":
    sys.exit(main())
