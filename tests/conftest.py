"""Tests run in float64, as the command line and the examples do; tests of float32 switch it off for themselves.

Most of their time goes into compiling. Programs once compiled are kept beside pytest's own cache: all processes of a
run share them, and the next run has them (`pytest --cache-clear` begins anew). So is the byte code of Python where the
environment forbids to write it beside the modules: a process that compiles JAX anew takes 6 s to begin in place of 2.
The default run, and that of CI (`pytest -m "not study"`), compile with few optimisations, in a third of the time;
`pytest -m long`, and a run of all (`pytest -m ""`), test the programs that users get.
"""

import ctypes
import gc
import os
from pathlib import Path

import jax
import pytest

jax.config.update("jax_enable_x64", True)


FEW_OPTIMISATIONS = (
    "--xla_backend_optimization_level=0 --xla_llvm_disable_expensive_passes=true"
    " --xla_cpu_use_fusion_emitters=false --xla_cpu_parallel_codegen_split_count=1"
)


def pytest_configure(config):
    if config.option.markexpr in ("not long", "not study", "long and not study") and jax.__version_info__ < (0, 11):
        # XLA ends the process at a flag that it does not know; later versions were not tried
        os.environ["XLA_FLAGS"] = f"{os.environ.get('XLA_FLAGS', '')} {FEW_OPTIMISATIONS}"
    if not hasattr(config, "cache"):
        return
    jax.config.update("jax_compilation_cache_dir", str(config.cache.mkdir("compiled")))
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)
    if os.environ.pop("PYTHONDONTWRITEBYTECODE", ""):
        os.environ.setdefault("PYTHONPYCACHEPREFIX", str(config.cache.mkdir("bytecode")))


def pytest_collection_finish(session):
    """Collect garbage less often, and not what is imported: tracing makes so many objects that it took a twentieth."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 20, 20)


EVERY_CASE = ("tests/docs/test_code_blocks.py", "tests/mechanism/test_hard_cases.py")
"""Files whose cases are each a test of their own: pages of the documents, and hard mechanisms."""


def pytest_addoption(parser):
    parser.addoption(
        "--last-case",
        action="store_true",
        help="of each test with several cases the last one, if -m leaves that, as the others repeat what costs most",
    )
    parser.addoption(
        "--last-long-case",
        action="store_true",
        help="of each test with several long cases that are no study the last of these, and all that are not long",
    )


def pytest_collection_modifyitems(config, items):
    """With `--last-case` or `--last-long-case` leave out all cases of a test but the last one."""
    only_long = config.getoption("last_long_case")
    if not (only_long or config.getoption("last_case")):
        return

    def test(item) -> str:
        every = item.nodeid.startswith(EVERY_CASE)
        if only_long:
            every = every or item.get_closest_marker("long") is None or item.get_closest_marker("study") is not None
        return item.nodeid if every else item.nodeid.partition("[")[0]

    last = {test(item): item for item in items}
    config.hook.pytest_deselected(items=[item for item in items if last[test(item)] is not item])
    items[:] = [item for item in items if last[test(item)] is item]


@pytest.fixture
def without_pictures(monkeypatch):
    """Have motions written without their pictures, which take seconds, for a test that looks at the other files."""
    from jaxkin.io.writers import WRITERS

    for name in ("motion.png", "coordinates.png"):
        monkeypatch.delitem(WRITERS, name)


MOST_MAPS = 15_000
"""Memory maps of a process above which compiled programs are forgotten. A program has some hundred of them, and Linux
allows 65,530 by default: beyond that XLA crashes."""
MOST_MEMORY = 2_000_000_000, 3_000_000_000
"""Bytes of memory above which they are forgotten, too: an eighth of that of the machine within these, as four processes
run at most, and a container may have less than its machine. One that ran half of the long tests had 6e9. Forgetting
takes seconds, with all small programs that are compiled again."""


def pytest_runtest_teardown(item, nextitem):
    """Forget compiled programs between modules before the process has too many; those on the disk are read again."""
    if nextitem is not None and nextitem.path == item.path:
        return
    process = Path("/proc/self")
    if not (process / "maps").exists():
        return
    maps = (process / "maps").read_bytes().count(b"\n")
    page = os.sysconf("SC_PAGE_SIZE")
    memory = int((process / "statm").read_text().split()[1]) * page
    least, most = MOST_MEMORY
    if maps > MOST_MAPS or memory > min(max(least, os.sysconf("SC_PHYS_PAGES") * page // 8), most):
        jax.clear_caches()
        gc.collect()
        if hasattr(libc := ctypes.CDLL(None), "malloc_trim"):  # glibc keeps what was freed otherwise
            libc.malloc_trim(0)
