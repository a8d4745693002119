#!/usr/bin/env bash
# Builds VRUT Preview and starts its server with the car; installs the Debian packages that are missing.
set -euo pipefail

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=deploy/packages.sh
source "$ROOT/deploy/packages.sh"

usage() {
    cat <<TEXT
Usage: deploy/quickstart.sh [--lan] [-- SERVE-ARGUMENTS...]
       deploy/quickstart.sh --several [-- SCENE]

Installs the Debian packages that are missing, builds the program, and starts its server.
When everything is there, it starts at once.

  --lan     serve tablets and other computers on the network (0.0.0.0:8080, by HTTPS, with access tokens),
            not this computer alone (127.0.0.1:8080)
  --several
            start what several machines would run, on this computer alone: a NATS server, two servers of one room,
            two edges, and HAProxy before them (http://127.0.0.1:8080/rooms/car/)
  --help    this text
  --        what follows goes to 'vrut-preview serve': a scene, --listen ADDRESS:PORT, ...; with --several, only a scene
TEXT
}

serve=(serve) lan=false several=false
while [ $# -gt 0 ]; do
    case $1 in
    --lan)
        lan=true
        serve+=(--lan)
        ;;
    --several) several=true ;;
    -h | --help)
        usage
        exit 0
        ;;
    --)
        shift
        break
        ;;
    *)
        say "quickstart.sh: there is no option '$1'; --help tells which there are."
        exit 2
        ;;
    esac
    shift
done
if $several && { $lan || [ $# -gt 1 ] || [[ ${1:-} == -* ]]; }; then
    say "quickstart.sh: --several serves this computer alone, and takes nothing but a scene: leave out the other options."
    exit 2
fi

# Configures where that has not been done, and builds; the build tool says how far it is.
build() {
    cd "$ROOT"
    if [ ! -f "$folder/build.ninja" ]; then
        cmake --preset release -B "$folder" -DVRUT_TESTS=OFF || return
    fi
    NINJA_STATUS='[%p, step %f of %t, %es] ' cmake --build "$folder" --target vrut-preview car --parallel "$(parallel_jobs)"
}

install_packages "${BUILD_PACKAGES[@]}" "${RUN_PACKAGES[@]}"

folder=build/quickstart
if [ -x "$ROOT/build/release/server/vrut-preview" ] && [ -f "$ROOT/build/release/build.ninja" ]; then
    folder=build/release
fi
if ! mkdir -p "$ROOT/$folder" 2>/dev/null || [ ! -w "$ROOT/$folder" ]; then
    die "cannot write to $ROOT/$folder: start this as the folder's owner, or from a copy of your own."
fi
program=$ROOT/$folder/server/vrut-preview
if [ ! -x "$program" ]; then
    require_space "$ROOT/$folder" 400 "Building the program"
    say "Building the program in $folder; the first time takes two to four minutes on two cores."
fi
(build) 2>&1 | tee "$ROOT/$folder/quickstart.log" >&2 ||
    die "the build failed (its last lines are above, all of them in $folder/quickstart.log): if the source is unchanged, remove $folder and start again."

if $several; then exec "$ROOT/deploy/several.sh" "$program" "$@"; fi
say "Starting: vrut-preview ${serve[*]} $*"
exec "$program" "${serve[@]}" "$@"
