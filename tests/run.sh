#!/usr/bin/env bash
# Builds the project and runs its tests; installs the Debian packages that are missing.
set -euo pipefail

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=deploy/packages.sh
source "$ROOT/deploy/packages.sh"

usage() {
    cat <<TEXT
Usage: tests/run.sh [--ci | --all]

Checks the source's format, builds the program, and runs the tests of its parts, of the server, of recorded sessions,
of the protocol and of the command line, and one walk through the page in a browser. Debian packages and node modules
that are missing are installed first.

  --ci      what the tests without an option leave out and fits into forty minutes on two cores: the rest of the tests,
            clang-tidy without its analyzer on the program, and the address and undefined behaviour sanitizers on the
            tests that need no renderer
  --all     both, and clang-tidy's analyzer, and clang-tidy on the tests, the same sanitizers with the real renderer, the
            thread sanitizer, the packages in a bare Debian, the soak tests, the benchmarks and the fuzzers: hours
  --help    this text
TEXT
}

default=true ci=false all=false
while [ $# -gt 0 ]; do
    case $1 in
    --ci) default=false ci=true ;;
    --all) default=true ci=true all=true ;;
    -h | --help)
        usage
        exit 0
        ;;
    *)
        say "run.sh: there is no option '$1'; --help tells which there are."
        exit 2
        ;;
    esac
    shift
done

cd "$ROOT"
jobs=$(parallel_jobs)
# Where there is a cache of compilers' work, the same source is compiled once, wherever it lies. It keeps nothing that
# is compiled with a precompiled header.
configure=()
if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$ROOT CCACHE_NOHASHDIR=1
    configure=(-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON)
else
    export CMAKE_CXX_COMPILER_LAUNCHER=$ROOT/tests/timed-compiler.sh  # for the budget of compile time
fi
default_labels='unit|net|replay|page|contract|cli|walk'
done_steps=0

# Runs a function or command as a named step; when it fails, says so with what to do, and stops.
step() { # NAME REMEDY COMMAND...
    local name=$1 remedy=$2 start=$SECONDS status
    shift 2
    say "[$SECONDS s] $name ..."
    # Not in a condition, where set -e would not hold inside the step.
    set +e
    (set -e && "$@")
    status=$?
    set -e
    if [ "$status" -ne 0 ]; then
        say "[$SECONDS s] FAILED: $name, after $((SECONDS - start)) s and $done_steps steps that passed.${remedy:+ $remedy}"
        exit 1
    fi
    done_steps=$((done_steps + 1))
    say "[$SECONDS s] $name: passed in $((SECONDS - start)) s"
}

sources() { # EXTENSION...
    local folder extension
    for folder in protocol render scenes server tests; do
        for extension in "$@"; do
            find "$folder" -name node_modules -prune -o -name "*.$extension" -print
        done
    done
}

packages() {
    local wanted=("${BUILD_PACKAGES[@]}" "${RUN_PACKAGES[@]}" "${TEST_PACKAGES[@]}")
    if $ci; then wanted+=("${FILM_PACKAGES[@]}" "${ALL_TEST_PACKAGES[@]}" "${PACKAGING_PACKAGES[@]}"); fi
    install_packages "${wanted[@]}"
}

node_modules() {
    cd tests/web
    if [ node_modules/.package-lock.json -nt package-lock.json ]; then return; fi
    npm ci --no-audit --no-fund --ignore-scripts </dev/null
    touch node_modules/.package-lock.json
}

format() {
    sources cpp hpp | xargs -r clang-format-14 --dry-run -Werror
}

configured() { # PRESET
    cmake --preset "$1" "${configure[@]}" >"build/$1.configure.log" 2>&1 || {
        cat "build/$1.configure.log"
        return 1
    }
}

build() { # PRESET CMAKE-BUILD-ARGUMENTS...
    configured "$1"
    NINJA_STATUS='[%p, step %f of %t, %es] ' cmake --build --preset "$1" --parallel "$jobs" "${@:2}"
}

tests() { # PRESET CTEST-ARGUMENTS...
    local status=0
    ctest --preset "$1" --parallel "$(nproc)" --no-tests=error "${@:2}" </dev/null || status=$?
    # Of whole tests that are skipped, and of cases of those that are not.
    awk -v preset="$1" '/^[0-9]+\/[0-9]+ Testing: / { name = $3 }
        /(^|MESSAGE: )skipped/ { print "  " preset ", " name ": " $0 }
        /^Skip regular expression found in output. Regex=\[test cases: \+0 \]/ {
            print "  " preset ", " name ": skipped: the variable " substr(name, index(name, "VRUT_TEST_")) " names no folder"
        }' "build/$1/Testing/Temporary/LastTest.log" >>build/skipped.txt
    return "$status"
}

