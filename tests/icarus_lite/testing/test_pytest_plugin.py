"""The pytest plug-in, in a pytest of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

DOMAIN = '(percepts (o))\n(test "there is one" :percepts ((o a)) :expect ((o a)))\n'


def pytest_in(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    (folder / "pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=60, check=False
    )


def test_each_test_form_is_a_test(tmp_path: Path) -> None:
    (tmp_path / "good.icr").write_text(DOMAIN)
    bad = DOMAIN + '(test "there are two" :percepts ((o a)) :expect ((o b)))\n'
    (tmp_path / "bad.icr").write_text(bad)
    (tmp_path / "untested.icr").write_text("(percepts (o)) (no test in here, but an error")
    done = pytest_in(tmp_path, "-v")
    assert done.returncode == 1
    assert "good.icr::there is one PASSED" in done.stdout
    assert "bad.icr::there is one PASSED" in done.stdout
    assert "bad.icr::there are two FAILED" in done.stdout
    assert (
        "bad.icr:3:50: :expect (o b)\n    it is not believed\n      nearest: (o a)" in done.stdout
    )
    assert "untested" not in done.stdout
    assert "Traceback" not in done.stdout + done.stderr


def test_a_file_with_errors_is_shown_with_its_carets(tmp_path: Path) -> None:
    (tmp_path / "broken.icr").write_text(DOMAIN + "(concepts ((p ?x) :elements ((oh ?x))))\n")
    done = pytest_in(tmp_path)
    assert done.returncode == 2
    assert "broken.icr:3:31: error[ICR013]" in done.stdout
    assert "^^" in done.stdout
    assert "Traceback" not in done.stdout + done.stderr


def test_it_imports_nothing_heavy_before_there_is_a_domain() -> None:
    code = (
        "import sys, icarus_lite.testing.pytest_plugin;"
        "print(*sorted(m for m in sys.modules if m.startswith(('icarus_lite', 'lark', 'numpy'))))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [
        "icarus_lite",
        "icarus_lite._on_use",
        "icarus_lite._version",
        "icarus_lite.testing",
        "icarus_lite.testing.pytest_plugin",
    ]
