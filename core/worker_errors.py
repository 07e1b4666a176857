"""Why a child process gave no answer (satcheck.core.worker)."""

from __future__ import annotations

from satcheck.core.errors import SatcheckError


class WorkerError(SatcheckError):
    """A child process gave no answer."""

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), self.args  # args holds the constructor arguments of each subclass


class WorkerNotStarted(WorkerError):
    """The system refused to start a child process."""

    def __init__(self, module: str, reason: str) -> None:
        super().__init__(
            "worker-not-started", f"no process could be started for {module}: {reason}"
        )
        self.args = (module, reason)
        self.reason = reason


class WorkerStopped(WorkerError):
    """The worker was stopped, before the request or during it."""

    def __init__(self, module: str) -> None:
        super().__init__("worker-stopped", f"{module} was stopped by the process that uses it")
        self.args = (module,)


class WorkerTimeout(WorkerError):
    """The child was killed at its time limit."""

    def __init__(self, module: str, seconds: float) -> None:
        super().__init__("worker-timeout", f"{module} was stopped after {seconds:g} s")
        self.args = (module, seconds)
        self.seconds = seconds


class WorkerOutOfMemory(WorkerError):
    """The child needed more memory than its limit."""

    def __init__(self, module: str, megabytes: int) -> None:
        super().__init__("worker-out-of-memory", f"{module} needed more than {megabytes} MiB")
        self.args = (module, megabytes)
        self.megabytes = megabytes


class WorkerCrashed(WorkerError):
    """The child died without an answer.

    exit_code: as subprocess reports it (negative: minus the signal number).
    signal_name: "SIGSEGV" and the like, or None.
    stderr_tail: its last lines of output, possibly empty.
    """

    def __init__(self, module: str, exit_code: int, stderr_tail: str) -> None:
        signal_name = _signal_name(exit_code)
        how = signal_name or f"exit code {exit_code}"
        said = f": {stderr_tail.splitlines()[-1]}" if stderr_tail else ""
        super().__init__("worker-crashed", f"{module} died ({how}){said}")
        self.args = (module, exit_code, stderr_tail)
        self.exit_code = exit_code
        self.signal_name = signal_name
        self.stderr_tail = stderr_tail


class WorkerFailed(WorkerError):
    """serve() raised.

    exception_type: the qualified name of the exception's class; exception_message: str() of it.
    """

    def __init__(self, module: str, exception_type: str, exception_message: str) -> None:
        super().__init__("worker-failed", f"{module}: {exception_type}: {exception_message}")
        self.args = (module, exception_type, exception_message)
        self.exception_type = exception_type
        self.exception_message = exception_message


def _signal_name(exit_code: int) -> str | None:
    if exit_code >= 0:
        return None
    import signal

    try:
        return signal.Signals(-exit_code).name
    except ValueError:
        return f"signal {-exit_code}"
