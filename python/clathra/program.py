"""The program: where it stands, and a run of it that is under way."""
import atexit
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

from .run import NoRun, Progress, Run

# OpenMPI may run as root and share cores, does not pin several runs to the same one, and starts no daemon for one rank.  What the user has set wins.
ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_ess_singleton_isolated": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "PRTE_MCA_hwloc_default_binding_policy": "none",
}  # fmt: skip
PATIENCE = 60.0  # s in which a run that is to stop ends its step and saves itself; then it is killed
BEGINS = 5.0  # s after which it has begun, though it has no row: a signal while MPI begins is lost, or kills it
ENDED = re.compile(r"^(Given up at .*|Ended by .*|Ended before .*)$", re.M)
LOG = re.compile(r"^(.*: (?:note|warning): .*(?:\n  What to try, in this order: .*)?|-{20,}\n(?:.*\n)*?-{20,}|mpiexec: Forwarding .*)\n?", re.M)  # what is no error: notes, warnings, and mpiexec's words on the end of a rank


class Failed(Exception):
    """A run did not come to its end.

    code    exit code of the program (docs/running.md), below 0 the signal that killed it, None where it was not started
    said    all that the program said
    folder  where its results are
    """

    def __init__(self, sentence, code=None, said="", folder=None):
        super().__init__(sentence)
        self.code, self.said, self.folder = code, said, folder


class Refused(Failed):
    """The case, an option, the checkpoint or the folder is wrong, or there is no program: nothing was run."""


class GaveUp(Failed):
    """The run could not go on; its last good state is in `folder`/checkpoint.h5."""


class Ended(Failed):
    """The run was ended by a signal or a limit; restart=True goes on from its checkpoint."""


def _beside():
    """Where the program may stand, as seen from this package: in the folder of the build, in the tree, below the prefix."""
    for here in dict.fromkeys((Path(__file__).absolute(), Path(__file__).resolve())):
        yield here.parents[2] / "clathra"
        yield here.parents[2] / "build" / "clathra"
        yield from (folder / "bin" / "clathra" for folder in here.parents)


def find_program(program=None):
    """Path of the program: `program`, else $CLATHRA_PROGRAM, else what was built or installed with this package, else the one on PATH."""
    wanted = program or os.environ.get("CLATHRA_PROGRAM")
    usable = lambda path: path.is_file() and os.access(path, os.X_OK)
    found = [wanted and shutil.which(wanted)] if wanted else [*map(str, filter(usable, _beside())), shutil.which("clathra")]
    if not any(found):
        raise Refused(f"there is no program {wanted}" if wanted else "there is no program clathra beside the package nor on PATH; program=... or CLATHRA_PROGRAM names it")
    return next(filter(None, found))


def environment(session, ranks=1):
    """Of a process, with a folder of its own for MPI's session: of two runs that share one, the first to end may remove what the other has
    just made.  One rank looks for no networks, and so starts in a third of the time."""
    return {**ENVIRONMENT, **({"OMPI_MCA_pml": "ob1"} if ranks == 1 else {}), **os.environ, "OMPI_MCA_orte_tmpdir_base": str(session)}


_living = set()


@atexit.register
def stop_all(jobs=None):
    """Stops these jobs, or all."""
    jobs = list(_living if jobs is None else jobs)
    for job in jobs:
        job.signal()
        job.end(0.0)  # which sends it
    for job in jobs:
        job.stop()


