#!/usr/bin/env bash
# Builds the lattice's program for 64-bit ARM in a root of Debian 12, presses with it on an emulated processor, and
# compares the forces with those of this machine's program. As root; half an hour.
# Usage: arm64.sh PROGRAM [ROOT], such as: arm64.sh build/release/bin/fingertip (ROOT: kept, for a second call)
set -euo pipefail

program=$(realpath "$1")
sources=$(realpath "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../..")
kept=${2:-}
root=$(realpath -m "${kept:-$(mktemp -d)}")
cd "$sources"
stop() {
  umount -q "$root/proc" || true
  [[ -n $kept ]] || rm -rf --one-file-system "$root"
}
trap stop EXIT
[[ -e $root/etc/debian_version ]] || debootstrap --variant=minbase bookworm "$root" >/dev/null
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
mkdir -p "$root/src"
git ls-files -z | xargs -0 cp --parents --update --target-directory="$root/src"

inside() { chroot "$root" env -i HOME=/root PATH="$PATH" DEBIAN_FRONTEND=noninteractive bash -euo pipefail -c "$@"; }
# What runs while it is built is this machine's, what it is built with the other's; most headers are anybody's.
inside '
  dpkg --add-architecture arm64
  apt-get update -qq
  source <(sed -n "/^packages=(/,/^)/p" /src/fingertip)
  wanted=(g++-aarch64-linux-gnu qemu-user)
  for package in "${packages[@]}"; do
    case $package in
      g++ | binutils) ;;
      lib*) [[ $(apt-cache policy "$package:arm64") == *"Candidate: "[0-9]* ]] && package+=:arm64 ;;&
      *) wanted+=("$package") ;;
    esac
  done
  apt-get install -y -qq --no-install-recommends "${wanted[@]}" >/packages.log
  export PKG_CONFIG_LIBDIR=/usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig
  cmake -S /src -B /build -G Ninja -DFINGERTIP_TESTS=OFF -DFINGERTIP_FEM=OFF \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64 \
    -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ >/configured.log
  time ninja -C /build fingertip >/built.log || { grep -A 5 -E "^FAILED|error:" /built.log | head -n 40; exit 1; }
  '

# compared NAME RESULT WORD...: the same command by both programs; the last row of RESULT, and how far all numbers are apart.
compared() {
  local name=$1 result=$2 scratch
  shift 2
  scratch=$(mktemp -d)
  "$program" "$@" --progress off --out "$scratch/here" >/dev/null
  inside 'cd /src && XDG_CACHE_HOME=/cache qemu-aarch64 /build/bin/fingertip "$@" --progress off --out "/runs/$0" >/dev/null' "$name" "$@"
  python3 - "$name" "$scratch/here/$result" "$root/runs/$name/$result" <<'PYTHON'
import csv, json, sys
name, here, there = sys.argv[1:]
if here.endswith(".csv"):
    rows = [[{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(open(path))] for path in (here, there)]
    force = next(key for key in rows[0][0] if key.startswith("normal_force"))
    a, b = ([row[force] for row in table] for table in rows)
else:
    a, b = ([x["estimate"] for x in json.load(open(path))["parameters"]] for path in (here, there))
apart = max(abs(x - y) for x, y in zip(a, b, strict=True)) / max(map(abs, a))
print(f"{name}: {a[-1]!r} here, {b[-1]!r} on ARM; all {len(a)} within {apart:.1e}")
sys.exit(apart > 1e-9)
PYTHON
  rm -rf "$scratch" "$root/runs/$name"
}
compared rest response.csv press --set press.mode=static
compared motion response.csv press --set lattice.spacing=tip_radius/10 --set press.depth="0.5 mm"
compared scaled response.csv press --set lattice.spacing=tip_radius/10 --set run.integrator=mass-scaled
compared fit calibration.json calibrate --config studies/examples/my_press.toml --set calibration.forward=lattice \
  --set lattice.spacing=tip_radius/8
echo "== the same on ARM"
