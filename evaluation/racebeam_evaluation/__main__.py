"""python -m racebeam_evaluation."""

import sys

from .main import main

sys.exit(main())
