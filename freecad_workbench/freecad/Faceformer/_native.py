# SPDX-License-Identifier: LGPL-2.1-or-later
"""The C ABI of the native library through ctypes. No other module uses ctypes.

The library is loaded at the first call, once a process. ctypes releases the interpreter lock
during every call, so the long ones may run in a Python thread. Nothing here touches FreeCAD.
"""

from __future__ import annotations

import ctypes
import json
import os
import platform
import threading
import weakref
from collections.abc import Callable
from ctypes import (
    CFUNCTYPE,
    POINTER,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_size_t,
    c_uint32,
    c_void_p,
)
from pathlib import Path
from typing import Any

from .errors import (
    BadInput,
    Cancelled,
    FaceformerError,
    Failed,
    InternalError,
    LibraryMissing,
)

ABI_VERSION = 1
"""Version of the C ABI that the declarations below follow."""

ENVIRONMENT = "FACEFORMER_LIBRARY"
"""Environment variable with the library's path, or the path of the folder that holds it."""

NATIVE = Path(__file__).resolve().parent / "native"
"""Folder of the libraries that come with the workbench, one folder a platform."""

Progress = Callable[[str, float], bool]
"""Hears the name of the stage and the share done, 0 to 1; returns False to cancel."""

_FILE_NAMES = {"windows": "faceformer_capi.dll", "darwin": "libfaceformer_capi.dylib"}
_MACHINES = {"amd64": "x86_64", "x64": "x86_64", "arm64": "aarch64"}
_ERRORS = {1: Failed, 2: BadInput, 3: Cancelled, 4: InternalError}
_CALLBACK = CFUNCTYPE(c_int32, c_char_p, c_double, c_void_p)

_HANDLE_OUT = POINTER(c_void_p)
_TEXT_OUT = POINTER(c_void_p)
_SIGNATURES = {
    "faceformer_info": [_TEXT_OUT],
    "faceformer_drawing_read": [c_char_p, c_size_t, _HANDLE_OUT],
    "faceformer_drawing_report": [c_void_p, _TEXT_OUT],
    "faceformer_identify": [c_void_p, c_char_p, c_size_t, _CALLBACK, c_void_p, _HANDLE_OUT],
    "faceformer_faces_read": [c_void_p, c_char_p, c_size_t, _HANDLE_OUT],
    "faceformer_faces_json": [c_void_p, _TEXT_OUT],
    "faceformer_lift": [
        c_void_p,
        c_void_p,
        c_char_p,
        c_size_t,
        _CALLBACK,
        c_void_p,
        _TEXT_OUT,
    ],
    "faceformer_solid": [
        c_void_p,
        c_void_p,
        c_char_p,
        c_size_t,
        _CALLBACK,
        c_void_p,
        _HANDLE_OUT,
    ],
    "faceformer_solid_report": [c_void_p, _TEXT_OUT],
    "faceformer_solid_brep": [c_void_p, POINTER(c_void_p), POINTER(c_size_t)],
    "faceformer_solid_write": [c_void_p, c_char_p, c_char_p],
}
_FREES = ("drawing", "faces", "solid", "string")


def platform_folder() -> str:
    """Name of the folder under ``native`` for this machine, for instance ``linux-x86_64``."""
    machine = platform.machine().lower()
    return f"{platform.system().lower()}-{_MACHINES.get(machine, machine)}"


def candidates() -> list[Path]:
    """The files that are tried, in order."""
    name = _FILE_NAMES.get(platform.system().lower(), "libfaceformer_capi.so")
    found = []
    chosen = os.environ.get(ENVIRONMENT)
    if chosen:
        path = Path(chosen).expanduser()
        found.append(path / name if path.is_dir() else path)
    found.append(NATIVE / platform_folder() / name)
    return found


class _Handle:
    """An opaque pointer of the library, freed when the last Python reference goes."""

    def __init__(self, library: Library, pointer: c_void_p, free: Callable[[int], None]):
        self.library = library
        self.pointer = pointer.value
        self._finalizer = weakref.finalize(self, free, pointer.value)


class Drawing(_Handle):
    """A drawing that was read, cleaned and checked."""

    def report(self) -> dict[str, Any]:
        """The drawing with its curves, the input edges of each edge, and what was found."""
        return json.loads(self.library.text("faceformer_drawing_report", self.pointer))

    def identify(self, options: dict[str, Any], progress: Progress | None = None) -> Faces:
        """Finds the faces with the engine that ``options`` names. Long; may run in a thread."""
        data = json.dumps(options).encode()
        call = _Callback(progress)
        pointer = self.library.handle(
            "faceformer_identify", call, self.pointer, data, len(data), call.function, None
        )
        return Faces(self.library, pointer, self.library.free("faces"))

    def read_faces(self, identification: dict[str, Any]) -> Faces:
        """Takes faces that came from elsewhere, for instance a choice among those found."""
        data = json.dumps(identification).encode()
        pointer = self.library.handle("faceformer_faces_read", None, self.pointer, data, len(data))
        return Faces(self.library, pointer, self.library.free("faces"))

    def lift(self, faces: Faces, progress: Progress | None = None) -> dict[str, Any]:
        """Depths, surfaces, and which of the faces conflict. May run in a thread."""
        call = _Callback(progress)
        return json.loads(
            self.library.text(
                "faceformer_lift",
                self.pointer,
                faces.pointer,
                None,
                0,
                call.function,
                None,
                callback=call,
            )
        )

    def solid(self, faces: Faces, options: dict[str, Any], progress: Progress | None = None):
        """Builds the solid that has these faces. Long; may run in a thread."""
        data = json.dumps(options).encode()
        call = _Callback(progress)
        pointer = self.library.handle(
            "faceformer_solid",
            call,
            self.pointer,
            faces.pointer,
            data,
            len(data),
            call.function,
            None,
        )
        return Solid(self.library, pointer, self.library.free("solid"))


