#!/usr/bin/env bash
# A compiler launcher: runs the compiler, and adds a line to compile-times.tsv in the folder where it runs: the CPU seconds
# of the compiler and of what it started, and the object file.
TIMEFORMAT='%U %S'
object=
for ((i = 1; i < $#; ++i)); do
    if [ "${!i}" = -o ]; then
        next=$((i + 1))
        object=${!next}
    fi
done
exec 3>&2
took=$({ time "$@" >&3 2>&3; } 2>&1 && echo 0 || echo $?)
read -r user system status <<<"${took//$'\n'/ }"
printf '%s\t%s\n' "$(awk "BEGIN { print $user + $system }")" "$object" >>compile-times.tsv
exit "$status"
