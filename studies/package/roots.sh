#!/usr/bin/env bash
# try.sh in a minimal root of each Debian release, made by debootstrap. As root.
# Usage: roots.sh FILE SUITE..., such as: roots.sh build/release/package/fingertip-0.1.0-x86_64.tar.xz bookworm trixie
set -euo pipefail

file=$(realpath "$1")
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
folder=$(mktemp -d)
trap 'umount -q "$folder"/*/proc || true; rm -rf --one-file-system "$folder"' EXIT
for suite in "${@:2}"; do
  root=$folder/$suite
  debootstrap --variant=minbase "$suite" "$root" >"$folder/$suite.log"
  mount -t proc proc "$root/proc" # where a program learns its own place
  cp "$here/try.sh" "$root"
  given=$(basename "$file")
  if [[ $file == *.tar.xz ]]; then
    tar -C "$root/opt" -xf "$file" # outside: a minimal root has no xz
    given=opt/$(ls "$root/opt")
  else
    cp "$file" "$root"
  fi
  printf '\n==== %s\n' "$suite"
  chroot "$root" env -i PATH="$PATH" HOME=/root bash /try.sh "/$given" 2>&1
done
