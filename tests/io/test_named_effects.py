"""Effects by name: computed where a study or the command line asks for them, and nowhere else."""

import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin.cli.app import app
from jaxkin.examples import path
from jaxkin.io import named_effects
from jaxkin.io.named_effects import EFFECTS, compute, missing
from reference import mechanisms

STUDY = """
geometry = "{file}"
fixed = ["ground"]
[drive]
ground-crank = "0:40:3"
[effects]
contacts = true
clashes = {{ within = 2.0 }}
rates = {rates}
"""


def test_every_name_stands_in_the_table_of_effects():
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "effects.md").read_text("utf-8")
    assert [name for name in EFFECTS if f"| `{name}` |" not in page] == []


def study(folder, rates="{ ground-crank = 180 }"):
    (folder / "study.toml").write_text(STUDY.format(file=path("fourbar"), rates=rates))
    return jk.load_study(folder / "study.toml")


@pytest.mark.long
def test_a_study_computes_what_it_asks_for(tmp_path):
    made = study(tmp_path)
    motion = made.sweep()
    results = made.computed(motion)
    assert list(results) == ["contacts", "clashes", "velocities", "accelerations"]
    assert results["clashes"].within == 2.0
    np.testing.assert_allclose(results["velocities"].coordinates["ground-crank"], np.pi, rtol=1e-15)
    direct = jk.velocities(motion, {"ground-crank": np.pi})
    np.testing.assert_array_equal(
        results["velocities"].coordinates["ground-rocker"], direct.coordinates["ground-rocker"]
    )


@pytest.mark.long
def test_what_is_off_or_not_named_is_not_computed(tmp_path, monkeypatch):
    never = EFFECTS["clashes"]._replace(compute=lambda motion: pytest.fail("clashes were not asked for"))
    monkeypatch.setitem(named_effects.EFFECTS, "clashes", never)
    made = study(tmp_path, rates="false")
    assert list(made.effects) == ["contacts", "clashes"]
    motion = made.sweep()
    assert list(compute(motion, {"contacts": {}})) == ["contacts"]
    assert missing(motion, ["rates", "contacts", "forces"]) == "Not computed: clashes (--effects clashes)."
    assert missing(motion, EFFECTS) == ""


@pytest.mark.long
@pytest.mark.usefixtures("without_pictures")
def test_only_what_can_be_computed_is_offered(tmp_path):
    """A study that is written from solids has its joints by hand: the option that is offered runs as it stands."""
    found = CliRunner().invoke(
        app, ["inspect", str(path("fourbar")), "--fixed", "ground", "--study", str(tmp_path / "study.toml")]
    )
    assert found.exit_code == 0, found.output
    sweep = ["sweep", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]
    said = CliRunner().invoke(app, sweep)
    assert said.exit_code == 0, said.output
    assert "Not computed: rates, clashes, contacts, forces (--effects rates,clashes,contacts)." in said.output
    assert "forces needs the density of the parts" in said.output and "[effects.forces]" in said.output
    assert CliRunner().invoke(app, [*sweep, "--effects", "rates,clashes,contacts"]).exit_code == 0
    by_hand = (tmp_path / "out" / "contacts.csv").read_text()
    # what the lines say is lacking, written into the study
    text = (tmp_path / "study.toml").read_text()
    head, drive = text[: text.index("[joints.")], text[text.index("[drive]") :]
    assert "contacts = false" in head
    head = head.replace("contacts = false", "contacts = true")
    (tmp_path / "study.toml").write_text(f'{head}\n{drive}\n[effects]\nforces = {{ density = "steel" }}\n')
    said = CliRunner().invoke(app, [*sweep, "--effects", "contacts"])
    assert said.exit_code == 0, said.output
    assert (tmp_path / "out" / "contacts.csv").read_text() == by_hand
    assert (tmp_path / "out" / "reactions.csv").stat().st_size


@pytest.mark.long
def test_an_effect_that_fails_keeps_nothing_else_from_being_written(tmp_path):
    study(tmp_path, rates="{ ground-rocker = 1 }")
    text = (tmp_path / "study.toml").read_text() + 'forces = { density = "stel" }\n'
    (tmp_path / "study.toml").write_text(text)
    said = CliRunner().invoke(app, ["sweep", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")])
    assert said.exit_code == 2
    assert "not computed: rates, forces; all else is written" in said.stderr
    assert "'ground-rocker' is not driven" in said.stderr and "no material 'stel'" in said.stderr
    written = {file.name for file in (tmp_path / "out").iterdir()}
    assert {"motion.npz", "motion.html", "contacts.csv", "clashes.csv"} <= written
    assert not written & {"velocities.csv", "reactions.csv"}


@pytest.mark.long
@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"rates": {"A": "10"}}, "rates: the speed of 'A' must be one finite number, got '10'"),
        ({"rates": {"A": [10, 20]}}, "rates: the speed of 'A' must be one finite number, got [10, 20]"),
        ({"rates": {"A": {"phi": 10}}}, "rates: a name with a dot stands in quotes: 'A.phi' = 10"),
        ({"rates": {"A": np.nan}}, "rates: the speed of 'A' must be one finite number, got nan"),
    ],
)
def test_speeds_that_are_none_are_told(asked, said):
    motion = mechanisms.planar_fourbar(1.0).sweep({"A": np.linspace(0.0, 1.0, 3)})
    with pytest.raises(ValueError, match=re.escape(said)):
        compute(motion, asked)


