#!/usr/bin/env bash
# Sets up a fresh Debian or Ubuntu machine: installs what is missing, builds everything, and turns a
# sample drawing into a solid (out/sample.step) and a picture (out/sample.png).
# It can be run again at any time and then does only what is left to do.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
# shellcheck source=scripts/lib.sh
. scripts/lib.sh

need_packages "${BUILD_PACKAGES[@]}" fonts-dejavu-core
need_cargo

step "Building (release)"
cargo build --release -p faceformer-cli -p faceformer-capi
target=$(target_dir)

# The workbench looks for the library here, see its _native.py.
native="freecad_workbench/freecad/Faceformer/native/linux-$(uname -m | sed 's/^arm64$/aarch64/')"
mkdir -p "$native"
cp "$target/release/libfaceformer_capi.so" "$native/"

step "Turning a sample drawing into a solid and a picture"
sample='tests/corpus/sample.jsonl.zst#fclib/00199#o0'
mkdir -p out
"$target/release/faceformer" solid "$sample" -o out/sample.step
"$target/release/faceformer" render "$sample" --solid --title 'The opener of a drink can' -o out/sample.png

cat <<END

Made:
  out/sample.step   the solid; open it in FreeCAD or any CAD program
  out/sample.png    the drawing with its faces, and the solid
  $native/
                    the library for the FreeCAD workbench in freecad_workbench/
Next:
  $target/release/faceformer --help
  ./test.sh
END