class Job:
    """A run that is under way (Case.start).

        for now in job:                    # every second, until it ends
            print(f"{now.share:.0%}")
        run = job.wait()

    Ctrl-C while Python waits for it, the end of a `with` block and the end of Python stop it.  Once it has ended, code is its exit code, said all that
    it said, usage what it took of the processor and of memory (resource.getrusage).
    """

    def __init__(self, command, folder=None, ranks=1, restarts=False, given=None):
        """Starts a command, the program and its options, on some ranks.  `folder`: of its results; `given`: a file that goes where the program
        refuses it."""
        if ranks < 1:
            raise Refused(f"ranks = {ranks} is below 1", folder=folder)
        self.command = [*(("mpiexec", "-n", str(ranks)) if ranks > 1 else ()), *map(str, command)]
        self.folder, self.code, self.usage, self.stopped, self._given = folder, None, None, False, given
        self._before, self._restarts, self._asked, self._begun = self._rows(), restarts, False, time.monotonic()
        self._session = tempfile.mkdtemp(prefix="clathra-mpi-")
        self._texts = [tempfile.TemporaryFile() for _ in range(2)]
        self._process = None
        try:
            self._process = subprocess.Popen(self.command, env=environment(self._session, ranks), stdin=subprocess.DEVNULL, stdout=self._texts[0], stderr=self._texts[1],
                                             start_new_session=True)  # fmt: skip
        except OSError as error:
            raise Refused(f"{self.command[0]} cannot be started: {error.strerror}", folder=folder) from None
        finally:
            if self._process is None:
                self._close()
        _living.add(self)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.stop()

    def __iter__(self):
        return self.follow()

    def follow(self, every=1.0):
        """Its progress every so many seconds, and at its end."""
        while self.end(every) is None:
            yield self.progress()
        yield self.progress()

    def _rows(self):
        """What tells that a run has written its first row."""
        try:
            found = os.stat(Path(self.folder) / "balance.csv")
        except (OSError, TypeError):  # there is none, or no folder
            return None
        return found.st_mtime_ns, found.st_ino, found.st_size

    def progress(self):
        """How far it is: Progress(step, time, end, share)."""
        if self.folder is not None and (self._restarts or self._rows() != self._before):
            try:
                return Run(self.folder).progress
            except NoRun:
                pass
        return Progress(0, 0.0, float("nan"), 0.0)

    def end(self, timeout=None):
        """Waits until it ends, at most `timeout` s; its exit code, None while it runs."""
        try:
            if self.code is None and self._reap(timeout):
                self._close()
        except BaseException:
            if not self.stopped:
                self.stop()
            raise
        return self.code

    def _reap(self, timeout):
        """Has it ended within so many seconds?  With its exit code, and what it took."""
        last, pause = float("inf") if timeout is None else time.monotonic() + timeout, 1e-3
        while True:
            if self._asked and (self._rows() != self._before or time.monotonic() - self._begun > BEGINS):
                self._asked = False
                os.kill(self._process.pid, signal.SIGUSR1)
            pid, status, usage = os.wait4(self._process.pid, os.WNOHANG)
            if pid:
                self.code = self._process.returncode = os.waitstatus_to_exitcode(status)
                self.usage = usage
                return True
            if (left := last - time.monotonic()) <= 0:
                return False
            time.sleep(min(pause, left))
            pause = min(2 * pause, 0.05)

    def _close(self):
        texts = []
        for file in self._texts:
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
            file.close()
        self.output, self.errors = texts
        shutil.rmtree(self._session, ignore_errors=True)
        if self.code == 2 and self._given:
            self._given.unlink(missing_ok=True)
        _living.discard(self)

    @property
    def said(self):
        """All that the program said, once it has ended."""
        return self.output + self.errors

    def wait(self):
        """Waits for its end: the Run.  Raises Failed (Refused, GaveUp, Ended) with what the program said."""
        if self.end():
            self.fail()
        return Run(self.folder)

    def signal(self):
        """Asks it, once, to end after its step with a checkpoint: whoever waits for it then sends SIGUSR1, which mpiexec hands on."""
        if not self.stopped and self.code is None:
            self.stopped = self._asked = True

    def stop(self, patience=PATIENCE):
        """Ends it, if it still runs, after its step and with a checkpoint; kills it if that takes more than `patience` s.  Returns its exit
        code: 4 if it saved itself."""
        self.signal()
        try:
            if self.end(patience) is not None:
                return self.code
        except BaseException:  # Ctrl-C once more
            self._kill()
            raise
        return self._kill()

    def _kill(self):
        """At once: by SIGTERM, with which mpiexec ends its ranks, or else by SIGKILL."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            if self.end(0.0) is None:
                os.killpg(self._process.pid, number)
                self.end(5.0)
        return self.end()

    def sentence(self):
        """Why it did not come to its end, in the program's words."""
        ended, errors = ENDED.findall(self.said), LOG.sub("", self.errors).strip().splitlines()
        number = -self.code if self.code < 0 else self.code - 128  # mpiexec adds 128
        if number in signal.valid_signals():
            early = self.stopped and number == signal.SIGUSR1
            return f"{self.command[0]} was {'stopped before its first step' if early else f'killed by signal {number}'}"
        words = ended[-1:] if ended else errors or self.output.strip().splitlines()[-1:] or ["it said nothing"]
        return "\n".join(words)

    def fail(self):
        """Raises what its exit code stands for."""
        kind = {2: Refused, 3: GaveUp, 4: Ended}.get(self.code, Ended if self.stopped else Failed)
        raise kind(f"{self.sentence()} (exit code {self.code})", self.code, self.said, self.folder)


def call(*words, program=None):
    """What the program says at once, to options that need no case; Failed where it fails."""
    job = Job([find_program(program), *words])
    if job.end():
        job.fail()
    return job.output
