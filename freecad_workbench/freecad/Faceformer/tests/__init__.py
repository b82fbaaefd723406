# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tests of the workbench that FreeCAD itself runs: ``freecadcmd -t freecad.Faceformer.tests``.

They need no native library. The whole way, library included, is tested from outside.
"""

from .test_extract import ExtractTest, NormaliseTest
from .test_feature import FeatureTest
from .test_model import ModelTest
from .test_native import NativeTest
from .test_picking import PickingTest
from .test_pipeline import PipelineTest
from .test_plane import PlaneTest
from .test_pose import PoseTest
from .test_resources import ResourcesTest
from .test_tessellate import TessellateTest
from .test_wireframe import SketchWriterTest, WireframeTest

__all__ = [
    "ExtractTest",
    "FeatureTest",
    "ModelTest",
    "NativeTest",
    "NormaliseTest",
    "PickingTest",
    "PipelineTest",
    "PlaneTest",
    "PoseTest",
    "ResourcesTest",
    "SketchWriterTest",
    "TessellateTest",
    "WireframeTest",
]
