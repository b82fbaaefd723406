# SPDX-License-Identifier: LGPL-2.1-or-later
"""One undo step around a command, and a document as it was if the command fails."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import FreeCAD


@contextmanager
def transaction(document: FreeCAD.Document, name: str) -> Iterator[None]:
    """Commits what happens inside as one undo step; takes it back if it raises.

    A document without undo, as `freecadcmd` makes them, has no transactions to abort: objects
    that were added are removed one by one.
    """
    before = {obj.Name for obj in document.Objects}
    document.openTransaction(name)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        for added in [obj.Name for obj in document.Objects if obj.Name not in before]:
            document.removeObject(added)
        raise
    document.commitTransaction()
