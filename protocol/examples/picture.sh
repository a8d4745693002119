#!/usr/bin/env bash
# Fetches the present picture over HTTP, and where there is one from before, only if it has changed.
set -euo pipefail

if [ $# -lt 1 ] || [ "$1" = --help ]; then
    cat <<TEXT
Usage: picture.sh OUT.jpg [WIDTH HEIGHT]

Saves the present view, and its ETag as OUT.jpg.etag; started again, it says whether the view has changed.
The size is 1280 720 if left out. Address and token come from the environment:

  VRUT_PREVIEW_URL     as the server prints it, with its #token; default http://127.0.0.1:8080/
  VRUT_PREVIEW_TOKEN   where the address has none; that of a watcher will do
TEXT
    [ $# -ge 1 ] && exit 0 || exit 2
fi

out=$1 width=${2:-1280} height=${3:-720}
page=${VRUT_PREVIEW_URL:-http://127.0.0.1:8080/}
address=${page%%/#*} token=${VRUT_PREVIEW_TOKEN:-}
case $page in *'#token='*) token=${page##*#token=} ;; esac
[ -f "$out" ] || rm -f "$out.etag"

fetch() { # PATH CURL-OPTIONS...
    local path=$1
    shift
    # The token comes from a file, as everybody on this machine can read a command line.
    curl --silent --show-error --fail --header @<(echo "Authorization: Bearer $token") \
        "$@" "${address%/}$path"
}

fetch /readyz >/dev/null
status=$(fetch "/frame.jpg?width=$width&height=$height" --output "$out" \
    --etag-compare "$out.etag" --etag-save "$out.etag" --write-out '%{http_code}')
if [ "$status" = 304 ]; then echo "$out: unchanged"; else echo "$out: saved"; fi
fetch /metrics | grep -v '^#' # what the server has done so far