class Faces(_Handle):
    """Faces of a drawing."""

    def identification(self) -> dict[str, Any]:
        """The faces, the alternatives and the notices."""
        return json.loads(self.library.text("faceformer_faces_json", self.pointer))


class Solid(_Handle):
    """A checked solid."""

    def report(self) -> dict[str, Any]:
        """Measures of the solid, with the lift and the plan behind it."""
        return json.loads(self.library.text("faceformer_solid_report", self.pointer))

    def brep(self) -> bytes:
        """The solid as BREP text that every FreeCAD reads."""
        return self.library.bytes("faceformer_solid_brep", self.pointer)

    def write(self, path: str, form: str) -> None:
        """Writes the solid to a file; ``form`` is ``step``, ``brep`` or ``stl``."""
        self.library.call(
            "faceformer_solid_write", None, self.pointer, path.encode(), form.encode()
        )


class _Callback:
    """A progress callback for C that keeps an exception of the Python one until the call ends."""

    def __init__(self, progress: Progress | None):
        self.error: BaseException | None = None
        self._progress = progress
        self.function = _CALLBACK(self._report) if progress else _CALLBACK()

    def _report(self, stage: bytes | None, share: float, _user: int | None) -> int:
        try:
            return int(bool(self._progress((stage or b"").decode("utf-8", "replace"), share)))
        except BaseException as error:  # noqa: B036 - it must not unwind through C
            self.error = error
            return 0


class Library:
    """The loaded library with its functions declared."""

    def __init__(self, path: Path):
        self.path = path
        self._dll = ctypes.CDLL(str(path))
        self._dll.faceformer_abi_version.restype = c_uint32
        self._dll.faceformer_abi_version.argtypes = []
        version = self._dll.faceformer_abi_version()
        if version != ABI_VERSION:
            raise OSError(f"has ABI version {version}, and this workbench needs {ABI_VERSION}")
        for name, arguments in _SIGNATURES.items():
            function = getattr(self._dll, name)
            function.restype = c_int
            function.argtypes = [*arguments, _TEXT_OUT]
        for name in _FREES:
            self.free(name).restype = None
            self.free(name).argtypes = [c_void_p]
        self._dll.faceformer_bytes_free.restype = None
        self._dll.faceformer_bytes_free.argtypes = [c_void_p, c_size_t]

    def free(self, kind: str):
        """The function that frees a handle or a string of the library."""
        return getattr(self._dll, f"faceformer_{kind}_free")

    def call(self, name: str, callback: _Callback | None, *arguments) -> None:
        """Calls a function and raises the exception that its status stands for."""
        message = c_void_p()
        status = getattr(self._dll, name)(*arguments, byref(message))
        text = self._take(message)
        if callback is not None and callback.error is not None:
            raise callback.error
        if status != 0:
            raise _ERRORS.get(status, Failed)(text or f"{name} failed with status {status}")

    def handle(self, name: str, callback: _Callback | None, *arguments) -> c_void_p:
        """Calls a function whose last own argument receives a handle.

        A handle that comes with an error, the part of a solid that could be built, stays on the
        exception as ``partial``.
        """
        pointer = c_void_p()
        try:
            self.call(name, callback, *arguments, byref(pointer))
        except FaceformerError as error:
            if pointer.value:
                error.partial = Solid(self, pointer, self.free("solid"))
            raise
        return pointer

    def text(self, name: str, *arguments, callback: _Callback | None = None) -> str:
        """Calls a function whose last own argument receives a string."""
        return self._take(self.handle(name, callback, *arguments)) or ""

    def bytes(self, name: str, *arguments) -> bytes:
        """Calls a function whose last own arguments receive a buffer and its length."""
        pointer, length = c_void_p(), c_size_t()
        self.call(name, None, *arguments, byref(pointer), byref(length))
        try:
            return ctypes.string_at(pointer.value, length.value) if pointer.value else b""
        finally:
            self._dll.faceformer_bytes_free(pointer, length)

    def _take(self, pointer: c_void_p) -> str | None:
        if not pointer.value:
            return None
        try:
            return ctypes.string_at(pointer.value).decode("utf-8", "replace")
        finally:
            self.free("string")(pointer)


_loaded: Library | None = None
_lock = threading.Lock()


def library() -> Library:
    """The library, loaded at the first call.

    Raises `LibraryMissing` with every file that was tried and why it was not taken.
    """
    global _loaded
    with _lock:
        if _loaded is None:
            _loaded = load()
        return _loaded


def load() -> Library:
    """Loads the first library that fits. Use `library`, which does so once."""
    tried = []
    for path in candidates():
        if not path.is_file():
            tried.append(f"{path}: there is no such file")
            continue
        try:
            return Library(path)
        except (OSError, AttributeError) as error:
            tried.append(f"{path}: {error}")
    lines = "\n".join(f"  {line}" for line in tried)
    raise LibraryMissing(
        "The Faceformer library was not found. Put it into the last of these places, or set "
        f"{ENVIRONMENT} to its path. Tried:\n{lines}"
    )


def info() -> dict[str, Any]:
    """Version of the library, version of its OpenCASCADE, and its engines."""
    return json.loads(library().text("faceformer_info"))


def read_drawing(text: str) -> Drawing:
    """Reads a drawing from JSON and cleans it."""
    loaded = library()
    data = text.encode()
    pointer = loaded.handle("faceformer_drawing_read", None, data, len(data))
    return Drawing(loaded, pointer, loaded.free("drawing"))
