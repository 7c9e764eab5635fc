"""`python -m fingertip`, and the command of a wheel: the program itself."""

import os
import sys

from . import _core


def main() -> None:
    program = str(_core.program())
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
