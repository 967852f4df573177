"""The command ``sinew``, for ``python -m sinew`` and the script of this name."""

import signal
import sys

from . import _sinew


def main() -> int:
    """Run the command line of this process and return its exit status."""
    # As a program in Rust finds them: Ctrl-C ends what does not handle it.
    for name, of_python in (("SIGINT", signal.default_int_handler), ("SIGXFSZ", signal.SIG_IGN)):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is of_python:
            signal.signal(number, signal.SIG_DFL)
    return _sinew.run_command(["sinew", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
