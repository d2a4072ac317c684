"""Archives beside the tests, unpacked."""

import tarfile
from pathlib import Path


def unpack(archive: Path, folder: Path, *names: str) -> None:
    """Unpack an archive, or some files of it, into a folder."""
    with tarfile.open(archive) as packed:
        packed.extraction_filter = getattr(tarfile, "data_filter", None)  # Python 3.11.4 on
        packed.extractall(folder, [packed.getmember(name) for name in names] or None)
