"""Running atrito: where the program is, runs within limits, runs that are kept."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path


class LabError(Exception):
    """What ends the tool: told to the lecturer, exit code 1."""


@dataclass(frozen=True)
class Limits:
    """What one run of a deck may take."""

    seconds: int = 10
    megabytes: int = 2000
    file_megabytes: int = 50


@dataclass
class Run:
    """What became of a run: exit code, or 'time' where it was ended; its folder; the first error, in words."""

    code: int
    folder: Path
    error: str = ""
    timed_out: bool = False


def find_program() -> str:
    """atrito: $ATRITO, beside this tool, on the PATH, or in a build of the checkout."""
    named = os.environ.get("ATRITO")
    if named:
        if not os.access(named, os.X_OK):
            raise LabError(f"$ATRITO is {named}, which is no program")
        return os.path.abspath(named)
    here = Path(__file__).resolve()
    if len(here.parents) > 4 and os.access(here.parents[4]/"bin"/"atrito", os.X_OK):  # PREFIX/share/atrito/lab/atrito_lab
        return str(here.parents[4]/"bin"/"atrito")
    on_path = shutil.which("atrito")
    if on_path:
        return on_path
    top = here.parents[3]
    builds = [path for path in top.glob("build/*/bin/atrito") if os.access(path, os.X_OK)]
    if not builds:
        raise LabError("atrito is not found: set $ATRITO, install it, or build it (./run --version does)")
    return str(max(builds, key=lambda path: (path.parts[-3] in ("run", "release"), path.stat().st_mtime)))


def run_atrito(program: str, words: list[str], folder: Path, limits: Limits, out: Path) -> Run:
    """Run atrito in `folder` within limits of time, memory and size of files; no word passes through a shell's eyes."""
    guard = (f"ulimit -v {limits.megabytes*1000}; ulimit -S -t {limits.seconds}; ulimit -H -t {limits.seconds + 2}; "
             f"ulimit -f {limits.file_megabytes*1000}; ulimit -c 0; exec \"$@\"")
    surroundings = {"PATH": os.defpath, "HOME": str(folder), "LC_ALL": "C.UTF-8", "TMPDIR": str(folder), "OMP_NUM_THREADS": "1",
                    "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(["/bin/sh", "-c", guard, "sh", program, *words], cwd=folder, env=surroundings,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said, start_new_session=True)
        timed_out = False
        try:
            process.wait(2*limits.seconds + 5)
        except subprocess.TimeoutExpired:
            timed_out = True
        _end_group(process)
        said.seek(0)
        messages = said.read(200_000)
    late = timed_out or process.returncode in (-signal.SIGXCPU, 128 + signal.SIGXCPU, -signal.SIGKILL, 128 + signal.SIGKILL)
    return Run(process.returncode, out, first_error(messages), late)


def _end_group(process: subprocess.Popen[bytes]) -> None:
    """End what is left of a run, gnuplot and others that it started, too."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass
    process.wait()


def first_error(messages: bytes) -> str:
    """The first error among messages of --messages json, in words."""
    for line in messages.decode("utf-8", "replace").splitlines():
        try:
            message = json.loads(line)
        except ValueError:
            continue
        if isinstance(message, dict) and message.get("severity") == "error":
            place = f"line {message['line']}: " if message.get("line") else ""
            expected = f"; expected: {message['expected']}" if message.get("expected") else ""
            return f"{place}{message.get('text', '')} [{message.get('id', '')}]{expected}"[:400]
    return ""


def observe_words(observations: dict[str, str]) -> list[str]:
    """Options --observe."""
    return [word for name, expression in observations.items() for word in ("--observe", f"{name}={expression}")]


class Keeper:
    """Reference runs of decks by the lecturer, kept in a folder by what they depend on."""

    def __init__(self, program: str, folder: Path, limits: Limits) -> None:
        self.program, self.folder, self.limits = program, folder, limits
        self.version = program + str(os.stat(program).st_mtime_ns) + str(os.stat(program).st_size)
        folder.mkdir(parents=True, exist_ok=True)

    def run(self, command: str, deck: str, words: list[str], name: str) -> Run:
        """Run a deck (its text), or take the run that was kept."""
        words = ([] if command == "run" else [command]) + [name, *words]
        key = hashlib.sha256("\0".join([self.version, deck, *words]).encode()).hexdigest()[:24]
        kept = self.folder/key
        if not (kept/"code").exists():
            self._make(deck, words, name, kept)
        code, _, error = (kept/"code").read_text().partition("\n")
        return Run(int(code), kept, error)

    def _make(self, deck: str, words: list[str], name: str, kept: Path) -> None:
        """Make a run and put its folder where it is kept."""
        with tempfile.TemporaryDirectory(dir=self.folder, prefix="run-") as work:
            folder = Path(work)
            (folder/name).write_text(deck)
            run = run_atrito(self.program, [*words, "-o", "out", "--quiet", "--messages", "json"], folder, self.limits, folder/"out")
            out = folder/"out"
            out.mkdir(exist_ok=True)
            (out/"code").write_text(f"{run.code}\n{run.error}")
            try:
                out.rename(kept)
            except OSError:
                if not (kept/"code").exists():  # else somebody else has made the same run meanwhile
                    raise LabError(f"{kept} cannot be written") from None


def processors() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def seconds_since(start: float) -> str:
    """Time that has gone by, in words."""
    return f"{time.monotonic() - start:.1f} s"
