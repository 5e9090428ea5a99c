"""`python -m vehgen`, and the script `vehgen`."""

from __future__ import annotations

import sys

from vehgen.commands import main

if __name__ == "__main__":
    sys.exit(main())
