# shellcheck shell=bash
# The Debian packages of the project, and what it takes to install the missing ones. For bash scripts to source;
# they say $0's name and run under `set -euo pipefail`.
#
# A package written as name:command is also there when the command is, wherever it came from.

# To build the program. The headers of libegl-dev bring those of OpenGL.
# shellcheck disable=SC2034
BUILD_PACKAGES=(
    g++ cmake:cmake ninja-build:ninja pkgconf:pkg-config
    libboost1.81-dev nlohmann-json3-dev libexpected-dev libcli11-dev libspdlog-dev libglm-dev
    libegl-dev libopengl-dev libturbojpeg0-dev libpng-dev libwebp-dev libtiff-dev libstb-dev zlib1g-dev libssl-dev libqrencode-dev libnats-dev
    libassimp-dev libmeshoptimizer-dev libdraco-dev esbuild:esbuild
)
# To build it with films (.mp4), which it leaves out without them. They bring the libraries that it loads for one.
# shellcheck disable=SC2034
FILM_PACKAGES=(libavformat-dev libavcodec-dev libswscale-dev)
# To run: EGL, and Mesa's drivers, with one that draws in software where there is no GPU; and the libraries that the
# program is linked with.
# shellcheck disable=SC2034
RUN_PACKAGES=(
    libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri
    libassimp5 libmeshoptimizer2d libdraco7 libspdlog1.10 libfmt9 libturbojpeg0 libpng16-16 libwebp7 libtiff6 zlib1g libssl3 libqrencode4 libnats3.4
)
# To start several servers and edges on one machine (several.sh).
# shellcheck disable=SC2034
SEVERAL_PACKAGES=(nats-server:nats-server haproxy:haproxy curl:curl)
# To make the Debian packages (cpack).
# shellcheck disable=SC2034
PACKAGING_PACKAGES=(dpkg-dev:dpkg-shlibdeps file:file)
# To test: doctest, a browser and what steers it, and what checks the source's format, the shaders and the manual pages.
# shellcheck disable=SC2034
TEST_PACKAGES=(
    doctest-dev libosd-dev nodejs:node npm:npm chromium:chromium clang-format-14:clang-format-14 glslang-tools:glslangValidator
    groff-base:groff
)
# To test all: another browser, what the charts, the examples and deploy/ work with, what checks the source and its
# comments, and clang with the sanitizers' runtime and libFuzzer.
# shellcheck disable=SC2034
ALL_TEST_PACKAGES=(
    firefox-esr:firefox-esr gnuplot-nox:gnuplot python3-websockets curl:curl haproxy:haproxy nats-server:nats-server openssl:openssl
    bubblewrap:bwrap mmdebstrap:mmdebstrap doxygen:doxygen lintian:lintian
    clang-14:clang++-14 libclang-rt-14-dev clang-tidy-14:clang-tidy-14
)

say() { printf '%s\n' "$*" >&2; }

die() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# Stops unless a folder's disk has so many megabytes free.
require_space() { # FOLDER MEGABYTES PURPOSE
    local free
    free=$(df -Pk "$1" | awk 'NR == 2 { print int($4 / 1024) }')
    [ "$free" -ge "$2" ] || die "$3 needs about $2 MB, but the disk of $1 has $free MB free: make room and start again."
}

# How many compilers at once: one a core, but no more than the memory holds (the largest take 1.7 gigabytes).
parallel_jobs() {
    local cores room
    cores=$(nproc)
    room=$(awk '/^MemAvailable:/ { print int($2 / 1700000) }' /proc/meminfo 2>/dev/null || true)
    if [ -n "$room" ] && [ "$room" -lt "$cores" ]; then cores=$((room > 0 ? room : 1)); fi
    echo "$cores"
}

# Prints those of the given packages that are not there.
missing_packages() {
    local entry asked=() installed
    for entry in "$@"; do
        if [[ $entry == *:* ]] && command -v "${entry#*:}" >/dev/null; then continue; fi
        asked+=("${entry%%:*}")
    done
    [ ${#asked[@]} -gt 0 ] || return 0
    installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${asked[@]}" 2>/dev/null || true)
    for entry in "${asked[@]}"; do
        grep -qxF "installed $entry" <<<"$installed" || printf '%s\n' "$entry"
    done
}

# Installs those of the given packages that are not there, and nothing else. Does nothing when all are.
install_packages() {
    local missing unknown entry reached=true install=(apt-get install -y --no-install-recommends) as_root=()
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -gt 0 ] || return 0

    command -v apt-get >/dev/null ||
        die "this script installs with apt-get on Debian 12, which is not here: install what ${missing[*]} are called on this system, and start again."
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null ||
            die "packages are missing and there is no sudo: run '${install[*]} ${missing[*]}' as root, and start again."
        as_root=(sudo)
    fi
    require_space /usr $((100 + 60 * ${#missing[@]})) "Installing the ${#missing[@]} missing packages"

    say "Installing ${#missing[@]} missing packages with apt-get: ${missing[*]}"
    as_root+=(env DEBIAN_FRONTEND=noninteractive)
    install+=(-o DPkg::Lock::Timeout=300)
    [ -t 2 ] && install+=(-o Dpkg::Progress-Fancy=1)
    "${as_root[@]}" apt-get update -q -o APT::Update::Error-Mode=any >&2 </dev/null || reached=false
    if ! "${as_root[@]}" "${install[@]}" "${missing[@]}" >&2 </dev/null; then
        $reached ||
            die "apt-get cannot reach the package archive (its messages are above): see that there is a network, and start again."
        unknown=$(for entry in "${missing[@]}"; do
            apt-cache policy "$entry" 2>/dev/null | grep -q 'Candidate: [^(]' || echo "$entry"
        done | paste -sd' ')
        [ -z "$unknown" ] ||
            die "apt-get does not know $unknown: this needs Debian 12 (bookworm), with its main archive in apt's sources."
        die "apt-get could not install the packages (its message is above): mend what it names, and start again."
    fi
}
