# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collects the workbench's texts into ``resources/translations/Faceformer.ts``.

    python3 tools/translations.py           writes the file
    python3 tools/translations.py --check   exits with 1 if the file is not up to date

Texts are the literal second arguments of ``translate`` and ``mark``, and the strings of the
preference page. Copy the file to ``Faceformer_LANGUAGE.ts``, translate it with Qt Linguist, and
release it to ``Faceformer_LANGUAGE.qm`` in the same folder.
"""

import ast
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path
from xml.sax.saxutils import escape

PACKAGE = Path(__file__).resolve().parents[1] / "freecad" / "Faceformer"
TARGET = PACKAGE / "resources" / "translations" / "Faceformer.ts"


def texts_of_module(path):
    """(context, text) of every call with literal arguments in a module."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if (
            isinstance(node, ast.Call)
            and getattr(node.func, "id", None) in ("translate", "mark")
            and len(node.args) == 2
            and all(isinstance(argument, ast.Constant) for argument in node.args)
        ):
            yield node.args[0].value, node.args[1].value


def texts_of_form(path):
    """(context, text) of every string of a form that is to be translated."""
    tree = ET.parse(path)
    for string in tree.iter("string"):
        if string.get("notr") != "true" and (string.text or "").strip():
            yield tree.findtext("class"), string.text


def collect():
    """All texts by context."""
    contexts = defaultdict(set)
    modules = [path for path in PACKAGE.rglob("*.py") if "tests" not in path.parts]
    for context, text in [pair for path in modules for pair in texts_of_module(path)]:
        contexts[context].add(text)
    for path in PACKAGE.rglob("*.ui"):
        for context, text in texts_of_form(path):
            contexts[context].add(text)
    return contexts


def render(contexts):
    """The file as text."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!DOCTYPE TS>", '<TS version="2.1">']
    for context in sorted(contexts):
        lines += ["  <context>", f"    <name>{escape(context)}</name>"]
        for text in sorted(contexts[context]):
            lines += [
                "    <message>",
                f"      <source>{escape(text)}</source>",
                '      <translation type="unfinished"></translation>',
                "    </message>",
            ]
        lines.append("  </context>")
    return "\n".join([*lines, "</TS>", ""])


def main():
    text = render(collect())
    if "--check" not in sys.argv[1:]:
        TARGET.write_text(text, encoding="utf-8")
        return 0
    if TARGET.exists() and TARGET.read_text(encoding="utf-8") == text:
        return 0
    print(f"{TARGET.name} is not up to date; run python3 tools/translations.py", file=sys.stderr)
    return 1


sys.exit(main())
