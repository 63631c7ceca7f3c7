# Sets up what the application or its tests need, once per change of pyproject.toml. Sourced by
# ./run and ./check, from the project's root. Needs nothing but Debian or Ubuntu and the ordinary
# package registries; asks sudo for a password when system packages are missing.
#
#   set_up app     the application and training
#   set_up tests   the same and the development tools

say() { printf 'gestureapp setup: %s\n' "$*" >&2; }

# A library that must be there -> the Debian/Ubuntu package that brings it. Qt itself comes from the
# Python package; it opens these at run time.
QT_LIBRARIES="
libEGL.so.1=libegl1 libGL.so.1=libgl1 libxkbcommon.so.0=libxkbcommon0
libfontconfig.so.1=libfontconfig1 libdbus-1.so.3=libdbus-1-3 libglib-2.0.so.0=libglib2.0-0"
# Needed on top by a real or virtual X screen. Qt's own error text blames libxcb-cursor0 also when
# icccm or keysyms is what is missing.
SCREEN_LIBRARIES="
libxkbcommon-x11.so.0=libxkbcommon-x11-0 libxcb-cursor.so.0=libxcb-cursor0
libxcb-icccm.so.4=libxcb-icccm4 libxcb-keysyms.so.1=libxcb-keysyms1
libxcb-image.so.0=libxcb-image0 libxcb-randr.so.0=libxcb-randr0
libxcb-render-util.so.0=libxcb-render-util0 libxcb-shape.so.0=libxcb-shape0
libxcb-xkb.so.1=libxcb-xkb1 libxcb-sync.so.1=libxcb-sync1 libxcb-xfixes.so.0=libxcb-xfixes0
libX11-xcb.so.1=libx11-xcb1"

missing_packages() {
    local pair known
    known=$(/sbin/ldconfig -p)
    for pair in $QT_LIBRARIES $SCREEN_LIBRARIES; do
        case "$known" in *"${pair%%=*} "*) ;; *) printf '%s ' "${pair#*=}" ;; esac
    done
    # A person has to read the window: at least one font.
    find /usr/share/fonts -name '*.ttf' -print -quit 2>/dev/null | grep -q . ||
        printf 'fonts-dejavu-core '
}

install_packages() {
    [ $# -gt 0 ] || return 0
    say "installs system packages: $*"
    local as_root=""
    [ "$(id -u)" -eq 0 ] || as_root="sudo"
    $as_root apt-get update -qq &&
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2 ||
        { say "could not install them; run: apt-get install $*"; return 1; }
}

find_python() {
    local name
    for name in python3 python3.14 python3.13 python3.12 python3.11; do
        if "$name" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 15))' \
            2>/dev/null; then
            printf '%s' "$name"
            return
        fi
    done
    return 1
}

make_environment() {
    local python
    [ -x .venv/bin/python ] && return 0
    if ! python=$(find_python); then
        install_packages python3.11 python3.11-venv || return 1
        python=python3.11
    fi
    if ! "$python" -c 'import ensurepip' 2>/dev/null; then
        install_packages "$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')" ||
            return 1
    fi
    say "makes .venv with $("$python" --version)"
    "$python" -m venv .venv
}

# The CPU build where the registry set up for pip has it; it is a tenth of the general one.
install_torch() {
    .venv/bin/python -c 'import torch' 2>/dev/null && return 0
    say "installs torch for training"
    .venv/bin/pip install -q "torch==2.13.0+cpu" 2>/dev/null && return 0
    say "no CPU build of torch is offered; installs the general one, which is several gigabytes"
    .venv/bin/pip install -q "torch==2.13.0"
}

set_up() {
    local extra="" stamp wanted missing
    [ "$1" = tests ] && extra="[dev]"
    stamp=".venv/set-up-for-$1"
    wanted=$(cat pyproject.toml packaging/setup.sh | cksum)
    [ -x .venv/bin/gestureapp ] && [ "$(cat "$stamp" 2>/dev/null)" = "$wanted" ] && return 0
    missing=""
    if command -v apt-get >/dev/null; then
        missing=$(missing_packages)
    fi
    # shellcheck disable=SC2086  a list of words is meant
    install_packages $missing && make_environment || return 1
    say "installs the Python packages"
    .venv/bin/pip install -q --disable-pip-version-check -e ".$extra" || return 1
    install_torch || return 1
    printf '%s' "$wanted" >"$stamp"
    say "done"
}
