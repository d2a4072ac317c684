"""Draw mechanisms with library parts: `python benchmarks/library_parts OUT [NAME ...]`.

Each NAME.step comes with NAME.joints.json, the joints that it was built with, as `benchmarks/cad.py OUT` reads them.
This needs an environment of its own with build123d and bd_warehouse (0.13 and 0.4 were used, both Apache-2.0).
"""

from __future__ import annotations

import sys
from pathlib import Path

import geared
import heads
import linkages
import machines
import shafts
import stages
from kit import write_all

MECHANISMS = (
    linkages.shoulder_fourbar,
    linkages.toggle_clamp,
    stages.screw_stage,
    machines.quick_return,
    machines.gripper,
    machines.castor,
    shafts.compressor,
    shafts.cardan,
    linkages.table_leg,
    stages.v_slot_gantry,
    geared.planetary,
    geared.arbor_press,
    heads.hook_block,
    heads.pan_tilt,
)

if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    write_all(MECHANISMS, Path(sys.argv[1]), sys.argv[2:])
