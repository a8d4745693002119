#!/usr/bin/env bash
# Starts on this machine what several machines would run: a NATS server, two servers of the room 'car', two edges, and
# HAProxy before the edges.
set -euo pipefail

# shellcheck source=deploy/packages.sh
source "$(dirname "${BASH_SOURCE[0]}")/packages.sh"

usage() {
    cat <<TEXT
Usage: deploy/several.sh [--port PORT] PROGRAM [SCENE]

Starts a NATS server, two servers of the room 'car', two edges, and HAProxy before the edges. It prints the room's
address when clients can come in. SIGINT, SIGTERM and SIGHUP end all of them.

  PROGRAM       the built vrut-preview
  SCENE         serve this scene file, not the car
  --port PORT   HAProxy listens on this port of 127.0.0.1; default: 8080
  --help        this text
TEXT
}

port=8080
case ${1:-} in
--port)
    port=${2:-}
    shift $(($# < 2 ? $# : 2))
    ;;
-h | --help)
    usage
    exit 0
    ;;
esac
if [ $# -lt 1 ] || [ $# -gt 2 ] || [[ ! $port =~ ^[0-9]+$ ]]; then
    usage >&2
    exit 2
fi
program=$1
scene=("${@:2}")

install_packages "${SEVERAL_PACKAGES[@]}"
PATH=$PATH:/usr/sbin  # of nats-server and haproxy
unset VRUT_PREVIEW_CONTROL_TOKEN VRUT_PREVIEW_VIEW_TOKEN  # what listens here serves this machine alone

folder=$(mktemp -d "${TMPDIR:-/tmp}/vrut-several.XXXXXX")
declare -A names=()  # of the processes that run, by their ids

end_all() {
    local _
    [ ${#names[@]} -eq 0 ] || kill "${!names[@]}" 2>/dev/null || true
    for _ in {1..50}; do
        kill -0 "${!names[@]}" 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL "${!names[@]}" 2>/dev/null || true
    rm -rf "$folder"
}
trap end_all EXIT
trap 'exit 0' INT TERM HUP

# A port of 127.0.0.1 at which nothing answers.
free_port() {
    local candidate
    while candidate=$((20000 + RANDOM % 10000)); do
        (: <>"/dev/tcp/127.0.0.1/$candidate") 2>/dev/null || break
    done
    echo "$candidate"
}

start() { # NAME PORT COMMAND...
    local name=$1 at=$2
    shift 2
    "$@" >"$folder/$name.log" 2>&1 &
    names[$!]=$name
    say "$name: process $!, 127.0.0.1:$at"
}

# Says which processes have ended. Stops if the others cannot go on without them.
check_processes() {
    local id name status
    for id in "${!names[@]}"; do
        kill -0 "$id" 2>/dev/null && continue
        name=${names[$id]} status=0
        wait "$id" 2>/dev/null || status=$?
        unset "names[$id]"
        say "$name has ended with status $status. Its last lines:"
        tail -n 3 "$folder/$name.log" >&2
    done
    for name in "$@"; do
        [[ " ${names[*]}" == *" $name"* ]] || die "there is no $name left, so the others end as well."
    done
}

nats=$(free_port)
start nats-server "$nats" nats-server -a 127.0.0.1 -p "$nats" -js -sd "$folder/nats"
until grep -qs 'Server is ready' "$folder/nats-server.log"; do
    check_processes nats-server
    sleep 0.1
done

for name in server-1 server-2; do
    own=$(free_port)
    start $name "$own" "$program" serve "${scene[@]}" --listen "127.0.0.1:$own" --nats "nats://127.0.0.1:$nats" --room car
done
edges=()
for name in edge-1 edge-2; do
    own=$(free_port)
    start $name "$own" "$program" edge --listen "127.0.0.1:$own" --nats "nats://127.0.0.1:$nats"
    edges+=("server $name 127.0.0.1:$own")
done

# As haproxy-edges.cfg, for this machine alone.
cat >"$folder/haproxy.cfg" <<TEXT
defaults
    mode http
    timeout client 30s
    timeout connect 2s
    timeout server 30s
    timeout tunnel 3600s
    option redispatch 1

frontend tablets
    bind 127.0.0.1:$port
    default_backend edges

backend edges
    balance leastconn
    stick-table type ipv6 size 1k expire 1h
    stick on src
    option httpchk
    http-check send meth GET uri /readyz ver HTTP/1.1 hdr Host localhost
    http-check expect status 200
    default-server check inter 500ms fall 2 rise 1 on-marked-down shutdown-sessions
    ${edges[0]}
    ${edges[1]}
TEXT
start haproxy "$port" haproxy -db -f "$folder/haproxy.cfg"

required=(nats-server server edge haproxy)
until curl -fs --max-time 5 -o "$folder/readyz" "http://127.0.0.1:$port/rooms/car/readyz"; do
    check_processes "${required[@]}"
    sleep 0.2
done
say "End any server or edge with 'kill -9 PROCESS': clients go on with the other one. Ctrl-C ends all."
echo "http://127.0.0.1:$port/rooms/car/"
while sleep 0.5; do check_processes "${required[@]}"; done
