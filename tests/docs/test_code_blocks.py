"""Every block of code on every page runs: Python in order in one namespace a page, commands as far as their options.

Pages run in a folder of their own that holds the files their blocks name: the shipped assemblies, and the parts of the
four-bar as meshes.
"""

import shlex
import shutil
import tarfile
import textwrap
from importlib import resources
from pathlib import Path

import pytest
import trimesh
import typer

import jaxkin as jk
from documents import PAGES, blocks, name
from reference.freecad import slider_crank

LONG = {
    f"docs/{page}.md"
    for page in (
        "index",
        "how-to/by-hand",
        "how-to/cams",
        "how-to/robots",
        "how-to/design",
        "how-to/derivatives",
        "how-to/sweep",
        "how-to/inverse",
        "how-to/clashes",
        "how-to/step",
        "how-to/couplings",
        "how-to/effects",
        "how-to/time",
        "how-to/tolerances",
        "how-to/calibration",
        "how-to/forces",
        "how-to/modes",
        "how-to/range",
        "how-to/workspace",
    )
}
"""Pages that compile several programs, each for seconds; the README and the other pages are in every run."""
CONSOLE = ("sh", "console", "bash")
COLUMNS = 104
"""Columns of code that a page of the site shows without scrolling in a window of 1300 pixels (`docs/site.css`)."""
WITH_CODE = [page for page in PAGES if any(block.language in ("python", "toml", *CONSOLE) for block in blocks(page))]


@pytest.fixture(scope="session")
def files(tmp_path_factory) -> Path:
    """A folder with the files that pages name."""
    folder = tmp_path_factory.mktemp("files")
    for file in resources.files("jaxkin.examples").iterdir():
        if file.name.endswith(".step"):
            shutil.copy(str(file), folder)
    shutil.copy(folder / "fourbar.step", folder / "machine.step")
    with tarfile.open(Path(__file__).parents[1] / "io" / "data" / "robots" / "robots.tar.xz") as packed:
        for suffix in (".urdf", ".yaml"):
            content = packed.extractfile(f"gepetto__5bar_linkage{suffix}")
            assert content is not None
            (folder / f"robot{suffix}").write_bytes(content.read())
    slider_crank(folder)  # "machine.FCStd"
    for part in jk.load(folder / "fourbar.step").parts:
        mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(part.triangles))
        mesh.export(folder / f"{part.name}.stl")
    return folder


@pytest.mark.parametrize(
    "page",
    [pytest.param(page, id=name(page), marks=pytest.mark.long if name(page) in LONG else ()) for page in WITH_CODE],
)
def test_the_blocks_of_a_page_run(page, files, tmp_path, monkeypatch):
    shutil.copytree(files, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    names: dict[str, object] = {"__name__": "__main__"}
    for number, block in enumerate(blocks(page)):
        if block.language == "python":
            # empty lines before it, so that a traceback names the line of the page
            text = "\n" * (block.line - 1) + textwrap.dedent(block.text)
            exec(compile(text, str(page), "exec"), names)
        elif block.language == "toml":
            study = tmp_path / f"study{number}.toml"
            study.write_text(block.text, encoding="utf-8")
            jk.load_study(study)
        elif block.language in CONSOLE:
            for words in commands(block.text):
                parse(words)


def test_code_is_seen_without_scrolling():
    wide = [
        f"{name(page)}, line {block.line + number}: {len(line)} columns"
        for page in PAGES
        for block in blocks(page)
        for number, line in enumerate(block.text.splitlines())
        if len(line) > COLUMNS
    ]
    assert not wide, f"more than {COLUMNS} columns; shorten the comment, or write the call in several lines: {wide}"


def commands(text: str) -> list[list[str]]:
    """The calls of jaxkin in a block, without comments, and without what stands before them on the line."""
    lines = (shlex.split(line, comments=True) for line in text.replace("\\\n", " ").splitlines())
    return [words[words.index("jaxkin") + 1 :] for words in lines if "jaxkin" in words]


def parse(words: list[str]) -> None:
    """Parse a call as the command line does; UsageError for a command, an option or a value that there is not."""
    from jaxkin.cli.app import app

    group = typer.main.get_command(app)
    context = group.make_context("jaxkin", list(words))
    command_name, command, rest = group.resolve_command(context, list(words))
    command.make_context(command_name, rest, parent=context)


def test_a_command_that_does_not_exist_is_found():
    with pytest.raises(Exception, match=r"No such (option|command)"):
        parse(["sweep", "--no-such-option"])
    with pytest.raises(Exception, match=r"No such (option|command)"):
        parse(["no-such-command"])
