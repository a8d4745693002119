#!/usr/bin/env bash
# Makes what a container of VRUT Preview is built from: a Debian 12 with the package in it, and no registry.
set -euo pipefail

HERE=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=deploy/packages.sh
source "$HERE/packages.sh"

if [ $# -ne 2 ] || [ ! -f "$1" ]; then
    say "Usage: deploy/container.sh PACKAGE FOLDER

Makes FOLDER/root.tar, a Debian 12 with the package PACKAGE (vrut-preview_VERSION_amd64.deb) and what it depends on, and
puts the Containerfile beside it: 'podman build --format docker -t vrut-preview FOLDER' makes the image of them."
    exit 2
fi
package=$(realpath "$1")
folder=$2
install_packages "${PACKAGING_PACKAGES[@]}"
mkdir -p "$folder"
require_space "$folder" 1200 "The container's root"

# apt and what it has fetched stay out, and so does documentation, but for licences.
mmdebstrap --variant=essential --include="$package" --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
    --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright' \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
    --customize-hook='install -d -o 65532 -g 65532 -m 700 "$1/var/lib/vrut-preview" "$1/var/lib/vrut-preview/recordings"' \
    bookworm "$folder/root.tar"
cp "$HERE/Containerfile" "$folder/"
