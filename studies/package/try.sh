#!/usr/bin/env bash
# Puts what `fingertip package` wrote on this machine, best one that has nothing (see README), and does with it what a
# newcomer does. Usage, as root: try.sh fingertip_VERSION_amd64.deb | fingertip-VERSION-*.whl |
# fingertip-VERSION-x86_64.tar.xz | the FOLDER that is in it
set -euo pipefail

what=$(realpath "$1")
cd "$(mktemp -d)"
if [[ $what == *.tar.xz ]]; then
  command -v xz >/dev/null || { apt-get update -qq && apt-get install -y -qq xz-utils >install.log; } # to unpack it
  tar -xf "$what"
  what=$(realpath fingertip-*)
fi
step() {
  printf '\n== %s\n' "$*"
  SECONDS=0
  "$@"
  printf '== %d s\n' "$SECONDS"
}
export DEBIAN_FRONTEND=noninteractive
python=python3
case $what in
  *.deb)
    apt-get update -qq
    step apt-get install -y -qq --no-install-recommends --download-only "$what"
    step apt-get install -y -qq --no-install-recommends "$what" >install.log
    tail -n 1 install.log
    dpkg-query -W -f '${Package} ${Version}, ${Installed-Size} KiB\n' fingertip
    ;;
  *.whl)
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends python3-venv python3-numpy >install.log # NumPy is its only need
    python3 -m venv --system-site-packages venv
    step venv/bin/pip install --quiet --no-index "$what"
    export PATH=$PWD/venv/bin:$PATH
    ;;
  *)
    export PATH=$what/bin:$PATH PYTHONPATH=$what/python
    python= # nothing is added: there is none
    ;;
esac
step fingertip press --set rubber.youngs_modulus="20 kPa" --set press.mode=static --out press
step fingertip validate --progress off --out validate
test -s validate/report.html
step fingertip live --exit-after 5
step fingertip web --out web
step fingertip export --format fmu --out unit
[[ -z $python ]] || step $python -c 'import fingertip
press = fingertip.press(rubber_youngs_modulus="20 kPa", press_mode="static", out="by_python")
print(f"{1e3 * press.normal_force[-1]:.1f} mN at {1e3 * press.indentation[-1]:.1f} mm")'
tail -n 1 press/response.csv | cut -d, -f1,2
echo "== all of it works"
