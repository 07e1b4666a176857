"""For all tests: Ctrl-C means Ctrl-C.

A background job of a shell ignores SIGINT, and every child would inherit that; some tests send it.
"""

from __future__ import annotations

import signal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
