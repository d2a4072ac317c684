"""Parts drawn as meshes, and assemblies of them."""

import trimesh

import jaxkin as jk


def box(low, high):
    return trimesh.creation.box(bounds=[low, high])


def loaded(folder, parts):
    """The parts as an assembly of STL files."""
    for name, mesh in parts.items():
        mesh.export(folder / f"{name}.stl")
    return jk.load({name: folder / f"{name}.stl" for name in parts}, unit="mm")
