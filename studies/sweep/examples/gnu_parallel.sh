#!/usr/bin/env bash
# One shard per core of this machine, or of those in a file: PARALLEL="--sshloginfile hosts"
# (with a shared folder). Debian package: parallel. SHARDS should be a few per core, so that none
# waits long for the last.
set -euo pipefail

fingertip=${FINGERTIP:-fingertip} config=${SWEEP:-sweep.toml} results=${RESULTS:-results}
shards=${SHARDS:-$((4 * $(nproc)))}

# A shard with points that do not converge ends with 3; the table tells which.
seq "$shards" | parallel --halt never "$fingertip" sweep --config "$config" --out "$results" \
  --shard "{}/$shards" --threads 1 --progress off || true
exec "$fingertip" sweep --collect --out "$results"
