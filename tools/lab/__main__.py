"""python3 -I -B tools/lab: atrito-lab."""

import sys

if sys.version_info < (3, 11):
    sys.exit("atrito-lab: Python 3.11 or later is needed")

from atrito_lab.cli import main  # noqa: E402

sys.exit(main())
