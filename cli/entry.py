"""The process: whatever happens inside becomes one exit code and a line or so of error."""

from __future__ import annotations

import gc
import os
import sys

from satcheck.cli import exit_codes
from satcheck.cli.output import abandon, cannot_write, talk
from satcheck.cli.plain import plain_choices

COMPLETION_VARIABLE = "_SATCHECK_COMPLETE"


def main() -> None:
    code = _run()
    if code == exit_codes.INTERRUPTED:
        # Threads may still be at work: the interpreter would wait for them.
        os._exit(code)
    # All that is left goes with the process: the interpreter's last search for cycles finds nothing
    # worth a tenth of a small check.
    gc.freeze()
    sys.exit(code)


def _run() -> int:
    """Not click's standalone mode: a crash and Ctrl-C would both exit 1 there, "findings"."""
    debug = "--debug" in sys.argv[1:]
    stdout = sys.stdout
    try:
        result = _called(sys.argv[1:])
    except KeyboardInterrupt:
        return _interrupted()
    except SystemExit as stop:
        return _stopped(stop, reader_left=sys.stdout is not stdout)
    except MemoryError:
        return _failed("error: out of memory [out-of-memory]", debug)
    except Exception as error:  # noqa: BLE001  the last resort: no traceback, never exit 1
        code = _said_by_click(error, debug)
        return _failed(_told(error), debug) if code is None else code
    return result if isinstance(result, int) else exit_codes.CLEAN


def _called(arguments: list[str]) -> object:
    choices = None if COMPLETION_VARIABLE in os.environ else plain_choices(arguments)
    if choices is None:
        from satcheck.cli.command import satcheck

        try:
            return satcheck.main(prog_name="satcheck", standalone_mode=False)
        except OSError as error:
            if COMPLETION_VARIABLE not in os.environ:
                raise
            abandon(sys.stdout)
            raise cannot_write("standard output", error.strerror) from None
    from satcheck.cli.checking import run

    return run(choices)


def _interrupted() -> int:
    talk("satcheck: interrupted")
    return exit_codes.INTERRUPTED


def _said_by_click(error: Exception, debug: bool) -> int | None:
    """The exit code of one of its exceptions; None for others. What nobody imported nobody
    raised."""
    if "click" not in sys.modules:
        return None
    import click

    if isinstance(error, click.Abort):
        return _interrupted()
    if isinstance(error, click.UsageError):
        if error.ctx is None:
            from satcheck.cli.command import default_context

            error = click.UsageError(error.message, default_context())
        error.show()
        return exit_codes.ERROR
    if isinstance(error, click.ClickException):
        return _failed(f"error: {error.format_message()}", debug)
    return None


def _stopped(stop: SystemExit, *, reader_left: bool) -> int:
    """click ends the process itself after a completion, and when the reader of a pipe has left.

    For the latter it wraps sys.stdout; no document was under way (see Document), only help.
    """
    if COMPLETION_VARIABLE in os.environ:
        return stop.code if isinstance(stop.code, int) else exit_codes.ERROR
    if reader_left:
        return exit_codes.CLEAN
    return _failed(f"internal error: ended early ({stop.code!r}) [internal-error]", debug=False)


def _told(error: Exception) -> str:
    """A line for each thing that is wrong.

    What nobody imported nobody raised: the core stays out of `--help`.
    """
    errors = sys.modules.get("satcheck.core.errors")
    if errors is not None and isinstance(error, errors.SatcheckError):
        return "\nsatcheck: ".join(f"error: {e} [{e.code}]" for e in (error, *error.others))
    first, *_ = [*str(error).strip().splitlines(), "no message"]
    name = type(error).__name__
    return f"internal error: {name}: {first} [internal-error] (--debug shows where)"


def _failed(line: str, debug: bool) -> int:
    if debug:
        import traceback

        talk(traceback.format_exc().rstrip())
    talk(f"satcheck: {line}")
    return exit_codes.ERROR
