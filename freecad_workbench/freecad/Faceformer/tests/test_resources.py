# SPDX-License-Identifier: LGPL-2.1-or-later
import unittest
import xml.etree.ElementTree as ET

from .. import RESOURCES, __version__
from ..pipeline import ENGINES


class ResourcesTest(unittest.TestCase):
    def test_every_icon_is_plain_svg(self):
        icons = sorted((RESOURCES / "icons").glob("*.svg"))
        self.assertGreaterEqual(len(icons), 6)
        for path in icons:
            self.assertTrue(ET.parse(path).getroot().tag.endswith("svg"), path)

    def test_the_preference_page_lists_the_engines_in_order(self):
        tree = ET.parse(RESOURCES / "ui" / "preferences.ui")
        box = tree.find(".//widget[@name='engineBox']")
        names = [item.findtext("property/string") for item in box.findall("item")]
        self.assertEqual(tuple(names), ENGINES)

    def test_the_package_has_the_modules_version(self):
        package = RESOURCES.parents[2] / "package.xml"
        if not package.exists():
            self.skipTest("installed without package.xml")
        space = {"p": "https://wiki.freecad.org/Package_Metadata"}
        version = ET.parse(package).findtext("p:version", namespaces=space)
        self.assertEqual(version, __version__)
