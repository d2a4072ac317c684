"""Models of MuJoCo whose meshes are not there."""

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest


def bare_model(file: Path, folder: Path) -> Any:
    """Compile a model without its meshes and pictures, by way of a file in a folder; skips where there is no MuJoCo."""
    mujoco = pytest.importorskip("mujoco")
    root = ElementTree.parse(file).getroot()
    assets = root.find("asset")
    assert assets is not None
    root.remove(assets)
    for body in root.iter("body"):
        for geom in body.findall("geom"):
            body.remove(geom)
    ElementTree.ElementTree(root).write(folder / "bare.xml")
    return mujoco.MjModel.from_xml_path(str(folder / "bare.xml"))