def test_an_effect_is_asked_for_by_a_word_or_its_settings(tmp_path):
    with pytest.raises(ValueError, match=r"effects\.rates: expected true, false, or a table of settings"):
        study(tmp_path, rates="360")


def test_parts_without_solids_and_contacts_are_told_in_words_of_a_study():
    motion = mechanisms.planar_fourbar().sweep({"A": [0.0, 0.1]})
    said = missing(motion, ())
    assert said.splitlines()[0] == "Not computed: rates, clashes, contacts, forces (--effects rates)."
    assert "clashes needs solids" in said and "the mass of crank, coupler, rocker, without a solid" in said
    for name in ("clashes", "contacts", "forces"):
        with pytest.raises(ValueError, match=f"^{name} needs "):
            compute(motion, {name: {}})


@pytest.mark.long
@pytest.mark.parametrize(
    ("effects", "message"),
    [
        ({"forces": {}}, r"needs the density.*\[effects.forces\]"),
        ({"forces": {"density": "stel"}}, "steel"),
        ({"forces": {"density": "steel", "speeds": {"ground-rocker": 1}}}, "forces: 'ground-rocker' is not driven"),
        ({"clahses": {}}, "no effect 'clahses'.*'clashes'"),
        ({"clashes": {"winthin": 1}}, "no setting 'winthin'; it has within, tolerance, ignore"),
        ({"contacts": {"within": 1}}, "no setting 'within'; it has none"),
        ({"rates": {"ground-rocker": 1}}, "'ground-rocker' is not driven"),
    ],
)
def test_what_is_no_effect_is_refused(effects, message, tmp_path):
    motion = study(tmp_path).sweep()
    with pytest.raises(ValueError, match=message):
        compute(motion, effects)


def test_a_study_with_an_unknown_effect_is_refused(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY.format(file=path("fourbar"), rates="true") + "forcs = true\n")
    with pytest.raises(ValueError, match=r"study\.toml: effects: there is no effect 'forcs'"):
        jk.load_study(tmp_path / "study.toml")


@pytest.mark.long
def test_several_drives_need_speeds():
    z = (0, 0, 1)
    joints = [jk.revolute(name, "ground", name.lower(), point=(k, 0, 0), axis=z) for k, name in enumerate("AB")]
    motion = jk.Mechanism.build(fixed=["ground"], joints=joints).sweep({"A": [0.0, 1.0], "B": [0.0, 2.0]})
    with pytest.raises(ValueError, match=r"speeds of the driven coordinates.*\[effects.rates\]"):
        compute(motion, {"rates": {}})
    found = compute(motion, {"rates": {"A": 90, "B.phi": 0}})
    np.testing.assert_allclose(found["velocities"].coordinates["A"], np.pi / 2, rtol=1e-15)


@pytest.mark.long
def test_a_joint_may_be_called_as_an_argument():
    joints = [jk.revolute("motion", "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1))]
    motion = jk.Mechanism.build(fixed=["ground"], joints=joints).sweep({"motion": [0.0, 1.0]})
    found = compute(motion, {"rates": {"motion": 180}})
    np.testing.assert_allclose(found["velocities"].coordinates["motion"], np.pi, rtol=1e-15)


@pytest.mark.long
def test_forces_by_name(tmp_path):
    motion = study(tmp_path).sweep()
    found = compute(motion, {"forces": {"density": {"*": 7850}, "speeds": {"ground-crank": 180}}})
    masses = jk.masses(motion.mechanism, "steel")
    direct = jk.drive_forces(motion, masses, gravity=(0, 0, -9.81), rates={"ground-crank": np.pi})
    np.testing.assert_allclose(
        found["drive_forces"].forces["ground-crank.phi"], direct.forces["ground-crank.phi"], rtol=1e-12
    )
    assert list(found) == ["drive_forces", "reactions"]
    with pytest.raises(ValueError, match=r"forces: speeds are given by name, .* got 360"):
        compute(motion, {"forces": {"density": 7850, "speeds": 360}})


@pytest.mark.long
@pytest.mark.usefixtures("without_pictures")
def test_the_command_line_writes_them(tmp_path):
    study(tmp_path, rates="true")
    said = CliRunner().invoke(app, ["sweep", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")])
    assert said.exit_code == 0, said.output
    for name in ("contacts", "clashes", "velocities", "accelerations"):
        for suffix in ("csv", "png"):
            assert (tmp_path / "out" / f"{name}.{suffix}").stat().st_size
    assert "0 clash" in said.output and "Not computed: forces" in said.output
    table = np.genfromtxt(tmp_path / "out" / "velocities.csv", delimiter=",", names=True)
    np.testing.assert_allclose(table["groundcrankphi_radtime"], 1.0)
    other = CliRunner().invoke(app, ["sweep", str(path("fourbar")), "--out", "x", "--effects", "clashes,forcs"])
    assert other.exit_code == 2
