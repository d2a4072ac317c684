"""The catalogue of mechanisms through each format and back: the same freedoms, and the same motion to 1e-12."""

import pytest

import jaxkin as jk
from reference import catalogue, mechanisms, overconstrained
from reference.cassie import cassie_leg
from reference.round_trips import compare_moved

CASES = {
    make.__name__: make
    for make in (
        mechanisms.planar_fourbar,
        mechanisms.slider_crank,
        mechanisms.cam,
        mechanisms.rssr_linkage,
        mechanisms.bennett_linkage,
        mechanisms.spherical_linkage,
        mechanisms.cardan_shafts,
        mechanisms.ball_in_bore,
        catalogue.antiparallelogram,
        catalogue.scotch_yoke,
        catalogue.quick_return,
        catalogue.watt,
        catalogue.stephenson,
        catalogue.jansen,
        catalogue.peaucellier,
        catalogue.andrews,
        catalogue.oldham,
        catalogue.sarrus,
        catalogue.fivebar,
        catalogue.hexapod,
        catalogue.delta,
        catalogue.cam_roller,
        catalogue.swash_plate,
        overconstrained.bricard_linkage,
        overconstrained.goldberg_linkage,
        cassie_leg,
    )
}


def through(mechanism, folder, suffix):
    """Write a mechanism and read it back."""
    path = folder / f"model{suffix}"
    if suffix == ".json":
        return jk.load(mechanism.save(path)).mechanism()
    if suffix == ".asmt":
        return jk.load(jk.write_asmt(mechanism, path)).mechanism()
    if suffix == ".xml":
        return jk.load(jk.write_mjcf(mechanism, path)).mechanism()
    loops = path.with_suffix(".yaml")
    jk.write_urdf(mechanism, path)
    return jk.load(path, loops=loops if loops.exists() else None).mechanism()


SHORT = {"cam", "cardan_shafts", "swash_plate"}
"""Cases of the usual run: a contact without and with a ball, and a joint of two axes; each takes half a second."""


@pytest.mark.parametrize("suffix", [".urdf", ".xml", ".asmt", ".json"])
@pytest.mark.parametrize(
    "name", [name if name in SHORT else pytest.param(name, marks=pytest.mark.long) for name in CASES]
)
def test_a_mechanism_comes_back_from_every_format(name, suffix, tmp_path):
    mechanism = CASES[name]()
    back = through(mechanism, tmp_path, suffix)
    compare_moved(mechanism, back, single=suffix in (".urdf", ".xml"), metres=suffix in (".urdf", ".xml"))
    assert not [note for note in back.notes if "open" in note or "left out" in note]
