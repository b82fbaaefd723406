#!/usr/bin/env bash
# Runs the tests: formatting, lints, then every test of the workspace.
#
#   ./test.sh         the fast ones
#   ./test.sh --all   the slow ones too: FreeCAD, C and C++ consumers, the whole corpus
#
# With the variable CI set, --all is taken as given. Missing tools are installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
# shellcheck source=scripts/lib.sh
. scripts/lib.sh

all=${CI:+yes}
for argument in "$@"; do
    case $argument in
        --all) all=yes ;;
        *) fail "unknown argument $argument; usage: ./test.sh [--all]" ;;
    esac
done

packages=("${BUILD_PACKAGES[@]}" fonts-dejavu-core python3 python3-venv)
[ -z "$all" ] || packages+=(freecad freecad-python3 xvfb xauth binutils)
need_packages "${packages[@]}"
need_cargo
cargo fmt --version >/dev/null 2>&1 && cargo clippy --version >/dev/null 2>&1 ||
    rustup component add rustfmt clippy

if command -v ruff >/dev/null; then
    ruff=ruff
else
    ruff=.venv/bin/ruff
    if [ ! -x "$ruff" ]; then
        step "Installing ruff into .venv"
        python3 -m venv .venv
        .venv/bin/pip install --quiet --disable-pip-version-check ruff
    fi
fi

step "Formatting and lints"
cargo fmt --all --check
"$ruff" check
"$ruff" format --check
cargo clippy --release --workspace --all-targets -- -D warnings

step "Building"
cargo build --release --workspace
FACEFORMER_LIBRARY="$(target_dir)/release/libfaceformer_capi.so"
export FACEFORMER_LIBRARY LANG=C.UTF-8 LC_ALL=C.UTF-8

step "Tests"
if [ -n "$all" ]; then
    exec cargo test --release --workspace -- --include-ignored
else
    exec cargo test --release --workspace
fi
