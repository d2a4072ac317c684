"""Limits by hand: said for one coordinate or several, kept in studies, refused where they can mean nothing."""

import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
POINT = (0.0, 0.0, 0.0)


def test_limits_of_one_and_of_several_coordinates():
    assert jk.revolute("A", "a", "b", point=POINT, axis=Z, limits=(-1, 2)).limits == ((-1.0, 2.0),)
    pin = jk.cylindrical("A", "a", "b", point=POINT, axis=Z, limits={"phi": (0, 1)})
    assert pin.limits == ((-np.inf, np.inf), (0.0, 1.0))
    assert jk.revolute("A", "a", "b", point=POINT, axis=Z).limits == ()


@pytest.mark.parametrize(
    ("make", "limits", "message"),
    [
        (jk.revolute, (1, -1), "low before high"),
        (jk.revolute, (0, np.nan), "low before high"),
        (jk.revolute, (1, 2, 3), "two numbers"),
        (jk.revolute, {"z": (0, 1)}, "no coordinate 'z'.*'phi'"),
        (jk.cylindrical, (0, 1), r"coordinates z, phi.*limits=\{'z'"),
    ],
)
def test_limits_that_mean_nothing_are_refused(make, limits, message):
    with pytest.raises(ValueError, match=message):
        make("A", "a", "b", point=POINT, axis=Z, limits=limits)


def test_the_angles_of_a_ball_have_none():
    with pytest.raises(ValueError, match="angles of a ball"):
        jk.free("A", "a", "b", point=POINT, limits={"phi": (-1, 1)})


def test_a_study_has_them_in_degrees_and_keeps_them(tmp_path):
    arm = jk.revolute("arm", "base", "arm", point=POINT, axis=Z, limits=(-np.pi / 2, np.inf))
    pin = jk.cylindrical("pin", "arm", "end", point=(1, 0, 0), axis=Z, limits={"z": (-0.25, 4)})
    mechanism = jk.Mechanism.build(fixed=["base"], joints=[arm, pin])
    jk.write_study(mechanism, tmp_path / "study.toml")
    assert "limits = { phi = [-90.0, inf] }" in (tmp_path / "study.toml").read_text()
    back = jk.load_study(tmp_path / "study.toml").mechanism
    assert back.joints["arm"].limits == ((-np.pi / 2, np.inf),)
    assert back.joints["pin"].limits == ((-0.25, 4.0), (-np.inf, np.inf))
    said = (tmp_path / "study.toml").read_text().replace("limits = { phi = [-90.0, inf] }", "limits = [-90, 45]")
    (tmp_path / "study.toml").write_text(said)
    assert jk.load_study(tmp_path / "study.toml").mechanism.joints["arm"].limits == ((-np.pi / 2, np.pi / 4),)
    (tmp_path / "study.toml").write_text(said.replace("[-90, 45]", "[90, 45]"))
    with pytest.raises(ValueError, match=r"study\.toml.*low before high"):
        jk.load_study(tmp_path / "study.toml")
