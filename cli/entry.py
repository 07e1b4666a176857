"""The process: every outcome becomes an exit code, and every failure a short message."""

from __future__ import annotations

import gc
import io
import os
import sys

import click

from satcheck.cli import exit_codes
from satcheck.cli.click_classes import satcheck
from satcheck.cli.interrupts import end, hear_interrupts
from satcheck.cli.output import abandon, cannot_write, harmless, talk
from satcheck.core.errors import SatcheckError

COMPLETION_VARIABLE = "_SATCHECK_COMPLETE"


def main() -> None:
    hear_interrupts()
    code = _run()
    if code == exit_codes.INTERRUPTED:
        end(code)
    # All that is left goes with the process: the interpreter's last search for cycles finds nothing
    # worth a tenth of a small check.
    gc.freeze()
    sys.exit(code)


def _run() -> int:
    """Not click's standalone mode: a crash and Ctrl-C would both exit 1 there, "findings"."""
    debug = "--debug" in sys.argv[1:]
    if debug:
        _talk_of_faults()
    stdout = sys.stdout
    try:
        result = _call()
    except (KeyboardInterrupt, click.Abort) as stop:
        if isinstance(stop.__cause__, EOFError):  # click takes it for an interrupt
            return _failed(_internal(stop.__cause__), debug)
        talk("satcheck: interrupted")
        return exit_codes.INTERRUPTED
    except SystemExit as stop:
        return _stopped(stop, reader_left=sys.stdout is not stdout)
    except MemoryError:
        return _failed("error: out of memory [out-of-memory]", debug)
    except click.UsageError as error:
        return _misused(error)
    except click.ClickException as error:
        return _failed(f"error: {error.format_message()}", debug)
    except SatcheckError as error:
        lines = (harmless(f"error: {each} [{each.code}]") for each in (error, *error.others))
        return _failed("\nsatcheck: ".join(lines), debug)
    except Exception as error:  # noqa: BLE001  the last resort: no traceback, never exit 1
        return _failed(_internal(error), debug)
    return result if isinstance(result, int) else exit_codes.CLEAN


def _misused(error: click.UsageError) -> int:
    """Say what is wrong, with a command to type instead if there is one."""
    advice = None
    if isinstance(error, click.NoSuchOption):
        from satcheck.cli.slips import about_option

        if advice := about_option(error):
            error = click.NoSuchOption(error.option_name, ctx=error.ctx)  # not what click has near
    shown = io.StringIO()
    error.show(shown)
    talk(f"{shown.getvalue()}{advice or ''}".removesuffix("\n"))
    return exit_codes.ERROR


def _call() -> object:
    try:
        return satcheck.main(prog_name="satcheck", standalone_mode=False)
    except OSError as error:
        if COMPLETION_VARIABLE not in os.environ:
            raise
        abandon(sys.stdout)
        raise cannot_write("standard output", error.strerror) from None


def _stopped(stop: SystemExit, *, reader_left: bool) -> int:
    """click ends the process itself after a completion, and when the reader of a pipe has left.

    For the latter it wraps sys.stdout; no document was under way (see Document), only help.
    """
    if COMPLETION_VARIABLE in os.environ:
        return stop.code if isinstance(stop.code, int) else exit_codes.ERROR
    if reader_left:
        return exit_codes.CLEAN
    return _failed(f"internal error: ended early ({stop.code!r}) [internal-error]", debug=False)


def _internal(error: Exception) -> str:
    first, *_ = [*str(error).strip().splitlines(), "no message"]
    name = type(error).__name__
    return f"internal error: {name}: {first} [internal-error] (--debug shows where)"


def _talk_of_faults() -> None:
    """Show the tracebacks of faults that a run survives."""
    import logging

    handler = logging.StreamHandler()
    handler.emit = lambda record: talk(handler.format(record))  # type: ignore[method-assign]
    log = logging.getLogger("satcheck")
    log.setLevel(logging.DEBUG)
    log.addHandler(handler)


def _failed(line: str, debug: bool) -> int:
    if debug:
        import traceback

        talk(traceback.format_exc().rstrip())
    talk(f"satcheck: {line}")
    return exit_codes.ERROR
