#!/usr/bin/env bash
# Installs a package on this machine, best one that has nothing (see README), and does with it what a
# newcomer does. As root. Usage: try.sh fingertip_VERSION_amd64.deb
set -euo pipefail

package=$(realpath "$1")
cd "$(mktemp -d)"
step() {
  printf '\n== %s\n' "$*"
  SECONDS=0
  "$@"
  printf '== %d s\n' "$SECONDS"
}
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
step apt-get install -y -qq --no-install-recommends --download-only "$package"
step apt-get install -y -qq --no-install-recommends "$package" >install.log
tail -n 1 install.log
dpkg-query -W -f '${Package} ${Version}, ${Installed-Size} KiB\n' fingertip
df -h /
step fingertip press --set rubber.youngs_modulus="20 kPa" --set press.mode=static --out press
step fingertip validate --out validate
test -s validate/report.html
step fingertip live --exit-after 5
step fingertip web --out web
step fingertip export --format fmu --out unit
step python3 -c 'import fingertip
press = fingertip.press(rubber_youngs_modulus="20 kPa", press_mode="static", out="by_python")
print(f"{1e3 * press.normal_force[-1]:.1f} mN at {1e3 * press.indentation[-1]:.1f} mm")'
echo "== all of it works"
