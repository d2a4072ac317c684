"""Names that users try first, and that are not there: the errors say what to write instead, and that is there."""

import copy
import importlib
import pickle
import re
from pathlib import Path

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin import _guesses
from reference.mechanisms import fourbar_through


@pytest.fixture(scope="module")
def motion():
    mechanism = fourbar_through((0, 0), (1, 0), (3.2, 2.9), (4, 0))
    return mechanism.sweep({next(iter(mechanism.joints)): np.linspace(0, 0.1, 5)})


def told(owner, name):
    with pytest.raises(AttributeError) as raised:
        getattr(owner, name)
    return str(raised.value)


@pytest.mark.parametrize("name", ["plot", "to_csv", "dof", "ik", "jacobian", "torque_of_drive", "animate"])
def test_names_of_other_programs_are_answered_by_all_that_users_hold(motion, name):
    for owner in (jk, motion, motion.mechanism, jk.load(jk_example())):
        said = told(owner, name)
        assert f"no attribute {name!r}" in said
        assert ("jk." in said or "motion." in said or "mechanism." in said) == (name != "torque_of_drive")


def jk_example():
    from jaxkin.examples import path

    return path("fourbar")


def test_functions_and_holders_of_a_name_are_told(motion):
    assert "did you mean jk.clashes(motion, ...)?" in told(motion, "clashes")
    assert "did you mean jk.limits(mechanism, ...)?" in told(motion.mechanism, "limits")
    assert "did you mean mechanism.sweep(...)?" in told(jk, "sweep")
    assert "did you mean motion.transforms?" in told(motion.mechanism, "transforms")
    assert "did you mean 'lengths'?" in told(motion.mechanism, "lenghts")


def test_what_is_advised_is_there(motion):
    holders = {"jk": jk, "motion": jk.Motion, "mechanism": jk.Mechanism, "joint": jk.Joint}
    for advice in _guesses._WORDS:
        found = re.findall(r"\b(jk|motion|mechanism|joint)\.((?:\w+\.)*\w+)", advice)
        assert found
        for holder, names in found:
            owner = holders[holder]
            for name in names.split("."):
                if name in ("html", "png", "csv", "npz", "glb", "json"):  # a file
                    continue
                fields = getattr(owner, "__dataclass_fields__", {})
                assert name in fields or hasattr(owner, name) or name in ("loops", "plot", "path", "stroke"), advice
                owner = getattr(owner, name, None)


def test_no_advised_name_is_there_already(motion):
    names = set(_guesses._ADVICE)
    assert not names & set(dir(jk.Motion) + list(jk.Motion.__dataclass_fields__))
    assert not names & set(dir(jk)), "the advice would never be read"


@pytest.mark.parametrize(
    ("name", "instead"),
    [
        ("mobility", "; did you mean mechanism.mobility(...)?"),
        ("solve", "; did you mean mechanism.solve(...)?"),
        ("mechanism", "; did you mean assembly.mechanism(...)?"),
        ("joints", "; did you mean mechanism.joints?"),
        ("effects", ""),
    ],
)
def test_packages_that_are_called_as_functions_say_what_to_write(motion, name, instead):
    """They are names of jaxkin once anything in them was imported: Python said no more than "not callable"."""
    importlib.import_module(f"jaxkin.{name}")
    with pytest.raises(TypeError) as raised:
        getattr(jk, name)(motion.mechanism)
    assert str(raised.value) == f"jaxkin.{name} is a package of modules, and no function{instead}"


@pytest.mark.parametrize(
    ("owner", "given", "named", "said"),
    [
        (jk.Mechanism, (), {"fixed": ["a"], "joints": []}, "no 'fixed', 'joints': jk.Mechanism.build(fixed="),
        (jk.Mechanism, ([],), {}, "no list: jk.Mechanism.build(fixed="),
        (jk.Assembly, ("machine.step",), {}, "no str: jk.load("),
    ],
)
def test_who_makes_what_is_held_by_its_class_is_told_what_makes_it(motion, owner, given, named, said):
    with pytest.raises(TypeError, match=re.escape(f"the class {owner.__name__} itself takes {said}")):
        owner(*given, **named)
    again = pickle.loads(pickle.dumps(motion.mechanism))
    assert again.parts == copy.copy(motion.mechanism).parts == motion.mechanism.parts


def test_what_is_no_function_is_asked_for_without_brackets(motion):
    with pytest.raises(TypeError, match=r"mechanism\.structure is no function: .* without brackets; it has .*loops"):
        motion.mechanism.structure()
    with pytest.raises(TypeError, match=r"by joint, .* in square brackets: write \['B'\]"):
        motion.mechanism.joints("B")
    with pytest.raises(TypeError, match=r"by part, .* write \['coupler'\]"):
        motion.transforms("coupler")


