"""Reads a STEP file by cascadio, as a program of its own: `python step_worker.py SOURCE TARGET OPTIONS`.

TARGET becomes a binary glTF. OPTIONS are those of tessellation, as JSON.
"""

import json
import sys

if __name__ == "__main__":
    source, target, options = sys.argv[1:]
    # cascadio imports trimesh for a loader that is not used here, which takes longer than to convert most files
    sys.modules["trimesh"] = None  # pyright: ignore[reportArgumentType]
    import cascadio

    cascadio.step_to_glb(source, target, include_brep=True, **json.loads(options))
