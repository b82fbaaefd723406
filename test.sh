#!/usr/bin/env bash
# Runs the tests: formatting, lints, then every test of the workspace.
#
#   ./test.sh         the fast ones
#   ./test.sh --all   the slow ones too: FreeCAD, C and C++ consumers, the whole corpus, solids projected
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

# The versions that the code is kept clean with. Newer ones may warn of more: a newer clippy is shown
# and does not fail, and ruff is installed in this version.
clippy_version=1.95
ruff_version=0.17.6

if [ "$(ruff --version 2>/dev/null || true)" = "ruff $ruff_version" ]; then
    ruff=ruff
else
    ruff=.venv/bin/ruff
    if [ "$("$ruff" --version 2>/dev/null || true)" != "ruff $ruff_version" ]; then
        step "Installing ruff $ruff_version into .venv"
        python3 -m venv .venv
        .venv/bin/pip install --quiet --disable-pip-version-check "ruff==$ruff_version"
    fi
fi

step "Formatting and lints"
cargo fmt --all --check
"$ruff" check
"$ruff" format --check
if at_least "$clippy_version.99" "$(cargo clippy --version | sed 's/^clippy 0\.1\./1./; s/ .*//')"; then
    deny=(-- -D warnings)
else
    deny=()
fi
cargo clippy --release --workspace --all-targets "${deny[@]}"

step "Building"
cargo build --release -p faceformer-cli -p faceformer-capi
FACEFORMER_LIBRARY="$(target_dir)/release/libfaceformer_capi.so"
export FACEFORMER_LIBRARY LANG=C.UTF-8 LC_ALL=C.UTF-8

step "Tests of the training package"
need_training
training/.venv/bin/python -m pytest --quiet ${all:+-m ""} training

step "Tests"
if [ -n "$all" ]; then
    exec cargo test --release --workspace -- --include-ignored
else
    exec cargo test --release --workspace
fi
