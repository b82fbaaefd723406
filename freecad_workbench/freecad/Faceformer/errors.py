# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exceptions of the workbench. Each message is written for the user and says what to do."""


class FaceformerError(Exception):
    """Base of every error that the workbench raises on purpose."""

    partial = None
    """What could be built of a solid before the error, for inspection: it has ``brep()``."""


class LibraryMissing(FaceformerError):
    """The native library was not found, or is not the one that this workbench needs."""


class BadInput(FaceformerError):
    """The drawing or an option cannot be used as given."""


class Failed(FaceformerError):
    """The input was understood, and the work still could not be done."""


class Cancelled(FaceformerError):
    """The user stopped the work."""


class InternalError(FaceformerError):
    """The native library caught a fault of its own."""