# What the build compiles, without precompiled headers, since clang-tidy reads no other compiler's; and of this only what
# has changed, itself or some header, since clang-tidy last passed it. Each check goes through all the headers: with the
# files of a library compiled as one it takes half the time. With --all each file stands by itself, so that it has to
# include what it uses.
tidy() { # STAMPS CLANG-TIDY-ARGUMENTS...
    local file name stamp header parts stamps=build/tidy/$1 folders='protocol|render|scenes|server' unity=ON
    if $all; then folders+='|tests' unity=OFF; fi
    local -A queued=()  # what several programs compile is looked at once
    cmake --preset release -B build/tidy -DCMAKE_CXX_COMPILER=clang++-14 -DVRUT_UNITY=$unity \
        -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >build/tidy.configure.log
    mkdir -p "$stamps"
    header=$(sources hpp | xargs ls -t | sed -n 1p)
    # shellcheck disable=SC2016
    sed -nE 's/.*"file": "(.*)".*/\1/p' build/tidy/compile_commands.json |
        while read -r file; do
            name=${file#"$ROOT"/}
            parts=("$file")
            if [[ $name == build/tidy/*/Unity/* ]]; then
                name=${name#build/tidy/}
                mapfile -t parts < <(sed -nE 's/^#include "(.*)"/\1/p' "$file")
            fi
            [[ $name =~ ^($folders)/ ]] || continue
            stamp=$stamps/${name//\//+}
            [ -z "$(find "${parts[@]}" "$header" .clang-tidy -newer "$stamp" 2>&1 | sed -n 1p)" ] && continue
            [ -n "${queued[$file]:-}" ] && continue
            queued[$file]=yes
            printf '%s\0%s\0' "$file" "$stamp"
        done | arguments=${*:2} xargs -0 -r -n 2 -P "$jobs" bash -c 'set -o pipefail; echo "  $(basename "$1")" >&2
            clang-tidy-14 -p build/tidy --quiet --warnings-as-errors="*" $arguments "$0" 2>&1 |
                sed -E "/^[0-9]+ warnings? (generated|treated)/d" && touch "$1"'
}

# A step in the time that those in the foreground leave over, in which they wait for pictures and browsers; it begins
# when the one before it has ended.
begin() { # NAME COMMAND...
    local name=$1 before=${background:-}
    rm -f "build/$name.passed"
    set -m  # a process group of its own
    (
        if [ -n "$before" ]; then tail --pid="$before" --follow /dev/null; fi
        chrt --idle --pid 0 "$BASHPID"
        set -e
        "${@:2}"
        touch "build/$name.passed"
    ) >"build/$name.log" 2>&1 </dev/null &
    background=$!
    backgrounds+=" -$background"
    set +m
    # shellcheck disable=SC2064
    trap "kill --$backgrounds 2>/dev/null || true" EXIT
}

end() { # NAME PROCESS
    tail --lines=+1 --follow --pid="$2" "build/$1.log"
    [ -e "build/$1.passed" ]
}

compile_remedy="The compiler's message is above; if the source is right, remove the folder build and start again."
if ! mkdir -p build 2>/dev/null || [ ! -w build ]; then
    die "cannot write to $ROOT/build: start this as the folder's owner, or from a copy of your own."
fi
space=900
if $ci; then space=3000; fi
if $all; then space=5500; fi
if [ ! -d build/release ]; then require_space build "$space" "Building the program and its tests"; fi

rm -f build/skipped.txt
step "Debian packages" "" packages
step "node modules" "npm's message is above: see that there is a network, and start again." node_modules
step "format" "Run clang-format-14 -i on the files named above." format
step "configuration" "CMake's message is above." configured release
step "programs that tests start" "Do what is said above." node tests/programs.mjs build/release
if $default; then
    step "build of the tests" "$compile_remedy" build release --target default_tests
    # One more at a time than there are cores: some wait for deadlines most of their time.
    step "tests" "Again alone: ctest --preset release -R NAME." tests release -L "^($default_labels)\$" --parallel "$(($(nproc) + 1))"
fi
if $ci; then
    step "build release" "$compile_remedy" build release
    step "budget of compile time" "Do what is said above." node tests/compile-budget.mjs build/release
    begin asan build asan --target tests_without_gpu
    asan=$background
    # The files of a library that are compiled as one are, to it, suspicious.
    if $all; then begin tidy tidy analyzer; else begin tidy tidy one '--checks=-clang-analyzer-*,-bugprone-suspicious-include'; fi
    step "rest of the tests" "Again alone: ctest --preset release -R NAME." tests release -LE "^($default_labels|soak|fuzz|bench|bare)\$"
    step "build asan" "$compile_remedy" end asan "$asan"
    step "tests of asan" "Again alone: ctest --preset asan -R NAME." tests asan -L '^(unit|net|replay)$'
    step "clang-tidy" "Mend what it names above." end tidy "$background"
fi
if $all; then
    step "build asan with the renderer" "$compile_remedy" build asan --target test_renderer test_gl_faults test_soak
    step "tests of asan with the renderer" "Again alone: ctest --preset asan -R NAME." tests asan -R '^(renderer|gl_faults|soak)$'
    step "build tsan" "$compile_remedy" build tsan --target tests_without_gpu
    step "tests of tsan" "Again alone: ctest --preset tsan -R NAME." tests tsan -L '^(unit|net)$'
    step "packages in a bare Debian" "Again alone: ctest --preset release -R NAME." tests release -L '^bare$'
    step "soak tests" "Again alone: ctest --preset release -R NAME." tests release -L '^soak$'
    step "benchmarks" "Again alone: ctest --preset release -R NAME." tests release -L '^bench$'
    step "build fuzz" "$compile_remedy" build fuzz
    step "fuzzers" "Again alone: ctest --preset fuzz -R NAME." tests fuzz -L '^fuzz$'
fi
if [ -s build/skipped.txt ]; then
    say "Skipped, and why:"
    cat build/skipped.txt >&2
fi
say "All $done_steps steps passed in $SECONDS s."
