# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scripts that run inside FreeCAD share: checks that are counted, and an exit code.

FreeCAD exits with 0 after an uncaught exception in a script, so each script hands its work to
`run`, which exits with 1 if a check failed or anything was raised.
"""

import os
import sys
import traceback
from pathlib import Path

OUTPUT = Path(os.environ.get("FACEFORMER_OUTPUT", "."))
"""Folder for files to look at."""

_failed = []


def check(good, what):
    """Counts a check and prints it."""
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        _failed.append(what)
    return good


def refuses(what, words, work, kind=None):
    """Checks that work raises the workbench's error with these words in its message."""
    from freecad.Faceformer.errors import FaceformerError

    kind = kind or FaceformerError
    try:
        work()
    except kind as error:
        text = " ".join(str(error).split())
        missing = [word for word in words if word not in text]
        check(not missing, f"{what}: {text!r}" + (f" lacks {missing}" if missing else ""))
    except Exception as error:  # any other kind of error is a failed check, not the end
        check(False, f"{what}: {type(error).__name__}: {error}")
    else:
        check(False, f"{what}: nothing was raised")


def run(main):
    """Runs a script's work and ends the process with its exit code."""
    try:
        main()
    except BaseException:  # nothing may end this process with 0 by accident
        traceback.print_exc()
        _failed.append("exception")
    finish()


def finish():
    """Prints the number of failures and ends the process, without FreeCAD's questions."""
    print(f"failed: {len(_failed)}", flush=True)
    sys.stderr.flush()
    os._exit(1 if _failed else 0)
