# SPDX-License-Identifier: LGPL-2.1-or-later
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from .. import _native
from ..errors import LibraryMissing


class NativeTest(unittest.TestCase):
    def load_with(self, value):
        with mock.patch.dict(os.environ, {_native.ENVIRONMENT: value}):
            native = Path(_native.__file__).parent / "native"
            with mock.patch.object(_native, "NATIVE", native / "nowhere"):
                return _native.load()

    def test_a_missing_library_lists_every_place_that_was_tried(self):
        with self.assertRaises(LibraryMissing) as caught:
            self.load_with("/no/such/library.so")
        text = str(caught.exception)
        self.assertIn("/no/such/library.so: there is no such file", text)
        self.assertIn(_native.platform_folder(), text)
        self.assertIn(_native.ENVIRONMENT, text)

    def test_a_file_that_is_no_library_is_named_with_the_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "broken.so"
            path.write_text("not a library")
            with self.assertRaisesRegex(LibraryMissing, "broken.so: "):
                self.load_with(str(path))

    def test_a_folder_stands_for_the_library_in_it(self):
        with (
            tempfile.TemporaryDirectory() as folder,
            mock.patch.dict(os.environ, {_native.ENVIRONMENT: folder}),
        ):
            self.assertEqual(_native.candidates()[0].parent, Path(folder))

    def test_the_folder_name_is_the_same_for_all_names_of_a_machine(self):
        with (
            mock.patch("platform.system", return_value="Windows"),
            mock.patch("platform.machine", return_value="AMD64"),
        ):
            self.assertEqual(_native.platform_folder(), "windows-x86_64")
            self.assertEqual(_native.candidates()[-1].name, "faceformer_capi.dll")