@pytest.mark.parametrize("name", ["crank-ground", "Crank_Ground", "ground crank"])
def test_a_joint_is_known_by_its_parts_in_either_order(name):
    mechanism = jk.load(jk_example()).mechanism(fixed=["ground"])
    with pytest.raises(ValueError, match=r"did you mean 'ground-crank'\?"):
        mechanism.sweep({name: [0.0, 0.1]})


def test_private_names_are_answered_without_advice(motion):
    assert told(motion, "_repr_html_").endswith("no attribute '_repr_html_'")
    assert not hasattr(motion, "__jax_array__")


def test_an_error_within_a_property_is_not_hidden(motion, monkeypatch):
    monkeypatch.setattr(jk.Motion, "closed", property(lambda self: self.status.nothing_such))
    with pytest.raises(AttributeError, match="nothing_such"):
        motion.closed  # noqa: B018


def test_what_users_hold_prints_itself_in_one_line(motion):
    held = [motion, motion.mechanism, jk.load(jk_example()).parts[0], *motion.mechanism.all_joints]
    for each in [*held, jax.tree.map(lambda leaf: None, motion)]:
        assert "\n" not in repr(each) and len(repr(each)) < 100
    assert "over 5 poses" in repr(motion)


@pytest.fixture(scope="module")
def results(motion):
    mechanism = motion.mechanism
    (crank,) = [name.rpartition(".")[0] for name in motion.inputs]
    return [
        jk.velocities(motion, {crank: 1.0}),
        jk.transmission(motion, list(mechanism.joints)[-1]),
        jk.screw_axes(jk.velocities(motion, {crank: 1.0}), "coupler"),
        jk.limits(mechanism, crank),
        jk.assembly_modes(mechanism, {crank: 0.1}),
        jk.coupler_curve(motion, "coupler", (1.0, 1.0, 0.0)),
        jk.motion_law([("harmonic", 1.0, 1.0)]),
        jk.load(jk_example()).contacts(),
        mechanism.mobility(),
        mechanism.structure,
        mechanism.plan([crank]),
    ]


@pytest.mark.long
def test_results_print_themselves_in_one_line_that_names_what_they_hold(results):
    """Of a hundred poses they had ten to ninety thousand letters."""
    for each in [*results, jax.tree.map(lambda leaf: None, results[0])]:
        line = repr(each)
        assert "\n" not in line and len(line) <= 120
        first = next(iter(type(each).__dataclass_fields__))
        assert line.startswith(f"<{type(each).__name__} with {first}")


@pytest.mark.long
def test_results_say_what_they_hold_where_they_are_asked_for_another_name(results):
    for each in results:
        said = told(each, "nothing_such")
        names = said.partition("it has ")[2].split(", ")
        assert {*type(each).__dataclass_fields__} <= {*names}
        assert all(hasattr(each, name) for name in names)
    velocities, transmission = results[:2]
    assert told(velocities, "coordinate").endswith("did you mean 'coordinates'?")
    assert told(velocities, "to_csv").endswith(': write save("table.csv")')
    assert told(velocities, "show").endswith(': write plot("picture.png")')
    assert told(transmission, "lost_contacts").endswith("did you mean .motion.lost_contacts?")


@pytest.mark.long
def test_results_are_copied_and_pickled(results):
    for each in (copy.deepcopy(results[0]), pickle.loads(pickle.dumps(results[0]))):
        assert each.order == 1 and np.array_equal(each.displacements[0], results[0].displacements[0])


def test_copies_and_pickles_are_not_answered_by_advice(motion):
    for again in (copy.deepcopy(motion), pickle.loads(pickle.dumps(motion))):
        np.testing.assert_array_equal(again.status, motion.status)


def test_a_coordinate_in_place_of_its_joint_is_told_where_it_is(motion):
    """Drives, inputs and tables name "joint.coordinate", entries are by joint: that one was not found, without more."""
    for named in (motion.coordinates, motion.mechanism.joints):
        with pytest.raises(KeyError, match=r"'B.phi' is a coordinate.*write \['B'\]"):
            named["B.phi"]
    assert motion.mechanism.joints["B"].coordinates == ("phi",)


def test_a_study_in_place_of_geometry_is_sent_to_load_study(tmp_path):
    with pytest.raises(ValueError, match=r"jk\.load_study\('.*machine\.toml'\)"):
        jk.load(tmp_path / "machine.toml")


def test_an_example_that_the_guides_read_is_found(tmp_path, monkeypatch):
    """All pages of the guide read `fourbar.step`, which whoever tries them has in no folder."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match=r"load\(path\('fourbar'\)\), or copy (.*fourbar\.step)") as raised:
        jk.load("fourbar.step")
    assert Path(str(raised.value).rpartition("copy ")[2]).is_file()
    with pytest.raises(FileNotFoundError, match=r"machine\.step does not exist: give the path"):
        jk.load("machine.step")


@pytest.mark.parametrize("use", [lambda motion: motion["coupler"], lambda motion: motion[0], list])
def test_a_motion_has_no_items(motion, use):
    with pytest.raises(TypeError, match=r"motion\.(transforms|inputs)|its arrays"):
        use(motion)
