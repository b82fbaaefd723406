# Shared by setup.sh and test.sh; sourced, never run. Needs bash with `set -euo pipefail`.

# A line that says what happens next.
step() { printf '\n==> %s\n' "$*"; }

# Ends the script with a message.
fail() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

# Installs the Debian or Ubuntu packages among "$@" that are not there yet.
need_packages() {
    command -v dpkg-query >/dev/null ||
        fail "this is not Debian or Ubuntu: install what matches these packages yourself: $*"
    local package missing=()
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] ||
            missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null ||
            fail "run this as root: apt-get install --no-install-recommends ${missing[*]}"
        as_root=(sudo)
    fi
    step "Installing ${missing[*]}"
    export DEBIAN_FRONTEND=noninteractive
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# Whether dotted version $1 is at least $2.
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# Makes sure of a cargo that is new enough for this workspace.
need_cargo() {
    local wanted found=none
    wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
    # rustup writes this file; a shell that was open before does not have it yet.
    local env="${CARGO_HOME:-$HOME/.cargo}/env"
    # shellcheck disable=SC1090
    if [ -f "$env" ]; then . "$env"; fi
    if command -v cargo >/dev/null; then
        found=$(cargo --version | cut -d' ' -f2)
        at_least "$found" "$wanted" && return 0
    fi
    step "Installing Rust with rustup (found: $found, needed: $wanted)"
    local installer
    installer=$(mktemp)
    curl --proto '=https' --tlsv1.2 -sSf https://static.rust-lang.org/rustup/rustup-init.sh -o "$installer" ||
        fail "rustup cannot be downloaded. Install Rust $wanted or newer, then run this again."
    sh "$installer" -y --profile minimal --component rustfmt,clippy --no-modify-path
    rm -f "$installer"
    # shellcheck disable=SC1090
    . "$env"
    at_least "$(cargo --version | cut -d' ' -f2)" "$wanted" ||
        fail "cargo is still older than $wanted: run rustup update stable, then this again."
}

# Installs the Python package in training/ with all it needs into training/.venv, anew when it asks
# for other packages than it did.
need_training() {
    local stamp=training/.venv/installed.toml
    cmp -s training/pyproject.toml "$stamp" && return 0
    step "Installing the training package into training/.venv"
    python3 -m venv training/.venv
    training/.venv/bin/pip install --quiet --disable-pip-version-check -e 'training[dev,plot]'
    cp training/pyproject.toml "$stamp"
}

# What compiles Rust, the C++ bridge, and OpenCASCADE's own headers.
BUILD_PACKAGES=(
    ca-certificates curl g++ make cmake
    libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
    libocct-data-exchange-dev
)

# Folder that cargo builds into.
target_dir() {
    cargo metadata --format-version 1 --no-deps |
        sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p'
}
