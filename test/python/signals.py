"""Signals during a call, in place of a user who presses Ctrl-C."""
import contextlib
import signal


@contextlib.contextmanager
def pressed_during_a_call(times=3):
    """Raises KeyboardInterrupt when the timer's signal has been handled for the third time. A call that does not let
    Python handle signals gets only one of the signals, at its end, and so the exception is not raised."""
    handled = 0

    def handler(_number, _frame):
        nonlocal handled
        handled += 1
        if handled >= times:
            signal.setitimer(signal.ITIMER_REAL, 0)
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
